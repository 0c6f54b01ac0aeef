"""Which file ending belongs to which stream format."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from irlx.diagnostics import report
from irlx.streams.csv_format import write_csv
from irlx.streams.csv_reader import scan_csv
from irlx.streams.error import StreamError
from irlx.streams.irdata import IrdataWriter, scan_irdata
from irlx.streams.joint_stream import JointStream
from irlx.streams.npz_format import write_npz
from irlx.streams.npz_reader import scan_npz
from irlx.streams.scan import ScanItem, collect


@dataclass(frozen=True)
class StreamFormat:
    """One format: its file ending, a title for people, writer and scanner, and whether blocks survive."""

    ending: str
    title: str
    write: Callable[[JointStream, Path], None]
    scan: Callable[[Path], Iterator[ScanItem]]
    carries_blocks: bool


def write_irdata(stream: JointStream, path: str | os.PathLike[str]) -> None:
    """Write a whole stream as IRDATA-like records, each block after the sample of its tick."""
    with IrdataWriter(path, stream.header) as writer:
        done = 0
        for record in stream.records:
            upto = int(stream.ticks.searchsorted(record.tick, side="right"))
            if upto > done:
                part = slice(done, upto)
                writer.samples(stream.ticks[part], stream.q[part], stream.block[part], stream.tool[part])
                done = upto
            writer.block(record)
        rest = slice(done, None)
        writer.samples(stream.ticks[rest], stream.q[rest], stream.block[rest], stream.tool[rest])
        writer.close(stream.complete)


FORMATS = {
    known.ending: known
    for known in (
        StreamFormat(".irdata", "IRDATA-like records", write_irdata, scan_irdata, carries_blocks=True),
        StreamFormat(".csv", "CSV", write_csv, scan_csv, carries_blocks=False),
        StreamFormat(".npz", "NPZ", write_npz, scan_npz, carries_blocks=True),
    )
}
"""Every format by its ending, lower case with the dot."""

KNOWN_ENDINGS: tuple[str, ...] = tuple(FORMATS)
"""File endings that `write_stream` and `read_stream` know."""


def write_stream(stream: JointStream, path: str | os.PathLike[str]) -> None:
    """Write a stream in the format of the path's ending; the file appears whole or not at all.

    Raises StreamError: IRL004 for an unknown ending, IRL003 where the file cannot be written.
    """
    format_of(path, "IRL004").write(stream, Path(path))


def read_stream(path: str | os.PathLike[str]) -> JointStream:
    """Read a stream in the format of the path's ending.

    Raises StreamError: IRL707 for an unknown ending, otherwise what the reader of the format raises.
    """
    return collect(scan_stream(path))


def scan_stream(path: str | os.PathLike[str]) -> Iterator[ScanItem]:
    """Scan of a stream file in the format of the path's ending, with little memory whatever its size.

    The header comes first, the end last, block records and batches of rows in between. Raises
    StreamError: IRL707 for an unknown ending at once, otherwise what the scanner of the format raises,
    when what stands before the damage has been given out.
    """
    return format_of(path, "IRL707").scan(Path(path))


def format_of(path: str | os.PathLike[str], code: str = "IRL707") -> StreamFormat:
    """The format of a path's ending; raises StreamError with `code` for an unknown one."""
    ending = Path(path).suffix
    chosen = FORMATS.get(ending.lower())
    if chosen is None:
        raise StreamError(report(code, path=path, ending=ending, known=", ".join(KNOWN_ENDINGS)))
    return chosen
