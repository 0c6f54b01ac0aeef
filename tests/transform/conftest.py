"""Robots for the inverse transform: a 7-axis arm, koch11, random Jacobians with active bounds."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files

import numpy as np
import pytest

from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.urdf import read_urdf
from irlx.transform.compact import StepProblem
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import BoundSource, StepBounds, StepLimiter
from irlx.transform.tick import TickSolution, TickSolver
from irlx.transform.tick_problem import TickProblem

ARM = [("0 0 0.34", "0 0 1"), ("0 0 0", "0 1 0"), ("0 0 0.4", "0 0 1"), ("0 0 0", "0 -1 0")]
ARM += [("0 0 0.4", "0 0 1"), ("0 0 0", "0 1 0"), ("0 0 0", "0 0 1")]


def seven_axis_urdf() -> str:
    """Spherical shoulder and wrist, an elbow between: stretched out at all zeros."""
    links = "".join(f'<link name="l{i}"/>' for i in range(9))
    joints = "".join(
        f'<joint name="a{i + 1}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<origin xyz="{xyz}"/><axis xyz="{axis}"/><limit lower="-2.9" upper="2.9" velocity="2"/></joint>'
        for i, (xyz, axis) in enumerate(ARM)
    )
    tool = (
        '<joint name="t" type="fixed"><parent link="l7"/><child link="l8"/><origin xyz="0 0 0.126"/></joint>'
    )
    return f'<robot name="arm7">{links}{joints}{tool}</robot>'


@dataclass(frozen=True)
class Arm:
    """A robot with an ordinary posture, weights, and one solver."""

    kinematics: Kinematics
    q: np.ndarray
    weights: np.ndarray
    lower: np.ndarray
    upper: np.ndarray

    @property
    def n(self) -> int:
        return self.q.size

    @property
    def size(self) -> float:
        """Reach in m, at least one."""
        return max(1.0, self.kinematics.description.reach)

    def bounds(self, half: float | np.ndarray, q: np.ndarray | None = None) -> StepBounds:
        """Step bounds +-half, cut by the position limits."""
        q = self.q if q is None else q
        half = np.broadcast_to(half, self.n)
        source = np.full(self.n, BoundSource.SPEED, dtype=np.int8)
        return StepBounds(np.maximum(-half, self.lower - q), np.minimum(half, self.upper - q), source, source)

    def pose(self, q: np.ndarray):
        return self.kinematics.target(*self.kinematics.tool_pose(q))

    def solve(
        self,
        target,
        criterion: Criterion,
        bounds: StepBounds,
        q: np.ndarray | None = None,
        free: np.ndarray | None = None,
    ) -> TickSolution:
        q = self.q if q is None else q
        free = np.ones(self.n, dtype=bool) if free is None else free
        solver = TickSolver(self.kinematics, ProxQpSolver())
        return solver.solve(TickProblem(target, q, bounds, criterion, free))


@pytest.fixture(scope="session")
def arm7() -> Arm:
    q = np.array([0.3, 0.6, -0.2, 1.3, 0.4, -0.7, 0.5])
    kinematics = Kinematics(read_urdf(seven_axis_urdf()))
    return Arm(kinematics, q, np.arange(7.0, 0.0, -1.0), np.full(7, -2.9), np.full(7, 2.9))


@pytest.fixture(scope="session")
def koch11() -> Arm:
    text = (files("irlx.cell") / "robots" / "koch11.urdf").read_text()
    robot = read_urdf(text, "tcp")
    degrees = [-0.05, -75.0, -102.0, 146.65, -80.6, -8.34, 55.4, 24.8, 106.1]
    q = np.concatenate([np.radians(degrees), [-0.46], np.radians([58.99])])
    weights = np.array([11.0, 10, 9, 8, 7, 6, 5, 4, 3, 5, 1])
    lower, upper = (np.array([getattr(axis, side) for axis in robot.axes]) for side in ("lower", "upper"))
    return Arm(Kinematics(robot), q, weights, lower, upper)


@pytest.fixture(params=["arm7", "koch11"])
def arm(request: pytest.FixtureRequest) -> Arm:
    return request.getfixturevalue(request.param)


def random_step_problem(seed: int, n: int) -> StepProblem:
    """A Newton step at a random full-rank Jacobian; bounds from wide to tight, zeros and pairs mixed in."""
    rng = np.random.default_rng([seed, n])
    jacobian = rng.normal(size=(6, n))
    hessian = rng.choice([np.arange(n, 0.0, -1.0), rng.uniform(0.1, 10.0, n), np.ones(n)])
    whole = rng.normal(size=n) * rng.choice([0.0, 1e-3, 1.0], size=n)
    half = rng.choice([0.02, 0.2, 2.0]) * rng.choice([1.0, 1.0, 0.0, 1e-16, 10.0], size=n)
    inside = np.clip(rng.normal(size=n) * 0.3, -1.0, 1.0) * half
    low, up = -half * rng.choice([1.0, 0.5], size=n), half
    low, up = np.minimum(low, inside), np.maximum(up, inside)
    # The path asks for what a step inside the bounds does, or for a little more than that.
    twist = jacobian @ (inside * rng.choice([1.0, 1.0, 0.3, 1.5])) * rng.choice([1.0, 1.0, 0.0])
    return StepProblem(jacobian, twist, hessian * whole, hessian, low, up)


@dataclass(frozen=True)
class Making:
    """Builders the tests share."""

    random_step_problem = staticmethod(random_step_problem)
    limiter = StepLimiter

    @staticmethod
    def limits(n: int, position=np.inf, speed=np.inf, acceleration=np.inf) -> JointLimits:
        """Limits of n joints, the lower sides mirrored."""
        pairs = [np.broadcast_to(value, n).astype(float) for value in (position, speed, acceleration)]
        p, v, a = pairs
        return JointLimits(-p, p.copy(), -v, v.copy(), -a, a.copy())


@pytest.fixture(scope="session")
def making() -> Making:
    return Making()
