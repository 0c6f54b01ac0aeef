"""Conversion of streams to other formats and to programs of controllers: what `irlx convert` does."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from irlx.blocks import InputBlock, SignalBlock, WaitBlock
from irlx.diagnostics import Diagnostic, Place, report
from irlx.exporters import TARGETS, ProgramWriter, Target, target_of_ending
from irlx.streams.error import StreamError
from irlx.streams.formats import FORMATS, open_writer, put, scan_stream
from irlx.streams.joint_stream import BlockRecord, JointStream, StreamHeader
from irlx.streams.scan import RowBatch, ScanItem, in_file_order, scan_of
from irlx.streams.writer import StreamWriter

if TYPE_CHECKING:
    # Not imported: a run brings along all that made it, of which nothing is wanted here.
    from irlx.report.run import Run

PathLike = str | os.PathLike[str]


def convert(
    source: PathLike | JointStream | Run,
    out: PathLike | Sequence[PathLike],
    target: str | None = None,
    incomplete: bool = False,
) -> tuple[Diagnostic, ...]:
    """Write a stream in another format, or as a program of a controller; returns notes on what it became.

    `source` is a stream file, a stream in memory, or a run. The ending of each `out` chooses its format,
    or the controller; with `target` ('urscript', 'krl', 'rapid', 'robodk') every `out` is a program for it.
    A stream that did not come to its end stays marked so; no program is made of it unless `incomplete` is
    True. A file is read in portions, whatever its length; files appear whole or not at all. Raises
    StreamError: IRL004 for an unknown ending, IRL005 where `source` would be overwritten, IRL006 for an
    unknown target or an ending that is not its own, IRL710 to IRL717 for what a target cannot play, and
    what reading and writing raise.
    """
    outputs = [Path(out)] if isinstance(out, str | os.PathLike) else [Path(path) for path in out]
    chosen = [(path, _target_of(path, target)) for path in outputs]
    if isinstance(source, str | os.PathLike):
        scan = in_file_order(scan_stream(source))
        _check_others(Path(source), outputs)
    else:
        scan = in_file_order(scan_of(source if isinstance(source, JointStream) else source.stream))
    header = next(scan)
    if not isinstance(header, StreamHeader):
        raise ValueError("a scan begins with the header")
    # Programs first: they may still refuse the end, and then nothing at all is to appear.
    chosen.sort(key=lambda pair: pair[1] is None)
    with ExitStack() as opened:
        writers = [opened.enter_context(_open(*pair, header, incomplete)) for pair in chosen]
        lost = _feed(scan, writers)
    notes = [note for writer in writers if isinstance(writer, ProgramWriter) for note in writer.notes]
    for path, to in chosen:
        known = FORMATS.get(path.suffix.lower()) if to is None else None
        if known is not None and lost.blocks and not known.carries_blocks:
            notes.append(_left_out(path, known.title, "blocks", lost.blocks))
        if known is not None and known.carries_blocks and lost.names_blocks and not lost.blocks:
            notes.append(_without_blocks(path, known.title))
        if to is not None and lost.signals:
            title = to.writer.profile.title
            notes.append(_left_out(path, title, "outputs, inputs and conditions of waits", lost.signals))
    return tuple(notes)


class _Counts(NamedTuple):
    """What was in a scan: block records, those that are signals or wait for one; whether rows name blocks."""

    blocks: int
    signals: int
    names_blocks: bool


def _feed(scan: Iterator[ScanItem], writers: Sequence[StreamWriter]) -> _Counts:
    """Give all that is left of a scan to every writer; returns what only some of them can hold."""
    blocks = signals = 0
    names_blocks = False
    for item in scan:
        if isinstance(item, BlockRecord):
            blocks += 1
            waits = isinstance(item.block, WaitBlock) and bool(item.block.condition)
            signals += waits or isinstance(item.block, SignalBlock | InputBlock)
        elif isinstance(item, RowBatch):
            names_blocks = names_blocks or bool(item.block.any())
        for writer in writers:
            put(item, writer)
    return _Counts(blocks, signals, names_blocks)


def _left_out(path: Path, title: str, what: str, number: int) -> Diagnostic:
    return report("IRL719", Place(str(path)), format=title, what=what, number=number)


def _without_blocks(path: Path, title: str) -> Diagnostic:
    known = ", ".join(ending for ending, format in FORMATS.items() if format.carries_blocks)
    return report("IRL729", Place(str(path)), title=title, known=known)


def _open(path: Path, target: Target | None, header: StreamHeader, incomplete: bool) -> StreamWriter:
    if target is None:
        return open_writer(path, header)
    return target.writer(path, header, incomplete)


def _target_of(path: Path, name: str | None) -> Target | None:
    """Target of an output, None for a stream format. Raises IRL004 and IRL006."""
    ending = path.suffix.lower()
    own = target_of_ending(ending)
    if name is None:
        if own is None and ending not in FORMATS:
            known = ", ".join(
                [*FORMATS, *(target.ending for target in TARGETS.values() if target.owns_ending)]
            )
            raise StreamError(report("IRL004", path=path, ending=path.suffix, known=known))
        return own
    target = TARGETS.get(name)
    if target is None:
        cause = f"no such target; known: {', '.join(TARGETS)}"
        raise StreamError(report("IRL006", option="--to", value=name, cause=cause))
    if ending != target.ending and (own is not None or ending in FORMATS):
        cause = f"{path} has the ending of another format; name it {path.with_suffix(target.ending).name}"
        raise StreamError(report("IRL006", option="--to", value=name, cause=cause))
    return target


def _check_others(source: Path, outputs: Sequence[Path]) -> None:
    """Raise IRL005 where an output is the source, by whatever name."""
    for path in outputs:
        if path.exists() and source.exists() and path.samefile(source):
            raise StreamError(report("IRL005", option="-o", path=path))
