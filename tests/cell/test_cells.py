"""Cells that are right: units, forms of limits, packaged defaults, frames, robots of one's own."""

from math import inf, radians

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

START = "start = [0, -75, -102, 146, -80, -8, 55, 24, 106, -400, 58]\n"
WITHOUT_ACCELERATION = "IRL621"


@pytest.mark.req("CELL-04")
def test_packaged_defaults(cell, koch):
    found = cell(koch)
    assert found.model == "koch11"
    assert found.robot.tip == "tcp"
    assert found.robot.joint_names == tuple(f"joint_{number}" for number in range(1, 12))
    assert found.weights.tolist() == [11, 10, 9, 8, 7, 6, 5, 4, 3, 5, 1]
    assert found.start[1] == pytest.approx(radians(-75), abs=1e-11)
    assert found.start[9] == pytest.approx(-0.462314722)
    assert not np.isfinite(found.limits.speed_upper).any()
    assert not np.isfinite(found.limits.acceleration_lower).any()
    assert np.isfinite(found.limits.position_lower).all()
    assert found.limits.position_upper[9] == pytest.approx(0.7)
    assert found.tick_ns == 10_000_000


@pytest.mark.req("CELL-04")
def test_what_a_cell_gives_replaces_the_packaged_value_only(cell, koch):
    bare = cell(koch)
    speed = "[robot.limits]\nspeed = [10, 20, 30, 40, 50, 60, 70, 80, 90, 100, 110]\n"
    found = cell(koch + START + speed)
    assert found.start == pytest.approx(
        [*np.radians([0, -75, -102, 146, -80, -8, 55, 24, 106]), -0.4, radians(58)]
    )
    assert found.weights.tolist() == bare.weights.tolist()
    assert found.limits.position_lower.tolist() == bare.limits.position_lower.tolist()
    assert found.limits.speed_upper == pytest.approx([*np.radians(range(10, 100, 10)), 0.1, radians(110)])
    assert found.limits.speed_lower.tolist() == (-found.limits.speed_upper).tolist()


def test_motion_defaults(cell, koch):
    motion = "[motion]\ntick_ms = 0.25\nspeed = 1000\nacc = 2000.5\nspeed_ori = 45\nspeed_ptp = 50\n"
    found = cell(koch + motion)
    assert found.tick_ns == 250_000
    assert (found.motion.speed, found.motion.acc, found.motion.speed_ori) == (1000.0, 2000.5, 45.0)
    assert (found.motion.acc_ori, found.motion.speed_ptp, found.motion.acc_ptp) == (180.0, 50.0, 100.0)


@pytest.mark.req("CELL-03")
def test_a_robot_of_ones_own(cell, chain):
    found = cell("[robot]\nmodel = 'own.urdf'\n", own=chain(7, slides=(2, 5)))
    assert found.robot.joint_names == ("j1", "j2", "j3", "j4", "j5", "j6", "j7")
    assert found.robot.tip == "link7"
    assert found.start.tolist() == [0.0] * 7
    assert found.weights.tolist() == [7, 6, 5, 4, 3, 2, 1]
    assert found.limits.position_upper.tolist() == [2.0] * 7
    assert found.limits.speed_lower.tolist() == [-1.5] * 7


@pytest.mark.req("CELL-03")
def test_the_model_is_relative_to_the_cell_file(cell, chain, tmp_path, monkeypatch):
    (tmp_path / "models").mkdir()
    (tmp_path / "models" / "own.urdf").write_text(chain(6))
    monkeypatch.chdir("/")
    assert len(cell("[robot]\nmodel = 'models/own.urdf'\n").robot.axes) == 6


@pytest.mark.parametrize(
    ("entry", "turn", "slide"),
    [
        ("90", (-90, 90), (-90, 90)),
        ("[-30, 60]", (-30, 60), (-30, 60)),
        ("[0, 0]", (0, 0), (0, 0)),
        ("false", (-inf, inf), (-inf, inf)),
        ("0.0", (0, 0), (0, 0)),
    ],
)
@pytest.mark.parametrize("kind", ["position", "speed", "acceleration"])
def test_forms_of_limits(cell, chain, kind, entry, turn, slide):
    entries = ", ".join([entry] * 6)
    found = cell(f"[robot]\nmodel = 'own.urdf'\n[robot.limits]\n{kind} = [{entries}]\n", own=chain(6))
    lower, upper = found.limits.pair(kind)
    assert (lower[0], upper[0]) == pytest.approx(tuple(np.radians(turn)))
    assert (lower[1], upper[1]) == pytest.approx(tuple(np.array(slide) * 1e-3))


