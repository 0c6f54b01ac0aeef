"""The axis of a link along a direction of the root frame: two rows, the turn that brings one to the other."""

from __future__ import annotations

from math import atan2, hypot, pi

import numpy as np
from numpy.typing import NDArray

from irlx.robot.axis_direction import AxisDirection
from irlx.robot.kinematics import Kinematics
from irlx.robot.link_constraint import LinkConstraint
from irlx.robot.link_motion import LinkMotion
from irlx.solids.placement import Vector3

Array = NDArray[np.float64]

_SMALL = 1e-4
_OPPOSITE = 1e-6
_NOTHING = (0.0, 0.0, 0.0)


class AxisConstraint(LinkConstraint):
    """Phi = angle (u / |u|), rad, where u (2,) are the parts of the axis at right angles to the direction.

    Phi is the angle between axis and direction long, so that it is zero along the direction alone and
    grows up to pi at its opposite, where a sine would be zero again. With c the cosine, u' the change of u:
    Phi = f(c) u, f = angle / sine, and dPhi = f u' + u f'(c) c'.
    """

    def __init__(self, relation: AxisDirection, kinematics: Kinematics) -> None:
        self.name = relation.name
        self._of = relation.link
        self._link = LinkMotion(kinematics, relation.link)
        self._axis = np.array(relation.axis)
        self._direction = np.array(relation.direction)
        self._frame = np.vstack([across(self._direction), self._direction])

    def rows(self, q: Array) -> tuple[Array, Array]:
        """The angle left about two axes (2,), rad, at posture q (n,), and its derivative (2, n)."""
        state = self._link.at(q)
        axis = state.pose.rotation @ self._axis
        first, second, c = (self._frame @ axis).tolist()
        s = hypot(first, second)
        against = c < 0.0 and s < _OPPOSITE
        ratio, rate = _ratio(c, _OPPOSITE if against else s)
        # The axis moves by w x a: what a change of the axis is worth, times that, is w . (a x worth).
        combined = [
            (_NOTHING, _cross(axis, ratio * self._frame[row] + rate * part * self._direction))
            for row, part in ((0, first), (1, second))
        ]
        # Along the opposite any turn by half a circle leads back: one of them.
        left = (pi, 0.0) if against else (ratio * first, ratio * second)
        return np.array(left), state.rates(combined)

    def in_words(self, q: Array) -> str:
        """How far posture q (n,) is from keeping it."""
        x, y, z = np.round(self._link.at(q).pose.rotation @ self._axis, 4) + 0.0
        angle = float(np.degrees(np.linalg.norm(self.residual(q))))
        return f"the axis of {self._of} points along ({x:g}, {y:g}, {z:g}), {angle:.6g} deg off"


def across(direction: Array) -> Array:
    """Two unit vectors (2, 3) at right angles to a unit vector (3,) and to each other."""
    least = np.zeros(3)
    least[int(np.argmin(np.abs(direction)))] = 1.0
    first = np.cross(direction, least)
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(direction, first)])


def _cross(a: Array, b: Array) -> Vector3:
    (ax, ay, az), (bx, by, bz) = a.tolist(), b.tolist()
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx


def _ratio(c: float, s: float) -> tuple[float, float]:
    """f = angle / sine of the angle with cosine c and sine s >= 0, and its derivative by the cosine."""
    if c > 0.0 and s < _SMALL:
        # Series in 1 - c = s^2 / (1 + c): what is left out is below s^6.
        x = s * s / (1.0 + c)
        return 1.0 + x / 3.0 + 2.0 * x * x / 15.0, -1.0 / 3.0 - 4.0 * x / 15.0
    ratio = atan2(s, c) / s
    return ratio, (c * ratio - 1.0) / (s * s)
