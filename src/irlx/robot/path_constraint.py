"""A link on a curve of the floor: its distance from the curve, and the angle of its x axis to it."""

from __future__ import annotations

from math import atan2, degrees, hypot

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.robot.link_constraint import LinkConstraint
from irlx.robot.link_motion import LinkMotion, LinkState
from irlx.robot.link_path import LinkPath
from irlx.robot.plane_curve import CurvePoint, PlaneCurve

Array = NDArray[np.float64]

_LEAST = 1e-6


class LinkBeside:
    """Where a link is beside a curve; the last answer is kept, since several rows ask for the same."""

    def __init__(self, curve: PlaneCurve, link: LinkMotion) -> None:
        self._curve = curve
        self._link = link
        self._last: tuple[LinkState, CurvePoint] | None = None

    def at(self, q: Array) -> tuple[LinkState, CurvePoint]:
        """The link's state at posture q (n,), and the nearest point of the curve."""
        state = self._link.at(q)
        if self._last is None or self._last[0] is not state:
            x, y, _ = state.position.tolist()
            self._last = state, self._curve.nearest(x, y)
        return self._last


class OnPathConstraint(LinkConstraint):
    """Phi = signed distance, m, of a link's origin from the nearest point of the curve, seen from above.

    The nearest point slides along the tangent, at a right angle to what is left: dPhi is the motion across.
    """

    def __init__(self, relation: LinkPath, beside: LinkBeside) -> None:
        self.name = relation.name
        self._of = relation.link
        self._beside = beside

    def residual(self, q: Array) -> Array:
        """The distance at posture q (n,), shape (1,)."""
        return np.array([self._beside.at(q)[1].offset])

    def derivative(self, q: Array) -> Array:
        """Its derivative by q, shape (1, n)."""
        state, at = self._beside.at(q)
        return np.asarray(at.tx * state.linear[1:2] - at.ty * state.linear[:1])

    def in_words(self, q: Array) -> str:
        """How far posture q (n,) is from keeping it."""
        state, at = self._beside.at(q)
        x, y, _ = state.position.tolist()
        off, place = f"{1e3 * abs(at.offset):.6g} mm", f"({1e3 * at.x:.6g}, {1e3 * at.y:.6g}) mm"
        return (
            f"{self._of} stands at ({1e3 * x:.6g}, {1e3 * y:.6g}) mm, {off} off its path, nearest to {place}"
        )


class HeadingConstraint(LinkConstraint):
    """Phi = angle, rad, from the tangent at the nearest point to the link's x axis, seen from above.

    With c the curvature, p the signed distance and s' the motion along the tangent the nearest point moves by
    s' / (1 - c p), and the tangent turns by c times that.
    """

    def __init__(self, relation: LinkPath, beside: LinkBeside) -> None:
        self.name = relation.name
        self._of = relation.link
        self._beside = beside

    def residual(self, q: Array) -> Array:
        """The angle at posture q (n,), shape (1,), between -pi and pi: the opposite way does not keep it."""
        state, at = self._beside.at(q)
        ax, ay, _ = state.rotation[:, 0].tolist()
        return np.array([atan2(at.tx * ay - at.ty * ax, at.tx * ax + at.ty * ay)])

    def derivative(self, q: Array) -> Array:
        """Its derivative by q, shape (1, n)."""
        state, at = self._beside.at(q)
        ax, ay, az = state.rotation[:, 0].tolist()
        wx, wy, wz = state.angular
        # The axis moves by w x a; of that what turns its image on the floor.
        level = max(ax * ax + ay * ay, _LEAST)
        turned = (ax * (wz * ax - wx * az) - ay * (wy * az - wz * ay)) / level
        room = 1.0 - at.curvature * at.offset
        room = room if abs(room) > _LEAST else _LEAST
        along = at.tx * state.linear[0] + at.ty * state.linear[1]
        return np.asarray(turned - at.curvature / room * along)[None]

    def in_words(self, q: Array) -> str:
        """How far posture q (n,) is from keeping it."""
        ax, ay, _ = self._beside.at(q)[0].rotation[:, 0].tolist()
        off = degrees(abs(float(self.residual(q)[0])))
        if hypot(ax, ay) < _LEAST:
            return f"the x axis of {self._of} stands upright, it points no way along its path"
        return f"the x axis of {self._of} points {off:.6g} deg off the way along its path"


def path_constraints(relation: LinkPath, kinematics: Kinematics) -> list[LinkConstraint]:
    """What a link on a path has to keep: one row, and one for its heading."""
    curve = PlaneCurve(np.array(relation.points), relation.closed)
    beside = LinkBeside(curve, LinkMotion(kinematics, relation.link))
    found: list[LinkConstraint] = [OnPathConstraint(relation, beside)]
    return found + ([HeadingConstraint(relation, beside)] if relation.heading else [])
