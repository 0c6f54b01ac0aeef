"""Many postures at once: poses, Jacobians and differences are those of Pinocchio, one by one."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from irlx.blocks.link_frame import LinkFrame
from irlx.cell.packaged import packaged_urdf
from irlx.robot.chain_batch import ChainBatch
from irlx.robot.kinematics import Kinematics
from irlx.robot.twists import angles_between, twists_between
from irlx.robot.urdf import read_urdf
from led_joints import CASES, coupled

pytestmark = pytest.mark.req("TRF-20")

ROUNDING = 1e-14
PIPE = LinkFrame("pipe", "left_hand", (0.1, -0.02, 0.03), (0.36, 0.48, 0.0, 0.8))


def postures(joints: int, count: int = 40) -> np.ndarray:
    """All zeros, exact half turns and residues mixed in, then anywhere, (N, n)."""
    rng = np.random.default_rng(joints)
    special = rng.choice([0.0, np.pi, -np.pi / 2, 1e-16], size=(3, joints))
    return np.vstack([np.zeros(joints), special, rng.uniform(-3.0, 3.0, (count, joints))])


def agrees(kinematics: Kinematics, q: np.ndarray) -> None:
    """Everything that a batch gives is what Pinocchio gives row by row, to rounding of its size."""
    size = ROUNDING * max(1.0, np.max(np.abs(q)), kinematics.description.reach)
    rotation, position = kinematics.tool_poses(q)
    rng = np.random.default_rng(5)
    goals = [pin.SE3(r, p) * pin.exp6(rng.normal(size=6)) for r, p in zip(rotation, position, strict=True)]
    targets = np.array([goal.rotation for goal in goals]), np.array([goal.translation for goal in goals])
    one_by_one = [kinematics.tool_difference(row, goal) for row, goal in zip(q, goals, strict=True)]
    left, jacobians = (np.array([np.array(pair[k]) for pair in one_by_one]) for k in range(2))
    batch = ChainBatch(kinematics)
    found = batch.poses_and_jacobians(q)
    assert [array.shape for array in found] == [rotation.shape, position.shape, jacobians.shape]
    assert np.max(np.abs(found[0] - rotation)) < ROUNDING
    assert np.max(np.abs(found[1] - position)) < size
    assert np.max(np.abs(found[2] - jacobians), initial=0.0) < 3.0 * size
    for mine, known in zip(batch.poses(q), found, strict=False):
        np.testing.assert_array_equal(mine, known)
    twists, again = batch.differences(q, targets)
    np.testing.assert_array_equal(again, found[2])
    # Near half turns both round more.
    assert np.max(np.abs(twists - left)) < 20.0 * size


def test_random_chains(random_robot) -> None:
    kinematics = Kinematics(read_urdf(random_robot.text, random_robot.tip, random_robot.locked))
    agrees(kinematics, postures(kinematics.joints))


@pytest.mark.parametrize("axis", ["1 0 0", "0 -1 0", "0 0 1", "0.6 0 -0.8"])
@pytest.mark.parametrize("kind", ["revolute", "prismatic", "continuous"])
def test_single_joint(kind: str, axis: str) -> None:
    text = (
        '<robot name="one"><link name="base"/><link name="arm"/><link name="tool"/>'
        f'<joint name="j" type="{kind}"><parent link="base"/><child link="arm"/><axis xyz="{axis}"/>'
        '<origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6"/><limit lower="-3" upper="3" '
        'velocity="1" effort="1"/></joint>'
        '<joint name="f" type="fixed"><parent link="arm"/><child link="tool"/>'
        '<origin xyz="0.3 -0.2 0.5" rpy="0.1 -0.7 2.6"/></joint></robot>'
    )
    agrees(Kinematics(read_urdf(text, "tool")), postures(1))


@pytest.mark.parametrize("name", sorted(CASES))
def test_joints_that_follow_others(name: str) -> None:
    plain = read_urdf(packaged_urdf(name), "tcp" if name == "koch11" else "tool")
    kinematics = Kinematics(coupled(plain, name)[0])
    assert kinematics.coupling is not None
    agrees(kinematics, postures(kinematics.joints))


@pytest.mark.parametrize("carriers", [("left_hand",), ("left_forearm_1",)])
def test_two_hands_and_the_tool_as_the_other_sees_it(carriers) -> None:
    kinematics = Kinematics(read_urdf(packaged_urdf("dual14"), "torch", carriers=carriers))
    agrees(kinematics, postures(kinematics.joints))
    if carriers == ("left_hand",):
        agrees(kinematics.relative_to(PIPE), postures(kinematics.joints))


@pytest.mark.parametrize("frame", ["forearm", "tool"])
def test_tool_as_a_link_of_its_own_arm_sees_it(frame: str) -> None:
    plain = read_urdf(packaged_urdf("arm7"), "tool")
    link = plain.chain[4].child if frame == "forearm" else plain.chain[-1].child
    kinematics = Kinematics(plain).relative_to(LinkFrame("f", link, (0.1, 0.0, 0.2), (0.0, 0.6, 0.0, 0.8)))
    agrees(kinematics, postures(7))


def test_jacobian_is_the_slope_of_the_pose() -> None:
    plain = read_urdf(packaged_urdf("arm7"), "tool")
    batch = ChainBatch(Kinematics(plain).with_tool((0.1, 0.2, 0.3), (0.5, 0.5, 0.5, 0.5)))
    q, step = postures(7), 1e-5
    jacobian = batch.poses_and_jacobians(q)[2]
    for joint, unit in enumerate(step * np.eye(7)):
        ahead, behind = batch.poses(q + unit), batch.poses(q - unit)
        moved = twists_between(*((r.transpose(1, 2, 0), p.T) for r, p in (behind, ahead))).T / (2 * step)
        assert np.max(np.abs(moved - jacobian[:, :, joint])) < 1e-9


@pytest.mark.parametrize("size", [0.0, 1e-16, 1e-12, 1e-9, 1e-7, 1e-4, 1e-3, 1e-2, 0.3, 0.6, 2.0, 3.14])
def test_twists_are_those_of_log6(size: float) -> None:
    rng = np.random.default_rng(11)
    poses = [pin.SE3.Random() for _ in range(60)]
    wanted = rng.normal(size=(60, 6))
    wanted[:, 3:] *= size / np.linalg.norm(wanted[:, 3:], axis=1)[:, None]
    wanted[:, :3] *= size
    # Exact zeros beside the rest.
    wanted[0], wanted[1, :3], wanted[2, 3:] = 0.0, 0.0, 0.0
    goals = [pose * pin.exp6(twist) for pose, twist in zip(poses, wanted, strict=True)]
    stacked = [
        (np.stack([one.rotation for one in of], 2), np.stack([one.translation for one in of], 1))
        for of in (poses, goals)
    ]
    found = twists_between(*stacked).T
    # The axis of a turn close to a half one is known less well.
    allowed = 2e-15 if size < 1.0 else 1e-13 if size < 3.0 else 1e-9
    assert np.max(np.abs(found - wanted)) < allowed
    theirs = np.array([pin.log6(a.actInv(b)).vector for a, b in zip(poses, goals, strict=True)])
    assert np.max(np.abs(found - theirs)) < allowed


@pytest.mark.parametrize("size", [0.0, 1e-16, 1e-9, 1e-3, 1.0, 3.0, np.pi])
def test_angles_are_those_turned_by(size: float) -> None:
    rng = np.random.default_rng(3)
    axes = rng.normal(size=(50, 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    rotations = np.array([pin.SE3.Random().rotation for _ in axes])
    others = np.array([turn @ pin.exp3(size * axis) for turn, axis in zip(rotations, axes, strict=True)])
    assert np.max(np.abs(angles_between(rotations, others) - size)) < 1e-14
