"""Plain facts of a robot: fingerprint, reach, limits as data, and what rounding may add."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from irlx.promises import rounding_allowance
from irlx.robot import urdf
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.urdf import read_urdf
from irlx.robot.urdf_values import RobotModelError

TEXT = """<robot name="two"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="j1" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" velocity="2"/></joint>
<joint name="j2" type="prismatic"><parent link="b"/><child link="c"/><origin xyz="3 0 4"/><axis xyz="0 1 0"/>
<limit lower="-0.5" upper="0.25" velocity="2"/></joint>
<joint name="tool" type="fixed"><parent link="c"/><child link="d"/><origin xyz="0 0 2"/></joint></robot>"""


def changed(**changes: object):
    robot = read_urdf(TEXT)
    return replace(robot, joints=(robot.joints[0], replace(robot.joints[1], **changes), robot.joints[2]))


@pytest.mark.parametrize("change", [{"lower": -9.0}, {"upper": 9.0}, {"speed": 0.1}])
def test_fingerprint_ignores_limits(change: dict) -> None:
    assert changed(**change).fingerprint == read_urdf(TEXT).fingerprint


@pytest.mark.parametrize(
    "change", [{"xyz": (3.0, 0.0, 4.000000001)}, {"rpy": (0.0, 1e-9, 0.0)}, {"axis": (0.0, -1.0, 0.0)}]
)
def test_fingerprint_changes_with_geometry(change: dict) -> None:
    assert changed(**change).fingerprint != read_urdf(TEXT).fingerprint


def test_fingerprint_changes_with_tip_and_locked_value() -> None:
    found = {
        read_urdf(TEXT).fingerprint,
        read_urdf(TEXT, tip="c").fingerprint,
        read_urdf(TEXT, locked={"j2": 0.1}).fingerprint,
        read_urdf(TEXT, locked={"j2": 0.2}).fingerprint,
    }
    assert len(found) == 4


def test_fingerprint_is_the_same_in_another_process() -> None:
    """Streams carry it, so neither hash seeds nor the layout of the file may enter it."""
    code = "import sys; from irlx.robot.urdf import read_urdf; print(read_urdf(sys.argv[1]).fingerprint)"
    environment = {**os.environ, "PYTHONHASHSEED": "12345", "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", code, TEXT.replace("\n", "  ")]
    found = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert found.stdout.strip() == read_urdf(TEXT).fingerprint


@pytest.mark.req("TRF-20")
def test_reach_bounds_the_distance_of_the_tool_from_the_first_axis() -> None:
    robot = read_urdf(TEXT)
    kinematics = Kinematics(robot)
    rng = np.random.default_rng(1)
    first_axis = np.array([0.0, 0.0, 1.0])
    for _ in range(200):
        q = np.array([rng.uniform(-1, 1), rng.choice([-0.5, 0.25, rng.uniform(-0.5, 0.25)])])
        _, position = kinematics.tool_pose(q)
        assert np.linalg.norm(position - first_axis) <= robot.reach + 1e-12
    assert robot.reach == pytest.approx(5.0 + 2.0 + 0.5)


def test_locked_joint_is_no_axis_and_stays_at_its_value() -> None:
    robot = read_urdf(TEXT, locked={"j2": 0.2})
    assert robot.joint_names == ("j1",)
    _, position = Kinematics(robot).tool_pose(np.zeros(1))
    assert position == pytest.approx([3.0, 0.2, 7.0], abs=1e-15)


def test_unlimited_limits_bound_nothing_and_a_pair_can_be_replaced() -> None:
    limits = JointLimits.unlimited(3)
    for kind in ("position", "speed", "acceleration"):
        lower, upper = limits.pair(kind)
        assert np.all(lower == -np.inf)
        assert np.all(upper == np.inf)
    narrowed = limits.with_pair("speed", -np.ones(3), 2.0 * np.ones(3))
    assert narrowed.speed_lower.tolist() == [-1.0] * 3
    assert narrowed.speed_upper.tolist() == [2.0] * 3
    assert np.all(narrowed.position_upper == np.inf)
    assert np.all(limits.speed_upper == np.inf)


@pytest.mark.req("MOT-20")
@pytest.mark.parametrize(
    ("largest", "unit"),
    [(3.0, 2.0**-51), (2.0, 2.0**-51), (1.999, 2.0**-52), (-11.5, 2.0**-49), (0.0, 5e-324)],
)
def test_rounding_allowance_is_two_and_four_units_in_the_last_place(largest: float, unit: float) -> None:
    q = np.array([[0.1, largest], [0.0, -0.05]]) if largest else np.zeros((2, 2))
    speed, acceleration = rounding_allowance(q, 0.001)
    assert speed == pytest.approx(2.0 * unit / 0.001, rel=1e-12)
    assert acceleration == pytest.approx(4.0 * unit / 0.001**2, rel=1e-12)


@pytest.mark.req("MOT-20")
def test_rounding_allowance_covers_what_storage_adds() -> None:
    """Exact ramps, rounded to float64, differ from their true differences by no more than allowed."""
    rng = np.random.default_rng(5)
    dt = 0.00025
    for seed in range(50):
        acceleration = Fraction(float(rng.uniform(-10, 10)))
        start = Fraction(float(rng.uniform(-3, 3)))
        times = [Fraction(k) * Fraction(dt) for k in range(6)]
        q = np.array([float(start + acceleration * t * t / 2) for t in times])
        second = np.diff(np.diff(q) / dt) / dt
        _, allowed = rounding_allowance(q, dt)
        excess = np.max(np.abs(second - float(acceleration)))
        assert excess <= allowed, f"seed 5, draw {seed}"


def test_rounding_allowance_of_nothing_is_tiny() -> None:
    assert rounding_allowance(np.zeros((0, 7)), 0.01)[1] < 1e-300


def test_the_lever_leaves_out_the_strokes_that_carry_the_first_turning_axis() -> None:
    """Of the robot above, which turns first, it is the reach; behind a rail of 3 m still that."""
    own = read_urdf(TEXT)
    assert own.lever == own.reach == pytest.approx(5.0 + 2.0 + 0.5)
    rail = """<link name="rail"/><joint name="j0" type="prismatic"><parent link="rail"/><child link="a"/>
<origin xyz="0 0 7"/><axis xyz="1 0 0"/><limit lower="-3" upper="2" velocity="2"/></joint></robot>"""
    on_rail = read_urdf(TEXT.replace("</robot>", rail))
    assert on_rail.reach == pytest.approx(1.0 + own.reach + 3.0)
    assert on_rail.lever == pytest.approx(own.lever)
    only_slides = read_urdf(TEXT.replace('type="revolute"', 'type="prismatic"'))
    assert only_slides.lever == only_slides.reach == pytest.approx(5.0 + 2.0 + 0.5 + 1.0)


def test_a_text_is_taken_apart_once_and_its_robots_share_nothing_that_changes(monkeypatch) -> None:
    read = []
    taken_apart = urdf.ET.fromstring
    monkeypatch.setattr(urdf.ET, "fromstring", lambda text: read.append(text) or taken_apart(text))
    text = TEXT.replace("two", "once")
    first = read_urdf(text)
    first.inertials.clear()
    first.solids["a"] = ()
    locked = read_urdf(text, tip="c", locked={"j2": 0.1})
    assert (locked.tip, locked.locked, dict(locked.solids)) == ("c", {"j2": 0.1}, {})
    assert read == [text]
    broken = text.replace("revolute", "turning")
    for _ in range(2):
        with pytest.raises(RobotModelError, match="turning"):
            read_urdf(broken)
