"""Which redundancy options are in force, and the joint limits that follow from them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import (
    CriterionBlock,
    CriterionClause,
    CyclicBlock,
    FreezeBlock,
    JointRange,
    LimitClause,
    LimitKind,
    LimitSwitchBlock,
    ObstacleBlock,
    Origin,
)
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]

SwitchBlock = LimitSwitchBlock | FreezeBlock | CyclicBlock | CriterionBlock | ObstacleBlock
"""Blocks that change the options in force."""


LIMIT_WORDS = {
    LimitKind.POSITION: "JOINTLIMIT",
    LimitKind.SPEED: "JOINTSPEEDLIMIT",
    LimitKind.ACCELERATION: "JOINTACCELLIMIT",
}
"""The program's word for each kind of limit."""


@dataclass(frozen=True)
class Options:
    """State of all switches between two blocks.

    `limits` maps a kind to its switch, `criteria` a name to what CRITERION chose; `frozen` and `frozen_by`
    the joints held (numbers from 1) and the switch; `cyclic_posture` (n,) the posture that CYCLICSTART
    stored, None while it is off; `obstacles` those kept clear of, by casefolded name.
    """

    limits: dict[LimitKind, LimitSwitchBlock] = field(default_factory=dict)
    frozen: tuple[int, ...] = ()
    frozen_by: FreezeBlock | None = None
    cyclic_posture: Array | None = None
    criteria: dict[str, CriterionClause] = field(default_factory=dict)
    obstacles: dict[str, ObstacleBlock] = field(default_factory=dict)

    def after(self, block: SwitchBlock, q: Array) -> Options:
        """Options once `block` has executed at posture q (n,). A switch of the same kind is replaced."""
        if isinstance(block, FreezeBlock):
            return replace(self, frozen=block.joints, frozen_by=block if block.joints else None)
        if isinstance(block, CyclicBlock):
            return replace(self, cyclic_posture=q.copy() if block.active else None)
        if isinstance(block, CriterionBlock):
            criteria = {name: chosen for name, chosen in self.criteria.items() if name != block.name}
            if block.choice is not None:
                criteria[block.name] = CriterionClause(block.choice, block.origin)
            return replace(self, criteria=criteria)
        if isinstance(block, ObstacleBlock):
            key = block.name.casefold()
            others = {name: switch for name, switch in self.obstacles.items() if name != key}
            return replace(self, obstacles={**others, key: block} if block.active else others)
        limits = {kind: switch for kind, switch in self.limits.items() if kind is not block.kind}
        if block.range is not None:
            limits[block.kind] = block
        return replace(self, limits=limits)

    def criteria_of(self, clauses: Iterable[CriterionClause]) -> tuple[CriterionClause, ...]:
        """Criteria of a move: the switched ones, and in place of those of their names its clauses."""
        return tuple({**self.criteria, **{clause.choice.name: clause for clause in clauses}}.values())

    def free_joints(self, joints: int) -> NDArray[np.bool_]:
        """True for every joint that is not frozen, shape (n,)."""
        free = np.ones(joints, dtype=bool)
        free[[number - 1 for number in self.frozen]] = False
        return free


@dataclass(frozen=True)
class LimitsInForce:
    """The joint limits of one move, and for each kind the clause or switch that narrowed them.

    `clauses`: the kinds that a clause of the move narrowed.
    """

    limits: JointLimits
    asked_by: dict[LimitKind, Origin]
    clauses: frozenset[LimitKind] = frozenset()

    @property
    def told(self) -> dict[LimitKind, str]:
        """What narrowed each kind, in the program's words, with its line."""
        return {
            kind: f"{'WITH ' if kind in self.clauses else ''}{LIMIT_WORDS[kind]} in line {origin.line}"
            for kind, origin in self.asked_by.items()
        }


def limits_in_force(
    robot: JointLimits, options: Options, clauses: Iterable[LimitClause] = ()
) -> LimitsInForce:
    """Limits of a move: the robot's, narrowed by its clause or else the switch of each kind.

    A program can only narrow what the robot allows: bounds outside the robot's count as the robot's.
    """
    asked: dict[LimitKind, tuple[JointRange, Origin]] = {}
    for kind, switch in options.limits.items():
        if switch.range is not None:
            asked[kind] = (switch.range, switch.origin)
    of_move = list(clauses)
    for clause in of_move:
        asked[clause.kind] = (clause.range, clause.origin)
    limits = robot
    for kind, (joint_range, _) in asked.items():
        lower, upper = robot.pair(kind.value.lower())
        narrowed = np.maximum(lower, joint_range.lower), np.minimum(upper, joint_range.upper)
        limits = limits.with_pair(kind.value.lower(), *narrowed)
    origins = {kind: origin for kind, (_, origin) in asked.items()}
    return LimitsInForce(limits, origins, frozenset(clause.kind for clause in of_move))
