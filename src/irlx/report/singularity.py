"""How near a stream comes to postures in which its tool cannot move in every direction.

Loads the kinematic model.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import LinkFrame, MoveBlock, ReconfigureBlock, ToolBlock
from irlx.robot.description import RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.streams.joint_stream import BlockRecord
from irlx.transform.measures.scaled_jacobian import task_jacobian

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


def smallest_singular_values(
    robot: RobotDescription, records: Sequence[BlockRecord], ticks: Integers, q: Array
) -> Array:
    """Smallest singular values (K,) of the tool Jacobian in postures q (K, n) of rising `ticks` (K,).

    What `SmallestSingularValue` tells: rows of the robot's task, lengths divided by its reach. The tool is
    the one in force there by the blocks of `records`, seen from the frame in which the motion leads it. A
    block recorded at tick k counts from tick k + 1 on; the start is seen from the frame of the first motion.
    """
    if not len(q):
        return np.zeros(0)
    tools = [(record.tick + 1, record.block) for record in records if isinstance(record.block, ToolBlock)]
    frames = [
        (record.tick + (record.tick > 0), record.block.frame)
        for record in records
        if isinstance(record.block, MoveBlock | ReconfigureBlock)
    ]
    of_tools = _in_force([tick for tick, _ in tools], ticks)
    of_frames = _in_force([tick for tick, _ in frames], ticks)
    known: dict[tuple[int, LinkFrame | None], Kinematics] = {}
    jacobians = []
    for number, motion, posture in zip(of_tools, of_frames, q, strict=True):
        key = number, frames[motion][1] if motion >= 0 else None
        if key not in known:
            known[key] = _seen(robot, tools[number][1] if number >= 0 else None, key[1])
        jacobians.append(task_jacobian(known[key], posture))
    return np.asarray(np.linalg.svd(np.stack(jacobians), compute_uv=False)[:, -1])


def _in_force(starts: Sequence[int], ticks: Integers) -> list[int]:
    """Which of those that begin at `starts`, rising, is in force at each tick; -1 before the first."""
    numbers = np.searchsorted(np.array(starts, dtype=np.int64), ticks, side="right") - 1
    return [int(number) for number in numbers]


def _seen(robot: RobotDescription, tool: ToolBlock | None, frame: LinkFrame | None) -> Kinematics:
    """The robot with a tool, seen from a frame that moves with one of its links, or from the world."""
    kinematics = Kinematics(robot)
    if tool is not None:
        kinematics = kinematics.with_tool(tool.position, tool.orientation)
    return kinematics if frame is None else kinematics.relative_to(frame)
