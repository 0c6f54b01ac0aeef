"""Checks of the cell's relations between joints, in every row."""

from __future__ import annotations

import numpy as np

from irlx.promises import CONDITION
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import Check
from irlx.verifier.rows import Rows


class ConditionChecks:
    """Sum of factor times joint value against the value of each relation, in the unit of its first joint."""

    def __init__(self, evidence: Evidence) -> None:
        names = evidence.outline.header.joint_names
        self._tally = evidence.tally("constraints", "rad|m")
        self._relations = evidence.relations
        factors = [dict(relation.factors) for relation in self._relations]
        self._matrix = np.array([[found.get(name, 0.0) for name in names] for found in factors])
        self._values = np.array([relation.value for relation in self._relations])

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        if self._relations:
            broken = np.abs(rows.q @ self._matrix.T - self._values)
            self._tally.add(rows.rows, np.max(broken, axis=1), CONDITION)

    def checks(self) -> list[Check]:
        """Constraints."""
        return [self._tally.check()]
