"""Cells of a robot with two hands: the packaged one, its other hand, frames that move with a link."""

from __future__ import annotations

from math import radians

import numpy as np
import pinocchio as pin
import pytest

from irlx.blocks.link_frame import LinkFrame
from irlx.cell.errors import CellError
from irlx.cell.joint_names import joint_names
from irlx.cell.packaged import packaged_urdf
from irlx.cell.robot_data import robot_data_folder
from irlx.robot.kinematics import Kinematics

pytestmark = pytest.mark.req("CELL-04", "TRF-23")

DUAL = "[robot]\nmodel = 'dual14'\n"
ONE = DUAL + "hands = []\n"
PIPE = """[frames]
table = { xyz = [600, 0, 0] }
pipe = { link = '%s', xyz = [0, 80, 0], rpy = [-90, 0, 0] }
"""


def fault(cell, text):
    with pytest.raises(CellError) as caught:
        cell(text)
    (found,) = caught.value.diagnostics
    return found


def test_dual14_starts_well(cell):
    found = cell(DUAL)
    assert (len(found.robot.axes), found.robot.tip) == (14, "torch")
    assert found.weights.tolist() == [7, 6, 5, 4, 3, 2, 1] * 2
    assert found.warnings == ()
    assert np.isfinite(found.limits.speed_upper).all()
    assert np.isfinite(found.limits.acceleration_upper).all()
    room = np.minimum(found.start - found.limits.position_lower, found.limits.position_upper - found.start)
    assert room.min() > radians(24)
    rotation, position = Kinematics(found.robot).tool_pose(found.start)
    assert rotation[:, 2] == pytest.approx([0, 0, -1], abs=1e-9)
    assert position == pytest.approx([0.5, -0.02, 0.9], abs=0.01)


def test_dual14_has_primitive_bodies_with_possible_inertias():
    text = packaged_urdf("dual14")
    assert "<mesh" not in text
    bodies = pin.buildModelFromXML(text).inertias[1:]
    assert 30.0 < sum(body.mass for body in bodies) < 200.0
    for body in bodies:
        moments = np.linalg.eigvalsh(body.inertia)
        assert moments[0] > 0.0
        assert moments[2] <= moments[0] + moments[1] + 1e-12


def test_frames_move_with_a_link_or_stand_still(cell):
    found = cell(DUAL + PIPE % "left_hand")
    assert list(found.frames) == ["table"]
    half = np.sqrt(0.5)
    (pipe,) = found.link_frames.values()
    assert (pipe.name, pipe.link, pipe.position) == ("pipe", "left_hand", (0.0, 0.08, 0.0))
    assert pipe.orientation == pytest.approx((-half, 0.0, 0.0, half))
    assert isinstance(pipe, LinkFrame)


def test_a_frame_brings_the_joints_of_its_link(cell, tmp_path):
    alone = cell(ONE)
    assert alone.robot.joint_names == tuple(f"right_{number}" for number in range(1, 8))
    assert np.degrees(alone.start) == pytest.approx([18, 90, -12, 73, 110.79725255, -84.33293046, 25])
    assert joint_names(tmp_path / "cell.toml") == alone.robot.joint_names
    both = cell(ONE + PIPE % "left_hand")
    assert both.robot.joint_names == cell(DUAL).robot.joint_names
    assert (both.start == cell(DUAL).start).all()
    assert joint_names(tmp_path / "cell.toml") == cell(DUAL).robot.joint_names
    part = cell(ONE + PIPE % "left_shoulder")
    assert part.robot.joint_names == ("left_1", *alone.robot.joint_names)
    assert np.degrees(part.start) == pytest.approx([16, 18, 90, -12, 73, 110.79725255, -84.33293046, 25])
    assert joint_names(tmp_path / "cell.toml") == part.robot.joint_names


@pytest.mark.skipif(robot_data_folder() is None, reason="the data package is missing")
def test_other_hands_of_a_named_robot_bring_no_lists(cell):
    found = cell("[robot]\nmodel = 'baxter_left'\nhands = ['right_gripper']\n")
    assert len(found.robot.axes) == 14
    assert found.weights.tolist() == list(range(14, 0, -1))
    assert not found.start.any()


def test_links_that_do_not_exist(cell):
    found = fault(cell, DUAL + PIPE % "left_hnd")
    assert (found.code, found.place.key) == ("IRL643", "frames.pipe.link")
    assert "did you mean 'left_hand'" in found.message
    found = fault(cell, DUAL + "hands = ['left_hand', 'lft_base']\n")
    assert (found.code, found.place.key) == ("IRL643", "robot.hands[2]")


@pytest.mark.parametrize("link", ["torch", "right_flange"])
def test_a_frame_that_the_tool_never_moves_in(cell, link):
    found = fault(cell, DUAL + PIPE % link)
    assert (found.code, found.place.key) == ("IRL647", "frames.pipe.link")


def test_obstacles_do_not_move_with_a_link(cell):
    post = "[[obstacle]]\nname = 'post'\nshape = 'sphere'\nradius = 5\nframe = 'Pipe'\n"
    found = fault(cell, DUAL + PIPE % "left_hand" + post)
    assert (found.code, found.place.key) == ("IRL646", "obstacle[1].frame")
    assert cell(DUAL + PIPE % "left_hand" + post.replace("Pipe", "table")).scene.obstacles
