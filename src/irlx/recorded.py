"""A recorded execution in the place of a program: its blocks are carried out again."""

from __future__ import annotations

import hashlib
from collections.abc import Generator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from irlx.blocks import (
    AskInput,
    AskStandstill,
    Block,
    InputBlock,
    MoveBlock,
    ObstacleBlock,
    Origin,
    Question,
    ReconfigureBlock,
    SignalBlock,
)
from irlx.blocks.sense import senseless
from irlx.cell.cell import Cell
from irlx.cell.errors import CellError
from irlx.cell.find import find_cell
from irlx.diagnostics import Diagnostic, IrlxError, Place, SourceText, Span, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.diagnostics.whole_file import whole_file
from irlx.language.source import decode_source
from irlx.language.suppression import Ignore
from irlx.pacing.inputs import Inputs
from irlx.streams.error import broken
from irlx.streams.formats import KNOWN_ENDINGS, format_of, scan_stream
from irlx.streams.joint_stream import BlockRecord, StreamHeader
from irlx.streams.scan import RowBatch, StreamEnd

Reply = tuple[float, ...] | None


@dataclass(frozen=True)
class Recorded:
    """The blocks of a stream file, and where the robot stood although a move was to pass its target.

    `stopped` are ids of moves before which it did. `source` is the text of the program where that very file
    stands beside the stream. A program has the other parts; here they are empty.
    """

    path: Path
    header: StreamHeader
    records: tuple[BlockRecord, ...]
    stopped: frozenset[int]
    stream_sha256: str
    source: SourceText | None = None
    diagnostics: tuple[Diagnostic, ...] = ()
    ignores: tuple[Ignore, ...] = ()
    data_lists: tuple[Any, ...] = field(default=(), init=False)
    modules: tuple[Any, ...] = field(default=(), init=False)
    all_lists: tuple[Any, ...] = field(default=(), init=False)

    @property
    def file_name(self) -> str:
        """Name of the file of the program that was recorded."""
        return self.header.program_name

    @property
    def sha256(self) -> str:
        """Digest of that program."""
        return self.header.program_sha256

    @property
    def move_count(self) -> int:
        """Number of its moves."""
        return sum(isinstance(record.block, MoveBlock | ReconfigureBlock) for record in self.records)

    @property
    def has_tolerances(self) -> bool:
        """Whether any of its moves is WITH TOLERANCE."""
        blocks = (record.block for record in self.records)
        return any(isinstance(block, MoveBlock) and block.tolerance is not None for block in blocks)

    def place(self, origin: Origin) -> Place:
        """Where a block comes from: in the text, or the line alone where the text is not there."""
        if self.source is not None and origin.file == self.file_name:
            return Place.in_text(self.source, Span(origin.start, origin.end))
        return Place(origin.file, key=f"line {origin.line}")

    def replayed(self, inputs: Inputs, cell: Cell) -> Generator[Block | Question, Reply, None]:
        """The blocks, and a question before each that must find the robot at rest, or an input as recorded.

        Raises IrlxError: IRL728 for an input that says something else by now, IRL573 for an obstacle that the
        cell does not have.
        """
        for record in self.records:
            block = record.block
            if block.id in self.stopped:
                yield AskStandstill(block.origin)
            if isinstance(block, InputBlock) and inputs.knows((block.port.name,)):
                said = yield AskInput(block.origin, block.port, (block.port.name,))
                if said is not None and said[0] != block.value:
                    raise IrlxError(self._other_input(block, said[0]))
            if isinstance(block, ObstacleBlock):
                self._check_obstacle(block, cell)
            yield block

    def _other_input(self, block: InputBlock, said: float) -> Diagnostic:
        found = {"name": block.port.name, "recorded": f"{block.value:g}", "value": f"{said:g}"}
        return report("IRL728", self.place(block.origin), **found)  # type: ignore[arg-type]

    def _check_obstacle(self, block: ObstacleBlock, cell: Cell) -> None:
        known = sorted({*cell.scene.obstacles, *cell.scene.groups})
        if block.name.casefold() not in {name.casefold() for name in known}:
            near = near_matches(block.name, known)
            told: dict[str, Any] = {"name": block.name, "near": near, "known": ", ".join(known) or "none"}
            raise IrlxError(report("IRL573", self.place(block.origin), **told))


