"""URDF texts of random robots, and the same robots as Pinocchio's own reader builds them."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
import pinocchio as pin
import pytest

from long_run import first


def words(values) -> str:
    return " ".join(repr(float(value)) for value in values)


@dataclass
class RandomRobot:
    """A chain with side branches; `axes` are its moving joints that are not locked, root to tip."""

    text: str
    tip: str
    axes: list[str]
    locked: dict[str, float]
    continuous: list[str]
    model: pin.Model = field(init=False)

    def __post_init__(self) -> None:
        self.model = pin.buildModelFromXML(self.text)
        self.data = self.model.createData()

    def full(self, q: np.ndarray) -> np.ndarray:
        """Configuration of Pinocchio's model: axes at q, locked joints at their values, others at zero."""
        configuration = pin.neutral(self.model)
        for name, value in {**self.locked, **dict(zip(self.axes, q, strict=True))}.items():
            joint = self.model.joints[self.model.getJointId(name)]
            if joint.nq == 2:
                configuration[joint.idx_q : joint.idx_q + 2] = np.cos(value), np.sin(value)
            else:
                configuration[joint.idx_q] = value
        return configuration

    def tool_pose(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        pin.framesForwardKinematics(self.model, self.data, self.full(q))
        pose = self.data.oMf[self.model.getFrameId(self.tip, pin.FrameType.BODY)]
        return pose.rotation.copy(), pose.translation.copy()

    def inertia(self, q: np.ndarray) -> np.ndarray:
        """Joint-space inertia of the axes, the other joints held."""
        matrix = pin.crba(self.model, self.data, self.full(q))
        matrix = np.triu(matrix) + np.triu(matrix, 1).T
        columns = [self.model.joints[self.model.getJointId(name)].idx_v for name in self.axes]
        return matrix[np.ix_(columns, columns)]


def _inertial(rng: np.random.Generator) -> str:
    half = rng.normal(size=(3, 3))
    moment = half @ half.T * 0.1 + 0.05 * np.eye(3)
    xx, xy, xz, yy, yz, zz = (float(value) for value in moment[np.triu_indices(3)])
    return (
        f'<inertial><origin xyz="{words(rng.normal(size=3) * 0.2)}" rpy="{words(rng.uniform(-3, 3, 3))}"/>'
        f'<mass value="{rng.uniform(0.1, 5.0)!r}"/><inertia ixx="{xx!r}" ixy="{xy!r}" ixz="{xz!r}" '
        f'iyy="{yy!r}" iyz="{yz!r}" izz="{zz!r}"/></inertial>'
    )


def _axis(rng: np.random.Generator) -> np.ndarray:
    """Along, against or askew of the frame's axes, in that order of likelihood."""
    aligned = np.eye(3)[rng.integers(3)] * rng.choice([1.0, -1.0])
    return aligned if rng.random() < 0.6 else rng.normal(size=3) * rng.uniform(0.1, 10.0)


def _joint(rng: np.random.Generator, name: str, kind: str, parent: str, child: str) -> str:
    xyz = rng.normal(size=3) * rng.choice([0.0, 0.5, 1.0])
    rpy = rng.choice([0.0, np.pi / 2, -np.pi, rng.uniform(-3, 3)], size=3)
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{words(xyz)}" rpy="{words(rpy)}"/><axis xyz="{words(_axis(rng))}"/>'
        '<limit lower="-2" upper="2.5" velocity="3" effort="10"/></joint>'
    )


def make_robot(seed: int) -> RandomRobot:
    rng = np.random.default_rng(seed)
    links = int(rng.integers(4, 12))
    chain = ["base", *(f"link_{i}" for i in range(1, links + 1))]
    parts, axes, locked, continuous = [], [], {}, []
    for i, (parent, child) in enumerate(pairwise(chain), start=1):
        kind = str(rng.choice(["revolute", "prismatic", "continuous", "fixed"], p=[0.5, 0.2, 0.15, 0.15]))
        name = f"joint_{i}"
        parts.append(_joint(rng, name, kind, parent, child))
        if kind == "fixed":
            continue
        if rng.random() < 0.15:
            locked[name] = float(rng.choice([0.0, 0.7, -1.2]))
        else:
            axes.append(name)
            continuous += [name] if kind == "continuous" else []
    for i in range(int(rng.integers(0, 4))):
        name, kind = f"side_{i}", str(rng.choice(["revolute", "prismatic", "fixed", "continuous"]))
        parts.append(_joint(rng, name, kind, str(rng.choice(chain)), f"branch_{i}"))
        chain.append(f"branch_{i}")
        if kind != "fixed" and rng.random() < 0.5:
            locked[name] = 0.4
    bodies = [f'<link name="{link}">{_inertial(rng) if rng.random() < 0.8 else ""}</link>' for link in chain]
    order = rng.permutation(len(parts))
    text = f'<robot name="r{seed}">{"".join(bodies)}{"".join(parts[i] for i in order)}</robot>'
    return RandomRobot(text, f"link_{links}", axes, locked, continuous)


@pytest.fixture(params=first(10, range(25)))
def random_robot(request: pytest.FixtureRequest) -> RandomRobot:
    """A random robot; the parameter is its seed."""
    return make_robot(request.param)
