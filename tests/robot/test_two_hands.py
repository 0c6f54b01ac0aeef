"""A robot with two hands: its axes, and the tool as a frame in the other hand sees it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks.link_frame import LinkFrame
from irlx.cell.packaged import packaged_urdf
from irlx.robot.equality import LinearConstraint
from irlx.robot.kinematics import Kinematics
from irlx.robot.relation import JointRelation
from irlx.robot.urdf import read_urdf
from irlx.robot.urdf_values import RobotModelError
from irlx.verifier.geometry.link_poses import link_poses

pytestmark = pytest.mark.req("TRF-23")

URDF = packaged_urdf("dual14")
LEFT = tuple(f"left_{number}" for number in range(1, 8))
RIGHT = tuple(f"right_{number}" for number in range(1, 8))
FRAME = LinkFrame("pipe", "left_hand", (0.1, -0.02, 0.03), (0.36, 0.48, 0.0, 0.8))


def robot(tip="torch", carriers=("left_hand",)):
    return read_urdf(URDF, tip, carriers=carriers)


def postures(count=5):
    """All zeros, exact half turns and residues mixed in, then anywhere."""
    rng = np.random.default_rng(23)
    yield np.zeros(14)
    yield rng.choice([0.0, np.pi, -np.pi / 2, 1e-16], size=14)
    yield from rng.uniform(-2.5, 2.5, (count, 14))


def by_pinocchio(q):
    """Pose of the tool in the frame, from Pinocchio's own reader."""
    model = pin.buildModelFromXML(URDF)
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    hand, torch = (data.oMf[model.getFrameId(name, pin.FrameType.BODY)] for name in ("left_hand", "torch"))
    inside = pin.SE3(Rotation.from_quat(FRAME.orientation).as_matrix(), np.array(FRAME.position))
    return (hand * inside).actInv(torch)


def test_axes_are_those_of_both_arms_whichever_carries_the_tool():
    assert robot().joint_names == LEFT + RIGHT
    assert robot("left_hand", ("torch",)).joint_names == LEFT + RIGHT
    assert robot(carriers=()).joint_names == RIGHT
    assert robot(carriers=("left_forearm_1",)).joint_names == LEFT[:4] + RIGHT
    assert robot(carriers=("right_flange", "base_link")).joint_names == RIGHT


def test_axes_come_as_pinocchio_numbers_them():
    assert list(Kinematics(robot()).model.names)[1:] == [*LEFT, *RIGHT]
    assert list(pin.buildModelFromXML(URDF).names)[1:] == [*LEFT, *RIGHT]


def test_the_fingerprint_tells_hands_apart():
    alone = robot(carriers=())
    assert alone.fingerprint != robot().fingerprint
    assert replace(alone, carriers=("right_flange",)).fingerprint == alone.fingerprint
    locked = replace(robot(), locked={"left_3": 0.1})
    assert locked.joint_names == tuple(name for name in LEFT + RIGHT if name != "left_3")
    assert locked.fingerprint != robot().fingerprint


def test_a_hand_that_the_robot_does_not_have():
    with pytest.raises(RobotModelError, match="no link is called 'left_hnd'") as caught:
        robot(carriers=("left_hnd",))
    assert "left_hand" in caught.value.known


def test_poses_in_the_frame_are_pinocchios():
    seen = Kinematics(robot()).relative_to(FRAME)
    rows = np.array(list(postures()))
    rotations, positions = seen.tool_poses(rows)
    for q, rotation, position in zip(rows, rotations, positions, strict=True):
        expected = by_pinocchio(q)
        assert rotation == pytest.approx(expected.rotation, abs=1e-12)
        assert position == pytest.approx(expected.translation, abs=1e-12)
        assert seen.tool_pose(q)[1] == pytest.approx(position, abs=1e-15)


