"""How far to go along the null space in one Newton step.

The QP of a Newton step knows the criterion's curvature but not the path's. On a strongly curved
path a full step along the null space overshoots: the iteration converges slowly, alternating, or
chatters for ever (TRF-05). The secant of two successive steps tells the curvature along the way,
and with it the right share of the step (the step length of Barzilai and Borwein, 1988).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.transform.compact import Step, StepProblem, path_step
from irlx.transform.metric import reduced, times

Array = NDArray[np.float64]

STRAIGHT = 1e-3
"""A step no longer than this part of the one before needs no other share than 1."""

_PATH_NEARLY_MET = 1e-3
_LATE = 6
_LATE_NEARLY_MET = 0.05
_LATE_SHARE = 0.4
_LEAST_SHARE = 0.05
_LARGEST_SHARE = 2.0
_NO_DIFFERENCE = 1e-3


class CriterionPace:
    """Chooses the share of each step's null-space part over the iterations of one tick."""

    def __init__(self) -> None:
        self._asked: Array | None = None
        self._taken: Array | None = None
        self._steps = 0

    def shape(self, problem: StepProblem, step: Step) -> Array:
        """Step to take where the QP asks for `step`; the path part always stays whole.

        With n the null-space part that is asked for and s the one taken before, the share is
        s'Hs / s'H(n_before - n), which is 1 where the path is straight.
        """
        d = taken = step.d
        share = self.share(problem.twist, problem.hessian, d)
        along_path = _along_path(problem, step) if share != 1.0 else None
        if along_path is not None:
            taken = along_path + share * (d - along_path)
            # The shortest way onto the path may lead out of the bounds; the QP's step never does.
            if not problem.keeps(taken):
                taken = d
        self.took(problem.twist, d, taken)
        return taken

    def share(self, twist: Array, hessian: Array, d: Array) -> float:
        """Share of the null-space part of `d` (n,) to take; exactly 1 where all of it is right.

        `twist` (6,) is what is left to the pose before the step, `hessian` H, (n,) or (n, n).
        """
        late = self._steps >= _LATE
        if late and not self._nearly_met(twist):
            return _LATE_SHARE
        if self._asked is None or self._taken is None or not self._nearly_met(twist):
            return 1.0
        if self._taken.shape != d.shape:
            return 1.0
        weighted = times(hessian, self._taken)
        length = float(self._taken.dot(weighted))
        bend = float(weighted.dot(self._asked - d))
        if length <= 0.0 or bend <= 0.0:
            return 1.0
        share = min(max(length / bend, _LEAST_SHARE), _LARGEST_SHARE)
        return share if abs(share - 1.0) > _NO_DIFFERENCE else 1.0

    def took(self, twist: Array, asked: Array, taken: Array) -> None:
        """Remember a step as it was asked for and as it was taken, each (n,)."""
        self._steps += 1
        self._asked, self._taken = (asked, taken) if self._nearly_met(twist) else (None, None)

    def _nearly_met(self, twist: Array) -> bool:
        # Steps that chatter leave the path again and again, the farther the longer they are.
        most = _PATH_NEARLY_MET if self._steps < _LATE else _LATE_NEARLY_MET
        # No entry is longer than the whole.
        return bool(twist.dot(twist) <= most**2 or np.max(np.abs(twist)) <= most)


def _along_path(problem: StepProblem, step: Step) -> Array | None:
    """The shortest step that meets the pose, joints held by a bound going as `step` does.

    None where the Jacobian has lost its rank.
    """
    held = step.active != 0
    try:
        if not np.any(held):
            return path_step(problem)
        others, d = ~held, step.d.copy()
        if np.count_nonzero(others) < problem.twist.size:
            return None
        left = problem.twist - problem.jacobian[:, held] @ d[held]
        rest = StepProblem(
            problem.jacobian[:, others],
            left,
            problem.gradient[others],
            reduced(problem.hessian, others),
            problem.lower[others],
            problem.upper[others],
        )
        d[others] = path_step(rest)
        return np.asarray(d)
    except np.linalg.LinAlgError:
        return None
