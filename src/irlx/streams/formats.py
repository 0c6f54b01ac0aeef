"""Which file ending belongs to which stream format."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from irlx.diagnostics import report
from irlx.streams.atomic import check_writable
from irlx.streams.csv_reader import scan_csv
from irlx.streams.csv_writer import CsvWriter
from irlx.streams.error import StreamError
from irlx.streams.irdata import IrdataWriter, scan_irdata
from irlx.streams.joint_stream import BlockRecord, JointStream, StreamHeader
from irlx.streams.jsonl_reader import scan_jsonl
from irlx.streams.jsonl_writer import JsonlWriter
from irlx.streams.npz_reader import scan_npz
from irlx.streams.npz_writer import NpzWriter
from irlx.streams.parquet import check_parquet, parquet_writer, scan_parquet
from irlx.streams.rosbag import check_rosbag, rosbag_writer, scan_rosbag
from irlx.streams.scan import RowBatch, ScanItem, StreamEnd, collect, in_order
from irlx.streams.writer import StreamWriter


@dataclass(frozen=True)
class StreamFormat:
    """One format: its file ending, a title for people, writer and scanner, and whether blocks survive.

    `check` raises what writing to a path would raise at once, and leaves no trace.
    """

    ending: str
    title: str
    writer: Callable[[Path, StreamHeader], StreamWriter]
    scan: Callable[[Path], Iterator[ScanItem]]
    carries_blocks: bool
    check: Callable[[Path], None] = check_writable


FORMATS = {
    known.ending: known
    for known in (
        StreamFormat(".irdata", "IRDATA-like records", IrdataWriter, scan_irdata, carries_blocks=True),
        StreamFormat(".csv", "CSV", CsvWriter, scan_csv, carries_blocks=False),
        StreamFormat(".npz", "NPZ", NpzWriter, scan_npz, carries_blocks=True),
        StreamFormat(".jsonl", "JSON Lines", JsonlWriter, scan_jsonl, carries_blocks=True),
        StreamFormat(".parquet", "Parquet", parquet_writer, scan_parquet, True, check_parquet),
        StreamFormat(".rosbag", "ROS 2 bag", rosbag_writer, scan_rosbag, True, check_rosbag),
    )
}
"""Every format by its ending, lower case with the dot."""

_OF_A_PROGRAM = "this is a program; irlx run {path} -o out.irdata writes its stream, which can be given here"
KNOWN_ENDINGS: tuple[str, ...] = tuple(FORMATS)
"""File endings that `write_stream` and `read_stream` know."""


def write_stream(stream: JointStream, path: str | os.PathLike[str]) -> None:
    """Write a stream in the format of the path's ending; the file appears whole or not at all.

    Raises StreamError: IRL004 for an unknown ending, IRL003 where the file cannot be written, IRL720 where
    the format needs a package that is not installed.
    """
    with open_writer(path, stream.header) as writer:
        for item in in_order(stream):
            put(item, writer)


def open_writer(path: str | os.PathLike[str], header: StreamHeader) -> StreamWriter:
    """A writer in the format of the path's ending, to which a stream is given as it comes.

    Raises StreamError: IRL004 for an unknown ending, IRL003 where no file can be written there, IRL720.
    """
    return format_of(path, "IRL004").writer(Path(path), header)


def put(item: ScanItem, writer: StreamWriter) -> None:
    """Give an item of a scan to a writer, which has the header; the end closes it."""
    if isinstance(item, BlockRecord):
        writer.block(item)
    elif isinstance(item, RowBatch):
        writer.samples(item.ticks, item.q, item.block, item.tool)
    elif isinstance(item, StreamEnd):
        writer.close(item.complete)


def read_stream(path: str | os.PathLike[str]) -> JointStream:
    """Read a stream in the format of the path's ending.

    Raises StreamError: IRL707 for an unknown ending, otherwise what the reader of the format raises.
    """
    return collect(scan_stream(path))


def scan_stream(path: str | os.PathLike[str]) -> Iterator[ScanItem]:
    """Scan of a stream file in the format of the path's ending, with little memory whatever its size.

    The header comes first, the end last, block records and batches of rows in between. Raises
    StreamError: IRL707 for an unknown ending and IRL720 at once, otherwise what the scanner of the format
    raises, when what stands before the damage has been given out.
    """
    return format_of(path, "IRL707").scan(Path(path))


def format_of(path: str | os.PathLike[str], code: str = "IRL707") -> StreamFormat:
    """The format of a path's ending; raises StreamError with `code` for an unknown one."""
    ending = Path(path).suffix
    chosen = FORMATS.get(ending.lower())
    if chosen is None:
        help = _OF_A_PROGRAM if code == "IRL707" and ending.lower() == ".irl" else None
        raise StreamError(report(code, help=help, path=path, ending=ending, known=", ".join(KNOWN_ENDINGS)))
    return chosen
