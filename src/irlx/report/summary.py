"""The figures of a finished run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.report.clearances import SmallestClearance
from irlx.report.events import LimitActive, Slowed
from irlx.report.returns import Return
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]


@dataclass(frozen=True)
class LimitUse:
    """Largest use of one kind of limit: joint, its value (rad | m per s^k), bound, share, and tick."""

    kind: str
    joint: str
    value: float
    bound: float
    share: float
    tick: int


@dataclass(frozen=True)
class Closure:
    """Posture difference over a path whose tool pose ends where it began: worst joint, rad or m."""

    joint: str
    difference: float


@dataclass(frozen=True, repr=False)
class Summary:
    """Figures of a run: durations in s, path errors in m and rad; `print(summary)` shows them to people.

    `slowed` tells where the tool ran slower than programmed, `planned` how many moves were planned as a
    whole because ordinary ticks would have broken a bound (their postures differ from the ordinary ones
    from the start of the move). `limit_use` holds, for each kind of limit the robot has, the joint that
    came nearest to its bound (for positions: the bound on that side of the middle of its range).
    `closure` is None where the tool does not end where it began; `returns` are the moves that ended at the
    tool pose of a CYCLICSTART; `clearance` is the place with the least room above a margin, None where
    nothing that was kept clear came near. `joint_units` are rad or m.
    """

    program: str
    complete: bool
    duration: float
    samples: int
    moves: int
    path_position_error: float
    path_orientation_error: float
    limit_use: tuple[LimitUse, ...]
    active: tuple[LimitActive, ...]
    slowed: tuple[Slowed, ...]
    planned: int
    closure: Closure | None
    iterations_per_tick: float
    returns: tuple[Return, ...] = ()
    clearance: SmallestClearance | None = None
    joint_names: tuple[str, ...] = ()
    joint_units: tuple[str, ...] = ()

    def __str__(self) -> str:
        # Imported here: that module is about this one.
        from irlx.report.terminal import summary_text

        return summary_text(self)

    def __repr__(self) -> str:
        from irlx.report.terminal import headline

        return f"<Summary of {headline(self).words}>"

    def to_plain(self) -> dict[str, object]:
        """The summary as JSON-able data; names and units of joints stand in the header of the stream."""
        plain = asdict(self)
        del plain["joint_names"], plain["joint_units"]
        plain["active"] = [event.to_plain() for event in self.active]
        plain["slowed"] = [event.to_plain() for event in self.slowed]
        plain["returns"] = [found.to_plain() for found in self.returns]
        return plain


def limit_uses(
    q: Array, qd: Array, qdd: Array, limits: JointLimits, joint_names: Sequence[str]
) -> tuple[LimitUse, ...]:
    """Largest use of position, speed and acceleration limits by rows (N, n), of the kinds that exist."""
    # The range of a joint without a bound on one side has no middle: its shares count from 0.
    both = np.isfinite(limits.position_lower) & np.isfinite(limits.position_upper)
    lower, upper = (np.where(both, side, 0.0) for side in (limits.position_lower, limits.position_upper))
    middle = 0.5 * (lower + upper)
    found = [
        _worst("position", q, limits.position_lower, limits.position_upper, middle, joint_names),
        _worst("speed", qd, limits.speed_lower, limits.speed_upper, np.zeros_like(middle), joint_names),
        _worst(
            "acceleration",
            qdd,
            limits.acceleration_lower,
            limits.acceleration_upper,
            np.zeros_like(middle),
            joint_names,
        ),
    ]
    return tuple(use for use in found if use is not None)


def _worst(
    kind: str, values: Array, lower: Array, upper: Array, middle: Array, joint_names: Sequence[str]
) -> LimitUse | None:
    if not np.any(np.isfinite(lower) | np.isfinite(upper)):
        return None
    # A share grows with the way from the middle: of each joint and side only the furthest value can be it.
    # One joint behind the other: along rows of few joints numpy is slow.
    columns = np.ascontiguousarray(values.T)
    highest, lowest = columns.max(axis=1), columns.min(axis=1)
    above = highest, _share(highest - middle, upper - middle), upper
    below = lowest, _share(middle - lowest, middle - lower), lower
    largest = max(float(share.max()) for _, share, _ in (above, below))
    if largest <= 0.0:
        bound = upper if values[0, 0] >= middle[0] else lower
        return LimitUse(kind, joint_names[0], float(values[0, 0]), float(bound[0]), 0.0, 0)
    tick, joint, bound = min(
        (
            (int(np.argmax(columns[joint] == furthest[joint])), joint, bound)
            for furthest, share, bound in (above, below)
            for joint in np.flatnonzero(share == largest).tolist()
        ),
        key=lambda place: place[:2],
    )
    return LimitUse(kind, joint_names[joint], float(values[tick, joint]), float(bound[joint]), largest, tick)


def _share(way: Array, room: Array) -> Array:
    """Share (n,) of the room that a way from the middle takes: 1 where there is none, 0 without limit."""
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.where(room > 0.0, way / room, (way > 0.0).astype(np.float64))
    return np.where(np.isfinite(room) & (way > 0.0), share, 0.0)


def closure(q: Array, tool: Array, joint_names: Sequence[str], tolerance: float) -> Closure | None:
    """Posture difference of the first and last rows, where their tool poses agree within `tolerance`."""
    if len(q) < 2 or float(np.linalg.norm(tool[-1, :3] - tool[0, :3])) > tolerance:
        return None
    # The angle between two orientations is twice the distance of their quaternions, either sign.
    alike = min(float(np.linalg.norm(tool[-1, 3:] - s * tool[0, 3:])) for s in (1.0, -1.0))
    if 2.0 * alike > tolerance:
        return None
    difference = np.abs(q[-1] - q[0])
    joint = int(np.argmax(difference))
    return Closure(joint_names[joint], float(difference[joint]))
