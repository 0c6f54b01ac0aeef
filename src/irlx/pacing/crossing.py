"""Corners between joint space and a path: the end of one move is led over into the beginning of the other."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import inf, pi

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Blend, MotionLaw, MoveBlock, MoveKind
from irlx.motion.corner import LEAST_BLEND, REVERSAL, Lost
from irlx.pacing.conditions import broken_condition
from irlx.pacing.demand import Demands
from irlx.pacing.row_check import broken_on_the_way
from irlx.pacing.rows import MotionRows, PathPart
from irlx.pacing.transition import transition
from irlx.promises import PROGRAM_EXCESS
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

LEAST_TICKS = 2
"""Ticks of each move that a corner takes at least: with less no row leaves the programmed ways."""

_KEPT = 3
"""Rows that a move keeps as they are, at least, beside its corners."""

_PARTS = (1.0, 0.7, 0.45, 0.25, 0.1, 0.04)
"""Parts of the most that a corner may take of a move which are tried, each with each."""

_TIMES = np.linspace(0.3, 1.0, 11)
"""Parts of the time that the moves have for it with a stop in which a corner is tried to be passed."""

_SLOWER = 3
"""Ways that keep the joints' limits, from the quickest on, between the same rows: so many are looked at."""

_TANGENT = 0.1
"""Part of the way beside a corner whose chord counts as the direction in which it is reached or left."""


@dataclass(frozen=True)
class Crossing:
    """A corner passed without a stop: the rows of the move before it and of the one behind it.

    `saved` ticks less than with the stop. The corner is left out by `miss` m; `left` and `joined` m is the
    tool away from it where it leaves the one move's way and is on the other's. `room` is half of the first
    move where it asks for more, m, else None.
    """

    before: MotionRows
    after: MotionRows
    saved: int
    left: float
    joined: float
    miss: float
    room: float | None


@dataclass(frozen=True)
class Meeting:
    """Two motions, each from rest to rest, the second from where the first one ends.

    `before` are the rows of the last move of the first one, its hold last, `after` those of the first move of
    the second one; `rooms`: how far a corner may reach into each of them, in the unit of their `s`.
    """

    before: MotionRows
    after: MotionRows
    rooms: tuple[float, float]

    @property
    def blocks(self) -> tuple[MoveBlock, MoveBlock]:
        """Both moves."""
        first, second = self.before.block, self.after.block
        assert isinstance(first, MoveBlock)
        assert isinstance(second, MoveBlock)
        return first, second

    def joined(self, kinematics: Kinematics, limits: JointLimits, dt: float) -> Crossing | Lost:
        """Pass the corner in the least time found, the blend's distance and all bounds being kept.

        The first move is left at a row within its blend's distance, the second one joined at a row no farther
        from the corner, and `transition` leads from the one to the other. Rows outside are untouched.
        Promised for those inside: `limits` hold, to both neighbours as well, and conditions between joints;
        no row's tool is farther from the corner than the same move's rows whose place it takes; the tool is
        no faster than SPEED of the path, or than the PTP moves it there (ticks of `dt` s).
        """
        blend = self.blocks[0].blend
        if blend is None:
            return Lost()
        for rows, name in ((self.before, "this move"), (self.after, "the next move")):
            if rows.path is not None and rows.path.is_turn:
                return Lost(f"{name} turns the tool on the spot")
        return _Corner(self, blend, kinematics, limits, dt).passed()


@dataclass(frozen=True)
class _Cut:
    """Past a corner: `ticks` from `left` ticks before the first move's end to tick `joined` of the next one.

    `q` (ticks - 1, n) are the rows between.
    """

    left: int
    joined: int
    ticks: int
    q: Array

    @property
    def saved(self) -> int:
        """Ticks less than with a stop, which has a hold tick."""
        return self.left + self.joined + 1 - self.ticks


@dataclass(frozen=True)
class _Passed:
    """A way past the corner that keeps every bound, its `first` rows being those of the first move.

    `rows`: q and the tool's position and rotation; `ways`: distance of the tool from the corner where it is
    left, joined, and passed, m.
    """

    cut: _Cut
    first: int
    rows: tuple[Array, Array, Array]
    ways: tuple[float, float, float]


