"""The limits in force at each row: the robot's, narrowed by switches and clauses."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from irlx.blocks import JointRange, LimitKind, LimitSwitchBlock
from irlx.robot.limits import JointLimits
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.moves import MoveRows
from irlx.verifier.outline import Outline

KINDS = {"position": LimitKind.POSITION, "speed": LimitKind.SPEED, "acceleration": LimitKind.ACCELERATION}

_Ranges = dict[LimitKind, JointRange]


@dataclass(frozen=True)
class LimitsInForce:
    """Limits by rows: `sets[i]` holds from row `starts[i]` on, to the next start; `starts` rises from 0."""

    starts: Integers
    sets: list[JointLimits]

    def bounds(self, kind: str, first: int, count: int) -> tuple[Floats, Floats]:
        """Lower and upper bounds (R, n) of 'position', 'speed' or 'acceleration' in R = `count` rows."""
        numbers = np.searchsorted(self.starts, np.arange(first, first + count), side="right") - 1
        here = np.arange(numbers[0], numbers[-1] + 1)
        lower, upper = (np.stack(side) for side in zip(*(self.sets[i].pair(kind) for i in here), strict=True))
        return lower[numbers - numbers[0]], upper[numbers - numbers[0]]


def limits_in_force(outline: Outline, moves: list[MoveRows]) -> LimitsInForce:
    """Limits at each row: the robot's, narrowed by the switch of each kind, or by the clause of the move.

    A switch recorded at tick k holds from row k + 1 on; a clause replaces the switch of its kind in
    the rows of its move; neither can widen the robot's own limits.
    """
    robot = outline.header.limits
    clauses = {move.block.id: move for move in moves if move.block.limits and move.last > move.start}
    switches: _Ranges = {}
    found: dict[int, JointLimits] = {0: robot}
    for record in outline.records:
        block = record.block
        if isinstance(block, LimitSwitchBlock):
            switches = {kind: bounds for kind, bounds in switches.items() if kind is not block.kind}
            if block.range is not None:
                switches[block.kind] = block.range
            found[record.tick + 1] = _narrowed(robot, switches)
        elif block.id in clauses:
            move = clauses[block.id]
            own = {clause.kind: clause.range for clause in move.block.limits}
            found[move.start + 1] = _narrowed(robot, {**switches, **own})
            found[move.last + 1] = _narrowed(robot, switches)
    starts = sorted(found)
    return LimitsInForce(np.array(starts, dtype=np.int64), [found[start] for start in starts])


def _narrowed(robot: JointLimits, ranges: _Ranges) -> JointLimits:
    limits = robot
    for name, kind in KINDS.items():
        if kind in ranges:
            lower, upper = robot.pair(name)
            bounds = ranges[kind]
            limits = limits.with_pair(name, np.maximum(lower, bounds.lower), np.minimum(upper, bounds.upper))
    return limits
