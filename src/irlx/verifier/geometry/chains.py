"""Curves run through one after another, their corners rounded or sharp: which of its parts a row lies on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.promises import PATH_POSITION, PATH_STEP
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.allowance import EXACT, Allowance
from irlx.verifier.geometry.bends import Stretches, least_bends, stretches_between
from irlx.verifier.geometry.chain_parts import ChainParts, Leg, Part
from irlx.verifier.geometry.curves import Pose
from irlx.verifier.geometry.further_parts import Reachable, Reached
from irlx.verifier.geometry.placed import Placed

FEW = 16
"""Rows that tell how corners are passed behind which the first of them lies, at most."""

FIRST_LOOK = 64
"""Rows looked at together on a part at first, then twice as many, and so on."""


class ChainWay:
    """The way along the legs of a chain; rows are given to it in order.

    `reach` is the longest way in a tick, m; `allowance` the turns that the tool may stand off by.
    """

    def __init__(self, legs: list[Leg], reach: float, allowance: Allowance = EXACT) -> None:
        self._parts = ChainParts(legs)
        self._allowance, self._reach = allowance, reach
        self._part = Part(0, False)
        """The part that the next row is looked for on first: that of the last one, or one behind it."""
        self._last = Reached(self._part, 0.0, 0.0)
        self._sought_from: Part | None = None

    @property
    def ends(self) -> Floats:
        """Way (K,) to the ends of the first K legs, as far as their corners are known."""
        return np.array(self._parts.ends)

    @property
    def length(self) -> float:
        """Way to the end of the leg that the rows have come to, m."""
        return self._parts.bases[self.leg] + self._parts.legs[self.leg].curve.length

    def start_of(self, leg: int) -> float:
        """Way to the start of a leg, m, endless where it is not known."""
        return self._parts.bases[leg] if leg <= self._parts.known else np.inf

    @property
    def leg(self) -> int:
        """Number of the leg that the rows have come to."""
        return self._part.leg

    @property
    def left(self) -> float:
        """Way to the end of the last leg, blends not known yet being counted as corners, m."""
        return self._parts.left

    def stretches_to_end(self, short: float = 0.0) -> Stretches:
        """The way from the last row to `short` m before the end of the last leg, counted like `left`."""
        legs = self._parts.legs
        end = Part(len(legs) - 1, False), legs[-1].curve.length - short
        return stretches_between(self._parts, self._last[:2], end)

    def begin_at(self, way: float) -> None:
        """Let the rows begin at a place on the first leg, m from its start."""
        self._last = Reached(self._part, way, way)

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
            found, waits = self._run(placed, done, stop, (positions, rotations), final)
            if waits:
                done = found
                break
            look = 2 * look if found == stop else FIRST_LOOK
            done = found
        return placed.first(done)

    @property
    def _reachable(self) -> Reachable:
        return Reachable(self._parts, self._last, self._reach, self._allowance)

    # ---- Corners

    def _settle(self, leg: int, rows: Pose, final: bool) -> bool:
        """Make the blend at the end of a leg, once its distance is known; whether it is."""
        if not self._parts.is_open(leg):
            self._parts.settle_told(leg)
            return True
        if not final and self._surely_before(leg, rows[0]) == len(rows[0]):
            return False
        distance = self._reachable.distance_taken(leg, rows, final)
        if distance is None:
            return False
        self._parts.settle(distance)
        return True

    def _surely_before(self, leg: int, positions: Floats) -> int:
        """How many of the next rows lie before any blend at the end of a leg."""
        curve, most = self._parts.legs[leg].curve, self._parts.legs[leg].corner.distance
        way = curve.nearest(positions, self._reachable.near(Part(leg, False)))
        off = np.linalg.norm(positions - curve.points(way), axis=1)
        # A row less than a tick before the blend may lie behind it, and within the leg's tolerance as well.
        nearby = np.where(way <= curve.length - most - self._reach, PATH_POSITION, PATH_STEP)
        low = self._parts.bounds(leg)[0]
        inside = (way >= low - PATH_POSITION) & (way <= curve.length - most) & (off <= nearby)
        return len(positions) if inside.all() else int(np.argmin(inside))

    # ---- Rows

    def _run(self, placed: Placed, done: int, stop: int, rows: Pose, final: bool) -> tuple[int, bool]:
        """Place rows from `done` up to `stop` that lie on the part reached, and go on to the next one behind
        them; how many are placed, and whether more have to be given to go on."""
        part, (positions, rotations) = self._part, rows
        at, off, past = self._reachable.on(part, positions[done:stop])
        bad = past | ~(off <= PATH_POSITION)
        unsure = self._may_be_further(part, at) & (off > PATH_STEP) & ~bad
        stops = bad | unsure
        count = len(bad) if not stops.any() else int(np.argmax(stops))
        self._place(placed, done, part, at[:count], off[:count], rotations)
        done += count
        if count == len(bad):
            return done, False
        rest = positions[done : done + FEW], rotations[done : done + FEW]
        # Whatever rows are given together, as many tell.
        lacking = not final and len(rest[0]) < FEW and self._reachable.has_unseen
        if unsure[count]:
            goes = self._goes_further(rest, float(off[count]) - PATH_STEP, lacking)
            if goes is False:
                here = slice(count, count + 1)
                self._place(placed, done, part, at[here], off[here], rotations)
                done += 1
            return done, goes is None
        row = rest[0][:1]
        other = self._reachable.fitting(part, row)
        if other is not None and other.order > part.order:
            self._part = other
        elif other is not None:
            at, off, _ = self._reachable.on(other, row)
            self._place(placed, done, other, at, off, rotations)
            done += 1
        elif past[count]:
            self._part = self._parts.next(part) or part
        elif lacking:
            return done, True
        elif not self._goes_behind_unseen(rest, PATH_POSITION):
            # On no part at all: as far off this one as it says, with all rows that do not leave its stretch.
            left = np.flatnonzero(past[count:])
            lost = int(left[0]) if left.size else len(bad) - count
            self._place(placed, done, part, at[count : count + lost], off[count : count + lost], rotations)
            done += lost
        return done, False

    def _may_be_further(self, part: Part, at: Floats) -> NDArray[np.bool_]:
        """Which rows at places `at` (R,) of a part a tick may have brought to the next one."""
        if self._parts.next(part) is None:
            return np.zeros(len(at), dtype=np.bool_)
        if part.blend:
            return np.ones(len(at), dtype=np.bool_)
        return np.asarray(at > self._parts.bounds(part.leg)[1] - self._reach)

    def _goes_further(self, rows: Pose, within: float, lacking: bool) -> bool | None:
        """Go on to a part further on that the first of rows lies within so many m of, if there is one.

        None where that is to be told by more rows, and they are `lacking`."""
        part = self._part
        other = self._reachable.fitting(part, rows[0][:1], within)
        if other is None and self._sought_from != part:
            if lacking:
                return None
            # Once on each part: where rows lie beside it all along, each of them would seek in vain.
            self._sought_from = part
            return self._goes_behind_unseen(rows, within)
        if other is None or other.order < part.order:
            return False
        self._part = other
        return True

    def _goes_behind_unseen(self, rows: Pose, within: float) -> bool:
        """The same behind corners of which no row tells."""
        found = self._reachable.behind_unseen(rows, within)
        if found is None:
            return False
        self._part, self._parts = found
        return True

    def _place(
        self, placed: Placed, start: int, part: Part, at: Floats, off: Floats, rotations: Floats
    ) -> None:
        """Enter rows that lie at places `at` (R,) of a part."""
        if not len(at):
            return
        here, parts, last = slice(start, start + len(at)), self._parts, self._last
        leg, base = part.leg, parts.bases[part.leg]
        curve, blend = parts.legs[leg].curve, parts.blend(part)
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
        placed.bend[here] = least_bends(parts, part, last.at if last.part == part else None, at)
        if part.order > last.part.order:
            placed.over[start] = stretches_between(parts, last[:2], (part, float(at[0])))
        placed.sharp[start] = parts.is_sharp_between(last.part, part)
        self._last = Reached(part, float(at[-1]), float(along[-1]))
