"""The verifier's kinematics and rotations against Pinocchio and SciPy."""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from irlx.cell.load import load_cell
from irlx.cell.named import named_urdf, robot_names
from irlx.diagnostics import Place
from irlx.robot.urdf import read_urdf
from irlx.verifier.geometry.forward import forward
from irlx.verifier.geometry.rotations import (
    about_axis,
    angle_between,
    from_quaternion,
    from_rpy,
    rotation_vectors,
)


def random_urdf(rng: np.random.Generator, joints: int) -> str:
    kinds = ["revolute", "continuous", "prismatic", "fixed"]
    parts = ['<robot name="r"><link name="l0"/>']
    for i in range(joints):
        kind = kinds[rng.integers(4)] if i else "revolute"
        axis = np.eye(3)[rng.integers(3)] * rng.choice([-1, 1]) if rng.random() < 0.5 else rng.normal(size=3)
        axis = axis / np.linalg.norm(axis)
        xyz, rpy, axis = (
            " ".join(map(repr, v.tolist())) for v in (rng.normal(size=3), rng.uniform(-4, 4, 3), axis)
        )
        limit = '<limit lower="-9" upper="9" effort="1" velocity="1"/>' if kind != "fixed" else ""
        parts.append(
            f'<link name="l{i + 1}"/><joint name="j{i}" type="{kind}"><parent link="l{i}"/>'
            f'<child link="l{i + 1}"/><origin xyz="{xyz}" rpy="{rpy}"/><axis xyz="{axis}"/>{limit}</joint>'
        )
    return "".join([*parts, "</robot>"])


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("seed", range(12))
def test_random_chains_against_pinocchio(seed: int) -> None:
    rng = np.random.default_rng(seed)
    text = random_urdf(rng, int(rng.integers(1, 10)))
    robot = read_urdf(text)
    model = pin.buildModelFromXML(text)
    data = model.createData()
    frame = model.getFrameId(robot.tip)
    q = rng.uniform(-4, 4, (20, len(robot.axes)))
    q[0] = 0.0
    positions, rotations = forward(robot, q)
    for row, values in enumerate(q):
        configuration = pin.neutral(model)
        for name, value in zip(robot.joint_names, values, strict=True):
            joint = model.joints[model.getJointId(name)]
            wide = [np.cos(value), np.sin(value)] if joint.nq == 2 else [value]
            configuration[joint.idx_q : joint.idx_q + joint.nq] = wide
        pin.forwardKinematics(model, data, configuration)
        pose = pin.updateFramePlacement(model, data, frame)
        assert np.abs(pose.translation - positions[row]).max() < 1e-13
        assert np.abs(pose.rotation - rotations[row]).max() < 1e-13


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("name", robot_names())
def test_every_named_robot_against_pinocchio(name: str, tmp_path: Path) -> None:
    """Its URDF read by Pinocchio itself, other moving joints at zero or at their locked values."""
    (tmp_path / "cell.toml").write_text(f'[robot]\nmodel = "{name}"\n', encoding="utf-8")
    robot = load_cell(tmp_path / "cell.toml").robot
    text = named_urdf(name, Place(name))
    model = pin.buildModelFromXML(text)
    followers = {
        joint.get("name"): joint.find("mimic").attrib
        for joint in ElementTree.fromstring(text).findall("joint")
        if joint.find("mimic") is not None and joint.get("name") in {one.name for one in robot.moving}
    }
    data, frame = model.createData(), model.getFrameId(robot.tip)
    rng = np.random.default_rng(4)
    q = rng.uniform(-2.0, 2.0, (8, len(robot.axes)))
    positions, rotations = forward(robot, q)
    root = model.getFrameId(robot.root)
    for row, values in enumerate(q):
        configuration = pin.neutral(model)
        held = {name: value for name, value in robot.locked.items() if model.existJointName(name)}
        led = dict(zip(robot.joint_names, values, strict=True))
        led |= {one: float(by["multiplier"]) * led[by["joint"]] for one, by in followers.items()}
        for joint_name, value in {**held, **led}.items():
            joint = model.joints[model.getJointId(joint_name)]
            wide = [np.cos(value), np.sin(value)] if joint.nq == 2 else [value]
            configuration[joint.idx_q : joint.idx_q + joint.nq] = wide
        pin.forwardKinematics(model, data, configuration)
        base = pin.updateFramePlacement(model, data, root)
        pose = base.actInv(pin.updateFramePlacement(model, data, frame))
        assert np.abs(pose.translation - positions[row]).max() < 1e-13
        assert np.abs(pose.rotation - rotations[row]).max() < 1e-13


def test_locked_joints_stand_at_their_value() -> None:
    text = random_urdf(np.random.default_rng(3), 6)
    free = read_urdf(text)
    name = free.joint_names[1]
    locked = read_urdf(text, locked={name: 0.7})
    q = np.random.default_rng(0).normal(size=(5, len(free.axes)))
    q[:, 1] = 0.7
    for one, other in zip(forward(free, q), forward(locked, np.delete(q, 1, axis=1)), strict=True):
        assert np.abs(one - other).max() < 1e-15


def test_rotations_against_scipy() -> None:
    rng = np.random.default_rng(1)
    axes = rng.normal(size=(200, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    angles = np.concatenate(
        [rng.uniform(0, np.pi, 190), [0, 1e-17, 1e-9, 1e-4, np.pi, np.pi - 1e-9], [1] * 4]
    )
    vectors = axes * angles[:, None]
    oracle = Rotation.from_rotvec(vectors)
    own = np.stack([about_axis(axis, angle[None])[0] for axis, angle in zip(axes, angles, strict=True)])
    assert np.abs(own - oracle.as_matrix()).max() < 1e-15
    assert np.abs(from_quaternion(oracle.as_quat()) - oracle.as_matrix()).max() < 1e-15
    back = rotation_vectors(own)
    assert np.abs(np.linalg.norm(back, axis=1) - angles).max() < 1e-13
    assert np.abs(Rotation.from_rotvec(back).as_matrix() - own).max() < 1e-13
    rpy = rng.uniform(-3, 3, 3)
    assert np.abs(from_rpy(tuple(rpy)) - Rotation.from_euler("xyz", rpy).as_matrix()).max() < 1e-15


def test_small_angles_are_accurate() -> None:
    for angle in (1e-12, 1e-9, 1e-6, 0.1, 3.0):
        turned = about_axis(np.array([0.6, 0.0, 0.8]), np.array([angle]))
        assert float(angle_between(turned, np.eye(3))[0]) == pytest.approx(angle, rel=1e-4, abs=1e-15)
