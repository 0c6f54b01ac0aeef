"""What a program changes of the robot itself while it runs: the tool frame and the weights of the joints."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from irlx.blocks import ToolBlock, WeightsBlock
from irlx.diagnostics import Place, report
from irlx.pacing.errors import PacingError
from irlx.pacing.situation import PacingSetup
from irlx.robot.kinematics import Kinematics


def refitted(setup: PacingSetup, block: ToolBlock | WeightsBlock, place: Place) -> PacingSetup:
    """The robot as it is from a block on; nothing moves.

    Raises PacingError, IRL571, for a tool frame whose axes lie so that the robot's task asks for other
    coordinates than it can move.
    """
    if isinstance(block, WeightsBlock):
        return replace(setup, weights=np.array(block.weights))
    before, after = setup.kinematics, setup.kinematics.with_tool(block.position, block.orientation)
    if not before.task.is_whole:
        _check_task(before, after, place)
    return replace(setup, kinematics=after)


def _check_task(before: Kinematics, after: Kinematics, place: Place) -> None:
    """What a task leaves out must in the new tool frame still be unmoved, or follow from what it asks for."""
    kept = after.immovable.coordinates
    lost = [name for name in before.immovable.coordinates if name not in kept]
    lost += [name for name in after.unbound.coordinates if name not in lost]
    if lost or after.task_rank < before.task_rank:
        robot, task = before.description.name, ", ".join(before.task.coordinates)
        raise PacingError(report("IRL571", place, robot=robot, task=task, lost=", ".join(lost)))
