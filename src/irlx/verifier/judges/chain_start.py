"""Where the rows of a chain of moves come out of the corner behind a PTP, and onto its way."""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.promises import PATH_ORIENTATION, PATH_POSITION, PATH_STEP
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.allowance import Allowance
from irlx.verifier.geometry.chain_parts import Leg
from irlx.verifier.geometry.chains import ChainWay
from irlx.verifier.geometry.curves import Curve, Pose
from irlx.verifier.geometry.task_turns import turned_off


@dataclass(frozen=True, eq=False)
class ChainStart:
    """How many rows lie in the corner, how many of them all are placed with that, and the ways (2,) m of the
    last two of these.

    Of the rows behind `fresh` have fewer than two known ones before them: of so many the change of speed is
    not told, with 2 of the first one not even the speed.
    """

    corner: int
    placed: int
    ways: Floats
    fresh: int = 0


def start_of_chain(
    rows: Pose,
    legs: tuple[Leg, ...],
    start: Floats,
    reach: float,
    allowance: Allowance,
    final: bool,
    step: float,
    end_reach: float = 0.0,
) -> ChainStart | None:
    """Where rows (positions (R, 3), attitudes (R, ..)) come out of the corner at `start` (3,), from which it
    reaches `reach` m; None where more rows have to tell. With `final` there are no more. From one row to the
    next the way leads on by `step` m at the most. Where the last leg ends in a corner as well that may reach
    `end_reach` m.

    They do where one lies on the first leg beyond the reach. Where the next blend begins there already no row
    may do so: then where one is farther away than the reach, those from the first one on that lie on the way.
    """
    positions, count, only = rows[0], len(rows[0]), legs[0].curve
    if len(legs) == 1 and only.length >= only.whole and reach >= 0.5 * only.whole:
        counted = _counted_from_end(rows, only, reach) if final else None
        if counted is not None or not final:
            return counted
    way, on = _on_first_leg(rows, legs[0].curve)
    first = _first_of(on & (way >= reach - PATH_STEP))
    away = _first_of(np.linalg.norm(positions - start, axis=1) > reach + PATH_POSITION)
    if away < first or (final and first == count):
        found = _beside_first_leg(rows, legs, reach, allowance, away, final, step)
        if found is None:
            return None
        if found < count and on[found]:
            # Short of what the corner may reach to.
            return ChainStart(found, found + 1, way[[found, found]], 1)
        return ChainStart(found, found, np.array([reach, reach]), 2)
    if first + 1 >= count:
        if not final:
            return None
        return ChainStart(first, first + 1, way[[first, first]], 1)
    second = first + 1
    if not on[second] and _may_leave(legs, end_reach, float(way[second])):
        # So short is the leg that the second row lies in the blend or corner at its end already.
        return ChainStart(first, second, way[[first, first]], 1)
    return ChainStart(first, second + 1, way[[first, second]])


def _counted_from_end(rows: Pose, circle: Curve, reach: float) -> ChainStart | None:
    """The same on a circle of which the corner may take half a turn or more: where rows end tells how much it
    takes. None where they do not come onto it about as far as the corner reaches, or do not stay on it."""
    way = circle.nearest(rows[0], 0.0)
    way = way + circle.whole * np.round((circle.length - way[-1]) / circle.whole)
    way, on = _on_first_leg(rows, circle, way)
    first = len(on) - _first_of(~on[::-1])
    first += _first_of(way[first:] >= reach - PATH_STEP)
    if first + 1 >= len(on) or way[first] > reach + 1.5 * (way[first + 1] - way[first]):
        return None
    return ChainStart(first, first + 2, way[[first, first + 1]])


def _on_first_leg(rows: Pose, curve: Curve, way: Floats | None = None) -> tuple[Floats, NDArray[np.bool_]]:
    """Ways (R,) of rows along the first leg, if they are not told, and which of them lie on it."""
    positions, rotations = rows
    way = curve.nearest(positions, 0.0) if way is None else way
    inside = np.clip(way, 0.0, curve.length)
    on = np.linalg.norm(positions - curve.points(inside), axis=1) <= PATH_POSITION
    return way, on & (turned_off(rotations, curve.rotations(inside)) <= PATH_ORIENTATION)


def _may_leave(legs: tuple[Leg, ...], end_reach: float, way: float) -> bool:
    """Whether a place on the first leg may lie where the blend or corner at its end has taken over."""
    blend = legs[0].corner.distance if len(legs) > 1 else end_reach
    return way > legs[0].curve.length - blend - PATH_STEP


def _beside_first_leg(
    rows: Pose,
    legs: tuple[Leg, ...],
    reach: float,
    allowance: Allowance,
    away: int,
    final: bool,
    step: float,
) -> int | None:
    """The first row from which on all up to the first one `away` from the corner lie on the way; where none
    does that one, which is off the way. None where more rows have to tell."""
    seen, waits = min(away + 1, len(rows[0])), False

    def all_lie_from(row: int) -> bool:
        nonlocal waits
        probe = ChainWay(list(legs), step, allowance)
        probe.begin_at(reach)
        placed = probe.take(rows[0][row:], rows[1][row:], final)
        waits = waits or len(placed.position) < seen - row
        return bool((placed.position[: seen - row] <= PATH_POSITION).all())

    found = bisect_left(range(seen), True, key=all_lie_from)
    return None if waits else min(found, away)


def _first_of(which: NDArray[np.bool_]) -> int:
    """Number of the first one that is so, of all where none is."""
    return int(np.argmax(which)) if which.any() else len(which)
