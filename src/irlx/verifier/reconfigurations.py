"""Checks of reconfigurations: the posture moves, the tool stays where it was."""

from __future__ import annotations

import numpy as np

from irlx.blocks import ReconfigureBlock
from irlx.promises import PATH_ORIENTATION, PATH_POSITION
from irlx.verifier.evidence import Evidence, Pose
from irlx.verifier.report import Check
from irlx.verifier.rotations import angle_between
from irlx.verifier.rows import Rows


class ReconfigurationChecks:
    """The tool in every row of a RECONFIGURATION against its pose in the row before the first one."""

    def __init__(self, evidence: Evidence) -> None:
        blocks = (record.block for record in evidence.outline.records)
        self._ids = {block.id for block in blocks if isinstance(block, ReconfigureBlock)}
        self._position = evidence.tally("reconfiguration position", "m")
        self._orientation = evidence.tally("reconfiguration orientation", "rad")
        self._held: Pose | None = None

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        for stretch in rows.stretches:
            if stretch.block not in self._ids:
                continue
            if stretch.begins or self._held is None:
                before = stretch.before.start
                self._held = rows.positions[before].copy(), rows.rotations[before].copy()
            positions, rotations = rows.positions[stretch.after], rows.rotations[stretch.after]
            off = np.linalg.norm(positions - self._held[0], axis=1)
            self._position.add(stretch.rows, off, PATH_POSITION)
            self._orientation.add(stretch.rows, angle_between(self._held[1], rotations), PATH_ORIENTATION)

    def checks(self) -> list[Check]:
        """Tool position and orientation during RECONFIGURATION."""
        return [self._position.check(), self._orientation.check()]
