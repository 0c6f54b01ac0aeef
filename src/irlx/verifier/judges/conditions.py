"""Checks of the cell's constraints, in every row."""

from __future__ import annotations

import numpy as np

from irlx.promises import CONDITION
from irlx.robot.axis_direction import AxisDirection
from irlx.robot.link_path import LinkPath
from irlx.robot.relation import JointRelation
from irlx.streams.joint_stream import Floats
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import Check
from irlx.verifier.geometry.link_poses import Poses, link_poses
from irlx.verifier.geometry.plane_paths import PlanePath
from irlx.verifier.rows import Rows


class ConditionChecks:
    """What is left of each constraint, by the verifier's own poses of links; the worst is told by its name.

    Sums of factor times joint value are in the unit of their first joint.
    """

    def __init__(self, evidence: Evidence) -> None:
        self._columns = {name: k for k, name in enumerate(evidence.outline.header.joint_names)}
        self._units = evidence.outline.header.joint_units
        self._tally = evidence.tally("constraints", "rad|m")
        self._relations = evidence.relations
        self._robot = evidence.robot
        self._paths: dict[LinkPath, PlanePath] = {}

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        if self._robot is None or not self._relations:
            return
        poses = link_poses(
            self._robot, rows.q, {one.link for one in self._relations if not isinstance(one, JointRelation)}
        )
        for relation in self._relations:
            if isinstance(relation, JointRelation):
                left, unit = self._sum(relation, rows.q)
            elif isinstance(relation, AxisDirection):
                left, unit = _angle(relation, poses[relation.link]), "rad"
            else:
                self._on_path(relation, poses[relation.link], rows)
                continue
            every = np.broadcast_to(left, len(rows.q))
            self._tally.add(rows.rows, every, CONDITION, unit=unit, constraint=relation.name)

    def _sum(self, relation: JointRelation, q: Floats) -> tuple[Floats, str]:
        columns = [self._columns[name] for name, _ in relation.factors]
        factors = np.array([factor for _, factor in relation.factors])
        return np.abs(q[:, columns] @ factors - relation.value), self._units[columns[0]]

    def _on_path(self, relation: LinkPath, pose: Poses, rows: Rows) -> None:
        """How far a link is off its path, and of one with a heading the angle of its x axis to it."""
        path = self._paths.setdefault(relation, PlanePath(np.array(relation.points), relation.closed))
        away, tangents = path.beside(pose[0][:, :2])
        judged = [(away, "m")]
        if relation.heading:
            level = pose[1][:, :2, 0]
            with np.errstate(invalid="ignore"):
                level = level / np.linalg.norm(level, axis=1, keepdims=True)
            judged.append((_between(level, tangents), "rad"))
        for left, unit in judged:
            every = np.broadcast_to(left, len(rows.q))
            self._tally.add(rows.rows, every, CONDITION, unit=unit, constraint=relation.name)

    def checks(self) -> list[Check]:
        """Constraints."""
        return [self._tally.check()]


def _angle(relation: AxisDirection, pose: Poses) -> Floats:
    """Angle (N,) between the axis of a link and its direction."""
    return _between(pose[1] @ np.array(relation.axis), np.array(relation.direction))


def _between(first: Floats, second: Floats) -> Floats:
    """Angles (N,) between unit vectors (N, d), by the diagonals of their rhombus."""
    apart, together = np.linalg.norm(first - second, axis=1), np.linalg.norm(first + second, axis=1)
    return np.asarray(2.0 * np.arctan2(apart, together))
