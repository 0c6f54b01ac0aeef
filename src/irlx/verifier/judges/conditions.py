"""Checks of the cell's constraints, in every row."""

from __future__ import annotations

import numpy as np

from irlx.promises import CONDITION
from irlx.robot.axis_direction import AxisDirection
from irlx.robot.relation import JointRelation
from irlx.streams.joint_stream import Floats
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import Check
from irlx.verifier.geometry.link_poses import Poses, link_poses
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
            else:
                left, unit = _angle(relation, poses[relation.link]), "rad"
            every = np.broadcast_to(left, len(rows.q))
            self._tally.add(rows.rows, every, CONDITION, unit=unit, constraint=relation.name)

    def _sum(self, relation: JointRelation, q: Floats) -> tuple[Floats, str]:
        columns = [self._columns[name] for name, _ in relation.factors]
        factors = np.array([factor for _, factor in relation.factors])
        return np.abs(q[:, columns] @ factors - relation.value), self._units[columns[0]]

    def checks(self) -> list[Check]:
        """Constraints."""
        return [self._tally.check()]


def _angle(relation: AxisDirection, pose: Poses) -> Floats:
    """Angle (N,) between the axis of a link and its direction, by the diagonals of their rhombus."""
    axis, direction = pose[1] @ np.array(relation.axis), np.array(relation.direction)
    apart, together = np.linalg.norm(axis - direction, axis=1), np.linalg.norm(axis + direction, axis=1)
    return np.asarray(2.0 * np.arctan2(apart, together))
