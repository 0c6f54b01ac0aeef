"""Where else the Newton steps of a tick may begin."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.transform.step_bounds import StepBounds

Array = NDArray[np.float64]

_WIDE = 0.5
"""Width (rad or m) of a joint's bounds from which on their middle is another posture, and no step."""


def middle_of_bounds(bounds: StepBounds) -> list[Array]:
    """The step (n,) in the middle of the bounds; nothing where all of them are wide.

    Near a singular posture the path as it is seen from where a tick starts may miss all bounds, although the
    path itself, which bends, goes through them: from their middle it is near wherever that is. Joints with
    wide bounds stay where they are.
    """
    width = bounds.upper - bounds.lower
    narrow = width < _WIDE
    if not np.any(narrow):
        return []
    middle = bounds.lower + 0.5 * np.where(narrow, width, 0.0)
    return [np.where(narrow, middle, np.clip(0.0, bounds.lower, bounds.upper))]