def test_the_relative_jacobian_is_that_of_finite_differences():
    seen, h = Kinematics(robot()).relative_to(FRAME), 1e-6
    for q in postures():
        here = by_pinocchio(q)
        left, jacobian = seen.difference(q, here)
        assert left == pytest.approx(np.zeros(6), abs=1e-9)
        for joint in range(14):
            step = np.zeros(14)
            step[joint] = h
            ahead, behind = (pin.log6(here.actInv(by_pinocchio(q + s))).vector for s in (step, -step))
            assert jacobian[:, joint] == pytest.approx((ahead - behind) / (2 * h), abs=1e-8), (q, joint)


def test_far_targets_and_partial_tasks_have_exact_derivatives():
    rng, h = np.random.default_rng(5), 1e-6
    for coordinates in (robot().coordinates, ("x", "y", "z"), ("x", "z", "rx", "ry")):
        seen = Kinematics(replace(robot(), coordinates=coordinates)).relative_to(FRAME)
        for q in postures(2):
            target = by_pinocchio(q) * pin.exp6(0.4 * rng.normal(size=6))
            _, derivative = seen.difference_derivative(q, target)
            for joint in range(14):
                step = np.zeros(14)
                step[joint] = h
                ahead, behind = (seen.difference(q + s, target)[0] for s in (step, -step))
                found = (ahead - behind) / (2 * h)
                assert derivative[:, joint] == pytest.approx(found, abs=2e-8), (q, joint)


def test_a_tool_and_constraints_stay_with_the_frame():
    tool = (0.01, 0.02, 0.3), (0.0, 0.6, 0.0, 0.8)
    plain = Kinematics(robot())
    same = JointRelation("same", (("left_1", 1.0), ("right_1", -1.0)), 0.0)
    relation = LinearConstraint(same, plain.description.joint_names)
    for made in (
        plain.with_tool(*tool).constrained([relation]).relative_to(FRAME),
        plain.relative_to(FRAME).constrained([relation]).with_tool(*tool),
    ):
        q = np.linspace(-1.0, 1.0, 14)
        expected = by_pinocchio(q) * pin.SE3(Rotation.from_quat(tool[1]).as_matrix(), np.array(tool[0]))
        assert made.tool_pose(q)[1] == pytest.approx(expected.translation, abs=1e-12)
        assert made.rows == 7
        assert made.world.tool_pose(q)[1] == pytest.approx(plain.with_tool(*tool).tool_pose(q)[1], abs=1e-15)


def test_rows_are_scaled_by_both_arms_and_no_view_is_made_twice():
    plain = Kinematics(robot())
    seen, both = plain.relative_to(FRAME), plain.description.lever + plain.description.lever_to("left_hand")
    assert seen is plain.relative_to(replace(FRAME))
    assert seen.row_scale[0] == pytest.approx(1 / both)
    with pytest.raises(KeyError):
        plain.relative_to(replace(FRAME, link="nowhere"))


def test_joints_that_follow_others_have_their_part_in_the_relative_jacobian():
    follows = '<mimic joint="left_2" multiplier="-0.5" offset="0.2"/>\n    <limit lower="0.08726646259971647"'
    text = URDF.replace('<limit lower="0.08726646259971647"', follows, 1)
    led = read_urdf(text, "torch", carriers=("left_hand",))
    assert led.joint_names == tuple(name for name in LEFT + RIGHT if name != "left_4")
    seen, h = Kinematics(led).relative_to(FRAME), 1e-6

    def by_verifier(q):
        found = link_poses(led, q[None], ("left_hand", "torch"))
        hand, torch = (pin.SE3(found[name][1][0], found[name][0][0]) for name in ("left_hand", "torch"))
        inside = pin.SE3(Rotation.from_quat(FRAME.orientation).as_matrix(), np.array(FRAME.position))
        return (hand * inside).actInv(torch)

    for q in np.random.default_rng(3).uniform(-1.5, 1.5, (4, 13)):
        here = by_verifier(q)
        left, jacobian = seen.difference(q, here)
        assert left == pytest.approx(np.zeros(6), abs=1e-9)
        for joint in range(13):
            step = np.zeros(13)
            step[joint] = h
            ahead, behind = (pin.log6(here.actInv(by_verifier(q + s))).vector for s in (step, -step))
            assert jacobian[:, joint] == pytest.approx((ahead - behind) / (2 * h), abs=1e-8), (q, joint)
