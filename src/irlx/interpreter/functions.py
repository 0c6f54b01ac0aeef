"""Built-in functions on numbers, texts and positions; those on orientations are in `rotations`."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from irlx.interpreter import quaternion as q
from irlx.interpreter.types import CHAR, INT, ORIENTATION, POSE, POSITION, REAL, STRING, Type
from irlx.interpreter.values import RecordValue, Value


@dataclass(frozen=True)
class Function:
    """A built-in: types of its parameters (several where one may be any of them), its meaning on values
    that fit them, and the type of the result, None for that of the first argument."""

    name: str
    parameters: tuple[Type | tuple[Type, ...], ...]
    result: Type | None
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


def _tangent(angle: float) -> float:
    if angle % 180.0 == 90.0:
        raise ValueError("the tangent of a right angle")
    return math.tan(math.radians(angle))


def _round(value: float) -> int:
    """The nearest whole number, halves away from zero; Python rounds these to even numbers."""
    whole = math.trunc(value)
    return whole + int(math.copysign(1, value)) if abs(value - whole) >= 0.5 else whole


def _character(number: int) -> str:
    if 0xD800 <= number <= 0xDFFF:
        raise ValueError("half a character")
    return chr(number)


def _dot(a: RecordValue, b: RecordValue) -> float:
    return sum(x * y for x, y in zip(vector_of(a), vector_of(b), strict=True))


def _cross(a: RecordValue, b: RecordValue) -> RecordValue:
    return position(q.cross(vector_of(a), vector_of(b)))


def _distance(a: RecordValue, b: RecordValue) -> float:
    """Between two positions, or those of poses."""
    one, other = (parts_of(v)[0] if v.type == POSE else vector_of(v) for v in (a, b))
    return math.dist(one, other)


_ONE, _TWO, _THREE = ((REAL,) * count for count in (1, 2, 3))
_PLACE = (POSITION, POSE)

PLAIN = (
    Function("POSITION", _THREE, POSITION, lambda x, y, z: position((x, y, z))),
    Function("POSE", (POSITION, ORIENTATION), POSE, lambda at, turned: RecordValue(POSE, (at, turned))),
    Function("INV", ((POSE, ORIENTATION),), None, inverse),
    Function("NORM", (POSITION,), REAL, lambda v: q.norm(vector_of(v))),
    Function("CROSS", (POSITION, POSITION), POSITION, _cross),
    Function("DOT", (POSITION, POSITION), REAL, _dot),
    Function("DISTANCE", (_PLACE, _PLACE), REAL, _distance),
    Function("SQRT", _ONE, REAL, math.sqrt),
    Function("SIN", _ONE, REAL, lambda a: math.sin(math.radians(a))),
    Function("COS", _ONE, REAL, lambda a: math.cos(math.radians(a))),
    Function("TAN", _ONE, REAL, _tangent),
    Function("ASIN", _ONE, REAL, lambda x: math.degrees(math.asin(x))),
    Function("ACOS", _ONE, REAL, lambda x: math.degrees(math.acos(x))),
    Function("ATAN", _ONE, REAL, lambda x: math.degrees(math.atan(x))),
    Function("ATAN2", _TWO, REAL, lambda y, x: math.degrees(math.atan2(y, x))),
    Function("EXP", _ONE, REAL, math.exp),
    Function("LN", _ONE, REAL, math.log),
    Function("ABS", ((INT, REAL),), None, abs),
    Function("ROUND", _ONE, INT, _round),
    Function("TRUNC", _ONE, INT, math.trunc),
    Function("FLOAT", _ONE, REAL, float),
    Function("ORD", (CHAR,), INT, ord),
    Function("CHR", (INT,), CHAR, _character),
    Function("LEN", (STRING,), INT, len),
)
"""Built-ins on numbers, texts and positions; angles in degrees, lengths in mm."""
