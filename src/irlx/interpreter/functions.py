"""Built-in functions of the executed part of the language."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from irlx.interpreter import quaternion as q
from irlx.interpreter.types import INT, ORIENTATION, POSE, POSITION, REAL, Type
from irlx.interpreter.values import RecordValue, Value


@dataclass(frozen=True)
class Function:
    """A built-in: types of its parameters (several where one may be any of them), and its meaning
    on values that fit them."""

    name: str
    parameters: tuple[Type | tuple[Type, ...], ...]
    apply: Callable[..., Value]


def orientation(quaternion: q.Quaternion) -> RecordValue:
    """ORIENTATION of a quaternion, scalar first, made unit."""
    return RecordValue(ORIENTATION, q.normalised(quaternion))


def quaternion_of(value: RecordValue) -> q.Quaternion:
    """Quaternion of an ORIENTATION."""
    w, x, y, z = value.reals()
    return (w, x, y, z)


def position(vector: q.Vector) -> RecordValue:
    """POSITION of three numbers, mm."""
    return RecordValue(POSITION, vector)


def vector_of(value: RecordValue) -> q.Vector:
    """Numbers of a POSITION, mm."""
    x, y, z = value.reals()
    return (x, y, z)


def pose(vector: q.Vector, quaternion: q.Quaternion) -> RecordValue:
    """POSE of a position (mm) and a unit quaternion."""
    return RecordValue(POSE, (position(vector), orientation(quaternion)))


def parts_of(value: RecordValue) -> tuple[q.Vector, q.Quaternion]:
    """Position (mm) and quaternion of a POSE."""
    at, turned = value.values
    if not isinstance(at, RecordValue) or not isinstance(turned, RecordValue):
        raise TypeError("a pose holds a position and an orientation")
    return vector_of(at), quaternion_of(turned)


def compose(first: RecordValue, second: RecordValue) -> RecordValue:
    """Pose `second`, given in the frame `first`, in the frame that `first` is given in."""
    (p1, q1), (p2, q2) = parts_of(first), parts_of(second)
    x, y, z = q.rotate(q1, p2)
    return pose((p1[0] + x, p1[1] + y, p1[2] + z), q.multiply(q1, q2))


def inverse(value: RecordValue) -> RecordValue:
    """Pose of the base in the frame of the POSE `value`, or the opposite turn of an ORIENTATION."""
    if value.type == ORIENTATION:
        return orientation(q.conjugate(quaternion_of(value)))
    at, turned = parts_of(value)
    back = q.conjugate(turned)
    x, y, z = q.rotate(back, at)
    return pose((-x, -y, -z), back)


def _turn_about(axis: RecordValue, angle: float) -> RecordValue:
    vector = vector_of(axis)
    length = q.norm(vector)
    if length == 0.0:
        raise ValueError("an axis of length 0")
    return orientation(q.about((vector[0] / length, vector[1] / length, vector[2] / length), angle))


def _angles(order: str) -> Callable[[float, float, float], Value]:
    return lambda first, second, third: orientation(q.intrinsic(order, (first, second, third)))


def _quaternion(w: float, x: float, y: float, z: float) -> RecordValue:
    return orientation((w, x, y, z))


def _tangent(angle: float) -> float:
    if angle % 180.0 == 90.0:
        raise ValueError("the tangent of a right angle")
    return math.tan(math.radians(angle))


_ONE, _TWO, _THREE, _FOUR = ((REAL,) * count for count in (1, 2, 3, 4))

_FUNCTIONS = (
    Function("ORIQUAT", _FOUR, _quaternion),
    Function("ORIVANG", (POSITION, REAL), _turn_about),
    Function("ORIXYZ", _THREE, _angles("XYZ")),
    Function("ORIYXZ", _THREE, _angles("YXZ")),
    Function("ORIZYX", _THREE, _angles("ZYX")),
    Function("POSITION", _THREE, lambda x, y, z: position((x, y, z))),
    Function("POSE", (POSITION, ORIENTATION), lambda at, turned: RecordValue(POSE, (at, turned))),
    Function("INV", ((POSE, ORIENTATION),), inverse),
    Function("NORM", (POSITION,), lambda v: q.norm(vector_of(v))),
    Function("SQRT", _ONE, math.sqrt),
    Function("SIN", _ONE, lambda a: math.sin(math.radians(a))),
    Function("COS", _ONE, lambda a: math.cos(math.radians(a))),
    Function("TAN", _ONE, _tangent),
    Function("ASIN", _ONE, lambda x: math.degrees(math.asin(x))),
    Function("ACOS", _ONE, lambda x: math.degrees(math.acos(x))),
    Function("ATAN", _ONE, lambda x: math.degrees(math.atan(x))),
    Function("ATAN2", _TWO, lambda y, x: math.degrees(math.atan2(y, x))),
    Function("EXP", _ONE, math.exp),
    Function("LN", _ONE, math.log),
    Function("ABS", ((INT, REAL),), abs),
)

FUNCTIONS: Mapping[str, Function] = {function.name.casefold(): function for function in _FUNCTIONS}
"""Executed built-in functions by casefolded name; angles in degrees, lengths in mm."""