def is_recorded(path: Path) -> bool:
    """Whether a file is a stream by its ending."""
    return path.suffix.lower() in KNOWN_ENDINGS


def recorded(path: Path) -> Recorded:
    """The execution that a stream file holds.

    Raises StreamError where it cannot be read, IRL701 also for a block that nobody could carry out;
    IrlxError: IRL725 for one without blocks, IRL726 for one that did not come to its end.
    """
    if not format_of(path).carries_blocks:
        with_blocks = ", ".join(ending for ending in KNOWN_ENDINGS if format_of(f"x{ending}").carries_blocks)
        raise IrlxError(report("IRL725", Place(str(path)), known=with_blocks))
    scan = scan_stream(path)
    header = next(scan)
    assert isinstance(header, StreamHeader)
    records, complete = [], False
    for item in scan:
        if isinstance(item, BlockRecord):
            wrong = senseless(item.block, len(header.joint_names))
            if wrong:
                raise broken(path, format_of(path).title, wrong, f"block {item.block.id}")
            records.append(item)
        elif isinstance(item, StreamEnd):
            complete = item.complete
    if not complete:
        raise IrlxError(report("IRL726", Place(str(path))))
    stopped = _stopped(path, records)
    return Recorded(path, header, tuple(records), stopped, _digest(path), text_beside(path, header))


def cell_of(found: Recorded, given: Path | None) -> Path:
    """Path of the cell file to replay in. Raises CellError, IRL609, that lists what was tried."""
    return cell_beside(found.path, found.header, given)


def cell_beside(path: Path, header: StreamHeader, given: Path | None) -> Path:
    """Path of the cell file of a stream at `path`. Raises CellError, IRL609, that lists what was tried."""
    if given is not None:
        return given
    name, folder = header.cell_name, path.parent
    # A stream is anybody's: a plain name only, and nothing but a cell file is read there.
    named = [folder / name, Path(name)] if name and Path(name).name == name else []
    return find_cell(list(dict.fromkeys([*named, path.with_suffix(".toml")])), Place(str(path)))


def check_joints(header: StreamHeader, cell: Cell) -> None:
    """Raises CellError, IRL727, for a robot with other joints than the recorded one."""
    expected, names = header.joint_names, cell.robot.joint_names
    if expected != names:
        told: dict[str, Any] = {"expected": ", ".join(expected), "found": ", ".join(names)}
        raise CellError(report("IRL727", Place(cell.file), **told))


def _stopped(path: Path, records: list[BlockRecord]) -> frozenset[int]:
    """Ids of the moves at whose beginning the robot stood though the move before was to pass its target."""
    asked: dict[int, list[int]] = {}
    passing = False
    for record in records:
        if isinstance(record.block, MoveBlock) and passing and record.tick > 0:
            asked.setdefault(record.tick, []).append(record.block.id)
        if not isinstance(record.block, SignalBlock):
            passing = isinstance(record.block, MoveBlock) and record.block.blend is not None
    if not asked:
        return frozenset()
    ticks, stood = np.array(sorted(asked)), []
    before = None
    for item in scan_stream(path):
        if not isinstance(item, RowBatch):
            continue
        q = item.q if before is None else np.vstack([before, item.q])
        first = np.zeros(int(before is None), dtype=np.bool_)
        rests = np.concatenate([first, np.all(q[1:] == q[:-1], axis=1)])
        stood += item.ticks[rests & np.isin(item.ticks, ticks)].tolist()
        before = item.q[-1:] if len(item.q) else before
    return frozenset(number for tick in stood for number in asked[tick])


def _digest(path: Path) -> str:
    digest = hashlib.sha256()
    files = [path] if path.is_file() else sorted(entry for entry in path.rglob("*") if entry.is_file())
    for file in files:
        with file.open("rb") as handle:
            while data := handle.read(1 << 20):
                digest.update(data)
    return digest.hexdigest()


def text_beside(path: Path, header: StreamHeader) -> SourceText | None:
    """Text of the program, where its very file is beside the stream and all there is to it."""
    if Path(header.program_name).name != header.program_name:
        return None
    file = path.with_name(header.program_name) if header.program_name else path
    try:
        content = whole_file(file)
        if hashlib.sha256(content).hexdigest() != header.program_sha256:
            return None
        return decode_source(str(file), content)
    except (OSError, ValueError, IrlxError):
        return None
