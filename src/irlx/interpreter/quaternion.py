"""Quaternions of the language: unit, scalar first (Q1..Q4); a pose turns and then shifts points.

Plain Python on tuples: a program handles poses one at a time, and reading one must not cost the
start-up of a numeric library.
"""

from __future__ import annotations

from math import cos, radians, sin, sqrt

Quaternion = tuple[float, float, float, float]
Vector = tuple[float, float, float]

IDENTITY: Quaternion = (1.0, 0.0, 0.0, 0.0)


def multiply(p: Quaternion, q: Quaternion) -> Quaternion:
    """Hamilton product: the rotation q followed, in the base frame, by the rotation p."""
    a, b, c, d = p
    w, x, y, z = q
    return (
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    )


def conjugate(q: Quaternion) -> Quaternion:
    """The opposite rotation of a unit quaternion."""
    return (q[0], -q[1], -q[2], -q[3])


def norm(values: tuple[float, ...]) -> float:
    """Euclidean length."""
    return sqrt(sum(value * value for value in values))


def normalised(q: Quaternion) -> Quaternion:
    """The unit quaternion of the same direction; the length of q must not be 0."""
    length = norm(q)
    return (q[0] / length, q[1] / length, q[2] / length, q[3] / length)


def rotate(q: Quaternion, v: Vector) -> Vector:
    """The vector v turned by the unit quaternion q: q v q*."""
    _, x, y, z = multiply(multiply(q, (0.0, *v)), conjugate(q))
    return (x, y, z)


def about(axis: Vector, angle: float) -> Quaternion:
    """Turn about a unit axis by an angle in degrees."""
    half = radians(angle) / 2.0
    s = sin(half)
    return (cos(half), axis[0] * s, axis[1] * s, axis[2] * s)


_AXES: dict[str, Vector] = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}


def intrinsic(order: str, angles: tuple[float, ...]) -> Quaternion:
    """Turns about the axes named in `order`, each one in the frame the turns before have made; degrees."""
    q = IDENTITY
    for axis, angle in zip(order, angles, strict=True):
        q = multiply(q, about(_AXES[axis], angle))
    return q
