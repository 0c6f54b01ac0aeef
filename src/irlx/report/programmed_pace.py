"""How fast the tool was to go where it went, from the moves that a stream records."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import Blend, MoveBlock, MoveKind, ToolBlock
from irlx.diagnostics import Place
from irlx.motion.errors import MotionError
from irlx.motion.line import Line
from irlx.motion.plan_path import PlannedPath, in_whole_ticks, path_law, plan_path
from irlx.promises import PATH_POSITION
from irlx.report.curves import blocks_fit, tool_rates
from irlx.report.stretches import stretches
from irlx.streams.joint_stream import JointStream
from irlx.verifier.moves import MoveRows, moves_of
from irlx.verifier.outline import Outline

Array = NDArray[np.float64]

SLOWED = 0.98
"""Share of the programmed speed below which a row counts as slowed."""

_FARTHEST = 1e6
"""Distance from the world's origin, m, from which on a pose is none."""

_SAME = 1e-6
"""What a tick may differ from the programmed time and still be as programmed, as a part of it."""


@dataclass(frozen=True, eq=False)
class ProgrammedPace:
    """Programmed rates where they are known, else no numbers: `speed` (N,) m/s and `turn` (N,) rad/s of the
    tool in the tick before each row, had it gone through the same piece of its path as programmed.

    `slowed` are the first and last rows of the stretches on which it was slower. Known are moves along lines
    and arcs from stop to stop in frames that rest, with bounds or with a time.
    """

    speed: Array
    turn: Array
    slowed: tuple[tuple[int, int], ...]


def programmed_pace(stream: JointStream, outline: Outline) -> ProgrammedPace:
    """Programmed rates over the rows of a stream.

    A tick that takes the tool from s0 to s1 of its path would have taken t(s1) - t(s0) by the time law t of
    the move; the programmed rates are those of the tick times dt / (t(s1) - t(s0)).
    """
    rows, dt = len(stream.ticks), stream.dt
    share = np.full(rows, np.nan)
    for move in _known_moves(outline) if blocks_fit(outline) else []:
        found = _shares(stream, move)
        if found is not None:
            share[move.start + 1 : move.start + 1 + len(found)] = found
    rates = tool_rates(stream.tool, dt)
    with np.errstate(divide="ignore", invalid="ignore"):
        speed, turn = (np.where(share > 0.0, rate / share, np.nan) for rate in rates)
    return ProgrammedPace(speed, turn, tuple(stretches(share < SLOWED)))


def _known_moves(outline: Outline) -> list[MoveRows]:
    """Moves whose path and law follow from the block and from where the tool was at its ends."""
    tools = {record.tick for record in outline.records if isinstance(record.block, ToolBlock)}
    found, passed = [], False
    for move in moves_of(outline):
        block = move.block
        stops = not passed and block.blend is None
        plain = block.course is None or block.arc is not None
        bare = block.tolerance is None and block.frame is None and plain and block.kind is not MoveKind.PTP
        if stops and bare and move.finished and move.last > move.start and move.start not in tools:
            found.append(move)
        passed = isinstance(block.blend, Blend)
    return found


def _shares(stream: JointStream, move: MoveRows) -> Array | None:
    """Part of the programmed speed that the tool had in each of the rows in which the move moves it."""
    tool = stream.tool[move.start : move.last + 1]
    planned = _planned(tool, move.block, stream.dt)
    if planned is None or planned.ticks == 0:
        return None
    way, turn = tool_rates(tool, stream.dt)
    gone = np.cumsum(turn if planned.path.is_pure_turn else way)
    if not gone[-1] > 0.0:
        return None
    s = planned.path.length * gone / gone[-1]
    # Behind the goal the robot holds; the last step is the last one that leads anywhere.
    moved = int(np.flatnonzero(np.diff(s) > 1e-12 * planned.path.length)[-1]) + 2
    share = np.diff(planned.law.times_at(s[:moved])) / stream.dt
    share[np.abs(share - 1.0) < _SAME * planned.ticks] = 1.0
    # Faster than programmed is no pace of this law: the path must be another one than it seems.
    return None if share.max() > 2.0 - SLOWED else share


def _planned(tool: Array, block: MoveBlock, dt: float) -> PlannedPath | None:
    """Path and law of a move whose tool poses are `tool` (M, 7); None where they cannot be told."""
    if not _sane(tool):
        return None
    start, end = (Rotation.from_quat(row[3:]).as_matrix() for row in (tool[0], tool[-1]))
    place = Place(block.origin.file)
    try:
        if block.kind is MoveKind.CIRCLE:
            planned = plan_path(block, start, tool[0, :3], dt, place)
        else:
            line = Line(tool[0, :3], start, tool[-1, :3], end)
            if line.is_nothing or not line.axis_is_defined:
                return None
            planned = in_whole_ticks(line, path_law(line, block.law, place), dt, place)
    except (MotionError, TypeError, ValueError):
        # Targets in joint values, or a law that this way cannot have.
        return None
    off = float(np.linalg.norm(planned.path.end_position - tool[-1, :3]))
    return planned if off <= 2.0 * PATH_POSITION else None


def _sane(tool: Array) -> bool:
    """Whether rows are poses at all: a file may hold any numbers."""
    return bool(np.all(np.abs(tool[:, :3]) < _FARTHEST) and np.all(np.abs(tool[:, 3:]).max(axis=1) > 0.1))
