"""The rows of one paced motion, and which bound held which joint in them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MoveBlock, PauseBlock, ReconfigureBlock, WaitBlock
from irlx.motion.time_law import TimeLaw
from irlx.pacing.demand import Demands
from irlx.pacing.freed import Freed
from irlx.pacing.nearest_rows import NearestRows
from irlx.pacing.posture_term import PostureTerm
from irlx.pacing.slowing import Slowing
from irlx.robot.limits import JointLimits
from irlx.transform.clearance import Clearance

Array = NDArray[np.float64]


@dataclass(frozen=True)
class PathPart:
    """What a motion along a path has beside its rows.

    `demands` of the rows (the hold tick has none), posture `term` in force, the programmed `law`;
    `is_turn`: what counts is an angle, of `angle_per_s` rad for each unit of s; `planned`: the motion was
    planned as a whole because ordinary ticks would have broken a bound; `slowings`: the stretches that took
    longer than programmed; `free` (n,): the joints that were not frozen. Of a move that is joined to others
    the path parameter counts over all of them: it `begin`s there, and was `s_before` in the row before.
    `clearance` is what the motion, whose first tick is `first_tick`, keeps clear.
    """

    demands: Demands
    term: PostureTerm
    law: TimeLaw
    is_turn: bool
    angle_per_s: float
    planned: bool
    slowings: tuple[Slowing, ...]
    free: NDArray[np.bool_]
    begin: float = 0.0
    s_before: float = 0.0
    clearance: Clearance | None = None
    first_tick: int = 0


@dataclass(frozen=True)
class MotionRows:
    """What a move, reconfiguration or wait becomes: rows at consecutive ticks, a hold last if it `stops`.

    `q` (N, n) rad or m; `tool_position` (N, 3) m and `tool_rotation` (N, 3, 3) of the tool in the
    world; `path_position_error` (N,) m and `path_orientation_error` (N,) rad against the demanded
    pose; `active` (N, n): 0, or the sign of the side times (1 + BoundSource) of the bound that holds
    a joint back; `s` (N,) path parameter of `length`; `iterations` Newton steps in all; `span` ticks that the
    rows of a dry run stand for, 0 where each is a tick;
    `limits` in force, None for the robot's own; `path`, None where no path was asked for; `nearest` what
    comes nearest where something is kept clear. `corner_rows` so many of the first and of the last rows pass
    a corner between joint space and a path (`Crossing`): they lie on no path. `freed`: the motion had virtual
    joints, as the postures of its `path` still have.
    """

    block: MoveBlock | ReconfigureBlock | WaitBlock | PauseBlock
    first_tick: int
    q: Array
    tool_position: Array
    tool_rotation: Array
    path_position_error: Array
    path_orientation_error: Array
    active: NDArray[np.int8]
    s: Array
    length: float
    iterations: int
    limits: JointLimits | None = None
    path: PathPart | None = None
    stops: bool = True
    span: int = 0
    nearest: NearestRows | None = None
    corner_rows: tuple[int, int] = (0, 0)
    freed: Freed | None = None

    def __len__(self) -> int:
        return int(self.q.shape[0])

    @property
    def ticks(self) -> int:
        """Ticks that the motion takes, its hold tick included."""
        return self.span or len(self)

    def passes_corner(self, row: int) -> bool:
        """Whether a row, counted from 0, lies in a corner between joint space and a path."""
        first, last = self.corner_rows
        return row < first or row >= len(self) - last


def held(rows: Array) -> Array:
    """Rows with the last one repeated: the hold tick of a stop."""
    return np.concatenate([rows, rows[-1:]])


def handed_out(
    rows: MotionRows, blocks: Sequence[MoveBlock], ends: Sequence[float]
) -> list[MotionRows | None]:
    """Rows of joined moves, to each those up to the tick nearest to where it hands over to the next.

    `ends` are the path parameters of these places, the last one that of the stop, which all rows left go to.
    None for a move so short that no row falls to it.
    """
    s = rows.s[:-1]
    cuts = [int(np.argmin(np.abs(s - end))) + 1 for end in ends[:-1]]
    lasts = np.maximum.accumulate([0, *cuts, len(rows)]).tolist()
    begins = [0.0, *ends]
    if rows.path is not None and rows.path.slowings:
        told = tuple(_with_lines(found, blocks, lasts) for found in rows.path.slowings)
        rows = replace(rows, path=replace(rows.path, slowings=told))
    return [
        _part(rows, block, (first, last), (begins[k], begins[k + 1])) if last > first else None
        for k, (block, (first, last)) in enumerate(zip(blocks, pairwise(lasts), strict=True))
    ]


def _with_lines(found: Slowing, blocks: Sequence[MoveBlock], lasts: Sequence[int]) -> Slowing:
    """A slowed stretch with the lines of the moves in whose rows it lies, those of the last one's file."""
    origins = [
        block.origin
        for block, (first, last) in zip(blocks, pairwise(lasts), strict=True)
        if first <= found.last_row and found.first_row < last
    ]
    lines = [origin.line for origin in origins if origin.file == origins[-1].file]
    return replace(found, lines=(min(lines), max(lines))) if lines else found


def _part(rows: MotionRows, block: MoveBlock, span: tuple[int, int], way: tuple[float, float]) -> MotionRows:
    first, last = span
    part = slice(first, last)
    begin, end = _first_tick(rows, first), _first_tick(rows, last)
    return replace(
        rows,
        block=block,
        first_tick=begin,
        span=end - begin,
        **{name: getattr(rows, name)[part] for name in _BY_ROW},
        length=way[1] - way[0],
        path=None if rows.path is None else _part_of_path(rows.path, span, way),
        nearest=None if rows.nearest is None else rows.nearest.part(first, last),
        stops=last == len(rows),
        iterations=rows.iterations if first == 0 else 0,
    )


def _part_of_path(path: PathPart, span: tuple[int, int], way: tuple[float, float]) -> PathPart:
    first, last = span
    # A stretch may reach into the moves beside it: it is told once, where it costs most.
    slowings = tuple(
        replace(found, first_row=found.first_row - first, last_row=found.last_row - first)
        for found in path.slowings
        if way[0] <= found.s < way[1]
    )
    return replace(
        path,
        demands=path.demands[first:last],
        slowings=slowings,
        begin=way[0],
        s_before=path.demands[first - 1].s if first > 0 else 0.0,
    )


def _first_tick(rows: MotionRows, row: int) -> int:
    """The first tick that a row stands for; the last row, a hold, stands for one."""
    if row == len(rows):
        return rows.first_tick + rows.ticks
    if rows.path is not None and row > 0:
        return rows.path.demands[row - 1].tick + 1
    return rows.first_tick + round(row * (rows.ticks - 1) / (len(rows) - 1))


_BY_ROW = (
    "q",
    "tool_position",
    "tool_rotation",
    "path_position_error",
    "path_orientation_error",
    "active",
    "s",
)
