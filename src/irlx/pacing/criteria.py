"""From the criteria that a move asks for to the terms that are added to its posture term."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from irlx.blocks import CriterionChoice, CriterionClause, Origin
from irlx.diagnostics import Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.pacing.errors import PacingError
from irlx.robot.description import RobotDescription
from irlx.transform.criteria.combined import Weighted
from irlx.transform.criteria.library import Entry, TermSetting, known
from irlx.transform.measures.inertia import has_masses

_GAIN = "GAIN"


def check_criterion(choice: CriterionChoice, robot: RobotDescription, place: Place) -> Entry:
    """The entry of a criterion that the robot can have.

    Raises PacingError: IRL360 for an unknown name, IRL361 for a parameter that it does not have, IRL362 for a
    robot without masses.
    """
    entries = known()
    entry = entries.get(choice.name)
    if entry is None:
        names = sorted(entries)
        data: dict[str, Any] = {
            "name": choice.name,
            "near": near_matches(choice.name, names),
            "known": ", ".join(names),
        }
        raise PacingError(report("IRL360", place, **data))
    takes = ("WEIGHT",) if entry.gain is None else ("WEIGHT", _GAIN)
    for param in choice.params:
        if param.name not in takes:
            found: dict[str, Any] = {"name": choice.name, "param": param.name, "known": ", ".join(takes)}
            raise PacingError(report("IRL361", place, **found))
    if entry.needs_masses and not has_masses(robot):
        raise PacingError(report("IRL362", place, name=choice.name, robot=robot.name))
    return entry


def added_terms(
    clauses: Iterable[CriterionClause], setting: TermSetting, locate: Callable[[Origin], Place]
) -> tuple[Weighted, ...]:
    """Terms of the criteria of a move. Raises what `check_criterion` raises, at the clause or switch."""
    robot = setting.kinematics.description
    found = []
    for clause in clauses:
        choice = clause.choice
        entry = check_criterion(choice, robot, locate(clause.origin))
        given = {param.name: param.value for param in choice.params}
        gain = given.get(_GAIN, entry.gain if entry.gain is not None else 1.0)
        try:
            found.append(Weighted(entry.make(setting, gain), choice.weight))
        except ValueError as cause:
            # Links with masses may still leave a joint without any: no dynamics comes of that.
            place = locate(clause.origin)
            raise PacingError(report("IRL362", place, name=choice.name, robot=robot.name)) from cause
    return tuple(found)
