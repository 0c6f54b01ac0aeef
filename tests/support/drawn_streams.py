"""Small streams to draw: a turn and a slide, tools on lines by closed forms, limits that change."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

import gantry
from irlx.blocks import (
    Block,
    JointRange,
    LimitClause,
    LimitKind,
    LimitSwitchBlock,
    MotionLaw,
    MoveBlock,
    MoveKind,
    Origin,
    PoseTarget,
)
from irlx.robot.limits import JointLimits
from irlx.streams import BlockRecord, JointStream

TICK_MS = 10.0
DT = TICK_MS / 1e3
LAW = MotionLaw(speed=0.2, acc=1.0, speed_ori=1.0, acc_ori=10.0)
LIMITS = JointLimits(
    np.array([-1.0, -np.inf]),
    np.array([1.0, 0.5]),
    np.array([-3.0, -0.4]),
    np.array([3.0, 0.4]),
    np.array([-np.inf, -np.inf]),
    np.array([np.inf, np.inf]),
)


@dataclass
class DrawnStream:
    """Builds a stream of the joints `turn` (rad) and `slide` (m); the tool rests unless a move says more."""

    names: tuple[str, ...] = ("turn", "slide")
    units: tuple[str, ...] = ("rad", "m")
    limits: JointLimits = LIMITS
    tick_ms: float = TICK_MS
    start: tuple[float, ...] = (0.0, 0.0)
    q: list[np.ndarray] = field(default_factory=list)
    tool: list[np.ndarray] = field(default_factory=list)
    block: list[int] = field(default_factory=lambda: [0])
    records: list[BlockRecord] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.q.append(np.array(self.start))
        self.tool.append(np.array([0.5, 0.0, 0.4, 0.0, 0.0, 0.0, 1.0]))

    @property
    def tick(self) -> int:
        return len(self.q) - 1

    def record(self, made: type[Block], /, **entries: Any) -> int:
        number = len(self.records) + 1
        origin = Origin("drawn.irl", 10 * number, 10 * number + 5, 10 * number)
        self.records.append(BlockRecord(self.tick, made(id=number, origin=origin, **entries)))
        return number

    def switch_speed(self, *bounds: float) -> None:
        """Speed limits of both sides, per joint, from here on."""
        both = JointRange(tuple(-bound for bound in bounds), bounds)
        self.record(LimitSwitchBlock, kind=LimitKind.SPEED, range=both)

    def move(
        self,
        q: np.ndarray,
        tool: np.ndarray | None = None,
        clause: tuple[LimitKind, JointRange] | None = None,
        law: MotionLaw = LAW,
    ) -> None:
        """A motion of rows q (M, n), and a hold; `tool` (M, 7) makes it a LIN, else it is a PTP."""
        rows = np.asarray(q, dtype=float)
        poses = np.tile(self.tool[-1], (len(rows), 1)) if tool is None else tool
        end = tuple(poses[-1].tolist())
        number = len(self.records) + 1
        origin = Origin("drawn.irl", 10 * number, 10 * number + 5, 10 * number)
        clauses = () if clause is None else (LimitClause(*clause, origin),)
        kind = MoveKind.PTP if tool is None else MoveKind.LIN
        self.record(MoveBlock, kind=kind, target=PoseTarget(end[:3], end[3:]), law=law, limits=clauses)
        self.q += [*rows, rows[-1]]
        self.tool += [*poses, poses[-1]]
        self.block += [number] * (len(rows) + 1)

    def stream(self, complete: bool = True, **changes: Any) -> JointStream:
        count = len(self.names)
        entries = {
            "program_name": "drawn.irl",
            "robot_name": "drawer",
            "robot_model": "nowhere/drawer.urdf",
            "robot_fingerprint": "0" * 64,
            "joint_names": self.names,
            "joint_units": self.units,
            "limits": self.limits,
            "weights": (1.0,) * count,
            "tick_ns": round(self.tick_ms * 1e6),
        }
        return JointStream(
            gantry.header(**{**entries, **changes}),
            tuple(self.records),
            np.arange(len(self.q), dtype=np.int64),
            np.array(self.q),
            np.array(self.block, dtype=np.int64),
            np.array(self.tool),
            complete,
        )


def trapezoid(length: float, speed: float, acc: float, times: np.ndarray) -> np.ndarray:
    """Way at times of a motion from rest to rest: ramps of speed/acc, and what is left at full speed."""
    ramp = speed / acc
    whole = length / speed + ramp
    t = np.clip(times, 0.0, whole)
    up, down = 0.5 * acc * t**2, length - 0.5 * acc * (whole - t) ** 2
    return np.where(t < ramp, up, np.where(t > whole - ramp, down, 0.5 * speed * ramp + speed * (t - ramp)))


def along_y(start: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Tool poses (M, 7) of a way (M,) along y."""
    poses = np.tile(start, (len(way), 1))
    poses[:, 1] += way
    return poses


def square_and_slow() -> JointStream:
    """A LIN of 0.2 m at 0.2 m/s as programmed, 1.2 s, and one back that takes twice the time in its middle.

    The turn goes to its limit of 57.3 deg and stays there; the slide runs at its limit of speed, which falls
    from 400 to 100 mm/s before the second move.
    """
    made = DrawnStream()
    ticks = np.arange(1, 121)
    way = trapezoid(0.2, 0.2, 1.0, ticks * DT)
    turn = np.minimum(ticks / 60.0, 1.0)
    slide = np.minimum(0.004 * ticks, 0.2)
    made.move(np.column_stack([turn, slide]), along_y(made.tool[-1], way))
    made.switch_speed(3.0, 0.1)
    slow = slowly_back(way)
    back = 0.2 - np.minimum(0.001 * np.arange(1, len(slow) + 1), 0.1)
    made.move(np.column_stack([np.ones(len(slow)), back]), along_y(made.tool[-1], -slow))
    return made.stream()


def slowly_back(way: np.ndarray) -> np.ndarray:
    """The same way with each step at full speed taken in two halves."""
    found, before = [], 0.0
    for here in way.tolist():
        if here - before > 0.2 * DT * 0.999:
            found.append(0.5 * (before + here))
        found.append(here)
        before = here
    return np.array(found)
