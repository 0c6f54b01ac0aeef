"""Types, values with their type, and places that hold them.

The data of a value is an int, float, bool or str, or for records and arrays a list of data in order; None is
no value yet.
"""

from __future__ import annotations

import copy
import math
from dataclasses import dataclass
from typing import Any

from reference_evaluator.trouble import Trouble


@dataclass(frozen=True)
class Simple:
    name: str


@dataclass(frozen=True)
class Array:
    bounds: tuple[tuple[int, int], ...]
    element: Any

    @property
    def parts(self):
        return [self.element] * math.prod(high - low + 1 for low, high in self.bounds)


@dataclass(frozen=True)
class Record:
    name: str
    fields: tuple[tuple[str, Any], ...]

    @property
    def parts(self):
        return [type for _, type in self.fields]


INT, REAL, BOOL, CHAR, STRING = map(Simple, ("INT", "REAL", "BOOL", "CHAR", "STRING"))
POSITION = Record("position", (("x", REAL), ("y", REAL), ("z", REAL)))
ORIENTATION = Record("orientation", tuple((f"q{i}", REAL) for i in range(1, 5)))
POSE = Record("pose", (("pos", POSITION), ("ori", ORIENTATION)))
JOINT_WORDS = ("min", "max", "speed_min", "speed_max", "accel_min", "accel_max")
JOINT_TYPES = ("main_joint", *(f"main_joint_{word}" for word in JOINT_WORDS))


def predefined(joints):
    """All predefined types by name, for a robot with a number of joints."""
    found = {
        "int": INT,
        "integer": INT,
        "real": REAL,
        "bool": BOOL,
        "boolean": BOOL,
        "char": CHAR,
        "character": CHAR,
        "string": STRING,
        "position": POSITION,
        "orientation": ORIENTATION,
        "pose": POSE,
    }
    endings = ("", ".min", ".max", ".s.min", ".s.max", ".a.min", ".a.max")
    for name, ending in zip(JOINT_TYPES, endings, strict=True):
        found[name] = Record(name, tuple((f"a{i}{ending}", REAL) for i in range(1, joints + 1)))
    added = found["add_joint"] = Record("add_joint", ())
    found["joint"] = Record("joint", (("m_joint", found["main_joint"]), ("a_joint", added)))
    turns = Array(((1, joints),), INT)
    found["robtarget"] = Record(
        "robtarget", (("pse", POSE), ("status", INT), ("turns", turns), ("a_joint", added))
    )
    return found


@dataclass
class Value:
    type: Any
    data: Any


def empty(type):
    """Data of a variable that nothing was assigned to."""
    return None if isinstance(type, Simple) else [empty(part) for part in type.parts]


def zeros(type):
    """Data of a part that a constructor leaves out."""
    return {INT: 0, REAL: 0.0}[type] if isinstance(type, Simple) else [zeros(part) for part in type.parts]


def whole(data):
    return data is not None and (not isinstance(data, list) or all(map(whole, data)))


@dataclass
class Place:
    """A variable or a part of one: `holder[at]` is its data."""

    holder: list
    at: int
    type: Any

    def part(self, number):
        return Place(self.holder[self.at], number, self.type.parts[number])

    def read(self, node):
        data = self.holder[self.at]
        if not whole(data):
            raise Trouble("IRL501", node)
        return Value(self.type, copy.deepcopy(data))

    def write(self, value):
        overwrite(self.holder, self.at, fitted(value, self.type).data)


def overwrite(holder, at, data):
    """Puts data where others are, part by part: places of parts stay places of the variable."""
    if not isinstance(data, list):
        holder[at] = data
        return
    for number, part in enumerate(data):
        overwrite(holder[at], number, part)


def variable(type):
    return Place([empty(type)], 0, type)


def fitted(value, type):
    """A value as one of the type where it is put: INT becomes REAL, CHAR becomes STRING."""
    if value.type == type:
        return Value(type, copy.deepcopy(value.data))
    if (value.type, type) == (INT, REAL):
        return Value(REAL, float(value.data))
    if (value.type, type) == (CHAR, STRING):
        return Value(STRING, value.data)
    raise TypeError(f"{value.type} where {type} is expected")
