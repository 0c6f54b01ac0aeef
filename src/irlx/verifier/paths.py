"""Geometry of moves, rebuilt from their blocks: straight lines, pure turns, and lines in joint space."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.streams.joint_stream import Floats
from irlx.verifier.rotations import about_axis, angle_between, rotation_vectors

TURN_RULES = 1e-3
"""A path shorter than this many m per rad of its turn takes its parameter from the angle: the position
would give it too coarsely."""

HALF_TURN = 1e-6
"""Turns nearer than this to half a turn, rad, may go either way round."""


@dataclass(frozen=True)
class PathDeviation:
    """How rows of a move lie to its path, each of shape (R,).

    `position` m and `orientation` rad off the path; `along` = distance travelled, in the unit that
    gives the parameter (m, or rad where the turn does); `length` of the whole way in that unit.
    """

    position: Floats
    orientation: Floats
    along: Floats
    length: float


def line_deviation(
    start: tuple[Floats, Floats], goal: tuple[Floats, Floats], positions: Floats, rotations: Floats
) -> PathDeviation:
    """Deviation of poses (R, 3), (R, 3, 3) from the straight path between two poses.

    The position runs along the segment, the orientation turns about one fixed axis, the shortest
    way, in proportion to it: R(s) = R_start exp(s w), w = log(R_start' R_goal). The parameter s of
    a pose is that of the nearest point of the segment; of a pure turn, that of the nearest angle.
    """
    found = [_deviation(start, goal, way, positions, rotations) for way in _turns(start[1], goal[1])]
    return min(found, key=lambda deviation: float(deviation.orientation.max(initial=0.0)))


def turn_deviation(
    start: Floats, goal: Floats, share: Floats, rotations: Floats, counts: NDArray[np.bool_] | None = None
) -> Floats:
    """Angle (R,) rad between rotations (R, 3, 3) and the turn from start to goal (3, 3) at the shares (R,).

    Of two ways round as long as each other the one that fits better to the rows that count.
    """
    turned = start.T @ rotations
    counts = np.ones(len(share), dtype=bool) if counts is None else counts
    found = []
    for turn in _turns(start, goal):
        angle = float(np.linalg.norm(turn))
        axis = turn / angle if angle > 0.0 else np.array([1.0, 0.0, 0.0])
        found.append(angle_between(turned, about_axis(axis, share * angle)))
    return min(found, key=lambda off: float(off[counts].max(initial=0.0)))


def _turns(start: Floats, goal: Floats) -> list[Floats]:
    """Rotation vectors (3,) of the shortest turn from start to goal, in the frame of the start."""
    turn = rotation_vectors((start.T @ goal)[None])[0]
    if np.pi - np.linalg.norm(turn) >= HALF_TURN:
        return [turn]
    # Rounding decides the sign of the axis; the other way round is as short.
    return [turn, turn - 2.0 * np.pi * turn / np.linalg.norm(turn)]


def _deviation(
    start: tuple[Floats, Floats],
    goal: tuple[Floats, Floats],
    turn: Floats,
    positions: Floats,
    rotations: Floats,
) -> PathDeviation:
    step = goal[0] - start[0]
    length, angle = float(np.linalg.norm(step)), float(np.linalg.norm(turn))
    offsets = positions - start[0]
    turned = start[1].T @ rotations
    if length > TURN_RULES * angle:
        scale = length
        parameter = offsets @ step / length**2
    elif angle > 0.0:
        scale = angle
        angles = _angles_about(turn / angle, turned)
        # Half of what the turn leaves of a full one lies before its start, half behind its end.
        parameter = np.where(angles < 0.5 * angle - np.pi, angles + 2.0 * np.pi, angles) / angle
    else:
        scale, parameter = 0.0, np.zeros(len(positions))
    inside = np.clip(parameter, 0.0, 1.0)
    axis = turn / angle if angle > 0.0 else np.array([1.0, 0.0, 0.0])
    off_line = np.linalg.norm(offsets - inside[:, None] * step, axis=1)
    off_turn = angle_between(turned, about_axis(axis, inside * angle))
    return PathDeviation(off_line, off_turn, inside * scale, scale)


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


def joint_line_deviation(q: Floats) -> tuple[Floats, Floats]:
    """Deviation (R, n) of joint values q (R, n) from the straight line between first and last row.

    Second result: distance travelled along it (R,), in the joint space's Euclidean norm.
    """
    step = q[-1] - q[0]
    length = float(np.linalg.norm(step))
    offsets = q - q[0]
    if length == 0.0:
        return np.abs(offsets), np.zeros(len(q))
    along = np.clip(offsets @ (step / length), 0.0, length)
    return np.abs(offsets - along[:, None] * (step / length)), along
