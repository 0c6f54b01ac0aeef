"""Checks of reconfigurations: the posture moves, the tool stays where it was."""

from __future__ import annotations

import numpy as np

from irlx.blocks import ReconfigureBlock
from irlx.promises import PATH_ORIENTATION, PATH_POSITION, PROGRAM_EXCESS
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import Check
from irlx.verifier.geometry.task_turns import turned_off
from irlx.verifier.moves import law_in_force
from irlx.verifier.rows import Rows, Stretch
from irlx.verifier.tools import Pose


class ReconfigurationChecks:
    """The tool in every row of a RECONFIGURATION against its pose in the row before the first one."""

    def __init__(self, evidence: Evidence) -> None:
        blocks = (record.block for record in evidence.outline.records)
        self._ids = {block.id for block in blocks if isinstance(block, ReconfigureBlock)}
        self._position = evidence.tally("reconfiguration position", "m")
        self._orientation = evidence.tally("reconfiguration orientation", "rad")
        self._speed = evidence.tally("reconfiguration speed", "rad/s|m/s")
        self._laws = {
            record.block.id: law_in_force(record.block.law)
            for record in evidence.outline.records
            if isinstance(record.block, ReconfigureBlock)
        }
        self._slides = np.array([unit == "m" for unit in evidence.outline.header.joint_units])
        self._limits = evidence.limits
        self._held: Pose | None = None

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        for stretch in rows.stretches:
            if stretch.block not in self._ids:
                continue
            if stretch.begins or self._held is None:
                self._held = rows.pose(stretch.before.start, stretch.block)
            positions, attitudes = rows.positions[stretch.after], rows.attitudes[stretch.after]
            off = np.linalg.norm(positions - self._held[0], axis=1)
            self._position.add(stretch.rows, off, PATH_POSITION)
            self._orientation.add(stretch.rows, turned_off(attitudes, self._held[1]), PATH_ORIENTATION)
            self._add_speeds(rows, stretch)

    def _add_speeds(self, rows: Rows, stretch: Stretch) -> None:
        """Joints without a speed limit go at that of the tool's turn, or of the tool where they slide."""
        law = self._laws[stretch.block]
        lower, upper = self._limits.bounds("speed", int(stretch.rows[0]), len(stretch.rows))
        unlimited = np.isinf(lower) | np.isinf(upper)
        bound = np.broadcast_to(np.where(self._slides, law.speed, law.speed_ori), unlimited.shape)
        speeds = np.abs(rows.qd[stretch.part])
        offends = unlimited & ~(speeds <= bound * (1.0 + PROGRAM_EXCESS))
        self._speed.add(stretch.rows, speeds, bound, offends, np.where(unlimited, speeds / bound, -np.inf))

    def checks(self) -> list[Check]:
        """Tool position and orientation during RECONFIGURATION, speed of the joints."""
        return [self._position.check(), self._orientation.check(), self._speed.check()]
