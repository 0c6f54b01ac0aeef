"""A posture to begin with: room to the limits on every side, and far from singular ones."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.nearest import scaled_singular_values

Array = NDArray[np.float64]

_SEED = 11
_DRAWN = 400
_REFINED = 4
_STEPS = (0.4, 0.2, 0.1, 0.05)
_ROOM = 0.2
"""Share of a joint's range beyond which more room to its limits is worth nothing."""

_HALF_TURN, _HALF_STROKE = np.pi, 0.5
"""Half the range, rad and m, that a joint without limits is thought to have."""


def open_posture(kinematics: Kinematics, limits: JointLimits) -> tuple[Array, float]:
    """Posture (n,) from which a tool moves well to all sides, and how well: 0 where none was found.

    The measure is the smallest singular value of the task's matrix in one unit, times how much of its
    range the joint nearest to a limit has left, drawn a little to the middle of all ranges and up from
    the robot's foot. Slides stand in their middles. Found among drawn postures, always the same ones, and
    refined joint by joint.
    """
    lower, upper = _ranges(kinematics, limits)
    middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
    turning = np.array([not joint.is_prismatic for joint in kinematics.description.axes])
    random = np.random.default_rng(_SEED)

    def measure(q: Array) -> float:
        share = np.abs(q - middle) / np.where(half > 0.0, half, 1.0)
        return _openness(kinematics, q) * _room(share[turning]) * (1.0 - 0.3 * float(np.mean(share)))

    drawn = [
        middle,
        *(middle + turning * half * random.uniform(-0.8, 0.8, len(middle)) for _ in range(_DRAWN)),
    ]
    # Of several postures as good, the first: sorted by the measure alone.
    best = sorted(((measure(q), -k) for k, q in enumerate(drawn)), reverse=True)[:_REFINED]
    refined = [_refined(drawn[-k], found, measure, half, turning, (lower, upper)) for found, k in best]
    found, _, q = max(((found, -k, q) for k, (q, found) in enumerate(refined)), key=lambda one: one[:2])
    return q, found


def _ranges(kinematics: Kinematics, limits: JointLimits) -> tuple[Array, Array]:
    """Bounds (n,) between which postures are looked for: the limits, at most a turn about their middle."""
    slides = np.array([joint.is_prismatic for joint in kinematics.description.axes], dtype=bool)
    widest = np.where(slides, _HALF_STROKE, _HALF_TURN)
    lower, upper = limits.position_lower, limits.position_upper
    # Where one side is open, the range begins at the other one.
    lower = np.where(np.isfinite(lower), lower, np.where(np.isfinite(upper), upper - 2.0 * widest, -widest))
    upper = np.where(np.isfinite(upper), upper, lower + 2.0 * widest)
    middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
    half = np.where(slides, half, np.minimum(half, widest))
    return middle - half, middle + half


def _refined(
    q: Array,
    found: float,
    measure: Callable[[Array], float],
    half: Array,
    turning: NDArray[np.bool_],
    bounds: tuple[Array, Array],
) -> tuple[Array, float]:
    """A posture moved joint by joint, in ever smaller steps, to where the measure is largest."""
    for step in _STEPS:
        for joint in np.flatnonzero(turning):
            for side in (step, -step):
                tried = q.copy()
                tried[joint] = np.clip(tried[joint] + side * half[joint], bounds[0][joint], bounds[1][joint])
                value = measure(tried)
                if value > found:
                    q, found = tried, value
    return q, found


def _openness(kinematics: Kinematics, q: Array) -> float:
    """Smallest singular value of the task's matrix, less where a joint or the tool is below the foot."""
    jacobian = kinematics.rows_here(q)
    if jacobian.shape[0] == 0:
        return 0.0
    least = float(scaled_singular_values(jacobian, kinematics.row_scale)[-1])
    _, tool = kinematics.tool_pose(q)
    heights = [float(tool[2]), *(float(frame.translation[2]) for frame in list(kinematics.data.oMi)[1:])]
    # The root frame of most robots lies on the floor; of those that hang, the first axis is the foot.
    below = min(0.0, min(heights) - min(0.0, heights[1])) / kinematics.description.reach
    return least * float(np.clip(1.0 + 5.0 * below, 0.2, 1.0))


def _room(share: Array) -> float:
    """1 where every joint has `_ROOM` of its range left on the nearer side, less in proportion."""
    left = 0.5 * (1.0 - float(np.max(share, initial=0.0)))
    return min(1.0, max(left, 0.0) / _ROOM)
