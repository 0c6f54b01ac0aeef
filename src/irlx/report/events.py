"""Events of a run: spans of ticks in which a limit held a joint back."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

SOURCES = ("position", "speed", "acceleration", "braking")
"""Names of the bound sources, in the order of their numbers in `active` flags."""


@dataclass(frozen=True)
class LimitActive:
    """A limit held a joint in every tick from `first_tick` to `last_tick`.

    `kind` is position, speed, acceleration, or braking (the way to a position limit); `side` upper
    or lower; times in s.
    """

    joint: str
    kind: str
    side: str
    first_tick: int
    last_tick: int
    first_time: float
    last_time: float

    def to_plain(self) -> dict[str, object]:
        """The event as JSON-able data."""
        return {"event": "limit active", **asdict(self)}


def limit_events(active: NDArray[np.int8], joint_names: Sequence[str], dt: float) -> tuple[LimitActive, ...]:
    """Events of a run from its `active` flags (N, n), one row a tick from tick 0, in order of time."""
    found = [
        LimitActive(name, SOURCES[abs(flag) - 1], "upper" if flag > 0 else "lower", *span, *_times(span, dt))
        for joint, name in enumerate(joint_names)
        for flag in (int(value) for value in np.unique(active[:, joint]) if value)
        for span in _spans(active[:, joint] == flag)
    ]
    return tuple(sorted(found, key=lambda event: (event.first_tick, event.joint)))


def _times(span: tuple[int, int], dt: float) -> tuple[float, float]:
    return span[0] * dt, span[1] * dt


def _spans(mask: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """First and last index of every run of True."""
    edges = np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8))
    for first, beyond in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
        yield int(first), int(beyond) - 1
