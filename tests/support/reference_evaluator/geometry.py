"""Positions, orientations and poses by scipy's rotations; quaternions scalar first, angles in degrees."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial.transform import Rotation

from reference_evaluator.types import INT, ORIENTATION, POSE, POSITION, REAL, STRING, Value

NUMBERS = (INT, REAL)
FORMS = {"XYZ": "XYZ", "YXZ": "YXZ", "ZYX": "ZYX", "ZYZ2": "ZYZ"}


class NoValueThere(Exception):
    """The arguments have no result."""


def turned(data):
    w, x, y, z = data
    return Rotation.from_quat([x, y, z, w])


def orientation(rotation):
    x, y, z, w = rotation.as_quat()
    return Value(ORIENTATION, [float(w), float(x), float(y), float(z)])


def position(numbers):
    return Value(POSITION, [float(number) for number in numbers])


def real(number):
    return Value(REAL, float(number))


def combined(op, left, right):
    """What an operator of the geometry gives, None where it has no meaning."""
    kinds = (left.type, op, right.type)
    a, b = left.data, right.data
    if kinds == (POSITION, "+", POSITION):
        return position(np.add(a, b))
    if kinds == (POSITION, "-", POSITION):
        return position(np.subtract(a, b))
    if kinds == (POSE, "+", POSITION):
        return Value(POSE, [position(np.add(a[0], b)).data, a[1]])
    if kinds == (POSE, "-", POSITION):
        return Value(POSE, [position(np.subtract(a[0], b)).data, a[1]])
    if left.type == POSITION and op == "*" and right.type in NUMBERS:
        return position(np.multiply(a, float(b)))
    if left.type in NUMBERS and op == "*" and right.type == POSITION:
        return position(np.multiply(float(a), b))
    if left.type == POSITION and op == "/" and right.type in NUMBERS:
        return position(np.divide(a, float(b)))
    if kinds == (ORIENTATION, "*", POSITION):
        return position(turned(a).apply(b))
    if kinds == (ORIENTATION, "@", ORIENTATION):
        return orientation(turned(a) * turned(b))
    if kinds == (POSE, "@", POSITION):
        return position(np.add(a[0], turned(a[1]).apply(b)))
    if kinds == (POSE, "@", POSE):
        at = np.add(a[0], turned(a[1]).apply(b[0]))
        return Value(POSE, [position(at).data, orientation(turned(a[1]) * turned(b[1])).data])
    return None


def inverse(value):
    if value.type == ORIENTATION:
        return orientation(turned(value.data).inv())
    back = turned(value.data[1]).inv()
    return Value(POSE, [position(-back.apply(value.data[0])).data, orientation(back).data])


def turn_about(axis, angle):
    length = np.linalg.norm(axis)
    if length == 0.0:
        raise NoValueThere
    return orientation(Rotation.from_rotvec(np.asarray(axis) / length * math.radians(angle)))


def from_axes(n, o, a):
    matrix = np.column_stack([n, o, a])
    if np.max(np.abs(matrix.T @ matrix - np.eye(3))) > 1e-6 or np.linalg.det(matrix) < 0.0:
        raise NoValueThere
    return orientation(Rotation.from_matrix(matrix))


def reference_system(origin, on_x, beside):
    x, aside = np.subtract(on_x, origin), np.subtract(beside, origin)
    z = np.cross(x, aside)
    if np.linalg.norm(z) == 0.0:
        raise NoValueThere
    x, z = x / np.linalg.norm(x), z / np.linalg.norm(z)
    return orientation(Rotation.from_matrix(np.column_stack([x, np.cross(z, x), z])))


def angles(form, data):
    """The three angles in the order of the form."""
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return turned(data).as_euler(FORMS[form.upper()], degrees=True)


def angle(axis, mode, ori):
    if mode.upper() not in FORMS:
        raise NoValueThere
    first, second, third = angles(mode, ori)
    order = {"X": third, "Y": second, "Z": first} if mode.upper() == "ZYZ2" else None
    return real(order[axis] if order else dict(zip(mode.upper(), (first, second, third), strict=True))[axis])


def axis_of(data):
    vector = turned(data).as_rotvec()
    length = np.linalg.norm(vector)
    return position([0.0, 0.0, 1.0] if length == 0.0 else vector / length)


def euler(form):
    def made(a, b, c):
        return orientation(Rotation.from_euler(FORMS[form], [a, b, c], degrees=True))

    return made


def column(number):
    return lambda ori: position(turned(ori).as_matrix()[:, number])


def distance(a, b):
    return real(np.linalg.norm(np.subtract(a, b)))


R, P, T = REAL, POSITION, ORIENTATION
FUNCTIONS = {
    "oriquat": ((R, R, R, R), lambda w, x, y, z: orientation(turned([w, x, y, z]))),
    "orivang": ((P, R), turn_about),
    "orimat": ((P, P, P), from_axes),
    "orirs": ((P, P, P), reference_system),
    "orixyz": ((R, R, R), euler("XYZ")),
    "oriyxz": ((R, R, R), euler("YXZ")),
    "orizyx": ((R, R, R), euler("ZYX")),
    "orizyz2": ((R, R, R), euler("ZYZ2")),
    "rotangle": ((T,), lambda o: real(math.degrees(turned(o).magnitude()))),
    "rotaxis": ((T,), axis_of),
    "vectorn": ((T,), column(0)),
    "vectoro": ((T,), column(1)),
    "vectora": ((T,), column(2)),
    "anglex": ((STRING, T), lambda mode, o: angle("X", mode, o)),
    "angley": ((STRING, T), lambda mode, o: angle("Y", mode, o)),
    "anglez": ((STRING, T), lambda mode, o: angle("Z", mode, o)),
    "norm": ((P,), lambda p: real(np.linalg.norm(p))),
    "cross": ((P, P), lambda p, q: position(np.cross(p, q))),
    "dot": ((P, P), lambda p, q: real(np.dot(p, q))),
    **{
        f"quat{letter}": ((T,), lambda o, number=number: real(o[number]))
        for number, letter in enumerate("abcd")
    },
}
"""Functions by name: types of the parameters, and what they do with their data."""
