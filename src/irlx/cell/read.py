"""TOML text -> validated `CellFile`, every fault with its key path, found value and expectation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from copy import copy
from dataclasses import dataclass
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
from irlx.cell.toml import cell_toml
from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.diagnostic import near_matches, near_names

_ROUNDS = 4
"""So often what is at fault is taken out: without one key another table may lack something."""
_DECIDES_ON_ROBOT = tuple(
    f"robot.{key}" for key in ("tip", "locked", "origins", "task", "task_frame", "free", "hands")
)
"""Keys that decide on the joints and the task."""
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


@dataclass(frozen=True)
class ReadCell:
    """Content of a cell file without what is at fault in it; None where too little is left to look at.

    `faults`, IRL602 and IRL603, are one for each of the keys that are `wrong`. `same_robot` is False where
    one of them decides on the joints or the task: what is left would be held against another robot.
    """

    content: CellFile | None
    faults: tuple[Diagnostic, ...] = ()
    wrong: frozenset[str] = frozenset()
    same_robot: bool = True

    def is_new(self, finding: Diagnostic) -> bool:
        """Whether a finding on the rest of the cell is no mere consequence of the faults."""
        key = (finding.place.key if finding.place is not None else None) or ""
        return not any(_is_within(key, wrong) or _is_within(wrong, key) for wrong in self.wrong)


def read_cell_file(content: bytes, file: str) -> CellFile:
    """Validated content of a cell file named `file`.

    Raises CellError with one diagnostic a fault: IRL601 not TOML, IRL602 unknown key, IRL603 value.
    """
    read = read_in_parts(content, file)
    if read.faults or read.content is None:
        raise CellError(read.faults)
    return read.content


def read_in_parts(content: bytes, file: str) -> ReadCell:
    """What can be used of a cell file named `file`. Raises CellError, IRL601, for what is not TOML."""
    table = cell_toml(content, file)
    faults: dict[str, Diagnostic] = {}
    wrong = set[str]()
    for _ in range(_ROUNDS):
        try:
            whole = CellFile.model_validate(table)
        except ValidationError as cause:
            found = _diagnostics(cause, table, file)
            # What is missing because it was taken out is no fault of the file.
            faults = faults or found
            places = [_in_file(fault["loc"], table) for fault in cause.errors(include_url=False)]
            wrong |= {key for place in places for key in _touched(place, table)}
            table = _without(table, places)
            continue
        same_robot = not any(_is_within(key, kept) for key in wrong for kept in _DECIDES_ON_ROBOT)
        return ReadCell(whole, tuple(faults.values()), frozenset(wrong), same_robot)
    return ReadCell(None, tuple(faults.values()), frozenset(wrong))


def _without(table: Any, places: Iterable[tuple[int | str, ...]]) -> dict[str, Any]:
    """The table without the keys at some places; of an entry of a list the whole list goes."""
    for place in places:
        names = [index for index, step in enumerate(place) if isinstance(step, str)]
        # A place may be gone already, with a table round it.
        with suppress(IndexError, KeyError, TypeError):
            table = _cut(table, place[: names[-1] + 1])
    return dict(table)


def _cut(table: Any, place: tuple[int | str, ...]) -> Any:
    """A table or list without what is at a place; what is not on the way there is shared."""
    copied = copy(table)
    if len(place) == 1:
        del copied[place[0]]
    else:
        copied[place[0]] = _cut(table[place[0]], place[1:])
    return copied


def _touched(place: tuple[int | str, ...], table: Mapping[str, Any]) -> Iterator[str]:
    """A key that is wrong, and those that the table lacks and that may have been meant by it."""
    yield key_path(place)
    if place and isinstance(place[-1], str):
        beside = _value_at(table, place[:-1])
        for known in near_names(place[-1], _known_keys(place[:-1])):
            if known not in beside:
                yield key_path((*place[:-1], known))


def _is_within(key: str, other: str) -> bool:
    """Whether a key path is another one, or of something in that."""
    return key == other or key.startswith((f"{other}.", f"{other}["))


def _diagnostics(cause: ValidationError, table: Mapping[str, Any], file: str) -> dict[str, Diagnostic]:
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
    return found


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
