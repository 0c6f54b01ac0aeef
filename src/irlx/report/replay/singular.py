"""How near a replay came to postures in which the tool cannot move in every direction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import ToolBlock
from irlx.robot.description import RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.transform.measures.scaled_jacobian import task_jacobian

Array = NDArray[np.float64]


def smallest_singular_values(
    robot: RobotDescription,
    ticks: NDArray[np.int64],
    q: Array,
    tools: Sequence[tuple[int, ToolBlock]],
) -> Array:
    """Smallest singular values (N,) of the tool Jacobian at postures q (N, n), of rising `ticks` (N,).

    What `SmallestSingularValue` tells: rows of the robot's task, lengths in reaches of the robot. `tools` are
    in force from their ticks on.
    """
    plain = Kinematics(robot)
    if not len(q):
        return np.zeros(0)
    starts = [0, *(tick for tick, _ in tools)]
    placed = [plain, *(plain.with_tool(tool.position, tool.orientation) for _, tool in tools)]
    numbers = np.searchsorted(np.array(starts), ticks, side="right") - 1
    pairs = zip(numbers.tolist(), q, strict=True)
    jacobians = np.stack([task_jacobian(placed[number], row) for number, row in pairs])
    return np.asarray(np.linalg.svd(jacobians, compute_uv=False)[:, -1])
