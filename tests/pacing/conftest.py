"""A gantry on a rail: tool pose and least-motion posture are closed form, so are its limits."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import (
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
from irlx.diagnostics import Place, SourceText, Span
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits

TEXT = SourceText("cell.irl", "".join(f"line {i}\n" for i in range(1, 60)))
START = np.array([0.0, 0.5, -0.2, 0.3, 0.1, -0.2, 0.3])
WEIGHTS = np.array([3.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])


def gantry() -> RobotDescription:
    """Slides along x (rail), x, y, z, then turns about z, y, x in one point."""
    x, y, z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
    slide, turn = JointKind.PRISMATIC, JointKind.REVOLUTE
    kinds = [("rail", slide, x), ("x", slide, x), ("y", slide, y), ("z", slide, z)]
    kinds += [("a", turn, z), ("b", turn, y), ("c", turn, x)]
    joints = [Joint(n, k, f"l{i}", f"l{i + 1}", axis=axis) for i, (n, k, axis) in enumerate(kinds)]
    return RobotDescription("gantry", "l0", "l7", tuple(joints))


def position_of(q: np.ndarray) -> np.ndarray:
    return np.array([q[0] + q[1], q[2], q[3]])


def rotation_of(q: np.ndarray) -> Rotation:
    return Rotation.from_euler("ZYX", q[4:7])


def pair(half, lower=None) -> tuple[np.ndarray, np.ndarray]:
    """Bounds (n,) of seven joints; the lower side mirrors the upper one where it is not given."""
    upper = np.broadcast_to(np.asarray(half, dtype=float), 7).copy()
    return (-upper if lower is None else np.broadcast_to(np.asarray(lower, dtype=float), 7).copy()), upper


def joint_range(half, lower=None) -> JointRange:
    low, up = pair(half, lower)
    return JointRange(tuple(low.tolist()), tuple(up.tolist()))


def limits(position=5.0, speed=np.inf, acceleration=np.inf) -> JointLimits:
    return JointLimits(*pair(position), *pair(speed), *pair(acceleration))


@dataclass
class Shop:
    """Builds blocks and runs them through one pacer; every block has its own line of the program."""

    limits: JointLimits = field(default_factory=limits)
    dt: float = 0.01
    modifiers: tuple = ()
    start: np.ndarray = field(default_factory=START.copy)

    def __post_init__(self) -> None:
        setup = PacingSetup(Kinematics(gantry()), self.limits, WEIGHTS, self.start, self.dt, self.modifiers)
        self.pacer = Pacer(setup, lambda o: Place.in_text(TEXT, Span(o.start, o.end)))
        self.count = 0
        self.rows: list = []

    def origin(self, line: int | None = None) -> Origin:
        line = self.count if line is None else line
        start = sum(len(f"line {i}\n") for i in range(1, line))
        return Origin("cell.irl", start, start + 4, line)

    def _data(self) -> dict:
        self.count += 1
        return {"id": self.count, "origin": self.origin()}

    def law(self, **changes: object) -> MotionLaw:
        return MotionLaw(**{"speed": 0.5, "acc": 2.0, "speed_ori": 1.0, "acc_ori": 4.0, **changes})

    def execute(self, block):
        rows = self.pacer.execute(block)
        if rows is not None:
            self.rows.append(rows)
        return rows

    def line(self, position, orientation: Rotation | None = None, clauses=(), **law: object):
        quaternion = None if orientation is None else tuple(orientation.as_quat().tolist())
        target = PoseTarget(tuple(float(c) for c in position), quaternion)
        data = {"target": target, "law": self.law(**law), "limits": tuple(clauses)}
        return self.execute(MoveBlock(**self._data(), kind=MoveKind.LIN, **data))

    def to(self, values, kind: MoveKind = MoveKind.PTP, clauses=(), **law: object):
        target = JointTarget(tuple(float(v) for v in values))
        data = {"target": target, "law": self.law(**law), "limits": tuple(clauses)}
        return self.execute(MoveBlock(**self._data(), kind=kind, **data))

    def ptp_pose(self, position, orientation: Rotation | None = None):
        quaternion = None if orientation is None else tuple(orientation.as_quat().tolist())
        target = PoseTarget(tuple(float(c) for c in position), quaternion)
        return self.execute(MoveBlock(**self._data(), kind=MoveKind.PTP, target=target, law=self.law()))

    def switch(self, kind: LimitKind, range_: JointRange | None):
        return self.execute(LimitSwitchBlock(**self._data(), kind=kind, range=range_))

    def freeze(self, *joints: int):
        return self.execute(FreezeBlock(**self._data(), joints=joints))

    def cyclic(self, active: bool = True):
        return self.execute(CyclicBlock(**self._data(), active=active))

    def clause(self, kind: LimitKind, range_: JointRange, line: int) -> LimitClause:
        return LimitClause(kind, range_, self.origin(line))

    def all_rows(self) -> np.ndarray:
        """All rows since the start, the start first."""
        return np.vstack([self.start, *(rows.q for rows in self.rows)])


@pytest.fixture
def kit():
    """Builders of this file under one name."""

    class Kit:
        pass

    made = Kit()
    made.shop, made.limits, made.range, made.pair = Shop, limits, joint_range, pair
    made.beyond = lambda *way: position_of(START) + np.array(way)
    made.moved = lambda *way: START + np.array(way)
    made.position, made.rotation, made.gantry, made.start = position_of, rotation_of, gantry, START
    return made


@pytest.fixture
def shop() -> Shop:
    """A gantry with position limits of 5 and no others, tick 10 ms."""
    return Shop()
