"""Names that every program knows: types, functions, procedures, system variables, motion parameters."""

from __future__ import annotations

__all__ = [
    "ACTUAL_VARIABLES",
    "ASKING_FUNCTIONS",
    "BARE_FUNCTIONS",
    "FOLLOWED",
    "FOLLOWED_VARIABLES",
    "FUNCTIONS",
    "LAYOUT_BOUNDS",
    "LIMIT_TYPES",
    "LIMIT_WORDS",
    "MOVE_PARAMETERS",
    "OPEN_MODES",
    "PORT_NAME",
    "PROCEDURES",
    "SIMPLE_VALUE",
    "STANDARD_CHANNELS",
    "SYSTEM_VARIABLES",
    "TYPES",
    "is_analog_port",
    "is_input_port",
    "is_port_name",
]

import re


def _table(words: str) -> dict[str, str]:
    return {word.casefold(): word for word in words.split()}


TYPES = _table(
    "INT INTEGER REAL CHAR CHARACTER STRING BOOL BOOLEAN FILE SEMAPHORE SIGNAL"
    " POSITION ORIENTATION POSE MAIN_JOINT ADD_JOINT JOINT ROBTARGET"
    " MAIN_JOINT_MIN MAIN_JOINT_MAX MAIN_JOINT_SPEED_MIN MAIN_JOINT_SPEED_MAX"
    " MAIN_JOINT_ACCEL_MIN MAIN_JOINT_ACCEL_MAX"
)
"""Predefined types, casefolded name to spelling."""

FUNCTIONS = _table(
    "POSITION ORIENTATION POSE ROBTARGET JOINT MAIN_JOINT ADD_JOINT"
    " ORIQUAT ORIVANG ORIMAT ORIRS ORIXYZ ORIYXZ ORIZYX ORIZYZ2"
    " QUATA QUATB QUATC QUATD ROTANGLE ROTAXIS VECTORN VECTORO VECTORA ANGLEX ANGLEY ANGLEZ"
    " INV CROSS DOT NORM ABS SQRT SIN COS TAN ASIN ACOS ATAN ATAN2 EXP LN ROUND TRUNC FLOAT ORD CHR LEN"
    " DISTANCE FK IK MANIPULABILITY CLEARANCE POSTURE EOF"
)
"""Predefined functions and constructors, casefolded name to spelling."""

BARE_FUNCTIONS = frozenset({"eof"})
"""Predefined functions that may be called by their name alone, casefolded."""

ASKING_FUNCTIONS = frozenset({"posture", "fk", "ik", "manipulability", "clearance"})
"""Predefined functions that ask the robot, casefolded."""

PROCEDURES = _table("OPEN CLOSE READ WRITE WRITELN")
"""Predefined procedures, casefolded name to spelling."""

OPEN_MODES = ("READ", "WRITE", "APPEND")
"""Modes of OPEN."""

LAYOUT_BOUNDS = {"width": 1_000, "precision": 100}
"""What WRITE takes at most as the parts of a layout; at least 0."""

SIMPLE_VALUE = "INT, REAL, CHAR, STRING or BOOL"
"""What READ and WRITE take, for messages."""

STANDARD_CHANNELS = {"IN": "KEYBOARD", "OUT": "SCREEN"}
"""Names for the standard channels as they are, by direction."""

MOVE_PARAMETERS = _table(
    "SPEED ACC TIME SPEED_ORI ACC_ORI SPEED_PTP ACC_PTP JERK C_CP C_PTP C_PASS PROFILE OVERRIDE ANGLE"
    " CIRC_ORI"
)
"""Parameters of MOVE, casefolded name to spelling."""

SYSTEM_VARIABLES = _table(
    "R_BASE R_TOOL R_ROBTARGET_ACT R_JOINT_ACT R_MOVE_TIME R_DISTANCE_FORW R_DISTANCE_BACK R_JBD R_WEIGHTS"
) | _table(
    "R_SPEED R_ACC R_SPEED_ORI R_ACC_ORI R_SPEED_PTP R_ACC_PTP R_JERK R_C_CP R_C_PTP R_C_PASS"
    " R_PROFILE R_OVERRIDE"
)
"""System variables and defaults of the motion parameters, casefolded name to spelling."""

ACTUAL_VARIABLES = frozenset(
    {"r_robtarget_act", "r_joint_act", "r_move_time", "r_distance_forw", "r_distance_back", "r_jbd"}
)
"""System variables that tell where the robot is, how its last move went and what it may do, casefolded."""

FOLLOWED_VARIABLES = frozenset({"r_tool", "r_weights"})
"""System variables that the robot follows, casefolded: only assignments set them."""

FOLLOWED = "a system variable that the robot follows"
"""What messages call one of these."""

LIMIT_WORDS = {"POSITION": "JOINTLIMIT", "SPEED": "JOINTSPEEDLIMIT", "ACCELERATION": "JOINTACCELLIMIT"}
"""Words that limit the joints, by what they limit."""

LIMIT_TYPES = {
    "POSITION": ("main_joint_min", "main_joint_max"),
    "SPEED": ("main_joint_speed_min", "main_joint_speed_max"),
    "ACCELERATION": ("main_joint_accel_min", "main_joint_accel_max"),
}
"""Types of the lower and of the upper bound of such a limit, casefolded, by what it limits."""

PORT_NAME = re.compile(r"a?(?:in|out)_[0-9]+")
"""Casefolded names of ports."""


def is_port_name(key: str) -> bool:
    """Whether a casefolded name is that of a port, such as ``out_3``, usable without a declaration."""
    return PORT_NAME.fullmatch(key) is not None


def is_input_port(key: str) -> bool:
    """Whether a casefolded name is that of a port which the cell sets, such as ``in_3`` or ``ain_1``."""
    return is_port_name(key) and key.partition("_")[0].endswith("in")


def is_analog_port(key: str) -> bool:
    """Whether a casefolded name is that of a port which carries numbers, such as ``aout_1``."""
    return is_port_name(key) and key.startswith("a")
