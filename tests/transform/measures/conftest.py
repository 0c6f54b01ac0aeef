"""Robots for the measures: the packaged ones, random chains, and arms with textbook formulas."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from math import inf

import numpy as np
import pytest

from irlx.robot.description import Inertial, Joint, JointKind, RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.verifier.geometry.forward import forward
from long_run import first
from machines import machine

SEEDS = range(12)
PACKAGED = ("arm7", "koch11", "rail6")
KINDS = (JointKind.REVOLUTE, JointKind.CONTINUOUS, JointKind.PRISMATIC, JointKind.FIXED)
GRAVITY = 9.81


@dataclass(frozen=True)
class Robot:
    """A robot with limits and a posture from which special ones are made."""

    kinematics: Kinematics
    limits: JointLimits
    start: np.ndarray

    @property
    def n(self) -> int:
        return self.start.size

    @property
    def description(self) -> RobotDescription:
        return self.kinematics.description

    def postures(self, seed: int, count: int) -> np.ndarray:
        """Random postures (count, n) within 80 % of the limits, +-3 where there are none."""
        rng = np.random.default_rng([seed, self.n])
        lower, upper = self.limits.position_lower, self.limits.position_upper
        drawn = rng.uniform(np.maximum(lower, -3.0), np.minimum(upper, 3.0), size=(count, self.n))
        return 0.8 * drawn

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        """Scaled Jacobian at the tool point in the world's axes, by differences of another model."""

        def rows(q: np.ndarray) -> np.ndarray:
            position, rotation = forward(self.description, q[None])
            return np.hstack([position[0] / self.description.reach, rotation[0].ravel()])

        slopes = derivative(rows, q)
        rotation = forward(self.description, q[None])[1][0]
        spin = np.einsum("abj,cb->acj", slopes[3:].reshape(3, 3, -1), rotation)
        return np.vstack([slopes[:3], spin[2, 1], spin[0, 2], spin[1, 0]])


def derivative(function: Callable[[np.ndarray], object], q: np.ndarray, h: float = 1e-4) -> np.ndarray:
    """Derivative of a function by q, joint of q last, from central differences of fourth order."""
    columns = []
    for step in h * np.eye(q.size):
        one = np.asarray(function(q + step)) - np.asarray(function(q - step))
        two = np.asarray(function(q + 2 * step)) - np.asarray(function(q - 2 * step))
        columns.append((8.0 * one - two) / (12.0 * h))
    return np.stack(columns, axis=-1)


def _random_inertial(rng: np.random.Generator) -> Inertial:
    half = rng.normal(size=(3, 3))
    moment = half @ half.T * 0.1 + 0.05 * np.eye(3)
    inertia = tuple(float(moment[i, k]) for i, k in zip(*np.triu_indices(3), strict=True))
    place, turn = rng.normal(size=3) * 0.2, rng.uniform(-3.0, 3.0, 3)
    return Inertial(float(rng.uniform(0.5, 5.0)), tuple(place), tuple(turn), inertia)


