"""Ticks one after another as if nothing stood against them; what does is looked for in all at once.

Bounds and distances are the smaller part of an ordinary tick when they are looked at as arrays over ticks,
and the larger one when they are looked at tick by tick. So a walk runs ahead for some ticks, and is then
taken back to the first of them in which something would have had a say.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.seeds import Seeds
from irlx.transform.undisturbed import UndisturbedTick

Array = NDArray[np.float64]


class FreeRun(NamedTuple):
    """Postures q (k, n) of ticks, and the Newton steps (k,) that each of them took."""

    q: Array
    iterations: NDArray[np.int64]


def free_run(
    kinematics: Kinematics,
    ticks: UndisturbedTick,
    q: Array,
    poses: tuple[Array, Array],
    criteria: Iterable[Criterion],
    seeds: Seeds,
) -> FreeRun:
    """Postures behind ticks from posture q (n,), up to the first one that an ordinary tick does not meet.

    `poses`: the rotations (N, 3, 3) and positions (N, 3) m demanded; `criteria` are those of
    these ticks, `seeds` where each of them begins: all steps are noted there.
    """
    rotations, positions = poses
    rows = np.empty((len(positions), q.size))
    steps = np.zeros(len(positions), dtype=np.int64)
    target = kinematics.target(rotations[0], positions[0])
    for k, (rotation, position, criterion) in enumerate(zip(rotations, positions, criteria, strict=True)):
        # One target for all ticks: to make one takes as long as a Jacobian.
        target.rotation, target.translation = rotation, position
        found, whole, _, steps[k] = ticks.solve(target, q, seeds.next(), criterion.begun(q), None)
        if not found:
            return FreeRun(rows[:k], steps[:k])
        reached = ticks.reached(q, whole)
        seeds.took(reached - q)
        rows[k] = q = reached
    return FreeRun(rows, steps)