class _Corner:
    """Looks for the quickest way from one motion into the next one."""

    def __init__(
        self, meeting: Meeting, blend: Blend, kinematics: Kinematics, limits: JointLimits, dt: float
    ) -> None:
        self._meeting, self._blend = meeting, blend
        self._kinematics, self._limits, self._dt = kinematics, limits, dt
        before, after = meeting.before, meeting.after
        self._a, self._b = before.q[:-1], after.q
        self._points = before.tool_position[:-1], after.tool_position
        self._turns = before.tool_rotation[:-1], after.tool_rotation
        self._corner = before.tool_position[-1]
        self._far = tuple(np.linalg.norm(points - self._corner, axis=1) for points in self._points)

    def passed(self) -> Crossing | Lost:
        """The quickest way found, or why there is none."""
        most = self._most()
        if isinstance(most, Lost):
            return most
        if min(most) < LEAST_TICKS:
            return Lost("the moves are too short for their ticks")
        if self._turns_back(most):
            return Lost("the path turns back on itself")
        for cut in self._cuts(most):
            found = self._judged(cut)
            if found is not None:
                return self._crossing(self._shortened(found))
        return Lost("the joints' limits, or the speed of the tool, leave no room for it")

    def _shortened(self, found: _Passed) -> _Passed:
        """A way past the corner, or the same in less ticks, as long as these do."""
        cut = found.cut
        for ticks in range(cut.ticks - 1, 0, -1):
            shorter = self._cut(cut.left, cut.joined, ticks)
            better = None if shorter is None else self._judged(shorter)
            if better is None:
                return found
            found = better
        return found

    def _cuts(self, most: tuple[int, int]) -> Iterator[_Cut]:
        """Ways that keep the joints' limits, those that save most first, each made when it is asked for."""
        asked = []
        for shares in product(_PARTS, repeat=2):
            left, joined = (
                max(LEAST_TICKS, round(share * ticks)) for share, ticks in zip(shares, most, strict=True)
            )
            every = sorted({max(2, round(part * (left + joined))) for part in _TIMES})
            asked += [(shares, left, joined, ticks) for ticks in every]
        found_of: Counter[tuple[float, ...]] = Counter()
        for shares, left, joined, ticks in sorted(asked, key=lambda one: one[3] - one[1] - one[2]):
            found = None if found_of[shares] == _SLOWER else self._cut(left, joined, ticks)
            if found is not None:
                found_of[shares] += 1
                yield found

    def _cut(self, left: int, joined: int, ticks: int) -> _Cut | None:
        """The way of so many ticks, None where the joints cannot go it."""
        if ticks < LEAST_TICKS:
            return None
        kept = len(self._a) - left
        before, behind = self._a[kept - 3 : kept], self._b[joined - 1 : joined + 2]
        alike = bool(self._kinematics.constraints)
        q = transition(before, behind, ticks, self._limits, self._dt, alike)
        if q is None or broken_on_the_way(np.vstack([before, q, behind]), self._limits, self._dt) is not None:
            return None
        return _Cut(left, joined, ticks, q)

    @cached_property
    def _asked(self) -> tuple[float, bool]:
        """How far the corner may reach back into the first move, by its s; whether more was asked for."""
        room = self._meeting.rooms[0]
        if self._meeting.blocks[0].kind is MoveKind.PTP:
            return room * (1.0 if self._blend.share is None else min(self._blend.share, 1.0)), False
        asked = inf if self._blend.distance is None else self._blend.distance
        return min(asked, room), asked > room and asked < inf

    def _most(self) -> tuple[int, int] | Lost:
        """Ticks of both moves that the corner may take, by their ways and rows alone."""
        before, after = self._meeting.before, self._meeting.after
        s = before.s[:-1]
        if not len(s):
            # Joined to the PTP before it, a short one is left with the row in which it ends.
            return Lost("the moves are too short for their ticks")
        inside = s >= s[-1] - self._asked[0]
        # Rows of the corner before lie on neither move, wherever their s stands.
        inside[: before.corner_rows[0]] = False
        first = int(np.count_nonzero(inside)) - 1
        reach = float(np.max(self._far[0][inside])) if before.path is None else self._asked[0]
        if reach < LEAST_BLEND:
            return Lost(f"{reach * 1000.0:.3g} mm beside the corner are next to nothing")
        room = self._meeting.rooms[1] if after.path is None else min(reach, self._meeting.rooms[1])
        near = (after.s <= room) & (self._far[1] <= reach)
        second = len(near) if near.all() else int(np.argmin(near))
        kept = len(self._a) - _KEPT - before.corner_rows[0], len(self._b) - _KEPT
        return min(first, kept[0]), min(second, kept[1])

    def _turns_back(self, most: tuple[int, int]) -> bool:
        """Whether the tool leaves the corner by the way it came."""
        into = self._chord(self._points[0][-most[0] - 1 :][::-1])
        out = self._chord(self._points[1][: most[1]])
        angle = float(np.arctan2(np.linalg.norm(np.cross(-into, out)), -into @ out))
        return angle > pi - REVERSAL

    def _chord(self, points: Array) -> Array:
        """From the corner to the first of points (N, 3), which lead away from it, that is far enough off."""
        away = points - self._corner
        far = np.linalg.norm(away, axis=1)
        return np.asarray(away[int(np.argmax(far >= _TANGENT * np.max(far)))])

    def _judged(self, cut: _Cut) -> _Passed | None:
        """A way past the corner with its tool, None where that or a condition does not allow it."""
        if broken_condition(cut.q, self._kinematics) is not None:
            return None
        kept = len(self._a) - cut.left
        rotation, position = self._kinematics.tool_poses(cut.q)
        far = np.linalg.norm(position - self._corner, axis=1)
        borders = float(self._far[0][kept - 1]), float(np.max(self._far[1][: cut.joined]))
        near = np.concatenate([self._far[0][kept - 1 : kept], far])
        first = int(np.argmin(near))
        if np.any(far[:first] > borders[0]) or np.any(far[first:] > borders[1]):
            return None
        if self._is_too_fast(cut, first, position, rotation):
            return None
        return _Passed(cut, first, (cut.q, position, rotation), (*borders, float(np.min(near))))

    def _is_too_fast(self, cut: _Cut, first: int, position: Array, rotation: Array) -> bool:
        """Whether the tool is too fast on a way, whose `first` rows are those of the first move.

        SPEED and SPEED_ORI of the path bound it, and where it is no row of a path that comes first, the
        rates at which the PTP moves it beside the corner.
        """
        kept, is_ptp = len(self._a) - cut.left, self._meeting.before.path is None
        ends = slice(kept - 1, kept), slice(cut.joined - 1, cut.joined)
        steps = _steps(
            np.vstack([self._points[0][ends[0]], position, self._points[1][ends[1]]]),
            np.concatenate([self._turns[0][ends[0]], rotation, self._turns[1][ends[1]]]),
        )
        here, there = self._points[0][kept - 2 :], self._turns[0][kept - 2 :]
        if not is_ptp:
            here = np.vstack([here[-1:], self._points[1][: cut.joined + 1]])
            there = np.concatenate([there[-1:], self._turns[1][: cut.joined + 1]])
        rates = _rates(self._meeting.blocks[is_ptp].law)
        for values, programmed, joints in zip(steps, rates, _steps(here, there), strict=True):
            bound = np.full(len(values), max(programmed * self._dt, float(np.max(joints))))
            if not is_ptp:
                bound[:first] = programmed * self._dt
            if np.any(values > bound * (1.0 + PROGRAM_EXCESS)):
                return True
        return False

    def _crossing(self, found: _Passed) -> Crossing:
        """The rows handed to both moves: the first ones of the way to the first of them."""
        cut, first, rows, ways = found.cut, found.first, found.rows, found.ways
        before, after = self._meeting.before, self._meeting.after
        kept, led = len(self._a) - cut.left, cut.ticks - 1 - first
        ended = _extended(_part(before, 0, kept), tuple(part[:first] for part in rows), behind=True)
        ended = replace(ended, stops=False, corner_rows=(before.corner_rows[0], first))
        begun = _extended(
            _part(after, cut.joined - 1, len(after)), tuple(part[first:] for part in rows), behind=False
        )
        begun = replace(begun, corner_rows=(led, after.corner_rows[1]))
        begun = shifted(begun, ended.first_tick + len(ended) - begun.first_tick)
        room = self._asked[0] if self._asked[1] else None
        return Crossing(ended, begun, cut.saved, *ways, room)


