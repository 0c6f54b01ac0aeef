"""Constraints of a cell: from its tables to relations between joint values, in SI units."""

from __future__ import annotations

from math import radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx.cell.cell import RegisteredConstraint
from irlx.cell.schema import ConstraintSection
from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.promises import CONDITION
from irlx.robot.description import RobotDescription
from irlx.robot.relation import JointRelation

Array = NDArray[np.float64]
Constraints = tuple[tuple[JointRelation, ...], tuple[RegisteredConstraint, ...]]


def read_constraints(
    sections: list[ConstraintSection],
    robot: RobotDescription,
    start: Array | None,
    file: str,
    errors: list[Diagnostic],
) -> Constraints:
    """Relations and registered constraints of a cell; faults go to `errors`: IRL603, IRL606, IRL616.

    `start` (n,) rad | m, None where it is at fault itself: then it is not compared.
    """
    relations: list[JointRelation] = []
    registered: list[RegisteredConstraint] = []
    for index, section in enumerate(sections):
        key = f"constraint[{index + 1}]"
        fault = _fault(section)
        if fault:
            data: dict[str, Any] = {"key": key, "expected": fault, "found": repr(section.name)}
            errors.append(report("IRL603", Place(file, key=key), **data))
        elif section.use is not None:
            registered.append(RegisteredConstraint(section.name, section.use, Place(file, key=f"{key}.use")))
        elif section.joints is not None and _known_joints(section.joints, robot, key, file, errors):
            relations.append(_relation(section, section.joints, robot, start, key, file, errors))
    return tuple(relations), tuple(registered)


def _fault(section: ConstraintSection) -> str:
    if (section.joints is None) == (section.use is None):
        return "either joints or use"
    if section.use is not None and section.value is not None:
        return "no value beside use"
    if section.joints is not None and not any(section.joints.values()):
        return "a factor other than 0"
    return ""


def _known_joints(
    factors: dict[str, float], robot: RobotDescription, key: str, file: str, errors: list[Diagnostic]
) -> bool:
    unknown = [name for name in factors if name not in robot.joint_names]
    for name in unknown:
        where = f"{key}.joints.{name}"
        data: dict[str, Any] = {"key": where, "name": name, "near": near_matches(name, robot.joint_names)}
        data["known"] = ", ".join(robot.joint_names)
        errors.append(report("IRL606", Place(file, key=where), **data))
    return not unknown


def _relation(
    section: ConstraintSection,
    factors: dict[str, float],
    robot: RobotDescription,
    start: Array | None,
    key: str,
    file: str,
    errors: list[Diagnostic],
) -> JointRelation:
    """The relation, times the unit of its first joint: what is left of it is in rad or m then."""
    units = [1e-3 if axis.is_prismatic else radians(1.0) for axis in robot.axes]
    of_joint = dict(zip(robot.joint_names, units, strict=True))
    unit = of_joint[next(iter(factors))]
    scaled = tuple((name, factor * unit / of_joint[name]) for name, factor in factors.items())
    here = 0.0
    if start is not None:
        values = dict(zip(robot.joint_names, start.tolist(), strict=True))
        here = sum(factor * values[name] for name, factor in scaled)
    value = here if section.value is None else section.value * unit
    if start is not None and abs(here - value) > CONDITION:
        data: dict[str, Any] = {
            "name": section.name,
            "found": f"{here / unit:.6g}",
            "due": f"{value / unit:.6g}",
        }
        errors.append(report("IRL616", Place(file, key=key), **data))
    return JointRelation(section.name, scaled, value)
