"""Times and rates of rows that come in portions, to the same bits as those of a whole stream."""

from __future__ import annotations

import numpy as np

from irlx.streams.joint_stream import Floats, Integers, StreamHeader
from irlx.streams.scan import StatedRates


class Rates:
    """Backward differences over portions of rows; the robot rests before the first one."""

    def __init__(self, header: StreamHeader) -> None:
        self._tick_ns, self._dt = header.tick_ns, header.dt
        self._q: Floats | None = None
        self._qd: Floats | None = None

    def of(self, ticks: Integers, q: Floats) -> StatedRates:
        """t (N,), s, and qd, qdd (N, n) of the next rows: ticks (N,) and q (N, n).

        Rates beyond all numbers, of values near the largest ones, are not finite; who asks looks at that.
        """
        t = ticks * self._tick_ns / 1e9
        if not len(q):
            return StatedRates(t, q, q)
        with np.errstate(over="ignore", invalid="ignore"):
            qd = _differences(q, self._q, self._dt)
            qdd = _differences(qd, self._qd, self._dt)
        self._q, self._qd = q[-1:].copy(), qd[-1:].copy()
        return StatedRates(t, qd, qdd)


def _differences(values: Floats, before: Floats | None, dt: float) -> Floats:
    """(values[k] - values[k-1]) / dt by row; without a row before, the first row is 0."""
    result = np.zeros_like(values)
    np.subtract(values[1:], values[:-1], out=result[1:])
    if before is not None:
        np.subtract(values[:1], before, out=result[:1])
    result /= dt
    return result
