"""Third differences of the way that a tool has come along its path."""

from __future__ import annotations

import numpy as np

from irlx.promises import PATH_STEP, PROGRAM_EXCESS
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.findings.tally import Tally


def add_jerk(tally: Tally, rows: Integers, along: Floats, bound: Floats, dt: float) -> None:
    """Third differences of the ways `along` (R + 3,) m, the rows before being counted in, against the largest
    `bound` (R + 3,) m/s3 of the four that each is of."""
    if not len(rows):
        return
    most = np.max([bound[k : len(rows) + k] for k in range(4)], axis=0)
    rates = np.abs(np.diff(along, n=3)) / dt**3
    high = most * (1.0 + PROGRAM_EXCESS) + 8.0 * PATH_STEP / dt**3
    told = np.isfinite(most)
    tally.add(rows[told], rates[told], most[told], ~(rates <= high)[told], (rates / high)[told])
