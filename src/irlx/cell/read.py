"""TOML text -> validated `CellFile`, every fault with its key path, found value and expectation."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel, ValidationError

from irlx.cell.errors import CellError
from irlx.cell.expectation import as_written, expectation
from irlx.cell.schema import (
    CellFile,
    ConstraintSection,
    FrameSection,
    LimitsSection,
    MotionSection,
    ObstacleSection,
    OriginSection,
    RobotSection,
    SelfCollisionSection,
    SignalsSection,
    WaypointSection,
)
from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.diagnostic import near_matches

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_SECTIONS: dict[tuple[str, ...], type[BaseModel]] = {
    (): CellFile,
    ("robot",): RobotSection,
    ("robot", "limits"): LimitsSection,
    ("robot", "origins", "*"): OriginSection,
    ("robot", "self_collision"): SelfCollisionSection,
    ("motion",): MotionSection,
    ("frames", "*"): FrameSection,
    ("constraint", "*"): ConstraintSection,
    ("obstacle", "*"): ObstacleSection,
    ("obstacle", "*", "trajectory", "*"): WaypointSection,
    ("signals",): SignalsSection,
}


def read_cell_file(content: bytes, file: str) -> CellFile:
    """Validated content of a cell file named `file`.

    Raises CellError with one diagnostic a fault: IRL601 not TOML, IRL602 unknown key, IRL603 value.
    """
    try:
        # Editors that put a byte-order mark before UTF-8 do so with cells as they do with programs.
        table = tomllib.loads(content.removeprefix(_BYTE_ORDER_MARK).decode("utf-8"))
    except UnicodeDecodeError as cause:
        message = f"byte {cause.start} is no UTF-8"
        raise CellError(report("IRL601", Place(file), cause=message)) from cause
    except (ValueError, RecursionError) as cause:
        # Besides its own errors tomllib lets those of Python through: too many digits, too deep lists.
        raise CellError(report("IRL601", Place(file), cause=str(cause))) from cause
    try:
        return CellFile.model_validate(table)
    except ValidationError as cause:
        raise CellError(_diagnostics(cause, table, file)) from cause


def _diagnostics(cause: ValidationError, table: Mapping[str, Any], file: str) -> list[Diagnostic]:
    """One diagnostic for each key that is wrong, in the order of the file's schema."""
    found: dict[str, Diagnostic] = {}
    for fault in cause.errors(include_url=False):
        location = _in_file(fault["loc"], table)
        key = key_path(location)
        place = Place(file, key=key)
        if fault["type"] == "extra_forbidden":
            known = _known_keys(location[:-1])
            near = near_matches(str(location[-1]), known)
            found[key] = report("IRL602", place, key=key, near=near, known=", ".join(known))
        else:
            expected = expectation(fault)
            value = as_written(_value_at(table, location))
            found[key] = report("IRL603", place, key=key, expected=expected, found=value)
    return list(found.values())


def _in_file(location: tuple[int | str, ...], table: object) -> tuple[int | str, ...]:
    """The part of pydantic's location that exists in the file; it adds names of alternatives."""
    real: list[int | str] = []
    for step in location:
        inside = isinstance(table, Mapping) and step in table
        inside = inside or (isinstance(table, list) and isinstance(step, int) and step < len(table))
        if not inside:
            continue
        real.append(step)
        table = table[step]  # type: ignore[index]
    return tuple(real)


def _value_at(table: Any, location: tuple[int | str, ...]) -> Any:
    for step in location:
        table = table[step]
    return table


def _known_keys(section: tuple[int | str, ...]) -> list[str]:
    names = tuple("*" if isinstance(step, int) else step for step in section)
    model = _SECTIONS.get(names) or _SECTIONS.get((*names[:-1], "*"))
    return list(model.model_fields) if model else []


def key_path(location: tuple[int | str, ...]) -> str:
    """Key path as people write it: ``robot.start[3]``, entries counted from 1."""
    path = ""
    for step in location:
        path += f"[{step + 1}]" if isinstance(step, int) else f".{step}" if path else step
    return path
