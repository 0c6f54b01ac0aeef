"""Types of the language as a running program needs them; the model is that of `irlx.language.types`."""

from irlx.language.types import (
    ADD_JOINT,
    BOOL,
    INT,
    JOINT_RECORDS,
    ORIENTATION,
    POSE,
    POSITION,
    REAL,
    STRING,
    Array,
    Record,
    Simple,
    Type,
    ambiguous_field,
    joint_type,
    predefined_types,
)

__all__ = [
    "ADD_JOINT",
    "BOOL",
    "INT",
    "JOINT_RECORDS",
    "ORIENTATION",
    "POSE",
    "POSITION",
    "REAL",
    "STRING",
    "Array",
    "Record",
    "Simple",
    "Type",
    "ambiguous_field",
    "joint_type",
    "predefined_types",
]
