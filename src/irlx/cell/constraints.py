"""Constraints of a cell: from its tables to conditions on joints and links, in SI units."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx.cell.cell import RegisteredConstraint
from irlx.cell.link_path_faults import fault_of_curve, fault_of_points
from irlx.cell.schema import ConstraintSection
from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.promises import CONDITION
from irlx.robot.axis_direction import AxisDirection
from irlx.robot.description import RobotDescription
from irlx.robot.link_path import LinkPath
from irlx.robot.relation import JointRelation, Relation
from irlx.solids.placement import Vector3

Array = NDArray[np.float64]
Constraints = tuple[tuple[Relation, ...], tuple[RegisteredConstraint, ...]]

_KINDS = {
    "joints": ("value",),
    "use": (),
    "axis": ("link", "direction"),
    "path": ("link", "closed", "heading"),
}
"""What says of which kind a constraint is, and what may stand beside it; `link` and `direction` must."""

_MUST_STAND = ("link", "direction")


@dataclass(frozen=True)
class _Reading:
    """A table that is read: where it stands, the robot, and where faults go."""

    section: ConstraintSection
    key: str
    robot: RobotDescription
    file: str
    errors: list[Diagnostic]

    def fault(self, code: str, key: str, **data: Any) -> None:
        where = f"{self.key}.{key}" if key else self.key
        self.errors.append(report(code, Place(self.file, key=where), **{"key": where, **data}))


def read_constraints(
    sections: list[ConstraintSection],
    robot: RobotDescription,
    start: Array | None,
    file: str,
    errors: list[Diagnostic],
) -> Constraints:
    """Relations and registered constraints of a cell; faults go to `errors`: IRL603, IRL606, IRL616, IRL626,
    IRL627, IRL643.

    `start` (n,) rad | m, None where it is at fault itself: then it is not compared. Whether it keeps
    conditions on links the robot's model says later.
    """
    relations: list[Relation] = []
    registered: list[RegisteredConstraint] = []
    for index, section in enumerate(sections):
        reading = _Reading(section, f"constraint[{index + 1}]", robot, file, errors)
        fault = _fault(section)
        if fault:
            reading.fault("IRL603", "", expected=fault, found=repr(section.name))
        elif section.use is not None:
            place = Place(file, key=f"{reading.key}.use")
            registered.append(RegisteredConstraint(section.name, section.use, place))
        elif section.joints is not None:
            if _known_joints(section.joints, reading):
                relations.append(_relation(section.joints, start, reading))
        elif _known_link(reading):
            relations += _link_path(reading) if section.path is not None else _axis_direction(reading)
    return tuple(relations), tuple(registered)


def _fault(section: ConstraintSection) -> str:
    """What is expected where a table is no constraint, or ''."""
    given = section.model_fields_set - {"name"}
    kinds = [kind for kind in _KINDS if kind in given]
    if len(kinds) != 1:
        return f"one of {', '.join(_KINDS)}"
    kind = kinds[0]
    beside = _KINDS[kind]
    odd = sorted(given - {kind, *beside})
    if odd:
        return f"no {odd[0]} beside {kind}"
    missing = [name for name in beside if name not in given and name in _MUST_STAND]
    if missing:
        return f"{missing[0]} beside {kind}"
    if section.joints is not None and not any(section.joints.values()):
        return "a factor other than 0"
    return ""


def _known_joints(factors: dict[str, float], reading: _Reading) -> bool:
    known = reading.robot.joint_names
    unknown = [name for name in factors if name not in known]
    for name in unknown:
        near = near_matches(name, known)
        reading.fault("IRL606", f"joints.{name}", name=name, near=near, known=", ".join(known))
    return not unknown


def _known_link(reading: _Reading) -> bool:
    robot, name = reading.robot, reading.section.link or ""
    links = (robot.root, *(joint.child for joint in robot.joints))
    if name not in links:
        reading.fault("IRL643", "link", name=name, near=near_matches(name, links), known=", ".join(links))
    return name in links


def _relation(factors: dict[str, float], start: Array | None, reading: _Reading) -> JointRelation:
    """The relation, times the unit of its first joint: what is left of it is in rad or m then."""
    section, robot = reading.section, reading.robot
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
        found, due = f"{here / unit:.6g}", f"{value / unit:.6g}"
        reading.fault("IRL616", "", name=section.name, found=found, due=due)
    return JointRelation(section.name, scaled, value, reading.key)


def _axis_direction(reading: _Reading) -> list[AxisDirection]:
    """The condition on an axis, none where a vector has no direction."""
    section = reading.section
    axis = _unit(section.axis or [], "axis", reading)
    direction = _unit(section.direction or [], "direction", reading)
    if axis is None or direction is None:
        return []
    return [AxisDirection(section.name, section.link or "", axis, direction, reading.key)]


def _link_path(reading: _Reading) -> list[LinkPath]:
    """The condition on a link's place, none where no link could follow the path."""
    section = reading.section
    points = tuple((1e-3 * x, 1e-3 * y) for x, y in section.path or [])
    cause = fault_of_points(points, section.closed)
    if cause:
        reading.fault("IRL626", "path", cause=cause)
        return []
    cause = fault_of_curve(points, section.closed)
    if cause:
        reading.fault("IRL627", "path", cause=cause)
        return []
    link = section.link or ""
    return [LinkPath(section.name, link, points, section.closed, section.heading, reading.key)]


def _unit(vector: list[float], key: str, reading: _Reading) -> Vector3 | None:
    """The vector made one long, None (and IRL603) for one of length 0."""
    largest = max(abs(part) for part in vector)
    if not largest:
        reading.fault("IRL603", key, expected="a vector other than 0", found=repr(vector))
        return None
    x, y, z = (part / largest for part in vector)
    length = hypot(x, y, z)
    return x / length, y / length, z / length
