"""The joint stream: what a robot does tick by tick, with the blocks that asked for it and its provenance."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Block
from irlx.robot.limits import JointLimits
from irlx.streams.making import Making

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

FORMAT_VERSION = 3
"""Version of the stream's content that this irlx writes; readers take it and all before it."""

JOINT_UNITS = ("rad", "m")


@dataclass(frozen=True, eq=False)
class StreamHeader:
    """Where a stream comes from and what its numbers mean.

    `cell_name` is the file name of the cell ('' if none), `robot_model` the packaged name or URDF
    path as the cell gives it, `robot_fingerprint` that of `RobotDescription`, `making` how the run was
    made, of which files of version 1 say nothing. Of n joints:
    `joint_names`, `joint_units` ('rad' or 'm'), `limits` (the robot's own) and `weights`. A tick
    lasts `tick_ns` nanoseconds. Headers hold arrays: compare `header_to_plain` of them.
    """

    format_version: int
    irlx_version: str
    program_name: str
    program_sha256: str
    cell_name: str
    robot_name: str
    robot_model: str
    robot_fingerprint: str
    tip: str
    joint_names: tuple[str, ...]
    joint_units: tuple[str, ...]
    tick_ns: int
    limits: JointLimits
    weights: tuple[float, ...]
    making: Making = field(default_factory=Making)

    def __post_init__(self) -> None:
        joints = len(self.joint_names)
        if not len(self.joint_units) == len(self.weights) == joints:
            raise ValueError(f"{joints} joints need as many units and weights")
        if len(set(self.joint_names)) != joints:
            raise ValueError("two joints have the same name")
        if not set(self.joint_units) <= set(JOINT_UNITS):
            raise ValueError(f"joint units are 'rad' or 'm', found {', '.join(self.joint_units)}")
        for kind in ("position", "speed", "acceleration"):
            if any(side.shape != (joints,) for side in self.limits.pair(kind)):
                raise ValueError(f"{kind} limits need one value a joint")
        if self.tick_ns <= 0:
            raise ValueError(f"a tick lasts a positive number of ns, found {self.tick_ns}")

    @property
    def dt(self) -> float:
        """Duration of a tick, s."""
        return self.tick_ns / 1e9

    @property
    def joints(self) -> int:
        """Number n of joints."""
        return len(self.joint_names)


@dataclass(frozen=True)
class BlockRecord:
    """A block that began executing at `tick`: the row of that tick stands when the block begins.

    A move recorded at tick k starts from the posture of row k and moves in rows k+1 and on; a switch
    of limits, frozen joints or the cyclic option holds for rows k+1 and on.
    """

    tick: int
    block: Block


@dataclass(frozen=True, eq=False, repr=False)
class JointStream:
    """N emitted samples of n joints, the blocks behind them, and where they come from.

    `ticks` (N,) counts from 0; `q` (N, n) in rad or m; `block` (N,) is the id of the move in execution,
    0 before the first one; `tool` (N, 7) holds x y z in m and a unit quaternion x y z w of the tool
    frame in the world. Tick 0 is the start posture at rest; a motion of m ticks adds m rows, then at
    least one hold row that repeats the last posture bit by bit under the same block id. `complete`
    is False where the run did not come to its end. Arrays are not to be changed.
    """

    header: StreamHeader
    records: tuple[BlockRecord, ...]
    ticks: Integers
    q: Floats
    block: Integers
    tool: Floats
    complete: bool

    def __post_init__(self) -> None:
        rows = len(self.ticks)
        wanted = {"ticks": (rows,), "q": (rows, self.header.joints), "block": (rows,), "tool": (rows, 7)}
        for name, shape in wanted.items():
            array = getattr(self, name)
            kind = np.int64 if name in {"ticks", "block"} else np.float64
            if array.shape != shape or array.dtype != kind:
                raise ValueError(
                    f"{name} needs shape {shape} and {kind.__name__}, found {array.shape} {array.dtype}"
                )

    def __repr__(self) -> str:
        size = f"{len(self.ticks)} samples of {self.header.joints} joints"
        return f"<JointStream of {self.header.program_name}: {size}{'' if self.complete else ', INCOMPLETE'}>"

    @property
    def dt(self) -> float:
        """Duration of a tick, s."""
        return self.header.dt

    @cached_property
    def t(self) -> Floats:
        """Time of each row, shape (N,), s: tick times the duration of a tick."""
        return self.ticks * self.header.tick_ns / 1e9

    @cached_property
    def qd(self) -> Floats:
        """Backward differences of q per s, shape (N, n); the robot rests before tick 0, so row 0 is 0."""
        return _backward_difference(self.q, self.dt)

    @cached_property
    def qdd(self) -> Floats:
        """Backward differences of `qd` per s, shape (N, n); row 0 is 0."""
        return _backward_difference(self.qd, self.dt)


def _backward_difference(values: Floats, dt: float) -> Floats:
    """(values[k] - values[k-1]) / dt by row, the row before the first being equal to it."""
    result = np.zeros_like(values)
    np.subtract(values[1:], values[:-1], out=result[1:])
    result /= dt
    return result
