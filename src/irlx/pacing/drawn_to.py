"""What a motion along a path is drawn to: postures of the program, the cyclic option, criteria."""

from __future__ import annotations

from dataclasses import replace
from math import hypot

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import JointTarget, MoveBlock
from irlx.diagnostics import Place, report
from irlx.motion.plan_chain import PlannedChain
from irlx.pacing.impossible import joint_value
from irlx.pacing.options import LimitsInForce
from irlx.pacing.posed import posture_target
from irlx.pacing.posture_left import NO_WAY, ON_THE_WAY, POSTURE_REACHED, posture_left
from irlx.pacing.posture_term import Asked, PostureTerm, posture_term
from irlx.pacing.postures import asked_posture
from irlx.pacing.situation import Situation
from irlx.pacing.slowdown.model import Model
from irlx.pacing.switches import check_joint_target
from irlx.robot.limits import JointLimits
from irlx.transform.criteria.combined import Weighted
from irlx.transform.criteria.keeping_clear import KeepingClear
from irlx.transform.criteria.some_joints import OfSomeJoints

Array = NDArray[np.float64]


def check_postures(situation: Situation, block: MoveBlock, in_force: LimitsInForce) -> None:
    """Check targets that are postures. Raises PacingError where one lies outside its limits."""
    place = situation.locate(block.origin)
    for number in range(len(block.targets)):
        posture = _given(situation, block, number)
        if posture is not None:
            check_joint_target(posture, situation.robot, in_force.limits, place)


def postures_asked(
    situation: Situation, block: MoveBlock, plan: PlannedChain, in_force: LimitsInForce, place: Place
) -> Asked | None:
    """Postures that a motion asks for: those of RECONFIGURATION, else those among its targets.

    A CIRCLE with ANGLE does not end at its target: it is not drawn to the target's posture. Joined moves ask
    for none.
    """
    ends = block.targets[: plan.points or None]
    given = [_given(situation, block, number) for number in range(len(ends))]
    for number, konf in enumerate(_konfs(block)[: len(ends)]):
        if konf is not None:
            given[number] = asked_posture(konf, situation, in_force, place)
    end, marks, length = given[-1], plan.marks[0], plan.path.length
    if end is None:
        return None
    inner = [
        (mark / length, posture)
        for mark, posture in zip(marks, given[:-1], strict=False)
        if posture is not None and 0.0 < mark < length
    ]
    return Asked(end, tuple(inner))


def _given(situation: Situation, block: MoveBlock, number: int) -> Array | None:
    """Posture (n,) that a target of a move is; None for poses, and where a CIRCLE does not come to it."""
    target = block.targets[number]
    given = posture_target(target, situation.q)
    if given is None or (block.arc is not None and (target is block.arc.via or block.arc.angle is not None)):
        return None
    return np.array(given.values)


def _konfs(block: MoveBlock) -> list[JointTarget | None]:
    """Postures of WITH RECONFIGURATION for each of a move's targets."""
    if block.arc is not None:
        return [block.arc.via_reconfiguration, block.reconfiguration]
    if block.path is None:
        return [block.reconfiguration]
    return [*(block.path.reconfigurations or [None] * len(block.path.points)), block.reconfiguration]


def term_of(
    situation: Situation,
    block: MoveBlock,
    plan: PlannedChain,
    model: Model,
    asked: Asked | None,
    limits: JointLimits,
) -> PostureTerm:
    """The posture term of a motion, with what CRITERION and OBSTACLE add to it."""
    cyclic = situation.options.cyclic_posture
    term = posture_term(model, situation.q, plan.programmed, asked, cyclic, situation.qp)
    added = _added_terms(situation, block, plan, limits)
    clearance, law = situation.clearance, plan.programmed
    found = term.with_terms(added, law)
    if clearance is None or not any(pair.obstacle is not None for pair in clearance.distances.pairs):
        return found
    # What pushes may make the motion swing; what the rows keep clear nothing has to push.
    for calm in (True, False):
        keeping = Weighted(KeepingClear(clearance.distances, situation.free, calm), 1.0)
        found = replace(term.with_terms((*added, keeping), law), calmer=found)
    return found


def _added_terms(
    situation: Situation, block: MoveBlock, plan: PlannedChain, limits: JointLimits
) -> tuple[Weighted, ...]:
    chosen = situation.options.criteria_of(block.criteria)
    if not chosen:
        return ()
    from irlx.pacing.criteria import added_terms
    from irlx.transform.criteria.library import TermSetting

    speed, turns = plan.programmed.speed, plan.path.is_pure_turn
    turning = situation.robot.reach * speed * (1.0 if turns else plan.path.turn_rate)
    tool_speed = hypot(0.0 if turns else speed, turning)
    freed = situation.freed
    if freed is None:
        setting = TermSetting(situation.kinematics, limits, situation.setup.weights, situation.q, tool_speed)
        return added_terms(chosen, setting, situation.locate)
    # Criteria are about the robot: its virtual joints have neither masses nor ranges worth centring.
    own = freed.joints
    setting = TermSetting(freed.robot, limits.of(own), freed.weights[own], situation.q[own], tool_speed)
    return tuple(
        Weighted(OfSomeJoints(entry.term, own), entry.weight)
        for entry in added_terms(chosen, setting, situation.locate)
    )


def warn_of_posture_left(
    situation: Situation, asked: Asked | None, q: Array, block: MoveBlock, place: Place
) -> None:
    """Warn of what is left to the posture asked for where a move ends in q (n,)."""
    if asked is None:
        return
    posture = asked.end
    robot = situation.robot
    if block.reconfiguration is not None:
        why = NO_WAY if q is situation.q else ON_THE_WAY
        situation.warnings.extend(posture_left(posture - q, why, robot, place))
        return
    left = np.abs(posture - q)
    joint = int(np.argmax(left))
    if left[joint] > POSTURE_REACHED:
        difference = joint_value(robot, joint, float(left[joint]))
        warned = report("IRL348", place, joint=robot.axes[joint].name, difference=difference)
        situation.warnings.append(warned)
