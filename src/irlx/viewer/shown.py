"""What is to be seen: one execution, with the cell that it took place in."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from irlx.blocks import ObstacleBlock
from irlx.cell.cell import Cell
from irlx.diagnostics import Diagnostic, SourceText
from irlx.report.events import Slowed
from irlx.report.legible import legible
from irlx.report.lines import Line as TextLine
from irlx.report.run import Run
from irlx.report.terminal import summary_lines
from irlx.streams.joint_stream import JointStream


class Line(NamedTuple):
    """A line of a program or module; number 0 before the first one."""

    file: str
    number: int


@dataclass(frozen=True, eq=False)
class Shown:
    """A stream and its cell; the `text` of its program where it is there, and what is told of the run.

    `summary` are lines for people, `slowed` the stretches where the tool was slower than programmed, `output`
    what the program wrote.
    """

    cell: Cell
    stream: JointStream
    text: SourceText | None
    summary: tuple[TextLine, ...]
    diagnostics: tuple[Diagnostic, ...] = ()
    slowed: tuple[Slowed, ...] = ()
    output: str = ""

    @property
    def title(self) -> str:
        """Name of the program."""
        return self.stream.header.program_name

    @property
    def duration(self) -> float:
        """Time of the last row, s."""
        return float(self.stream.t[-1])

    @property
    def switches_obstacles(self) -> bool:
        """Whether the program has switched an obstacle on."""
        return any(isinstance(record.block, ObstacleBlock) for record in self.stream.records)

    def row_at(self, time: float) -> int:
        """The row nearest to a time, s."""
        return int(np.clip(round(time / self.stream.dt), 0, len(self.stream.q) - 1))

    def line_at(self, row: int) -> Line:
        """The line in execution in a row: that of the block last begun before it."""
        ticks, lines = self._lines
        begun = int(np.searchsorted(ticks, self.stream.ticks[row], side="left"))
        return lines[begun - 1] if begun else Line("", 0)

    @cached_property
    def _lines(self) -> tuple[np.ndarray, list[Line]]:
        records = self.stream.records
        origins = [record.block.origin for record in records]
        ticks = np.array([record.tick for record in records], dtype=np.int64)
        return ticks, [Line(origin.file, origin.line) for origin in origins]

    @cached_property
    def slow_rows(self) -> np.ndarray:
        """Whether the tool came slower than programmed to each row (N,)."""
        found = np.zeros(len(self.stream.q), dtype=np.bool_)
        for event in self.slowed:
            found[event.first_tick : event.last_tick + 1] = True
        return found


def shown_run(run: Run, cell: Cell, text: SourceText | None) -> Shown:
    """A run in its cell."""
    slowed = tuple(event for event in run.events if isinstance(event, Slowed))
    summary = tuple(summary_lines(run.summary))
    return Shown(cell, run.stream, text, summary, run.diagnostics, slowed, run.output)


def shown_stream(stream: JointStream, name: str, cell: Cell, text: SourceText | None) -> Shown:
    """A stream file of that `name`: no more is known of it than it says itself."""
    header, rows = stream.header, len(stream.q)
    state = "complete" if stream.complete else "INCOMPLETE"
    lines = (
        TextLine(None, f"{name}: {state}, {(rows - 1) * header.dt:.6g} s"),
        TextLine("program", legible(header.program_name or "not named")),
        TextLine("samples", f"{rows} of {header.joints} joints, {header.dt * 1e3:g} ms a tick"),
    )
    return Shown(cell, stream, text, lines)
