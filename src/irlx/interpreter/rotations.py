"""Built-in functions that make orientations and take them apart; angles in degrees."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from irlx.interpreter import quaternion as q
from irlx.interpreter.functions import (
    PLAIN,
    Function,
    orientation,
    position,
    quaternion_of,
    vector_of,
)
from irlx.interpreter.types import ORIENTATION, POSITION, REAL, STRING
from irlx.interpreter.values import RecordValue

CONVENTIONS = {"XYZ": "XYZ", "YXZ": "YXZ", "ZYX": "ZYX", "ZYZ2": "ZYZ"}
"""Conventions of angles by name, each with the moving axes that it turns about in order."""

_ORTHOGONAL = 1e-6


def _turn_about(axis: RecordValue, angle: float) -> RecordValue:
    return orientation(q.about(_unit(vector_of(axis)), angle))


def _unit(vector: q.Vector) -> q.Vector:
    length = q.norm(vector)
    if length == 0.0:
        raise ValueError("a direction of length 0")
    return (vector[0] / length, vector[1] / length, vector[2] / length)


def _angles(order: str) -> Callable[[float, float, float], RecordValue]:
    return lambda first, second, third: orientation(q.intrinsic(order, (first, second, third)))


def _of_axes(n: RecordValue, o: RecordValue, a: RecordValue) -> RecordValue:
    """The orientation whose axes x, y, z point along n, o, a; these must be a right-handed frame."""
    columns = [vector_of(axis) for axis in (n, o, a)]
    crossed = q.cross(columns[0], columns[1])
    lengths = [abs(q.norm(column) - 1.0) for column in columns]
    angle = abs(sum(x * y for x, y in zip(columns[0], columns[1], strict=True)))
    if max(*lengths, angle, math.dist(crossed, columns[2])) > _ORTHOGONAL:
        raise ValueError("no right-handed frame of unit vectors")
    return orientation(q.of_columns(*columns))


def _of_points(origin: RecordValue, on_x: RecordValue, in_xy: RecordValue) -> RecordValue:
    """Orientation of the reference system with that origin, a point on its x axis, and one beside it."""
    o, x, y = (vector_of(point) for point in (origin, on_x, in_xy))
    along = _unit((x[0] - o[0], x[1] - o[1], x[2] - o[2]))
    upright = _unit(q.cross(along, (y[0] - o[0], y[1] - o[1], y[2] - o[2])))
    return orientation(q.of_columns(along, q.cross(upright, along), upright))


def _angle(turned: RecordValue) -> float:
    w, x, y, z = quaternion_of(turned)
    return math.degrees(2.0 * math.atan2(q.norm((x, y, z)), abs(w)))


def _axis(turned: RecordValue) -> RecordValue:
    """The axis that belongs to `_angle`; z where nothing turns."""
    w, x, y, z = quaternion_of(turned)
    length = math.copysign(q.norm((x, y, z)), w)
    return position((0.0, 0.0, 1.0) if length == 0.0 else (x / length, y / length, z / length))


def _column(axis: q.Vector) -> Callable[[RecordValue], RecordValue]:
    return lambda turned: position(q.rotate(quaternion_of(turned), axis))


def _component(index: int) -> Callable[[RecordValue], float]:
    return lambda turned: turned.reals()[index]


def _angle_about(axis: str) -> Callable[[str, RecordValue], float]:
    def angle(mode: str, turned: RecordValue) -> float:
        order = CONVENTIONS[mode.upper()]
        # Of two turns about z, the first counts as that about z and the last as the one about x.
        index = order.index(axis) if axis in order else 2
        return q.intrinsic_angles(order, quaternion_of(turned))[index]

    return angle


_THREE = (REAL,) * 3
_ORI = (ORIENTATION,)
_POINTS = (POSITION,) * 3
_ANGLE = (STRING, ORIENTATION)

_ROTATIONS = (
    Function("ORIQUAT", (REAL,) * 4, ORIENTATION, lambda w, x, y, z: orientation((w, x, y, z))),
    Function("ORIVANG", (POSITION, REAL), ORIENTATION, _turn_about),
    Function("ORIMAT", _POINTS, ORIENTATION, _of_axes),
    Function("ORIRS", _POINTS, ORIENTATION, _of_points),
    *(Function(f"ORI{name}", _THREE, ORIENTATION, _angles(order)) for name, order in CONVENTIONS.items()),
    *(Function(f"QUAT{letter}", _ORI, REAL, _component(index)) for index, letter in enumerate("ABCD")),
    Function("ROTANGLE", _ORI, REAL, _angle),
    Function("ROTAXIS", _ORI, POSITION, _axis),
    Function("VECTORN", _ORI, POSITION, _column((1.0, 0.0, 0.0))),
    Function("VECTORO", _ORI, POSITION, _column((0.0, 1.0, 0.0))),
    Function("VECTORA", _ORI, POSITION, _column((0.0, 0.0, 1.0))),
    *(Function(f"ANGLE{axis}", _ANGLE, REAL, _angle_about(axis)) for axis in "XYZ"),
)

FUNCTIONS: Mapping[str, Function] = {function.name.casefold(): function for function in (*PLAIN, *_ROTATIONS)}
"""Built-in functions that ask nobody, by casefolded name; angles in degrees, lengths in mm."""
