"""A tick written out: what it depends on, and the quadratic problem of a Newton step, not solved yet."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.transform.clearance import SideRows, TickClearance
from irlx.transform.compact import StepProblem
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.metric import reduced
from irlx.transform.step_bounds import StepBounds

Array = NDArray[np.float64]


class TickProblem(NamedTuple):
    """All that one tick depends on.

    `target`: demanded tool pose in the world; `q` (n,): posture at the start of the tick; `bounds`
    of the step; `criterion` in force; `free` (n,) bool: joints that are not frozen; `clearance` what must not
    come nearer than it may.
    """

    target: pin.SE3
    q: Array
    bounds: StepBounds
    criterion: Criterion
    free: NDArray[np.bool_]
    clearance: TickClearance | None = None


def build_tick(kinematics: Kinematics, problem: TickProblem, whole: Array | None = None) -> StepProblem:
    """The quadratic problem of the Newton step at an iterate, of the free joints only.

        min g' d + 1/2 d' H d     subject to  J d = e,  lower - S <= d <= upper - S,  A d >= b

    `whole` S (n,) is the step since the start of the tick, by default nothing. The rows of J and e are the
    task's coordinates, then those of the constraints; g and H are gradient and Hessian of the criterion at S;
    A and b keep clear, see `irlx.transform.clearance`.
    """
    free, criterion = problem.free, problem.criterion.begun(problem.q)
    step = np.zeros(problem.q.size) if whole is None else whole
    left, jacobian = kinematics.difference(problem.q + step, problem.target)
    sides = None
    if problem.clearance is not None and len(problem.clearance.near.pairs):
        rows = problem.clearance.rows(step)
        sides = SideRows(rows.matrix[:, free], rows.lower)
    return StepProblem(
        jacobian[:, free],
        left,
        criterion.gradient(problem.q, step)[free],
        reduced(criterion.hessian(), free),
        (problem.bounds.lower - step)[free],
        (problem.bounds.upper - step)[free],
        sides,
    )