def shifted(rows: MotionRows, ticks: int) -> MotionRows:
    """The same rows so many ticks later."""
    path = rows.path
    if path is not None:
        path = replace(path, demands=path.demands.later(ticks))
    return replace(rows, first_tick=rows.first_tick + ticks, path=path)


def _rates(law: MotionLaw) -> tuple[float, float]:
    return law.speed * law.override, law.speed_ori * law.override


def _steps(position: Array, rotation: Array) -> tuple[Array, Array]:
    """Way (N,) m and angle (N,) rad from each pose of (N + 1, ..) to the next."""
    from scipy.spatial.transform import Rotation

    turned = Rotation.from_matrix(np.swapaxes(rotation[:-1], 1, 2) @ rotation[1:]).magnitude()
    return np.asarray(np.linalg.norm(np.diff(position, axis=0), axis=1)), np.asarray(turned)


def _part(rows: MotionRows, first: int, last: int) -> MotionRows:
    """Rows from `first` on, before `last`, of rows that are one a tick each."""
    part = slice(first, last)
    path = None if rows.path is None else _part_of_path(rows.path, first, last)
    return replace(
        rows,
        first_tick=rows.first_tick + first,
        q=rows.q[part],
        tool_position=rows.tool_position[part],
        tool_rotation=rows.tool_rotation[part],
        path_position_error=rows.path_position_error[part],
        path_orientation_error=rows.path_orientation_error[part],
        active=rows.active[part],
        s=rows.s[part],
        path=path,
        span=last - first,
    )


