"""Constraints that say nothing new beside the pose of the tool."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from irlx.robot.equality import Constraint

if TYPE_CHECKING:
    from irlx.robot.kinematics import Kinematics

Array = NDArray[np.float64]

_POSTURES, _SEED = 3, 5
_ROUNDING = 1e-9
"""What is left of a row beside the rows of the task, of its own length: less is rounding."""


def implied_by_pose(kinematics: Kinematics) -> tuple[Constraint, ...]:
    """Those constraints of a robot whose rows lie in the row space of its task, wherever it stands.

    The pose alone keeps or breaks them: where an axis of the tool points, say, is told by the whole pose. As
    rows of their own they would make every posture singular. Postures are drawn at random, the same in
    every run; their joints are counted as rad and m.
    """
    rng = np.random.default_rng(_SEED)
    postures = rng.uniform(-1.0, 1.0, (_POSTURES, kinematics.joints))
    size = kinematics.task.size
    found = []
    for constraint in kinematics.constraints:
        if all(_depends(kinematics.here(q)[1][:size], constraint.derivative(q)) for q in postures):
            found.append(constraint)
    return tuple(found)


def _depends(task: Array, rows: Array) -> bool:
    """Whether rows (k, n) are combinations of the task's rows (m, n)."""
    _, values, basis = np.linalg.svd(task, full_matrices=False)
    basis = basis[values > _ROUNDING * values[0]]
    left = rows - rows @ basis.T @ basis
    length = float(np.linalg.norm(rows))
    return length > 0.0 and float(np.linalg.norm(left)) <= _ROUNDING * length
