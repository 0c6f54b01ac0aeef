"""A gantry on a rail, whose joint values for any pose are closed form, and good streams of it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import (
    ArcCourse,
    Block,
    CyclicBlock,
    FreezeBlock,
    JointRange,
    JointTarget,
    LimitClause,
    LimitKind,
    LimitSwitchBlock,
    MotionLaw,
    MoveBlock,
    MoveKind,
    Origin,
    PoseTarget,
)
from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.robot.limits import JointLimits
from irlx.streams import FORMAT_VERSION, BlockRecord, JointStream, StreamHeader

LAW = MotionLaw(speed=30.0, acc=300.0, speed_ori=30.0, acc_ori=500.0)
DT = 0.004


def gantry(offset: float = 0.0) -> RobotDescription:
    """Slides along x (rail), x, y, z, then turns about z, y, x in one point; `offset` makes another robot."""
    kinds = [
        ("rail", JointKind.PRISMATIC, (1.0, 0.0, 0.0)),
        ("ось_x", JointKind.PRISMATIC, (1.0, 0.0, 0.0)),
        ("y", JointKind.PRISMATIC, (0.0, 1.0, 0.0)),
        ("z", JointKind.PRISMATIC, (0.0, 0.0, 1.0)),
        ("a", JointKind.REVOLUTE, (0.0, 0.0, 1.0)),
        ("b", JointKind.REVOLUTE, (0.0, 1.0, 0.0)),
        ("c", JointKind.REVOLUTE, (1.0, 0.0, 0.0)),
    ]
    joints = [
        Joint(name, kind, f"link{i}", f"link{i + 1}", (offset if i == 3 else 0.0, 0.0, 0.0), axis=axis)
        for i, (name, kind, axis) in enumerate(kinds)
    ]
    return RobotDescription("gantry", "link0", "link7", tuple(joints))


ROBOT = gantry()


def limits() -> JointLimits:
    infinite = np.full(7, np.inf)
    position = np.array([5.0, 2.0, 2.0, 2.0, 3.1, 1.5, 3.1])
    return JointLimits(-position, position, -infinite, infinite, -infinite, infinite)


def header(**changes: object) -> StreamHeader:
    units = tuple("m" if joint.is_prismatic else "rad" for joint in ROBOT.axes)
    entries: dict[str, object] = {
        "format_version": FORMAT_VERSION,
        "irlx_version": "0.1.0",
        "program_name": "weld.irl",
        "program_sha256": "ab" * 32,
        "cell_name": "cell.toml",
        "robot_name": "gantry",
        "robot_model": "robots/gantry.urdf",
        "robot_fingerprint": ROBOT.fingerprint,
        "tip": "link7",
        "joint_names": ROBOT.joint_names,
        "joint_units": units,
        "tick_ns": 4_000_000,
        "limits": limits(),
        "weights": (7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0),
    }
    return StreamHeader(**{**entries, **changes})  # type: ignore[arg-type]


def smooth(ticks: int) -> np.ndarray:
    """Path parameter at ticks 1..n of a quintic from rest to rest, the last exactly 1."""
    u = np.arange(1, ticks + 1) / ticks
    s = u**3 * (10 - 15 * u + 6 * u * u)
    s[-1] = 1.0
    return s


def pose_of(q: np.ndarray) -> tuple[np.ndarray, Rotation]:
    """Tool pose of one posture, by the gantry's closed form."""
    return np.array([q[0] + q[1], q[2], q[3]]), Rotation.from_euler("ZYX", q[4:7])


