"""Quaternions of the language: unit, scalar first (Q1..Q4); a pose turns and then shifts points.

Plain Python on tuples: a program handles poses one at a time, and reading one must not cost the
start-up of a numeric library.
"""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, radians, sin, sqrt

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


def cross(a: Vector, b: Vector) -> Vector:
    """Vector product."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def of_columns(x: Vector, y: Vector, z: Vector) -> Quaternion:
    """Rotation of a matrix by its columns, the turned axes; they must be orthonormal.

    Shepperd 1978: the largest component first, so that nothing is divided by a small number.
    """
    diagonal = (x[0] + y[1] + z[2], x[0], y[1], z[2])
    if diagonal[0] >= max(diagonal[1:]):
        q = (1.0 + diagonal[0], y[2] - z[1], z[0] - x[2], x[1] - y[0])
    elif diagonal[1] >= max(diagonal[2:]):
        q = (y[2] - z[1], 1.0 + x[0] - y[1] - z[2], y[0] + x[1], z[0] + x[2])
    elif diagonal[2] >= diagonal[3]:
        q = (z[0] - x[2], y[0] + x[1], 1.0 - x[0] + y[1] - z[2], z[1] + y[2])
    else:
        q = (x[1] - y[0], z[0] + x[2], z[1] + y[2], 1.0 - x[0] - y[1] + z[2])
    return normalised(q)


_SINGULAR = 1e-14
"""Sine of the middle angle's distance from where first and last turn are about one line."""


def intrinsic_angles(order: str, q: Quaternion) -> tuple[float, float, float]:
    """Angles, degrees, of which `intrinsic` makes the rotation; the last is 0 where only a sum counts.

    The last angle is measured on what the first two leave, so that all three together give the rotation
    also near such places.
    """
    (i, j, k), odd = ("XYZ".index(axis) for axis in order), order in ("YXZ", "XZY", "ZYX")
    middle_axis = rotate(q, _AXES[order[2]])
    sign = -1.0 if odd else 1.0
    if i != k:
        # The turned last axis: its part along the first axis is the sine of the middle angle.
        across = hypot(middle_axis[j], middle_axis[k])
        first = atan2(-sign * middle_axis[j], middle_axis[k])
        second = atan2(sign * middle_axis[i], across)
    else:
        other = 3 - i - j
        turning = 1.0 if (j - i) % 3 == 1 else -1.0
        across = hypot(middle_axis[j], middle_axis[other])
        first = atan2(middle_axis[j], -turning * middle_axis[other])
        second = atan2(across, middle_axis[i])
    if across < _SINGULAR:
        undone = multiply(q, conjugate(about(_AXES[order[1]], degrees(second))))
        return _angle_about(undone, i), degrees(second), 0.0
    one = multiply(about(_AXES[order[0]], degrees(first)), about(_AXES[order[1]], degrees(second)))
    return degrees(first), degrees(second), _angle_about(multiply(conjugate(one), q), k)


def _angle_about(q: Quaternion, axis: int) -> float:
    """Angle of a rotation about an axis, in (-180, 180] degrees."""
    angle = 2.0 * degrees(atan2(q[axis + 1], q[0]))
    return angle - 360.0 if angle > 180.0 else angle + 360.0 if angle <= -180.0 else angle
