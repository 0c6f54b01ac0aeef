"""Motions as they are carried out one after another, joined where joint space meets a path."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Block, MoveBlock, MoveKind, Origin
from irlx.diagnostics import Diagnostic, Place, Related, report
from irlx.motion.corner import Lost
from irlx.motion.plan_chain import lost_blend
from irlx.pacing.crossing import Crossing, Meeting, shifted
from irlx.pacing.executed import Executed
from irlx.pacing.nearest_rows import nearest_rows
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.clearance import Clearance

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Carried:
    """Blocks of one motion from stop to stop, with the signals before and between its moves.

    `rooms` as those of `Motion`.
    """

    parts: tuple[Executed, ...]
    rooms: tuple[float, float] = (0.0, 0.0)

    @property
    def moves(self) -> Iterator[Executed]:
        """The moves among the parts."""
        return (part for part in self.parts if isinstance(part.block, MoveBlock))

    @property
    def last(self) -> Executed | None:
        """The last move, None where there is none."""
        return next((part for part in reversed(self.parts) if isinstance(part.block, MoveBlock)), None)


@dataclass(frozen=True)
class Joined:
    """Two motions, joined where that can be: `saved` ticks less than with the stop, and `notes` on it."""

    motions: tuple[Carried, Carried]
    saved: int
    notes: tuple[Diagnostic, ...]


def passes(block: Block) -> bool:
    """Whether a block is a move that asks to pass its target."""
    if not isinstance(block, MoveBlock) or block.blend is None:
        return False
    return 0.0 not in (block.blend.distance, block.blend.share)


def are_of_one_kind(first: Block, second: Block) -> bool:
    """Whether two moves are both of the joints, or both along a path."""
    return _is_ptp(first) is _is_ptp(second)


def _is_ptp(block: Block) -> bool:
    return isinstance(block, MoveBlock) and block.kind is MoveKind.PTP


def crossed(
    first: Carried,
    second: Carried,
    kinematics: Kinematics,
    limits: JointLimits,
    dt: float,
    locate: Callable[[Origin], Place],
    clearance: Clearance | None = None,
) -> Joined:
    """Join two motions, the first of which ends with a move that passes its target to another kind."""
    before, after = first.last, next(second.moves, None)
    if before is None or after is None:
        return Joined((first, second), 0, ())
    places = locate(before.block.origin), locate(after.block.origin)
    found: Crossing | Lost
    if before.rows is None or after.rows is None:
        found = Lost(f"{'this move' if before.rows is None else 'the next move'} has no length")
    else:
        meeting = Meeting(before.rows, after.rows, (first.rooms[1], second.rooms[0]))
        found = meeting.joined(kinematics, limits, dt)
        if isinstance(found, Crossing) and clearance is not None:
            found = _clear_of_all(found, before.rows.q[0], clearance, dt)
    if isinstance(found, Lost):
        return Joined((first, second), 0, (lost_blend(places[0], found.reason, places[1]),))
    ended = tuple(replace(part, rows=found.before) if part is before else part for part in first.parts)
    begun = tuple(_earlier(part, after, found) for part in second.parts)
    motions = replace(first, parts=ended), replace(second, parts=begun)
    return Joined(motions, found.saved, tuple(_notes(before.block, found, places)))


def _clear_of_all(found: Crossing, start: Array, clearance: Clearance, dt: float) -> Crossing | Lost:
    """A corner with what is nearest in its rows, after posture `start` (n,); lost where that is too near."""
    for rows in (found.before, found.after):
        if clearance.first_short(rows.q, start) is not None:
            return Lost("on the short cut something would come too near")
    before, after = (
        replace(rows, nearest=nearest_rows(clearance, rows.q, dt)) for rows in (found.before, found.after)
    )
    return replace(found, before=before, after=after)


def _earlier(part: Executed, first: Executed, found: Crossing) -> Executed:
    """A part of the second motion at the tick to which the corner brings it forward."""
    begin = found.before.first_tick + len(found.before) - 1
    if part is first:
        return replace(part, tick=begin, rows=found.after)
    if part.tick <= first.tick:
        return replace(part, tick=begin)
    rows = None if part.rows is None else shifted(part.rows, -found.saved)
    return replace(part, tick=part.tick - found.saved, rows=rows)


def _notes(block: Block, found: Crossing, places: tuple[Place, Place]) -> Iterator[Diagnostic]:
    """How the corner was passed, IRL436; IRL433 where half of the move is less than what was asked for."""
    related = (Related("the next move", places[1]),)
    if found.room is not None and isinstance(block, MoveBlock) and block.blend is not None:
        asked, used = (f"{(way or 0.0) * 1000.0:.6g}" for way in (block.blend.distance, found.room))
        yield report("IRL433", places[0], related=related, where="its target", asked=asked, used=used)
    left, joined, miss = (f"{way * 1000.0:.4g}" for way in (found.left, found.joined, found.miss))
    yield report("IRL436", places[0], related=related, left=left, joined=joined, miss=miss)
