"""TIME of a move along a PATH that has to stop on its way, shared among its parts."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import report
from irlx.motion.errors import MotionError
from irlx.motion.plan_chain import Leg, plan_chain
from irlx.pacing.posed import Pose

Array = NDArray[np.float64]

_SLACK = 1e-9


def share_of_time(leg: Leg, start: Pose) -> float:
    """Time (s) for the part up to the first stop: in proportion to what the parts take as fast as they may.

    Raises MotionError, IRL421, where all parts together cannot be done in TIME.
    """
    asked = leg.block.law.duration
    if asked is None:
        raise TypeError("only a move with TIME has time to share")
    untimed = replace(leg.block, law=replace(leg.block.law, duration=None))
    left: tuple[Leg, ...] = (Leg(untimed, leg.place),)
    durations, pose = [], start
    while left:
        plan = plan_chain(left, *pose, inf)
        durations.append(plan.programmed.duration)
        pose, left = (plan.path.end_rotation, plan.path.end_position), plan.rest(left)
    least = sum(durations)
    if asked < least * (1.0 - _SLACK):
        data: dict[str, Any] = {"asked": f"{asked:.6g}", "least": f"{least:.6g}", "governor": "SPEED and ACC"}
        raise MotionError(report("IRL421", leg.place, **data))
    return asked * durations[0] / least
