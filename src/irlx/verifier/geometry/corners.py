"""How corners are passed, and how far from a corner rows left the path where nobody says."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.promises import PATH_ORIENTATION, PATH_POSITION, PATH_STEP
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.geometry.allowance import EXACT as EXACT_POSE
from irlx.verifier.geometry.allowance import Allowance
from irlx.verifier.geometry.blends import TANGENTS, Blend
from irlx.verifier.geometry.curves import Curve, Pose, rounds

ON_A_LEG = 1e-8
"""Rows that are nearer to both legs than this, m, tell nothing of the blend between them."""

STEPS, EXACT = 60, 1e-13
"""Steps of the search for a distance at most, and how exactly it is sought, m."""

ASKED = 16
"""Rows asked whether a distance fits, at most: so many of those about the corner, and those furthest off."""

NEAR = 0.1
"""Part of the tolerances within which a distance fits that a single row gave."""

GRID, GOLDEN = 32, 0.5 * (5.0**0.5 - 1.0)


@dataclass(frozen=True)
class Corner:
    """The end of a leg is passed at `distance` m, 0: it leads to the very corner.

    It `may_be_less` as well, or the way `may_stop` in the corner: the rows tell.
    """

    distance: float
    may_be_less: bool = False
    may_stop: bool = False

    @property
    def is_open(self) -> bool:
        """Whether rows have to tell how it is passed."""
        return self.distance > 0.0 and (self.may_be_less or self.may_stop)


class _Rows(NamedTuple):
    """Rows about a corner: poses, and where they are on both legs, (R,) m."""

    positions: Floats
    rotations: Floats
    way: Floats
    there: Floats

    def part(self, chosen: Integers) -> _Rows:
        return _Rows(*(field[chosen] for field in self))


def distance_taken(
    legs: tuple[Curve, Curve],
    asked_for: Corner,
    rows: Pose,
    near: float,
    final: bool,
    allowance: Allowance = EXACT_POSE,
) -> float | None:
    """Distance of the blend that the next rows run on from one curve to the next.

    None where they do not tell yet, the next curve not being reached. The row before them is at `near`. Where
    any distance will do, the row furthest from both curves decides, and, where that leaves others off, what
    fits all of them best. Where no row lies beside the curves, or no blend fits one that does, it is the
    widest that leaves rows on the curves, if the way is the shorter for it.
    """
    first, second = legs
    most = asked_for.distance
    corner = second.points(np.zeros(1))
    found = _Rows(*rows, first.nearest(rows[0], near), second.nearest_at_start(rows[0]))
    off = np.linalg.norm(found.positions - first.points(np.minimum(found.way, first.length)), axis=1)
    apart = np.min([_apart(second, found.positions, way) for way in rounds(second, found.there)[:2]], axis=0)
    away = np.linalg.norm(found.positions - corner, axis=1)
    arrived = _arrived(second, found, off, apart, final) | ((off > PATH_POSITION) & (away > most))
    if not arrived.any() and not final:
        return None
    seen = int(np.argmax(arrived)) + 1 if arrived.any() else len(off)
    # A circle may come by the corner in earlier rounds.
    earlier = (off <= PATH_POSITION) & (found.way < first.length - most - PATH_POSITION)
    near_it = (away <= most) & ~earlier
    between = np.where(near_it, np.minimum(off, apart), 0.0)[:seen]
    row = int(np.argmax(between))
    about = np.flatnonzero(near_it[:seen])
    spread = about[np.linspace(0, len(about) - 1, min(ASKED, len(about))).astype(np.int64)]
    furthest = np.argsort(between)[::-1][:ASKED]
    asked = found.part(np.union1d(spread, furthest[between[furthest] > 0.0]))
    if not asked_for.may_be_less:
        if not len(about):
            return most
        worst = [_worst(legs, way, asked, allowance) for way in (most, 0.0)]
        return most if worst[0] <= worst[1] else 0.0
    seen_rows = found.part(np.arange(seen))
    if between[row] > ON_A_LEG:
        distance = _fitting(legs, most, found.positions[row], asked, allowance)
    else:
        distance = _least_way(legs, most, seen_rows)
    if len(about) and _worst(legs, distance, asked, allowance) > NEAR:
        distance = _best(lambda d: _worst(legs, d, asked, allowance), distance, most)
        if _worst(legs, distance, asked, allowance) > 1.0:
            untold = _least_way(legs, most, seen_rows)
            beside = found.part(np.flatnonzero(between > ON_A_LEG))
            distance = _fitting_first(legs, most, beside, untold, allowance)
    return distance if distance > PATH_STEP else 0.0


def _apart(curve: Curve, positions: Floats, way: Floats) -> Floats:
    """Distances (R,) of positions from the places of a curve at ways (R,), or its ends."""
    return np.asarray(np.linalg.norm(positions - curve.points(np.clip(way, 0.0, curve.length)), axis=1))


def _least_way(legs: tuple[Curve, Curve], most: float, rows: _Rows) -> float:
    """Distance of the widest blend, of `most` m, for which rows leave room; 0 where the way is no shorter for
    it, where curves go on straight."""
    distance = min(most, float(np.min(_rooms(legs, rows)))) - EXACT
    if distance <= PATH_STEP or Blend(*legs, distance).length >= 2.0 * distance:
        return 0.0
    return distance


def _rooms(legs: tuple[Curve, Curve], rows: _Rows) -> Floats:
    """How far (R,) a blend may reach that leaves rows on the curves on which they lie, by the ways there: a
    circle may come by the corner in other rounds. Endless for rows that lie on neither."""
    first, second = legs
    room = np.full(len(rows.way), np.inf)
    for way in reversed(rounds(second, rows.there)[:2]):
        room = np.where(_apart(second, rows.positions, way) <= PATH_POSITION, way, room)
    # They come from the first one, and are on the second one where they have left that.
    on_first = _apart(first, rows.positions, rows.way) <= PATH_POSITION
    return np.asarray(np.where(on_first, first.length - rows.way, room))


def _arrived(second: Curve, rows: _Rows, off: Floats, apart: Floats, final: bool) -> NDArray[np.bool_]:
    """Which rows (R,), `off` the first curve and `apart` from the second one, lie on the latter.

    On more than half of a circle a place before its start may be one near its end as well: that counts where
    no row lies on its first half, and if the next row lies on it, too.
    """
    left = off > PATH_POSITION
    early = left & (rows.there > 0.0) & (_apart(second, rows.positions, rows.there) <= PATH_POSITION)
    if early.any() or not np.isfinite(second.whole):
        return early
    on = apart <= PATH_POSITION
    return np.asarray(left & on & np.append(on[1:], final))


def _fitting(
    legs: tuple[Curve, Curve], most: float, position: Floats, asked: _Rows, allowance: Allowance
) -> float:
    """Distance of the blend through a position (3,) that fits rows best.

    Where the tangents of a blend change with its distance, it does not change smoothly: then each is tried.
    """
    distance = _through(legs, most, position, TANGENTS)
    if _worst(legs, distance, asked, allowance) <= NEAR:
        return distance
    found = [_through(legs, most, position, TANGENTS[k : k + 1]) for k in range(len(TANGENTS))]
    return min([distance, *found], key=lambda d: _worst(legs, d, asked, allowance))


def _fitting_first(
    legs: tuple[Curve, Curve], most: float, rows: _Rows, otherwise: float, allowance: Allowance
) -> float:
    """Distance of the blend that fits the first rows beside both curves, as many as may be, halved each time:
    those behind them may have left the second curve on its next blend already."""
    count = len(rows.way)
    while count:
        asked = rows.part(np.arange(count))
        # The first row may lie next to the first curve, and tell little.
        for distance in (otherwise, _through(legs, most, asked.positions[count // 2], TANGENTS)):
            if _worst(legs, distance, asked, allowance) <= NEAR:
                return distance
        count //= 2
    return otherwise


def _through(legs: tuple[Curve, Curve], most: float, position: Floats, tangents: Floats) -> float:
    """Distance of the blend, with one of some tangents, through a position (3,)."""
    widest = Blend(*legs, most, tangents)
    to_corner = (legs[1].points(np.zeros(1)) - widest.points(np.array([widest.corner])))[0]

    def miss(distance: float) -> float:
        """How much nearer to the corner the position is than the blend."""
        blend = Blend(*legs, distance, tangents)
        return float((position - blend.points(blend.nearest(position[None]))[0]) @ to_corner)

    return _root(miss, most)


def _worst(legs: tuple[Curve, Curve], distance: float, rows: _Rows, allowance: Allowance) -> float:
    """How far rows are off a path with a blend of a distance, in tolerances; the worst of them."""
    first, second = legs
    before = np.minimum(rows.way, first.length - distance)
    offs = [(first.points(before), allowance.turned_off(rows.rotations, first.rotations(before)))]
    for way in rounds(second, rows.there):
        behind = np.maximum(way, distance)
        offs.append((second.points(behind), allowance.turned_off(rows.rotations, second.rotations(behind))))
    if distance > PATH_STEP:
        blend = Blend(first, second, distance)
        u = blend.nearest(rows.positions)
        offs.append((blend.points(u), blend.turned_off(u, rows.rotations, allowance)))
    shares = [
        np.maximum(np.linalg.norm(rows.positions - points, axis=1) / PATH_POSITION, turned / PATH_ORIENTATION)
        for points, turned in offs
    ]
    return float(np.max(np.min(shares, axis=0)))


def _root(function: Callable[[float], float], most: float) -> float:
    """Where a rising function is 0, in 0..`most`, or the nearer end; by the Illinois method."""
    low, high = 1e-6 * most, most
    at_low, at_high = function(low), function(high)
    if at_low >= 0.0 or at_high <= 0.0:
        return low if at_low >= 0.0 else high
    side, middle = 0, high
    for _ in range(STEPS):
        last, middle = middle, (low * at_high - high * at_low) / (at_high - at_low)
        value = function(middle)
        if abs(middle - last) <= EXACT or value == 0.0:
            break
        if value > 0.0:
            high, at_high = middle, value
            at_low, side = (0.5 * at_low if side > 0 else at_low), 1
        else:
            low, at_low = middle, value
            at_high, side = (0.5 * at_high if side < 0 else at_high), -1
    return middle


def _best(function: Callable[[float], float], start: float, most: float) -> float:
    """Argument in 0..`most` of the least value: best of an even grid and `start`, then golden sections."""
    grid = np.sort(np.append(np.linspace(0.0, most, GRID + 1), start))
    values = [function(float(place)) for place in grid]
    best = int(np.argmin(values))
    least, found = values[best], float(grid[best])
    low, high = float(grid[max(best - 1, 0)]), float(grid[min(best + 1, GRID + 1)])
    left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_left, at_right = function(left), function(right)
    for _ in range(STEPS):
        if at_left < at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = function(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = function(right)
    return float(min((least, found), (at_left, left), (at_right, right))[1])
