"""One sample of a joint stream: what `irlx.stream` yields."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.correction.nearness import NearPair

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Sample:
    """State at one tick; its arrays are its own.

    `t` in s; `q`, `qd`, `qdd` (n,) rad | m and per s, s2; `tool` (7,) x y z m and quaternion x y z w;
    `block` is the id of the move in execution; `correction` (6,) is the one that the tool has, None where no
    sensor corrects: displacement x y z in m and rotation vector in rad, in the programmed tool frame;
    `nearest` is the pair with the least room above its margin, None beyond all influences, and where rows
    are not followed tick by tick.
    """

    tick: int
    t: float
    q: Array
    qd: Array
    qdd: Array
    tool: Array
    block: int
    correction: Array | None = None
    nearest: NearPair | None = None
