"""Geometry of moves, rebuilt from their blocks: straight lines and turns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.allowance import EXACT, Allowance
from irlx.verifier.geometry.rotations import about_axis, rotation_vectors
from irlx.verifier.geometry.task_turns import turns_asked

TURN_RULES = 1e-3
"""A path shorter than this many m per rad of its turn takes its parameter from the angle: the position
would give it too coarsely."""

DECIDED = 1e-5
"""Rows that fit one way round so much better, rad, than the other tell which one is taken."""

HALF_TURN = 1e-6
"""Turns nearer than this to half a turn, rad, may go either way round."""

ROUNDS, SMALL_TURN = 6, 1e-5
"""Steps by which the angle of a row is found where not all turns count, with slopes over so many rad."""

UNASKED = 1e-6
"""Turns of which less than this part is asked for are no way at all."""

Pose = tuple[Floats, Floats]


@dataclass(frozen=True)
class PathDeviation:
    """How rows of a move lie to its path, each of shape (R,).

    `position` m and `orientation` rad off the path; `along` = distance travelled, in the unit that
    gives the parameter (m, or rad where the turn does, `by_angle`); `length` of the whole way in that unit.
    `wanted` (R, 3, 3): the path's own orientation there, told where not all turns count.
    """

    position: Floats
    orientation: Floats
    along: Floats
    length: float
    by_angle: bool
    wanted: Floats | None = None


class LineWay:
    """The straight way between two poses (position (3,), rotation (3, 3)); rows are given to it in order.

    The position runs along the segment, the orientation turns about one fixed axis, the shortest
    way, in proportion to it: R(s) = R_start exp(s w), w = log(R_start' R_goal). The parameter s of
    a pose is that of the nearest point of the segment; of a pure turn, that of the nearest angle.
    Of two ways round as long as each other, the one that the rows take counts. `allowance`: turns that the
    tool may stand off by.
    """

    def __init__(self, start: Pose, goal: Pose, allowance: Allowance = EXACT) -> None:
        self._start = start
        self._allowance = allowance
        self._step = goal[0] - start[0]
        self._turns = shortest_turns(start[1], goal[1])

    @property
    def angle(self) -> float:
        """Angle of the turn, rad."""
        return float(np.linalg.norm(self._turns[0]))

    @property
    def distance(self) -> float:
        """Distance between the two poses, m."""
        return float(np.linalg.norm(self._step))

    @property
    def by_angle(self) -> bool:
        """Whether the angle gives the parameter of the way, and not the distance."""
        return not self.distance > TURN_RULES * self.angle

    @property
    def length(self) -> float:
        """Length of the way: m, or rad where it goes by the angle."""
        return self.angle if self.by_angle else self.distance

    def deviation(self, positions: Floats, attitudes: Floats) -> PathDeviation:
        """Deviation of the next rows (positions (R, 3), attitudes (R, ..)) from the way."""
        found = [self._from(turn, positions, attitudes) for turn in self._turns]
        best, self._turns = settled([deviation.orientation for deviation in found], self._turns)
        return found[best]

    @property
    def reach(self) -> float:
        """Length of the way, m, or rad where it goes by the angle."""
        return self.length

    def nearest(self, positions: Floats) -> Floats:
        """Way (R,) to the points nearest to positions (R, 3); to its middle where positions do not tell."""
        if self.by_angle:
            return np.full(len(positions), 0.5 * self.length)
        return np.clip((positions - self._start[0]) @ self._step / self.distance, 0.0, self.distance)

    def travelled(self, positions: Floats, aside: float) -> tuple[Floats, float]:
        """Way (R,) m to the points nearest to positions (R, 3), and how far that is off the way at most where
        tools stand up to `aside` m beside it. Endless where positions do not tell."""
        return self.nearest(positions), np.inf if self.by_angle else aside

    def at(self, way: Floats) -> Pose:
        """Positions (R, 3) and orientations (R, 3, 3) after ways (R,), m or rad."""
        turn = self._turns[0]
        angle = float(np.linalg.norm(turn))
        axis = turn / angle if angle > 0.0 else np.array([1.0, 0.0, 0.0])
        share = way / self.length if self.length > 0.0 else way
        points = self._start[0] + share[:, None] * self._step
        return points, self._start[1] @ about_axis(axis, share * angle)

    def _from(self, turn: Floats, positions: Floats, attitudes: Floats) -> PathDeviation:
        angle = float(np.linalg.norm(turn))
        offsets = positions - self._start[0]
        turned = self._start[1].T @ attitudes[:, :3]
        if not self.by_angle:
            scale = self.distance
            parameter = offsets @ self._step / scale**2
        elif angle > 0.0:
            scale = angle
            angles = _angles_about(turn / angle, turned)
            if attitudes.shape[1] > 3:
                angles, scale = self._asked_angles(turn / angle, angles, attitudes, scale)
            # Half of what the turn leaves of a full one lies before its start, half behind its end.
            parameter = np.where(angles < 0.5 * angle - np.pi, angles + 2.0 * np.pi, angles) / angle
        else:
            scale, parameter = 0.0, np.zeros(len(positions))
        inside = np.clip(parameter, 0.0, 1.0)
        axis = turn / angle if angle > 0.0 else np.array([1.0, 0.0, 0.0])
        off_line = np.linalg.norm(offsets - inside[:, None] * self._step, axis=1)
        turns = about_axis(axis, inside * angle)
        off_turn = self._allowance.turned_from(attitudes, self._start[1], turns)
        wanted = None if attitudes.shape[1] == 3 else self._start[1] @ turns
        return PathDeviation(off_line, off_turn, inside * scale, scale, self.by_angle, wanted)

    def _asked_angles(
        self, axis: Floats, angles: Floats, attitudes: Floats, scale: float
    ) -> tuple[Floats, float]:
        """Angles (R,) that come nearest in the turns asked for, from those that do in all; and the length of
        the way. It is 0 where none of it is asked for: then no row tells how far it is.
        """
        for _ in range(ROUNDS):
            off, ahead, behind = (
                turns_asked(attitudes, self._start[1] @ about_axis(axis, angles + step))
                for step in (0.0, SMALL_TURN, -SMALL_TURN)
            )
            rate = (ahead - behind) / (2.0 * SMALL_TURN)
            size = np.sum(rate**2, axis=1)
            if not (size > UNASKED**2).any():
                return np.zeros(len(angles)), 0.0
            angles = angles - np.sum(rate * off, axis=1) / np.maximum(size, UNASKED**2)
        return angles, scale


class Turn:
    """The turn from one rotation (3, 3) to another about one fixed axis; rows are given to it in order.

    Of two ways round as long as each other, the one that the rows take counts. `allowance` as that of a line.
    """

    def __init__(self, start: Floats, goal: Floats, allowance: Allowance = EXACT) -> None:
        self._start = start
        self._allowance = allowance
        self._ways = shortest_turns(start, goal)

    def at(self, share: Floats) -> Floats:
        """Orientations (R, 3, 3) at shares (R,) of the way."""
        angle = float(np.linalg.norm(self._ways[0]))
        axis = self._ways[0] / angle if angle > 0.0 else np.array([1.0, 0.0, 0.0])
        return np.asarray(self._start @ about_axis(axis, share * angle))

    def off(self, share: Floats, attitudes: Floats, counts: NDArray[np.bool_] | None = None) -> Floats:
        """Angle (R,) rad between attitudes (R, ..) and the turn at the shares (R,) of its way.

        Only rows that `counts` (R,) help to tell which way round it goes.
        """
        counts = np.ones(len(share), dtype=bool) if counts is None else counts
        found = []
        for way in self._ways:
            angle = float(np.linalg.norm(way))
            axis = way / angle if angle > 0.0 else np.array([1.0, 0.0, 0.0])
            found.append(self._allowance.turned_from(attitudes, self._start, about_axis(axis, share * angle)))
        best, self._ways = settled([off[counts] for off in found], self._ways)
        return found[best]


def settled(offs: list[Floats], ways: list[Floats]) -> tuple[int, list[Floats]]:
    """Which of several ways round fits the rows better, and the ways still open after these rows."""
    worst = [float(off.max(initial=0.0)) for off in offs]
    best = int(np.argmin(worst))
    return best, ([ways[best]] if max(worst) - min(worst) > DECIDED else ways)


def shortest_turns(start: Floats, goal: Floats) -> list[Floats]:
    """Rotation vectors (3,) of the shortest turn from start to goal, in the frame of the start."""
    turn = rotation_vectors((start.T @ goal)[None])[0]
    if np.pi - np.linalg.norm(turn) >= HALF_TURN:
        return [turn]
    # Rounding decides the sign of the axis; the other way round is as short.
    return [turn, turn - 2.0 * np.pi * turn / np.linalg.norm(turn)]


def _angles_about(axis: Floats, turned: Floats) -> Floats:
    """Angle in (-pi, pi] about a unit axis that comes nearest to each rotation (R, 3, 3).

    The trace of R(-a) M is largest where tan a = (axis . vee(M - M')) / (trace M - axis' M axis).
    """
    sine = (
        axis[0] * (turned[:, 2, 1] - turned[:, 1, 2])
        + axis[1] * (turned[:, 0, 2] - turned[:, 2, 0])
        + axis[2] * (turned[:, 1, 0] - turned[:, 0, 1])
    )
    cosine = np.trace(turned, axis1=1, axis2=2) - np.einsum("i,rij,j->r", axis, turned, axis)
    return np.asarray(np.arctan2(sine, cosine))
