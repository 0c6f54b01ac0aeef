"""Where joints are at their limits, from the rows of a stream."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from irlx.report.plot.curves import LimitSpan
from irlx.report.plot.quantity import Quantity
from irlx.report.stretches import stretches
from irlx.streams.joint_stream import JointStream
from irlx.verifier.limits import LimitsInForce

Array = NDArray[np.float64]
Integers = NDArray[np.int64]
Mask = NDArray[np.bool_]

AT_POSITION = 1e-3
"""Distance from a position limit, rad or m, up to which a joint counts as at it."""

AT_RATE, AT_RATE_SLOWED = 0.98, 0.9
"""Part of a speed or acceleration limit from which on a joint counts as at it; and where the tool is slower
than programmed, since a plan keeps a reserve, if no other joint or rate uses more of its limit there."""

_SAME = 5e-3
"""Difference of such parts up to which two joints decide together."""


def limit_spans(
    stream: JointStream,
    limits: LimitsInForce,
    quantities: Sequence[Quantity],
    inside: Integers,
    slowed: Sequence[tuple[int, int]],
) -> Iterator[LimitSpan]:
    """Spans in which joints are at limits of the quantities, of the rows `inside`, which follow each other.

    `slowed` are the first and last rows of stretches in which the tool is slower than programmed. A limit
    that leaves a joint no room is none that it comes to.
    """
    if not inside.size:
        return
    first = int(inside[0])
    at = _at_rates(stream, limits, inside, slowed)
    at[Quantity.POSITION] = _at_position(stream, limits, inside)
    for quantity in quantities:
        for joint in range(at[quantity].shape[1]):
            for begin, end in stretches(at[quantity][:, joint]):
                times = time_of(stream, first + begin - 1), time_of(stream, first + end)
                yield LimitSpan(quantity, joint, *times)


def time_of(stream: JointStream, row: int) -> float:
    """Time of a row, s; what is before the first one is at its time."""
    return float(stream.t[max(row, 0)])


def _at_position(stream: JointStream, limits: LimitsInForce, inside: Integers) -> Mask:
    lower, upper = limits.bounds("position", int(inside[0]), len(inside))
    q = stream.q[inside]
    near = (q <= lower + AT_POSITION) | (q >= upper - AT_POSITION)
    return np.asarray(near & (lower < upper))


def _at_rates(
    stream: JointStream, limits: LimitsInForce, inside: Integers, slowed: Sequence[tuple[int, int]]
) -> dict[Quantity, Mask]:
    """Which joints (N, n) are at their limits of speed and acceleration in N rows."""
    rows = int(inside[0]), len(inside)
    shares = {
        Quantity.SPEED: _shares(stream.qd[inside], *limits.bounds("speed", *rows)),
        Quantity.ACCELERATION: _shares(stream.qdd[inside], *limits.bounds("acceleration", *rows)),
    }
    slow = np.zeros((len(inside), 1), dtype=bool)
    for begin, end in slowed:
        slow[(inside >= begin) & (inside <= end)] = True
    most = np.max(np.hstack(list(shares.values())), axis=1, keepdims=True)
    return {
        quantity: (share >= AT_RATE) | (slow & (share >= AT_RATE_SLOWED) & (share >= most - _SAME))
        for quantity, share in shares.items()
    }


def _shares(values: Array, lower: Array, upper: Array) -> Array:
    """Parts (N, n) of the bounds that values use, 0 of bounds that leave no room or are none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        above = np.where((upper > 0.0) & (values > 0.0), values / upper, 0.0)
        below = np.where((lower < 0.0) & (values < 0.0), values / lower, 0.0)
    return np.where(lower < upper, np.nan_to_num(np.maximum(above, below)), 0.0)
