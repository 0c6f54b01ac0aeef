"""Signatures: what routines and built-in functions take and give."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache

from irlx.language.types.model import BOOL, CHAR, FILE, INT, REAL, STRING, UNKNOWN, Type
from irlx.language.types.predefined import ORIENTATION, POSE, POSITION


@dataclass(frozen=True, slots=True)
class Parameter:
    """One parameter: its name, '' for a built-in's, the types that it may have, and whether it is VAR.

    One that `names_obstacle` takes no value, but a name of the cell.
    """

    name: str
    types: tuple[Type, ...]
    by_reference: bool = False
    names_obstacle: bool = False


@dataclass(frozen=True, slots=True)
class Signature:
    """Parameters and result of a routine; `result` is None for a procedure.

    `least` is the smallest number of arguments. With `like_first` the result has the type of the first one.
    """

    name: str
    parameters: tuple[Parameter, ...]
    result: Type | None
    least: int
    like_first: bool = False


_ANGLES = "SQRT SIN COS TAN ASIN ACOS ATAN EXP LN"


def _signature(
    name: str, result: Type, *parameters: Type | tuple[Type, ...], optional: int = 0, like_first: bool = False
) -> Signature:
    taken = tuple(Parameter("", p if isinstance(p, tuple) else (p,)) for p in parameters)
    return Signature(name, taken, result, len(taken) - optional, like_first)


_OBSTACLE = Parameter("", (UNKNOWN,), names_obstacle=True)


@cache
def _of_any_robot() -> Mapping[str, Signature]:
    """The functions that take and give the same whatever the robot."""
    places = (POSE, POSITION)
    found = [
        *(_signature(name, REAL, REAL) for name in _ANGLES.split()),
        *(
            _signature(name, ORIENTATION, REAL, REAL, REAL)
            for name in ("ORIXYZ", "ORIYXZ", "ORIZYX", "ORIZYZ2")
        ),
        *(_signature(f"QUAT{part}", REAL, ORIENTATION) for part in "ABCD"),
        *(_signature(f"VECTOR{part}", POSITION, ORIENTATION) for part in "NOA"),
        *(_signature(f"ANGLE{part}", REAL, STRING, ORIENTATION) for part in "XYZ"),
        _signature("ORIQUAT", ORIENTATION, REAL, REAL, REAL, REAL),
        _signature("ORIVANG", ORIENTATION, POSITION, REAL),
        _signature("ORIMAT", ORIENTATION, POSITION, POSITION, POSITION),
        _signature("ORIRS", ORIENTATION, POSITION, POSITION, POSITION),
        _signature("ROTANGLE", REAL, ORIENTATION),
        _signature("ROTAXIS", POSITION, ORIENTATION),
        _signature("INV", POSE, (POSE, ORIENTATION), like_first=True),
        _signature("CROSS", POSITION, POSITION, POSITION),
        _signature("DOT", REAL, POSITION, POSITION),
        _signature("NORM", REAL, POSITION),
        _signature("ABS", REAL, (INT, REAL), like_first=True),
        _signature("ATAN2", REAL, REAL, REAL),
        _signature("ROUND", INT, REAL),
        _signature("TRUNC", INT, REAL),
        _signature("FLOAT", REAL, REAL),
        _signature("ORD", INT, CHAR),
        _signature("CHR", CHAR, INT),
        _signature("LEN", INT, STRING),
        _signature("DISTANCE", REAL, places, places),
    ]
    return {signature.name.casefold(): signature for signature in found}


def built_in_functions(types: Mapping[str, Type]) -> dict[str, Signature]:
    """Signatures of the built-in functions by casefolded name; `types` are those of the program.

    Constructors named like their type are not among them: they take the fields of the type.
    """
    main, postures = types["main_joint"], (types["main_joint"], types["joint"])
    places = (POSE, POSITION)
    found = [
        _signature("FK", POSE, postures),
        _signature("IK", main, places, postures),
        _signature("MANIPULABILITY", REAL, postures),
        Signature("CLEARANCE", (Parameter("", postures), _OBSTACLE), REAL, 2),
        Signature("POSTURE", (Parameter("", places), _OBSTACLE), main, 1),
        Signature("EOF", (Parameter("", (FILE,), by_reference=True),), BOOL, 0),
    ]
    return {**_of_any_robot(), **{signature.name.casefold(): signature for signature in found}}