def random_chain(seed: int) -> RobotDescription:
    """4 to 11 axes of all kinds, askew and aligned, between them fixed and locked joints, one link aside."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(4, 12))
    kinds = [KINDS[i] for i in [*rng.choice(3, size=count, p=[0.6, 0.15, 0.25]), 3]]
    links = [f"l{i}" for i in range(count + 3)]
    kinds.insert(int(rng.integers(1, count)), JointKind.REVOLUTE)
    joints, locked = [], {}
    for i, (parent, child) in enumerate(pairwise(links)):
        axis = np.eye(3)[rng.integers(3)] if rng.random() < 0.6 else rng.normal(size=3)
        axis = tuple(float(a) for a in axis / np.linalg.norm(axis))
        xyz, rpy = tuple(rng.normal(size=3) * 0.5), tuple(rng.uniform(-3.0, 3.0, 3))
        limit = inf if kinds[i] is JointKind.CONTINUOUS else 2.0
        joints.append(Joint(f"j{i}", kinds[i], parent, child, xyz, rpy, axis, -limit, limit))
    held = next(i for i, kind in enumerate(kinds) if i > 0 and kind is JointKind.REVOLUTE)
    locked[f"j{held}"] = 0.7
    joints.append(Joint("aside", JointKind.REVOLUTE, links[count // 2], "branch", (0.3, 0.1, -0.2)))
    inertials = {link: _random_inertial(rng) for link in [*links[: count + 2], "branch"]}
    return RobotDescription(f"r{seed}", links[0], links[-1], tuple(joints), inertials, locked)


def robot_of(description: RobotDescription) -> Robot:
    limits = JointLimits.unlimited(len(description.axes)).with_pair(
        "position",
        *(np.array([getattr(axis, side) for axis in description.axes]) for side in ("lower", "upper")),
    )
    return Robot(Kinematics(description), limits, np.zeros(len(description.axes)))


def chain_of(
    *joints: tuple[JointKind, tuple[float, float, float], tuple[float, float, float]],
    tip: tuple[float, float, float] = (0.0, 0.0, 0.0),
    masses: dict[int, Inertial] | None = None,
    stroke: float = 1.0,
) -> Robot:
    """Chain of (kind, xyz of the joint, axis); link i hangs on joint i - 1, the tool is fixed to the last."""
    parts = [
        Joint(f"j{i}", kind, f"l{i}", f"l{i + 1}", xyz, axis=axis, lower=-stroke, upper=stroke)
        for i, (kind, xyz, axis) in enumerate(joints)
    ]
    parts.append(Joint("tool", JointKind.FIXED, f"l{len(joints)}", "tip", tip))
    inertials = {f"l{i + 1}": inertial for i, inertial in (masses or {}).items()}
    return robot_of(RobotDescription("chain", "l0", "tip", tuple(parts), inertials))


@dataclass(frozen=True)
class Pendulum:
    """Two links in the upright x-z plane: lengths m, centres of mass m, masses kg, inertias kg m2."""

    length: tuple[float, float] = (0.7, 0.4)
    centre: tuple[float, float] = (0.3, 0.25)
    mass: tuple[float, float] = (3.0, 2.0)
    about_centre: tuple[float, float] = (0.11, 0.05)

    @property
    def robot(self) -> Robot:
        axis = (0.0, -1.0, 0.0)
        return chain_of(
            (JointKind.REVOLUTE, (0.0, 0.0, 0.0), axis),
            (JointKind.REVOLUTE, (self.length[0], 0.0, 0.0), axis),
            tip=(self.length[1], 0.0, 0.0),
            masses={
                i: Inertial(m, (c, 0.0, 0.0), (0.0, 0.0, 0.0), (moment, 0.0, 0.0, moment, 0.0, moment))
                for i, (m, c, moment) in enumerate(
                    zip(self.mass, self.centre, self.about_centre, strict=True)
                )
            },
        )

    def inertia(self, q: np.ndarray) -> np.ndarray:
        (l1, _), (c1, c2), (m1, m2), (i1, i2) = self.length, self.centre, self.mass, self.about_centre
        coupling = l1 * c2 * np.cos(q[1])
        m12 = i2 + m2 * (c2**2 + coupling)
        m11 = i1 + m1 * c1**2 + i2 + m2 * (l1**2 + c2**2 + 2.0 * coupling)
        return np.array([[m11, m12], [m12, i2 + m2 * c2**2]])

    def inertia_derivative(self, q: np.ndarray) -> np.ndarray:
        slope = -self.mass[1] * self.length[0] * self.centre[1] * np.sin(q[1])
        result = np.zeros((2, 2, 2))
        result[:, :, 1] = [[2.0 * slope, slope], [slope, 0.0]]
        return result

    def torque(self, q: np.ndarray) -> np.ndarray:
        (l1, _), (c1, c2), (m1, m2) = self.length, self.centre, self.mass
        second = m2 * GRAVITY * c2 * np.cos(q[0] + q[1])
        return np.array([(m1 * c1 + m2 * l1) * GRAVITY * np.cos(q[0]) + second, second])

    def torque_derivative(self, q: np.ndarray) -> np.ndarray:
        (l1, _), (c1, c2), (m1, m2) = self.length, self.centre, self.mass
        second = -m2 * GRAVITY * c2 * np.sin(q[0] + q[1])
        first = -(m1 * c1 + m2 * l1) * GRAVITY * np.sin(q[0])
        return np.array([[first + second, second], [second, second]])

    def volume(self, q: np.ndarray) -> float:
        """sqrt(det(J' J)) of the two columns, lengths in reaches."""
        l1, l2 = np.array(self.length) / sum(self.length)
        along = l1 * l2 * np.cos(q[1])
        p11, p22, p12 = 1.0 + l1**2 + l2**2 + 2.0 * along, 1.0 + l2**2, 1.0 + l2**2 + along
        return float(np.sqrt(p11 * p22 - p12**2))


@dataclass(frozen=True)
class Making:
    """Builders the tests share."""

    Pendulum = Pendulum
    chain_of = staticmethod(chain_of)
    robot_of = staticmethod(robot_of)
    random_chain = staticmethod(random_chain)
    derivative = staticmethod(derivative)


@pytest.fixture(scope="session")
def make() -> Making:
    return Making()


def _packaged(name: str) -> Robot:
    made = machine(name)
    return Robot(made.kinematics, made.limits, made.start)


@pytest.fixture(params=[*PACKAGED, *first(6, SEEDS)], ids=lambda p: p if isinstance(p, str) else f"seed{p}")
def robot(request: pytest.FixtureRequest) -> Robot:
    """A packaged robot or a random chain."""
    return (
        _packaged(request.param) if isinstance(request.param, str) else robot_of(random_chain(request.param))
    )


@pytest.fixture(params=PACKAGED)
def packaged(request: pytest.FixtureRequest) -> Robot:
    return _packaged(request.param)


@pytest.fixture
def arm7() -> Robot:
    return _packaged("arm7")


@pytest.fixture
def pendulum() -> Pendulum:
    return Pendulum()
