"""What tests over all formats need to know of them."""

from pathlib import Path

LINES = (".irdata", ".csv", ".jsonl")
"""Formats of text: a file that was cut is read up to its last whole line."""

FOLDERS = (".rosbag",)

SLOW_TO_OPEN = (".parquet", ".rosbag")
"""Formats of which a few hundred damaged files take a second."""


def data_file(path: Path) -> Path:
    """The file that holds the rows of a stream."""
    return path / "stream.mcap" if path.suffix in FOLDERS else path


def content_of(path: Path) -> dict[str, bytes]:
    """Bytes of a stream's file, or of all files of its folder."""
    files = sorted(path.iterdir()) if path.is_dir() else [path]
    return {file.name if path.is_dir() else "": file.read_bytes() for file in files}
