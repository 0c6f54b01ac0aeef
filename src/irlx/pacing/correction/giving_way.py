"""Where the posture goes when a tick cannot keep clear: away from what is too near, the tool where it is."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.transform.tick_problem import TickProblem

Array = NDArray[np.float64]

LONGEST = 0.2
"""Most that a joint is asked to move at once (rad or m): farther off, directions are others."""

_NO_FREEDOM = 1e-6


class Retreat(NamedTuple):
    """The pairs that come too near, by number, and a joint step (n,) that would win what they lack."""

    pairs: NDArray[np.intp]
    step: Array


def retreat_of(problem: TickProblem, kinematics: Kinematics, weights: Array, base: Array) -> Retreat:
    """The way out of a tick whose floors cannot be kept, from where the step `base` (n,) would end.

    The smallest joint step by the weights (n,) that wins what the pairs lack and moves the tool by nothing,
    both to first order: the posture's bounds are not looked at, pairs that contradict each other share.
    """
    keeping, free = problem.clearance, problem.free
    step = np.zeros(problem.q.size)
    if keeping is None or not len(keeping.near.pairs):
        return Retreat(np.zeros(0, dtype=np.intp), step)
    rows = keeping.rows(base)
    short = rows.lower > 0.0
    pairs = keeping.near.pairs
    if not np.any(short):
        return Retreat(pairs, step)
    _, whole = kinematics.difference(problem.q + base, problem.target)
    j, g, w = whole[:, free], rows.matrix[short][:, free], weights[free]
    along = (g / w).T
    across = (j / w).T
    along = along - across @ (np.linalg.pinv(j @ across, rcond=1e-12, hermitian=True) @ (j @ along))
    gains, vectors = np.linalg.eigh(g @ along)
    least = _NO_FREEDOM * float(np.max(np.sum(g * g / w, axis=1)))
    usable = gains > least
    inverse = np.divide(1.0, gains, out=np.zeros(gains.size), where=usable)
    step[free] = along @ (vectors @ (inverse * (vectors.T @ rows.lower[short])))
    step *= LONGEST / max(float(np.max(np.abs(step))), LONGEST)
    return Retreat(pairs[short], step)
