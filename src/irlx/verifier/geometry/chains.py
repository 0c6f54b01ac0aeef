"""Curves run through one after another, their corners rounded or sharp: which of its parts a row lies on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.promises import PATH_POSITION, PATH_STEP
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.allowance import EXACT, Allowance
from irlx.verifier.geometry.blends import Blend
from irlx.verifier.geometry.corners import Corner, distance_taken
from irlx.verifier.geometry.curves import Curve, Pose, rounds
from irlx.verifier.geometry.placed import Placed, Stretches

FEW = 16
"""Rows that tell how corners are passed behind which the first of them lies, at most."""

FIRST_LOOK = 64
"""Rows looked at together on a part at first, then twice as many, and so on."""

PLACES, CELLS = 5, 8
"""Places between two rows on a part, those of the rows included, at which the curvature is looked at; cells
into which each part is cut that lies between two rows."""


@dataclass(frozen=True)
class Leg:
    """One curve of a chain, and how its end is passed; the last leg's corner counts for nothing."""

    curve: Curve
    corner: Corner


@dataclass(frozen=True)
class _Part:
    """A leg without its blends, or the blend at its end."""

    leg: int
    blend: bool


class ChainWay:
    """The way along the legs of a chain; rows are given to it in order.

    `reach` is the longest way in a tick, m; `allowance` the turns that the tool may stand off by.
    """

    def __init__(self, legs: list[Leg], reach: float, allowance: Allowance = EXACT) -> None:
        self._legs = legs
        self._allowance = allowance
        self._reach = reach
        self._bases = [0.0]
        self._blends: list[Blend | None] = []
        self._ends: list[float] = []
        self._part = _Part(0, False)
        self._along = 0.0
        self._near: tuple[_Part, float] = self._part, 0.0
        self._sought_from: _Part | None = None

    @property
    def ends(self) -> Floats:
        """Way (K,) to the ends of the first K legs, as far as their corners are known."""
        return np.array(self._ends)

    @property
    def length(self) -> float:
        """Way to the end of the leg that the rows have come to, m."""
        leg = self._part.leg
        return self._bases[leg] + self._legs[leg].curve.length

    @property
    def leg(self) -> int:
        """Number of the leg that the rows have come to."""
        return self._part.leg

    @property
    def left(self) -> float:
        """Way to the end of the last leg, blends not known yet being counted as corners, m."""
        known = len(self._bases) - 1
        return self._bases[known] + sum(leg.curve.length for leg in self._legs[known:])

    def stretches_to_end(self, short: float = 0.0) -> Stretches:
        """The way from the last row to `short` m before the end of the last leg, counted like `left`."""
        last = len(self._legs) - 1
        return self._stretches(_Part(last, False), self._legs[last].curve.length - short)

    def begin_at(self, way: float) -> None:
        """Let the rows begin at a place on the first leg, m from its start."""
        self._near, self._along = (self._part, way), way

    def take(self, positions: Floats, rotations: Floats, final: bool) -> Placed:
        """Place the next rows (positions (R, 3), attitudes (R, ..)), or the first of them.

        Where a blend's distance has to be found out, rows wait until the next leg is reached: they have to be
        given again, with more behind them. With `final` there are no more.
        """
        placed = Placed.empty(len(positions), rotations.shape[1] == 3)
        done, look = 0, FIRST_LOOK
        while done < len(positions):
            part = self._part
            stop = min(done + look, len(positions))
            rest = positions[done:], rotations[done:]
            if not part.blend and not self._settle(part.leg, rest, final):
                stop = min(stop, done + self._surely_before(part.leg, positions[done:stop]))
                if stop == done:
                    break
            found = self._run(placed, done, positions[:stop], rotations)
            look = 2 * look if found == stop else FIRST_LOOK
            done = found
        return placed.first(done)

    # ---- Corners

    def _is_open(self, leg: int) -> bool:
        """Whether the distance of the blend at the end of a leg is still to be found out."""
        return len(self._blends) <= leg < len(self._legs) - 1 and self._legs[leg].corner.is_open

    def _settle(self, leg: int, rows: Pose, final: bool) -> bool:
        """Make the blend at the end of a leg, once its distance is known; whether it is."""
        if leg < len(self._blends) or leg == len(self._legs) - 1:
            return True
        first, second, corner = self._legs[leg].curve, self._legs[leg + 1].curve, self._legs[leg].corner
        distance = corner.distance
        if corner.is_open:
            if not final and self._surely_before(leg, rows[0]) == len(rows[0]):
                return False
            hint = self._hint(_Part(leg, False))
            found = distance_taken((first, second), corner, rows, hint, final, self._allowance)
            if found is None:
                return False
            distance = found
        blend = Blend(first, second, distance) if distance > PATH_STEP else None
        self._blends.append(blend)
        end, cut = self._bases[leg] + first.length, 0.0
        if blend is not None:
            cut = blend.length - 2.0 * blend.distance
            self._ends.append(end - blend.distance + float(blend.way(np.array([blend.corner]))[0]))
        else:
            self._ends.append(end)
        self._bases.append(end + cut)
        return True

    def _surely_before(self, leg: int, positions: Floats) -> int:
        """How many of the next rows lie before any blend at the end of a leg."""
        curve, most = self._legs[leg].curve, self._legs[leg].corner.distance
        way = curve.nearest(positions, self._hint(_Part(leg, False)))
        off = np.linalg.norm(positions - curve.points(way), axis=1)
        # A row less than a tick before the blend may lie behind it, and within the leg's tolerance as well.
        nearby = np.where(way <= curve.length - most - self._reach, PATH_POSITION, PATH_STEP)
        inside = (
            (way >= self._bounds(leg)[0] - PATH_POSITION) & (way <= curve.length - most) & (off <= nearby)
        )
        return len(positions) if inside.all() else int(np.argmin(inside))

    # ---- Parts

    def _run(self, placed: Placed, done: int, positions: Floats, rotations: Floats) -> int:
        """Place rows from `done` on that lie on the part reached, and go on to the next one behind them."""
        part = self._part
        at, off, past = self._on(part, positions[done:])
        bad = past | ~(off <= PATH_POSITION)
        unsure = self._may_be_further(part, at) & (off > PATH_STEP) & ~bad
        stops = bad | unsure
        count = len(bad) if not stops.any() else int(np.argmax(stops))
        self._place(placed, done, part, at[:count], off[:count], rotations)
        done += count
        if count == len(bad):
            return done
        row, few = positions[done : done + 1], slice(done, min(done + FEW, len(positions)))
        rest = positions[few], rotations[few]
        if unsure[count]:
            better = float(off[count]) - PATH_STEP
            other = self._fitting(row, better)
            if other is None and self._sought_from != part:
                # Once on each part: where rows lie beside it all along, each of them would seek in vain.
                self._sought_from = part
                other = self._behind_unseen(rest, better)
            if other is not None and self._order(other) > self._order(part):
                self._part = other
                return done
            here = slice(count, count + 1)
            self._place(placed, done, part, at[here], off[here], rotations)
            return done + 1
        other = self._fitting(row)
        if other is not None and self._order(other) > self._order(part):
            self._part = other
        elif other is not None:
            at, off, _ = self._on(other, row)
            self._place(placed, done, other, at, off, rotations)
            done += 1
        elif past[count]:
            self._part = self._next(part) or part
        elif (behind := self._behind_unseen(rest, PATH_POSITION)) is not None:
            self._part = behind
        else:
            # On no part at all: as far off this one as it says, with all rows that do not leave its stretch.
            left = np.flatnonzero(past[count:])
            lost = int(left[0]) if left.size else len(bad) - count
            self._place(placed, done, part, at[count : count + lost], off[count : count + lost], rotations)
            done += lost
        return done

    def _on(self, part: _Part, positions: Floats) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """Places (R,) on a part nearest to positions, distances from it, and which rows lie behind it."""
        if part.blend:
            blend = self._blends[part.leg]
            assert blend is not None
            u = blend.nearest(positions)
            return (
                u,
                np.linalg.norm(positions - blend.points(u), axis=1),
                (u >= 1.0) & (blend.behind(positions) > 0.0),
            )
        curve = self._legs[part.leg].curve
        low, high = self._bounds(part.leg)
        hint = self._hint(part)
        way = curve.nearest(positions, hint)
        inside = np.clip(way, low, high)
        off = np.linalg.norm(positions - curve.points(inside), axis=1)
        if part.leg == len(self._legs) - 1:
            return inside, off, np.zeros(len(way), dtype=np.bool_)
        if part.leg >= len(self._blends) or self._blends[part.leg] is not None:
            return inside, off, way > high
        return inside, off, self._past_sharp(part.leg, positions, way, off, hint)

    def _past_sharp(
        self, leg: int, positions: Floats, way: Floats, off: Floats, hint: float
    ) -> NDArray[np.bool_]:
        """Which rows lie behind a sharp corner: nearer to the next leg, or going back on both."""
        following = self._legs[leg + 1].curve
        there = rounds(following, following.nearest_at_start(positions))[:2]
        inside = [np.clip(at, 0.0, following.length) for at in there]
        apart = np.min([np.linalg.norm(positions - following.points(at), axis=1) for at in inside], axis=0)
        furthest = np.maximum.accumulate(np.concatenate([[hint], way]))[1:]
        back = (furthest - way > PATH_STEP) & (apart <= off + PATH_STEP)
        # Legs may lie on each other: rounding must not tell which is nearer.
        return np.asarray((apart < off - PATH_STEP) | back)

    def _place(
        self, placed: Placed, start: int, part: _Part, at: Floats, off: Floats, rotations: Floats
    ) -> None:
        """Enter rows that lie at places `at` (R,) of a part."""
        if not len(at):
            return
        here = slice(start, start + len(at))
        leg, base = part.leg, self._bases[part.leg]
        curve, blend = self._legs[leg].curve, self._blends[leg] if part.blend else None
        if blend is not None:
            turned, along = (
                blend.turned_off(at, rotations[here], self._allowance),
                base + curve.length - blend.distance + blend.way(at),
            )
            placed.leg[here] = leg + (at > blend.corner)
        else:
            turned, along = self._allowance.turned_off(rotations[here], curve.rotations(at)), base + at
            placed.leg[here] = leg
        if placed.wanted is not None:
            placed.wanted[here] = (curve if blend is None else blend).rotations(at)
        placed.position[here], placed.along[here] = off, along
        placed.orientation[here] = turned
        placed.straight[here] = not part.blend
        placed.bend[here] = self._bends(part, at)
        if self._order(part) > self._order(self._near[0]):
            placed.over[start] = self._stretches(part, float(at[0]))
        placed.sharp[start] = self._is_sharp_between(self._near[0], part)
        self._near, self._along = (part, float(at[-1])), float(along[-1])

    def _bends(self, part: _Part, at: Floats) -> Floats:
        """Least curvature (R,) from the place before, on the same part, to each place; otherwise 0."""
        curve = self._legs[part.leg].curve
        if not part.blend and curve.is_straight:
            return np.zeros(len(at))
        known = self._near[0] == part
        before = np.concatenate([[self._near[1] if known else at[0]], at[:-1]])
        shares = np.linspace(0.0, 1.0, PLACES)
        places = (before[:, None] + (at - before)[:, None] * shares).ravel()
        if part.blend:
            blend = self._blends[part.leg]
            assert blend is not None
            found = blend.curvature(places)
        else:
            found = np.linalg.norm(curve.bends(places), axis=1)
        least = _least(found.reshape(-1, len(shares)))
        if not known:
            least[0] = 0.0
        return least

    def _stretches(self, part: _Part, at: float) -> Stretches:
        """The way from the last row to a place on the same part or one behind it."""
        (here, start), found = self._near, [Stretches(np.zeros(0), np.zeros(0))]
        for order in range(self._order(here), self._order(part) + 1):
            leg, is_blend = divmod(order, 2)
            blend = self._blends[leg] if is_blend and leg < len(self._blends) else None
            if is_blend and blend is None:
                continue
            low, high = (0.0, 1.0) if is_blend else self._bounds(leg)
            low = start if order == self._order(here) else low
            high = max(low, at if order == self._order(part) else high)
            found.append(self._bent_stretches(leg, blend, low, high))
        return Stretches(*(np.concatenate(parts) for parts in zip(*found, strict=True)))

    def _bent_stretches(self, leg: int, blend: Blend | None, low: float, high: float) -> Stretches:
        """A leg, or the blend at its end, between two of its places."""
        curve, corner = self._legs[leg].curve, self._legs[leg].corner
        if blend is None and curve.is_straight:
            return Stretches(np.array([high - low]), np.zeros(1))
        if blend is not None and corner.may_be_less:
            # Rows need not tell which blend was run, and another one may take less time.
            return Stretches(np.diff(blend.way(np.array([low, high]))), np.zeros(1))
        places = np.linspace(low, high, 2 * CELLS + 1)
        if blend is None:
            ways, bends = places, np.linalg.norm(curve.bends(places), axis=1)
        else:
            ways, bends = blend.way(places), blend.curvature(places)
        cells = np.column_stack([bends[:-2:2], bends[1::2], bends[2::2]])
        return Stretches(np.diff(ways[::2]), _least(cells))

    # ---- Order of the parts

    def _bounds(self, leg: int) -> tuple[float, float]:
        """First and last place on a leg that no blend takes."""
        before = self._blends[leg - 1] if 0 < leg <= len(self._blends) else None
        behind = self._blends[leg] if leg < len(self._blends) else None
        low = 0.0 if before is None else before.distance
        length = self._legs[leg].curve.length
        return low, max(low, length if behind is None else length - behind.distance)

    def _hint(self, part: _Part) -> float:
        """Place on a part from which the next rows go on."""
        if self._near[0] == part:
            return self._near[1]
        return self._bounds(part.leg)[0] if part.leg <= len(self._blends) else 0.0

    def _order(self, part: _Part) -> int:
        return 2 * part.leg + part.blend

    def _next(self, part: _Part) -> _Part | None:
        if part.leg >= len(self._blends):
            return None
        if not part.blend and self._blends[part.leg] is not None:
            return _Part(part.leg, True)
        return _Part(part.leg + 1, False) if part.leg + 1 < len(self._legs) else None

    def _may_be_further(self, part: _Part, at: Floats) -> NDArray[np.bool_]:
        """Which rows at places `at` (R,) of a part a tick may have brought to the next one."""
        if self._next(part) is None:
            return np.zeros(len(at), dtype=np.bool_)
        if part.blend:
            return np.ones(len(at), dtype=np.bool_)
        return np.asarray(at > self._bounds(part.leg)[1] - self._reach)

    def _fitting(self, row: Floats, within: float = PATH_POSITION) -> _Part | None:
        """The first part `within` m of which a row (1, 3) lies that a tick can reach from here, or the one
        before."""
        part = self._next(self._part)
        while part is not None and self._start(part) <= self._along + self._reach + PATH_POSITION:
            if not part.blend and self._is_open(part.leg):
                # Its blend is found out when it is reached.
                return part if self._off_curve(part.leg, row) <= within else None
            if not part.blend:
                self._settle(part.leg, (row, row), False)
            _, off, past = self._on(part, row)
            if off[0] <= within and not past[0]:
                return part
            part = self._next(part)
        before = self._before(self._part)
        if before is not None and self._on(before, row)[1][0] <= within:
            return before
        return None

    def _behind_unseen(self, rows: Pose, within: float) -> _Part | None:
        """The first part within so many m of the first of rows, behind corners of which no row before it
        tells: legs may be run within a tick. They are passed as rows fit best, if any do, else as widely as
        may be."""
        known, row = len(self._blends), rows[0][:1]
        for leg in range(known, len(self._legs) - 1):
            if self._start(_Part(leg, False)) > self._along + self._reach + PATH_POSITION:
                break
            self._settle(leg, rows, True)
            if self._blends[leg] is not None and self._lies_on(_Part(leg, True), row, within):
                return _Part(leg, True)
            if self._lies_on(_Part(leg + 1, False), row, within):
                return _Part(leg + 1, False)
        del self._blends[known:], self._ends[known:], self._bases[known + 1 :]
        return None

    def _lies_on(self, part: _Part, row: Floats, within: float) -> bool:
        if not part.blend and self._is_open(part.leg):
            return self._off_curve(part.leg, row) <= within
        if not part.blend:
            self._settle(part.leg, (row, row), False)
        _, off, past = self._on(part, row)
        return bool(off[0] <= within and not past[0])

    def _off_curve(self, leg: int, row: Floats) -> float:
        """How far a row (1, 3) is off a leg, its blends left away."""
        curve = self._legs[leg].curve
        way = np.clip(curve.nearest(row, self._hint(_Part(leg, False))), 0.0, curve.length)
        return float(np.linalg.norm(row[0] - curve.points(way)[0]))

    def _before(self, part: _Part) -> _Part | None:
        if part.blend:
            return _Part(part.leg, False)
        if part.leg == 0:
            return None
        return _Part(part.leg - 1, self._blends[part.leg - 1] is not None)

    def _start(self, part: _Part) -> float:
        """Way to the start of a part."""
        low, high = self._bounds(part.leg)
        return self._bases[part.leg] + (high if part.blend else low)

    def _is_sharp_between(self, one: _Part, other: _Part) -> bool:
        low, high = sorted((one.leg, other.leg))
        return any(self._blends[leg] is None for leg in range(low, high))


def _least(found: Floats) -> Floats:
    """Least values (R,) of curves sampled evenly (R, K): they may dip by an eighth of a second difference."""
    dip = np.max(np.abs(np.diff(found, 2, axis=1)), axis=1) / 8.0
    return np.asarray(np.maximum(np.min(found, axis=1) - dip, 0.0))
