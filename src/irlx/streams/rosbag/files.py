"""The two files of a bag, and what tells a bag of irlx from other folders."""

from __future__ import annotations

from pathlib import Path

MCAP, METADATA = "stream.mcap", "metadata.yaml"
"""Names of the files, the same in every bag: a bag that is renamed stays whole."""

FORMAT = "ROS 2 bag"
MAGIC = b"\x89MCAP0\r\n"
LIBRARY = "irlx"
HEAD = MAGIC + b"\x01" + (16).to_bytes(8, "little") + b"\4\0\0\0ros2" + b"\4\0\0\0" + LIBRARY.encode()
"""How every MCAP file of irlx begins: a header record with profile and library."""


def may_replace(folder: Path) -> None:
    """Raise ValueError unless a folder is a bag that irlx wrote, with nothing else in it."""
    names = {entry.name for entry in folder.iterdir()}
    if names != {MCAP, METADATA}:
        raise ValueError("it is a folder, and no ROS 2 bag of irlx that could be replaced")
    with (folder / MCAP).open("rb") as handle:
        if handle.read(len(HEAD)) != HEAD:
            raise ValueError("it is a ROS 2 bag that irlx did not write")
