"""Newton steps of a tick for as long as no bound and no bad posture stands against them."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray
from scipy.linalg.lapack import dposv

from irlx.robot.kinematics import Kinematics
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.criterion_pace import STRAIGHT, CriterionPace
from irlx.transform.precision import MAX_NEWTON_STEP
from irlx.transform.settling import Settling, is_met, settles_at_once
from irlx.transform.step_bounds import StepBounds

Array = NDArray[np.float64]

Found = tuple[bool, Array, Array, int]
"""Whether the tick is solved; the step (n,) since its start, or else the iterate to go on from with all
precautions; what was left of the demand (m,) before the last Newton step, and how many there were."""


class UndisturbedTick:
    """The ordinary tick of a robot of which the joints `free` (n,) bool move, the others stand.

    The same steps as those of the bounded search, with little more than the arithmetic of their closed form:
    this is what nearly all ticks consist of. Joints that stand take part with an inverse Hessian and a pull
    of zero, which gives them a step of exactly zero. A nearly singular J needs no factors of its own
    here: what the Gram matrix loses of the pose the next step sees, and less than that stays behind
    than the rounding of the pose itself is worth in joints.
    """

    def __init__(self, kinematics: Kinematics, free: NDArray[np.bool_], most: int) -> None:
        """`most` Newton steps are taken."""
        self._kinematics = kinematics
        self._linear = kinematics.task.linear
        self._free = None if np.all(free) else free
        self._most = most

    def solve(
        self, target: pin.SE3, q: Array, whole: Array, criterion: Criterion, bounds: StepBounds | None
    ) -> Found:
        """Steps from the iterate `whole` (n,) of a tick that begins at posture q (n,).

        Iterates outside `bounds` end the search; without any, the caller has to look.
        """
        inverse, free, difference = criterion.inverse_hessian(), self._free, self._kinematics.difference
        is_matrix = inverse.ndim == 2
        if free is not None:
            if is_matrix:
                # Without its frozen joints a full matrix has another inverse.
                return False, whole, whole, 0
            inverse = inverse * free
        later: tuple[Settling, CriterionPace] | None = None
        for iteration in range(1, self._most + 1):
            twist, jacobian = difference(q + whole, target)
            pull = criterion.pull(q, whole)
            if free is not None:
                pull = pull * free
            scaled = jacobian.dot(inverse) if is_matrix else jacobian * inverse
            gram = scaled.dot(jacobian.T)
            _, k, failed = dposv(gram, twist - jacobian.dot(pull))
            d = pull + k.dot(scaled)
            size = sqrt(d.dot(d))
            if failed or not size <= MAX_NEWTON_STEP:
                return False, whole, twist, iteration
            pulled, met = sqrt(pull.dot(pull)), is_met(twist, self._linear)
            if later is None and met and settles_at_once(size, pulled):
                done, taken = True, d
            else:
                settling, pace = later = later or (Settling(), CriterionPace())
                before = settling.before
                done = settling.after(size, pulled, met)
                taken = d
                # Steps that shrink this fast find the path straight; the last step is a full one.
                if not done and size > STRAIGHT * before:
                    share = pace.share(twist, criterion.hessian(), d)
                    if share != 1.0:
                        along_path = dposv(gram, twist)[1].dot(scaled)
                        taken = along_path + share * (d - along_path)
                    pace.took(twist, d, taken)
            further = whole + taken
            if bounds is not None and not _inside(further, bounds):
                return False, whole, twist, iteration
            whole = further
            if done:
                return True, whole, twist, iteration
        return False, whole, twist, self._most

    def reached(self, q: Array, whole: Array) -> Array:
        """Posture (n,) behind a step from q (n,): a joint that stands at -0.0 does not get to 0.0."""
        return q + whole if self._free is None else np.where(self._free, q + whole, q)


def _inside(step: Array, bounds: StepBounds) -> bool:
    inside = np.count_nonzero(step >= bounds.lower) + np.count_nonzero(step <= bounds.upper)
    return bool(inside == 2 * step.size)