@dataclass
class Maker:
    """Builds a stream move by move, as a run would emit it."""

    q: np.ndarray
    changes: dict[str, object] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.rows = [self.q.copy()]
        self.blocks = [0]
        self.records: list[BlockRecord] = []

    @property
    def tick(self) -> int:
        return len(self.rows) - 1

    def record(self, what: type[Block], /, **data: object) -> int:
        number = len(self.records) + 1
        origin = Origin("weld.irl", 10 * number, 10 * number + 5, number + 3)
        self.records.append(BlockRecord(self.tick, what(id=number, origin=origin, **data)))  # type: ignore[call-arg]
        return number

    def emit(self, number: int, rows: np.ndarray, holds: int = 1) -> None:
        self.rows += list(rows) + [rows[-1].copy()] * holds
        self.blocks += [number] * (len(rows) + holds)

    def ptp(self, goal: np.ndarray, ticks: int = 40, **data: object) -> None:
        target = JointTarget(tuple(goal.tolist()))
        number = self.record(MoveBlock, kind=MoveKind.PTP, target=target, law=LAW, **data)
        start = self.rows[-1]
        rows = start + smooth(ticks)[:, None] * (goal - start)
        rows[-1] = goal
        self.emit(number, rows)

    def lin(self, position, turn=None, ticks: int = 50, rail: float = 0.0, **data: object) -> None:
        """Line to a position with the orientation turned by a rotation vector (tool axes) or kept."""
        start = self.rows[-1]
        p0, r0 = pose_of(start)
        step = np.zeros(3) if turn is None else np.array(turn, dtype=float)
        goal = None if turn is None else tuple((r0 * Rotation.from_rotvec(step)).as_quat().tolist())
        target = PoseTarget(tuple(float(c) for c in position), goal)
        number = self.record(MoveBlock, kind=MoveKind.LIN, target=target, law=LAW, **data)
        s = smooth(ticks)
        rows = np.repeat(start[None], ticks, axis=0)
        points = p0 + s[:, None] * (np.array(position) - p0)
        points[-1] = position
        rows[:, 0] = start[0] + rail * s
        rows[:, 1] = points[:, 0] - rows[:, 0]
        rows[:, 2:4] = points[:, 1:]
        if turn is not None:
            rows[:, 4:7] = (r0 * Rotation.from_rotvec(s[:, None] * step)).as_euler("ZYX")
        self.emit(number, rows)

    def circle(self, centre, via: float, end: float, angle=None, turn=None, ticks: int = 60, **data) -> None:
        """CIRCLE about the z axis through `centre` (x, y), via and end point at angles (rad) from the start;
        travels `angle` instead of `end` where given. The orientation turns by a rotation vector or is kept.
        """
        start = self.rows[-1]
        p0, r0 = pose_of(start)
        arm = p0 - np.array([*centre, p0[2]])

        def points(phi: np.ndarray) -> np.ndarray:
            return p0 - arm + Rotation.from_rotvec(np.multiply.outer(phi, [0.0, 0.0, 1.0])).apply(arm)

        step = np.zeros(3) if turn is None else np.array(turn, dtype=float)
        goal = None if turn is None else tuple((r0 * Rotation.from_rotvec(step)).as_quat().tolist())
        last, between = (tuple(position) for position in points(np.array([end, via])).tolist())
        target, middle = PoseTarget(last, goal), PoseTarget(between, None)
        more = {"target": target, "course": ArcCourse(middle, angle), "law": LAW, **data}
        number = self.record(MoveBlock, kind=MoveKind.CIRCLE, **more)
        # A negative ANGLE goes against the sense from start over via to end.
        travel = end if angle is None else angle * np.sign(end)
        s = smooth(ticks)
        rows = np.repeat(start[None], ticks, axis=0)
        rows[:, 1:4] = points(s * travel) - np.array([start[0], 0.0, 0.0])
        if turn is not None:
            rows[:, 4:7] = (r0 * Rotation.from_rotvec(s[:, None] * step)).as_euler("ZYX")
        self.emit(number, rows)

    def switch(self, kind: LimitKind, bound: np.ndarray | None) -> None:
        self.record(LimitSwitchBlock, kind=kind, range=None if bound is None else both(bound))

    def stream(self, complete: bool = True) -> JointStream:
        q = np.array(self.rows)
        turns = Rotation.from_euler("ZYX", q[:, 4:7])
        tool = np.column_stack([q[:, 0] + q[:, 1], q[:, 2], q[:, 3], turns.as_quat()])
        block = np.array(self.blocks, dtype=np.int64)
        ticks = np.arange(len(q), dtype=np.int64)
        return JointStream(header(**self.changes), tuple(self.records), ticks, q, block, tool, complete)


def both(bound: np.ndarray) -> JointRange:
    return JointRange(tuple((-bound).tolist()), tuple(bound.tolist()))


def make_good() -> JointStream:
    """A run with every kind of move and switch; records and rows fit, all promises are kept."""
    maker = Maker(np.array([0.1, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]))
    maker.ptp(np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1]))
    fastest = 0.5 * 1.875 / (50 * DT) * 1.01
    maker.switch(LimitKind.SPEED, np.full(7, 8.0))
    clause = LimitClause(LimitKind.SPEED, both(np.full(7, fastest)), Origin("weld.irl", 5, 9, 7))
    maker.lin((1.0, 0.25, 0.4), (0.3, -0.2, 0.5), limits=(clause,))
    maker.record(FreezeBlock, joints=(1,))
    maker.record(CyclicBlock, active=True)
    maker.lin((1.0, 0.75, 0.4))
    maker.lin((1.0, 0.75, 0.4), (0.0, 0.7, 0.0))
    maker.record(FreezeBlock, joints=())
    maker.switch(LimitKind.SPEED, None)
    maker.switch(LimitKind.ACCELERATION, np.full(7, 1000.0))
    maker.lin((0.8, 0.25, 0.4), (0.0, -0.7, 0.0), rail=0.2)
    maker.lin((1.0, 0.25, 0.4), rail=-0.2)
    maker.record(CyclicBlock, active=False)
    return maker.stream()


@pytest.fixture(scope="session")
def good() -> JointStream:
    return make_good()


@pytest.fixture(scope="session")
def robot() -> RobotDescription:
    return ROBOT


@pytest.fixture(scope="session")
def gantry_kit():
    """Everything of this file that tests build with, under one name."""

    class Kit:
        pass

    kit = Kit()
    kit.__dict__.update(
        {k: v for k, v in globals().items() if not k.startswith("_") and k not in {"pytest", "annotations"}}
    )
    return kit
