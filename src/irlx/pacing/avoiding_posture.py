"""The posture of a pose that keeps best clear of an obstacle."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import AskAvoidingPosture, PoseTarget
from irlx.diagnostics import report
from irlx.pacing.clearance_answers import pairs_of
from irlx.pacing.postures import posture_of_pose
from irlx.pacing.situation import Situation
from irlx.pacing.too_near import told
from irlx.robot.limits import JointLimits
from irlx.scene.distances import Distances
from irlx.transform.clearance import Clearance
from irlx.transform.criteria.combined import Combined, Weighted
from irlx.transform.criteria.keeping_clear import KeepingClear
from irlx.transform.criteria.posture import Posture
from irlx.transform.step_bounds import BoundSource, StepBounds
from irlx.transform.tick import TickSolver
from irlx.transform.tick_problem import TickProblem

Array = NDArray[np.float64]

_TICK = 0.05
_LONGEST = 0.05
_AT_REST = 1e-7
_MOST_TICKS = 600


def avoiding_posture(question: AskAvoidingPosture, situation: Situation) -> tuple[float, ...]:
    """The rest point of keeping clear of an obstacle and of the posture term, the tool held at the pose.

    It begins at the posture that POSTURE finds without an obstacle, and is drawn to that one still. Warns,
    IRL565, where the margin is not kept. Raises PacingError: IRL522 for a pose that none reaches, IRL573,
    IRL574 where there is nothing to avoid.
    """
    place = situation.locate(question.origin)
    pairs = pairs_of(question.name, situation.kinematics, situation.setup.scene, place)
    distances = Distances(situation.kinematics, pairs, situation.setup.scene.sightings)
    clearance = Clearance(distances, situation.tick * situation.dt)
    clearance.after(0.0)
    in_force = situation.in_force()
    target = PoseTarget(question.position, question.orientation)
    nearest = posture_of_pose(target, None, situation, in_force, place)
    q = _rest_point(situation, clearance, nearest, in_force.limits)
    short = clearance.inside_margin(q)
    if short is not None:
        situation.warnings.append(report("IRL565", place, name=question.name, **told(clearance, short)))
    return tuple(q.tolist())


def _rest_point(situation: Situation, clearance: Clearance, start: Array, limits: JointLimits) -> Array:
    """Posture (n,) at which ticks at the tool pose of `start` (n,) come to rest."""
    kinematics, q = situation.kinematics, start
    target = kinematics.target(*kinematics.tool_pose(start))
    term = Weighted(KeepingClear(clearance.distances, situation.free), 1.0)
    criterion = Combined(Posture(situation.setup.weights, start), (term,), _TICK)
    # A program may ask for it in a dry run: it gets the same values.
    solver = TickSolver(kinematics, situation.qp)
    for _ in range(_MOST_TICKS):
        keeping = clearance.tick(q, _TICK)
        problem = TickProblem(target, q, _room(q, limits), criterion, situation.free, keeping)
        found = solver.solve(problem, thorough=False)
        if not found.solved:
            break
        moved = float(np.max(np.abs(found.q - q)))
        q = limits.into_positions(found.q)
        if moved <= _AT_REST:
            break
    return q


def _room(q: Array, limits: JointLimits) -> StepBounds:
    """Steps within the position limits, short enough for the criterion to be what it is at their start."""
    source = np.full(q.size, BoundSource.POSITION, dtype=np.int8)
    lower = np.maximum(limits.position_lower - q, -_LONGEST)
    return StepBounds(lower, np.minimum(limits.position_upper - q, _LONGEST), source, source)
