"""Events of a run: spans of ticks in which a limit held a joint back, or slowed the tool on its path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.rows import MotionRows, PathPart
from irlx.pacing.slowdown.clock_bounds import Governor
from irlx.pacing.slowing import Slowing
from irlx.robot.limits import JointLimits

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


@dataclass(frozen=True)
class Slowed:
    """The tool ran slower than programmed from `first_tick` to `last_tick`, for one joint's limit.

    `line` of the move in the program; `way` of `length` (m, or rad where the tool only `turns`) where most
    speed is missing: `achieved` instead of `requested` (m/s or rad/s), for the `kind` (speed or acceleration)
    limit `bound` of `joint` ('' where no single joint decides); `lost` time, s. Of moves that are joined it
    reaches over those of the lines from `first_line` to `last_line`.
    """

    line: int
    first_tick: int
    last_tick: int
    first_time: float
    last_time: float
    way: float
    length: float
    turns: bool
    requested: float
    achieved: float
    joint: str
    kind: str
    bound: float
    lost: float
    first_line: int
    last_line: int

    @property
    def lines(self) -> str:
        """Those lines in words."""
        if self.first_line == self.last_line:
            return f"line {self.line}"
        return f"lines {self.first_line}-{self.last_line}"

    def to_plain(self) -> dict[str, object]:
        """The event as JSON-able data."""
        return {"event": "slowed", **asdict(self)}


def slowed_events(
    rows: MotionRows, limits: JointLimits, joint_names: Sequence[str], dt: float
) -> tuple[Slowed, ...]:
    """Events of the slowed stretches of one motion."""
    if rows.path is None:
        return ()
    return tuple(_slowed(slowing, rows, rows.path, limits, joint_names, dt) for slowing in rows.path.slowings)


def _slowed(
    slowing: Slowing,
    rows: MotionRows,
    path: PathPart,
    limits: JointLimits,
    joint_names: Sequence[str],
    dt: float,
) -> Slowed:
    first, last = rows.first_tick + slowing.first_row, rows.first_tick + slowing.last_row
    scale = path.angle_per_s if path.is_turn else 1.0
    known = slowing.joint >= 0 and slowing.governor is not Governor.PROGRAM
    kind = slowing.governor.name.lower() if known else ""
    # Of a limit that differs by direction the narrower side is told.
    bound = float(min(abs(side[slowing.joint]) for side in limits.pair(kind))) if known else 0.0
    return Slowed(
        line=rows.block.origin.line,
        first_tick=first,
        last_tick=last,
        first_time=first * dt,
        last_time=last * dt,
        way=(slowing.s - path.begin) * scale,
        length=rows.length * scale,
        turns=path.is_turn,
        requested=slowing.requested * scale,
        achieved=slowing.achieved * scale,
        joint=joint_names[slowing.joint] if known else "",
        kind=kind,
        bound=bound,
        lost=slowing.lost,
        first_line=rows.block.origin.line if slowing.lines is None else slowing.lines[0],
        last_line=rows.block.origin.line if slowing.lines is None else slowing.lines[1],
    )


class ActiveSpans:
    """Events of a run from its `active` flags, which come in portions, one row a tick from tick 0 on."""

    def __init__(self, joint_names: Sequence[str], dt: float) -> None:
        self._names, self._dt = tuple(joint_names), dt
        self._found: list[LimitActive] = []
        self._rows = 0
        self._flags = [0] * len(self._names)
        """Flag of each joint in the last row, and .."""
        self._since = [0] * len(self._names)
        """.. the tick from which on it was that."""

    def take(self, active: NDArray[np.int8]) -> None:
        """Take the flags (M, n) of the next rows."""
        if any(self._flags) or active.any():
            for joint in range(len(self._names)):
                self._take(joint, active[:, joint])
        self._rows += len(active)

    def _take(self, joint: int, column: NDArray[np.int8]) -> None:
        before = np.concatenate([[self._flags[joint]], column[:-1]])
        for row in np.flatnonzero(column != before).tolist():
            tick = self._rows + row
            if self._flags[joint]:
                self._found.append(self._event(joint, tick - 1))
            self._flags[joint], self._since[joint] = int(column[row]), tick

    def _event(self, joint: int, last: int) -> LimitActive:
        flag, first = self._flags[joint], self._since[joint]
        kind, side = SOURCES[abs(flag) - 1], "upper" if flag > 0 else "lower"
        return LimitActive(self._names[joint], kind, side, first, last, first * self._dt, last * self._dt)

    @property
    def events(self) -> tuple[LimitActive, ...]:
        """All events so far in order of time, those that go on included."""
        last = self._rows - 1
        going_on = [self._event(joint, last) for joint, flag in enumerate(self._flags) if flag]
        return tuple(sorted([*self._found, *going_on], key=lambda event: (event.first_tick, event.joint)))
