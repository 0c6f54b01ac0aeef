"""A link on a curve of the floor: its distance from the curve, and the angle of its x axis to it."""

from __future__ import annotations

from math import atan2, degrees, hypot

import numpy as np
from numpy.typing import NDArray

from irlx.promises import CONDITION
from irlx.robot.equality import STILL
from irlx.robot.kinematics import Kinematics
from irlx.robot.link_constraint import LinkConstraint
from irlx.robot.link_motion import LinkMotion
from irlx.robot.link_path import LinkPath
from irlx.robot.plane_curve import CurvePoint, PlaneCurve
from irlx.solids.placement import Vector3

Array = NDArray[np.float64]

_LEAST = 1e-6
_NOTHING = (0.0, 0.0, 0.0)
_EACH = [
    ((1.0, 0.0, 0.0), _NOTHING),
    ((0.0, 1.0, 0.0), _NOTHING),
    *((_NOTHING, axis) for axis in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))),
]
"""Motion along x and y, turns about x, y and z."""


class PathConstraint(LinkConstraint):
    """Phi = signed distance, m, of a link's origin from the nearest point of its curve, seen from above.

    The nearest point slides along the tangent, at a right angle to what is left: dPhi is the motion across.
    With a heading a second row: the angle, rad, from the tangent to the link's x axis. With c the curvature,
    p the distance and s' the motion along the tangent the nearest point moves by s' / (1 - c p), and the
    tangent turns by c times that.
    """

    def __init__(self, relation: LinkPath, kinematics: Kinematics) -> None:
        self.name = relation.name
        self._of = relation.link
        self._curve = PlaneCurve(np.array(relation.points), relation.closed)
        self._link = LinkMotion(kinematics, relation.link)
        self._heading = relation.heading

    def residual(self, q: Array) -> Array:
        """What is left at posture q (n,), m and rad, shape (1,) or (2,)."""
        pose = self._link.pose(q)
        x, y, _ = pose.translation.tolist()
        at = self._curve.nearest(x, y)
        if not self._heading:
            return np.array([at.offset])
        ax, ay, _ = pose.rotation[:, 0].tolist()
        return np.array([at.offset, _angle(ax, ay, at)])

    def rows(self, q: Array) -> tuple[Array, Array]:
        """What is left at posture q (n,), shape (1,) or (2,), and its derivative by q."""
        state = self._link.at(q)
        x, y, _ = state.pose.translation.tolist()
        at = self._curve.nearest(x, y)
        across = (-at.ty, at.tx, 0.0), _NOTHING
        if not self._heading:
            return np.array([at.offset]), state.rates([across])
        ax, ay, az = state.pose.rotation[:, 0].tolist()
        return np.array([at.offset, _angle(ax, ay, at)]), state.rates([across, _turned(ax, ay, az, at)])

    def breakable(self, postures: Array, free: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Which of the equations joints `free` (n,) can break, whatever part of the curve they lead to."""
        rates = np.array([self._link.at(q).rates(_EACH)[:, free] for q in postures])
        moved, turned = (bool(np.any(np.abs(part) > STILL)) for part in (rates[:, :2], rates[:, 2:]))
        if self._curve.is_straight:
            end = self._curve.ends[0]
            moved = bool(np.any(np.abs(end.tx * rates[:, 1] - end.ty * rates[:, 0]) > STILL))
        bent = moved and not self._curve.is_straight
        return np.array([moved, turned or bent] if self._heading else [moved])

    def in_words(self, q: Array) -> str:
        """How far posture q (n,) is from keeping it."""
        pose = self._link.at(q).pose
        x, y, _ = (1e3 * pose.translation).tolist()
        ax, ay, _ = pose.rotation[:, 0].tolist()
        at = self._curve.nearest(1e-3 * x, 1e-3 * y)
        if abs(at.offset) > CONDITION:
            off, place = f"{1e3 * abs(at.offset):.6g} mm", f"({1e3 * at.x:.9g}, {1e3 * at.y:.9g}) mm"
            return f"{self._of} stands at ({x:.6g}, {y:.6g}) mm, {off} off its path, nearest to {place}"
        if hypot(ax, ay) < _LEAST:
            return f"the x axis of {self._of} stands upright, it points no way along its path"
        off = f"{degrees(_angle(ax, ay, at)):.9g} deg"
        return f"the x axis of {self._of} is turned by {off} from the way along its path"


def _angle(ax: float, ay: float, at: CurvePoint) -> float:
    """Angle from the tangent to an axis, between -pi and pi: the opposite way does not keep it."""
    return atan2(at.tx * ay - at.ty * ax, at.tx * ax + at.ty * ay)


def _turned(ax: float, ay: float, az: float, at: CurvePoint) -> tuple[Vector3, Vector3]:
    """Its derivative by the velocity of the link and by its turn."""
    # The axis moves by w x a; of that what turns its image on the floor.
    level = max(ax * ax + ay * ay, _LEAST)
    turn = -ax * az / level, -ay * az / level, (ax * ax + ay * ay) / level
    room = 1.0 - at.curvature * at.offset
    back = -at.curvature / (room if abs(room) > _LEAST else _LEAST)
    return (back * at.tx, back * at.ty, 0.0), turn
