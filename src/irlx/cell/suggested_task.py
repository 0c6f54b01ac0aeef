"""Which coordinates of the tool pose a robot with few axes can be asked for."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from irlx.robot.description import COORDINATES, RobotDescription
from irlx.robot.kinematics import Kinematics

_TURNS = COORDINATES[3:]
_POSITION = COORDINATES[:3]


@dataclass(frozen=True)
class SuggestedTask:
    """`coordinates` that moves ask for, in the frame of the link `frame` or of the tip, and `free` turns."""

    coordinates: tuple[str, ...]
    frame: str | None = None
    free: tuple[str, ...] = ()


def suggested_task(robot: RobotDescription) -> SuggestedTask | None:
    """A task for a robot with fewer axes than a pose has coordinates; None where there is none to suggest.

    What its joints move, if that is no more than it has axes: arms in a plane, SCARAs. Of five axes that move
    all six: all but the turn, in the frame of the link before the last axis, that they can do least. Else the
    position alone, its turns as they come.
    """
    fixed = Kinematics(replace(robot, coordinates=())).immovable.coordinates
    moved = tuple(name for name in COORDINATES if name not in fixed)
    count = len(robot.axes)
    if 0 < len(moved) <= count:
        return SuggestedTask(moved)
    if count == len(COORDINATES) - 1:
        found = _all_but_a_turn(robot)
        if found is not None:
            return found
    alone = Kinematics(replace(robot, coordinates=_POSITION, free=_TURNS))
    return SuggestedTask(_POSITION, None, _TURNS) if alone.task_rank == len(_POSITION) else None


def _all_but_a_turn(robot: RobotDescription) -> SuggestedTask | None:
    frame = robot.axes[-1].parent
    best, found = 0.0, None
    for left_out in _TURNS:
        coordinates = tuple(name for name in COORDINATES if name != left_out)
        kinematics = Kinematics(replace(robot, coordinates=coordinates, task_frame=frame))
        if kinematics.task_rank < len(coordinates) or kinematics.unbound.size:
            continue
        motions = kinematics.usual_motions[:, list(kinematics.task.rows)]
        least = float(np.median(np.linalg.svd(motions, compute_uv=False)[:, -1]))
        if least > best:
            best, found = least, SuggestedTask(coordinates, frame)
    return found
