"""Types of the language at run time, and the predefined ones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias


@dataclass(frozen=True)
class Simple:
    """INT, REAL, BOOL, CHAR or STRING."""

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
CHAR = Simple("CHAR")


def _reals(name: str, *fields: str) -> Record:
    return Record(name, tuple((field, REAL) for field in fields))


POSITION = _reals("POSITION", "X", "Y", "Z")
ORIENTATION = _reals("ORIENTATION", "Q1", "Q2", "Q3", "Q4")
POSE = Record("POSE", (("POS", POSITION), ("ORI", ORIENTATION)))

ADD_JOINT = Record("ADD_JOINT", ())

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
        "char": CHAR,
        "character": CHAR,
        "position": POSITION,
        "orientation": ORIENTATION,
        "pose": POSE,
    }
    for key, pattern in JOINT_RECORDS.items():
        types[key] = _reals(key.upper(), *(pattern.format(number) for number in range(1, joints + 1)))
    types["add_joint"] = ADD_JOINT
    types["joint"] = joint_type(types["main_joint"])
    types["robtarget"] = robtarget_type(joints)
    return types


def robtarget_type(joints: int) -> Record:
    """ROBTARGET of a robot: a pose, marks of its posture, and one whole number of turns a joint."""
    turns = Array(((1, joints),), INT)
    return Record("ROBTARGET", (("PSE", POSE), ("STATUS", INT), ("TURNS", turns), ("A_JOINT", ADD_JOINT)))


def joint_type(main: Type) -> Record:
    """JOINT with a type of main joints."""
    return Record("JOINT", (("M_JOINT", main), ("A_JOINT", ADD_JOINT)))


def ambiguous_field(record: Record, name: str) -> tuple[str, str] | None:
    """Field, and the path inside it, that the dotted field `name` of the same record could also mean."""
    words = name.split(".")
    for used in range(1, len(words)):
        field, rest = ".".join(words[:used]), words[used:]
        position = record.index.get(field.casefold())
        if position is not None and _leads_somewhere(record.fields[position][1], rest):
            return record.fields[position][0], ".".join(rest)
    return None


def _leads_somewhere(type: Type, words: list[str]) -> bool:
    """Whether words joined by dots are a path of fields in a type."""
    if not words:
        return True
    if not isinstance(type, Record):
        return False
    positions = [
        (used, type.index.get(".".join(words[:used]).casefold())) for used in range(1, len(words) + 1)
    ]
    return any(
        position is not None and _leads_somewhere(type.fields[position][1], words[used:])
        for used, position in positions
    )
