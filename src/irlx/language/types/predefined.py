"""Types that every program knows, and those with one field for each joint of the robot."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from irlx.language.types.model import (
    ANY_BOUNDS,
    BOOL,
    CHAR,
    FILE,
    INT,
    REAL,
    SEMAPHORE,
    STRING,
    Array,
    Record,
    Type,
)
from irlx.language.words import count


def _reals(name: str, *fields: str) -> Record:
    return Record(name, tuple((field, REAL) for field in fields))


POSITION = _reals("POSITION", "X", "Y", "Z")
TOLERANCE = _reals("TOLERANCE", "dx", "dy", "dz", "da", "db", "dc")
ORIENTATION = _reals("ORIENTATION", "Q1", "Q2", "Q3", "Q4")
POSE = Record("POSE", (("POS", POSITION), ("ORI", ORIENTATION)))

ADD_JOINT = Record("ADD_JOINT", ())
"""Additional joints of a robot that has none."""

_ANY_TURNS = Array((ANY_BOUNDS,), INT)

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

_SIMPLE: dict[str, Type] = {
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
_FURTHER: dict[str, Type] = {
    "char": CHAR,
    "character": CHAR,
    "file": FILE,
    "semaphore": SEMAPHORE,
}


def predefined_types(joints: int) -> dict[str, Type]:
    """Types that a running program knows, by casefolded name, for a robot of this number of joints."""
    types = _SIMPLE | {key: joint_record(key, joints) for key in JOINT_RECORDS}
    return types | {"char": CHAR, "character": CHAR, "file": FILE} | _postures(types["main_joint"], joints)


def known_types(joints: int | None) -> dict[str, Type]:
    """Types that the text of a program knows, by casefolded name; `joints` None: the robot is not known."""
    types = _SIMPLE | _FURTHER | {key: joint_record(key, joints) for key in JOINT_RECORDS}
    return types | _postures(types["main_joint"], joints)


def _postures(main: Type, joints: int | None) -> dict[str, Type]:
    """JOINT, and ROBTARGET: a pose, marks of its posture, and one whole number of turns a joint."""
    turns = _ANY_TURNS if joints is None else Array(((1, joints),), INT)
    fields = (("PSE", POSE), ("STATUS", INT), ("TURNS", turns), ("A_JOINT", ADD_JOINT))
    robtarget = Record("ROBTARGET", fields)
    return {"add_joint": ADD_JOINT, "joint": joint_type(main), "robtarget": robtarget}


def joint_record(key: str, joints: int | None) -> Record:
    """Predefined joint type of a casefolded name, for a number of joints or for any."""
    pattern = JOINT_RECORDS[key]
    if joints is None:
        return Record(key.upper(), (), pattern)
    return _reals(key.upper(), *(pattern.format(number) for number in range(1, joints + 1)))


def values_of_joints(candidates: Iterable[Type]) -> str:
    """How many values a MAIN_JOINT among the types takes, as help; '' where none is or nobody knows."""
    for type in candidates:
        if isinstance(type, Record) and type.name.casefold() == "main_joint" and not type.pattern:
            joints = len(type.fields)
            return f"{type.name} takes {count(joints, 'value')}: the robot has {count(joints, 'joint')}"
    return ""


def joint_bounds(types: Mapping[str, Type]) -> Record:
    """Type of R_JBD: the two bounds of JOINTLIMIT, as the program or the language defines them."""
    lower, upper = types["main_joint_min"], types["main_joint_max"]
    return Record("JOINT_BOUNDS", (("LOWER", lower), ("UPPER", upper)))


def joint_weights(joints: int | None) -> Array:
    """Type of R_WEIGHTS: one REAL a joint."""
    return Array((ANY_BOUNDS if joints is None else (1, joints),), REAL)


def joint_type(main: Type) -> Record:
    """JOINT with a type of main joints."""
    return Record("JOINT", (("M_JOINT", main), ("A_JOINT", ADD_JOINT)))
