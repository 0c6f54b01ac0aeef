"""Types of the language at run time, and the predefined ones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias


@dataclass(frozen=True)
class Simple:
    """INT, REAL, BOOL or STRING."""

    name: str


@dataclass(frozen=True)
class Record:
    """A record type: names of its fields as declared, and their types."""

    name: str
    fields: tuple[tuple[str, Type], ...]

    @cached_property
    def index(self) -> Mapping[str, int]:
        """Position of a field by its casefolded name."""
        return {name.casefold(): position for position, (name, _) in enumerate(self.fields)}


@dataclass(frozen=True)
class Array:
    """An array type: lowest and highest index of each dimension, type of the elements."""

    ranges: tuple[tuple[int, int], ...]
    element: Type

    @property
    def name(self) -> str:
        """The type as a program would write it."""
        ranges = ", ".join(f"{low}..{high}" for low, high in self.ranges)
        return f"ARRAY [{ranges}] OF {self.element.name}"

    @property
    def size(self) -> int:
        """Number of elements."""
        product = 1
        for low, high in self.ranges:
            product *= high - low + 1
        return product


Type: TypeAlias = Simple | Record | Array

INT, REAL, BOOL, STRING = Simple("INT"), Simple("REAL"), Simple("BOOL"), Simple("STRING")


def _reals(name: str, *fields: str) -> Record:
    return Record(name, tuple((field, REAL) for field in fields))


POSITION = _reals("POSITION", "X", "Y", "Z")
ORIENTATION = _reals("ORIENTATION", "Q1", "Q2", "Q3", "Q4")
POSE = Record("POSE", (("POS", POSITION), ("ORI", ORIENTATION)))

JOINT_RECORDS = {
    "main_joint": "A{}",
    "main_joint_min": "A{}.MIN",
    "main_joint_max": "A{}.MAX",
    "main_joint_speed_min": "A{}.S.MIN",
    "main_joint_speed_max": "A{}.S.MAX",
    "main_joint_accel_min": "A{}.A.MIN",
    "main_joint_accel_max": "A{}.A.MAX",
}
"""Types with one REAL a joint, by casefolded name, and the pattern of their predefined fields."""


def predefined_types(joints: int) -> dict[str, Type]:
    """Types every program knows, by casefolded name, for a robot of this number of joints."""
    types: dict[str, Type] = {
        "int": INT,
        "integer": INT,
        "real": REAL,
        "bool": BOOL,
        "boolean": BOOL,
        "string": STRING,
        "position": POSITION,
        "orientation": ORIENTATION,
        "pose": POSE,
    }
    for key, pattern in JOINT_RECORDS.items():
        types[key] = _reals(key.upper(), *(pattern.format(number) for number in range(1, joints + 1)))
    types["add_joint"] = Record("ADD_JOINT", ())
    types["joint"] = Record("JOINT", (("M_JOINT", types["main_joint"]), ("A_JOINT", types["add_joint"])))
    return types