@pytest.mark.parametrize("kind", ["position", "speed", "acceleration"])
def test_a_limit_of_zero_is_a_limit(cell, chain, kind):
    found = cell(f"[robot]\nmodel = 'own.urdf'\n[robot.limits]\n{kind} = [0, 0, 0, 0, 0, 0]\n", own=chain(6))
    assert found.limits.pair(kind)[1].tolist() == [0.0] * 6


@pytest.mark.parametrize("kind", ["position", "speed", "acceleration"])
def test_no_limits_of_a_kind(cell, chain, kind):
    found = cell(f"[robot]\nmodel = 'own.urdf'\n[robot.limits]\n{kind} = false\n", own=chain(6))
    lower, upper = found.limits.pair(kind)
    assert lower.tolist() == [-inf] * 6
    assert upper.tolist() == [inf] * 6


def test_locked_joints_leave_the_robot(cell, chain):
    found = cell("[robot]\nmodel = 'own.urdf'\nlocked = { j2 = 250, j7 = 90 }\n", own=chain(8))
    assert found.robot.joint_names == ("j1", "j3", "j4", "j5", "j6", "j8")
    assert found.robot.locked == pytest.approx({"j2": 0.25, "j7": radians(90)})
    assert found.weights.tolist() == [6, 5, 4, 3, 2, 1]


def test_a_joint_that_mimics_another_may_be_locked(cell, chain):
    mimicking = chain(7).replace(
        '</joint><link name="link4"/>', '<mimic joint="j1"/></joint><link name="link4"/>'
    )
    found = cell("[robot]\nmodel = 'own.urdf'\nlocked = { j3 = 5 }\n", own=mimicking)
    assert found.robot.joint_names == ("j1", "j2", "j4", "j5", "j6", "j7")


def test_a_locked_joint_of_a_packaged_robot(cell, koch):
    whole, found = cell(koch), cell(koch + "locked = { joint_1 = 0, joint_10 = 3 }\n")
    assert found.robot.joint_names == whole.robot.joint_names[1:9] + whole.robot.joint_names[10:]
    assert found.weights.tolist() == [10, 9, 8, 7, 6, 5, 4, 3, 1]
    assert found.start.tolist() == [*whole.start[1:9], whole.start[10]]


def test_another_tip_of_a_packaged_robot(cell, koch):
    whole, found = cell(koch), cell(koch + "tip = 'arm_9'\n")
    assert len(found.robot.axes) < 11
    assert found.weights.tolist() == whole.weights.tolist()[: len(found.robot.axes)]


@pytest.mark.parametrize(
    "rpy", [(0, 0, 0), (90, 0, 0), (0, 90, 0), (0, 0, 90), (10, 20, 30), (180, -90, 45), (-400, 500, 3)]
)
def test_frames_turn_about_fixed_axes(cell, koch, rpy):
    found = cell(koch + f"[frames]\nfixture = {{ xyz = [600, 0, -2.5], rpy = {list(rpy)} }}\nhere = {{}}\n")
    w, x, y, z = found.frames["fixture"].quaternion
    expected = Rotation.from_euler("xyz", rpy, degrees=True)
    assert (Rotation.from_quat([x, y, z, w]).inv() * expected).magnitude() < 1e-14
    assert found.frames["fixture"].position == (600.0, 0.0, -2.5)
    assert found.frames["here"].position == (0.0, 0.0, 0.0)
    assert found.frames["here"].quaternion == (1.0, 0.0, 0.0, 0.0)


@pytest.mark.parametrize("value", ["-180", "180"])
def test_a_start_on_its_limit_is_inside(cell, koch, value):
    start = START.replace("[0,", f"[{value},", 1)
    position = "[180, [-150, 0], [-180, 0], [0, 180], [-180, 0], [-180, 0], 180, 60, 180, 500, 60]"
    found = cell(koch + start + f"[robot.limits]\nposition = {position}\n")
    assert found.start[0] == radians(float(value))


def test_warnings(cell, koch):
    limits = "[robot.limits]\nacceleration = [1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n"
    assert [d.code for d in cell(koch).warnings] == [WITHOUT_ACCELERATION]
    assert cell(koch + limits).warnings == ()
