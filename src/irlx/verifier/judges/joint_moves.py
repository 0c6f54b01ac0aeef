"""Checks of PTP moves: straight in joint space, never backwards, joint targets reached, no joint too fast."""

from __future__ import annotations

import numpy as np

from irlx.blocks import MoveKind
from irlx.promises import JOINT_LINE
from irlx.streams.joint_stream import Floats
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import Check
from irlx.verifier.judges.crossing_ptps import CrossingPtps
from irlx.verifier.moves import MoveRows
from irlx.verifier.rows import Rows, Stretch


class JointMoveChecks:
    """Every row of a PTP against the straight line between the postures in which it starts and ends."""

    def __init__(self, evidence: Evidence) -> None:
        self._evidence = evidence
        self._moves = {
            move.block.id: move
            for move in evidence.moves
            if move.block.kind is MoveKind.PTP and move.last > move.start and not self._is_joined(move)
        }
        self._straight = evidence.tally("PTP straight", "rad|m")
        self._progress = evidence.tally("PTP progress", "rad|m")
        self._goal = evidence.tally("joint goal", "rad|m")
        self._along = 0.0
        self._crossing = CrossingPtps(evidence, self._straight, self._progress)
        for move in evidence.moves:
            if move.block.kind is MoveKind.PTP:
                self._add_goal(move)

    def _is_joined(self, move: MoveRows) -> bool:
        """Whether it runs from or into another move: then it need not be straight all the way.

        So may one that passes its target where a stream breaks off, nobody knows whither.
        """
        demand = self._evidence.demands[move.block.id]
        broken_off = move.block.blend is not None and not move.finished
        return demand.passes or demand.follows or broken_off

    def _add_goal(self, move: MoveRows) -> None:
        demand = self._evidence.demands[move.block.id]
        target = demand.targets[-1].posture
        if target is not None and move.finished and not demand.passes:
            miss = np.abs(self._evidence.posture(move.last) - target)
            self._goal.add(np.array([move.last]), miss[None], JOINT_LINE)

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        for stretch in rows.stretches:
            move = self._moves.get(stretch.block)
            if move is not None:
                self._add(rows, stretch, move)
            self._crossing.take(rows, stretch)

    def _add(self, rows: Rows, stretch: Stretch, move: MoveRows) -> None:
        start, end = self._evidence.posture(move.start), self._evidence.posture(move.last)
        off, along = joint_line_deviation(start, end, rows.q[stretch.part])
        self._straight.add(stretch.rows, off, JOINT_LINE)
        # Against the furthest row so far: small steps back must not add up.
        furthest = np.maximum.accumulate(np.concatenate(([0.0 if stretch.begins else self._along], along)))
        self._progress.add(stretch.rows, furthest[:-1] - along, JOINT_LINE)
        self._along = float(furthest[-1])

    def checks(self) -> list[Check]:
        """Straightness, progress, joint goals."""
        return [self._straight.check(), self._progress.check(), self._goal.check()]


def joint_line_deviation(start: Floats, end: Floats, q: Floats) -> tuple[Floats, Floats]:
    """Deviation (R, n) of joint values q (R, n) from the straight line between two postures (n,).

    Second result: distance travelled along it (R,), in the joint space's Euclidean norm.
    """
    step = end - start
    length = float(np.linalg.norm(step))
    offsets = q - start
    if length == 0.0:
        return np.abs(offsets), np.zeros(len(q))
    along = np.clip(offsets @ (step / length), 0.0, length)
    return np.abs(offsets - along[:, None] * (step / length)), along
