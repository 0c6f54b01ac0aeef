"""What a sensor asks for."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import Place, report
from irlx.pacing.correction.answer import HALF_TURN, numbers_in, told_answer
from irlx.pacing.correction.tool_offset import parts
from irlx.pacing.errors import PacingError
from irlx.robot.task import Task

Array = NDArray[np.float64]

SIZE = 6
FARTHEST = 1e3
"""Largest displacement that may be asked for, m."""


def read_request(answer: object, tick: int, task: Task, place: Place) -> Array | None:
    """The correction (6,) that a sensor asks for at a tick, None where it has nothing new to say.

    Coordinates that the robot's task leaves out count as 0. Raises PacingError: IRL580 for anything but six
    numbers, IRL581 for numbers that are not finite, IRL582 for more than half a turn or `FARTHEST`.
    """
    if answer is None:
        return None
    request = numbers_in(answer)
    if request is None or request.shape != (SIZE,):
        raise PacingError(report("IRL580", place, tick=tick, found=told_answer(answer)))
    if not np.all(np.isfinite(request)):
        raise PacingError(report("IRL581", place, tick=tick, found=_numbers(request)))
    distance, angle = parts(request)
    if distance > FARTHEST or angle > HALF_TURN:
        told: dict[str, Any] = {
            "distance": f"{distance:.6g}",
            "angle": f"{angle:.6g}",
            "farthest": f"{FARTHEST:g}",
        }
        raise PacingError(report("IRL582", place, tick=tick, **told))
    for left_out in set(range(SIZE)) - set(task.rows):
        request[left_out] = 0.0
    return request


def _numbers(request: Array) -> str:
    return ", ".join(f"{value:.6g}" for value in request)
