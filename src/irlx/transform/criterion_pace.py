"""How far to go along the null space in one Newton step.

The QP of a Newton step knows the criterion's curvature but not the path's. On a strongly curved
path a full step along the null space overshoots: the iteration converges slowly, alternating, or
chatters for ever (TRF-05). The secant of two successive steps tells the curvature along the way,
and with it the right share of the step (the step length of Barzilai and Borwein, 1988).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.transform.compact import StepProblem, path_step, within

Array = NDArray[np.float64]

_PATH_NEARLY_MET = 1e-3
_LEAST_SHARE = 0.05
_LARGEST_SHARE = 2.0
_NO_DIFFERENCE = 1e-3


class CriterionPace:
    """Chooses the share of each step's null-space part over the iterations of one tick."""

    def __init__(self) -> None:
        self._asked: Array | None = None
        self._taken: Array | None = None

    def shape(self, problem: StepProblem, d: Array) -> Array:
        """Step to take where the QP asks for `d`; the path part always stays whole.

        With n the null-space part that is asked for and s the one taken before, the share is
        s'Hs / s'H(n_before - n), which is 1 where the path is straight.
        """
        if float(np.max(np.abs(problem.twist))) > _PATH_NEARLY_MET:
            self._asked = self._taken = None
            return d
        share = self._share(problem.hessian, d)
        taken = d
        if abs(share - 1.0) > _NO_DIFFERENCE:
            along_path = path_step(problem)
            taken = along_path + share * (d - along_path)
            # The shortest way onto the path may lead out of the bounds; the QP's step never does.
            if not within(taken, problem.lower, problem.upper):
                taken = d
        self._asked, self._taken = d, taken
        return taken

    def _share(self, hessian: Array, d: Array) -> float:
        if self._asked is None or self._taken is None or self._taken.shape != d.shape:
            return 1.0
        length = float(self._taken @ (hessian * self._taken))
        bend = float(self._taken @ (hessian * (self._asked - d)))
        if length <= 0.0 or bend <= 0.0:
            return 1.0
        return min(max(length / bend, _LEAST_SHARE), _LARGEST_SHARE)