def _part_of_path(path: PathPart, first: int, last: int) -> PathPart:
    slowings = tuple(
        replace(
            found,
            first_row=max(found.first_row - first, 0),
            last_row=min(found.last_row, last - 1) - first,
        )
        for found in path.slowings
        if found.last_row >= first and found.first_row < last
    )
    s_before = path.demands[first - 1].s if first > 0 else path.s_before
    return replace(path, demands=path.demands[first:last], slowings=slowings, s_before=s_before)


def _extended(rows: MotionRows, poses: tuple[Array, ...], behind: bool) -> MotionRows:
    """Rows with others (q, tool position and rotation), on no path, put behind or before them."""
    q, position, rotation = poses
    count = len(q)

    def put(values: Array, new: Array) -> Array:
        return np.concatenate([values, new] if behind else [new, values])

    s = rows.s[-1:] if behind else rows.s[:1]
    nothing = np.zeros(count)
    return replace(
        rows,
        q=put(rows.q, q),
        tool_position=put(rows.tool_position, position),
        tool_rotation=put(rows.tool_rotation, rotation),
        path_position_error=put(rows.path_position_error, nothing),
        path_orientation_error=put(rows.path_orientation_error, nothing),
        active=np.concatenate([rows.active, still] if behind else [still, rows.active])
        if len(still := np.zeros(q.shape, dtype=np.int8))
        else rows.active,
        s=put(rows.s, np.repeat(s, count)),
        path=None if rows.path is None else _path_extended(rows.path, count, behind),
        span=len(rows) + count,
    )


def _path_extended(path: PathPart, count: int, behind: bool) -> PathPart:
    """The part of a path of rows to which so many were added: their demand is that of the row beside them."""
    if behind or not count:
        return replace(path, demands=Demands.joined(path.demands, path.demands.repeated(-1, count)))
    demands = path.demands.repeated(0, count).later(np.arange(-count, 0))
    slowings = tuple(
        replace(found, first_row=found.first_row + count, last_row=found.last_row + count)
        for found in path.slowings
    )
    return replace(path, demands=Demands.joined(demands, path.demands), slowings=slowings)
