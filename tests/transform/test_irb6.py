"""A 5-axis arm: the inverse transform against its geometry on paper, also with the tool on its side."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from irb6_by_hand import LENGTHS, joint_step, pose, posture, radius
from irlx.cell.load import load_cell
from irlx.robot.kinematics import Kinematics
from irlx.robot.task import framed_difference, partial_difference
from irlx.transform.criteria.posture import Posture
from irlx.transform.measures.dynamic_manipulability import DynamicManipulability
from irlx.transform.measures.manipulability import Manipulability
from irlx.transform.measures.smallest_singular_value import SmallestSingularValue
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import BoundSource, StepBounds
from irlx.transform.tick import TickSolver, TickStatus
from irlx.transform.tick_problem import TickProblem
from long_run import first

pytestmark = pytest.mark.req("TRF-21")

STEPS = 1000
UPRIGHT = np.radians(90.0)
LOWER, UPPER = np.radians([-170, -40, -25, -90, -180]), np.radians([170, 40, 40, 90, 180])


@pytest.fixture(scope="module")
def robot(tmp_path_factory):
    path = tmp_path_factory.mktemp("irb6") / "cell.toml"
    path.write_text('[robot]\nmodel = "irb6"\n', encoding="utf-8")
    return load_cell(path).robot


@pytest.fixture(scope="module")
def arm(robot) -> Kinematics:
    return Kinematics(robot)


def postures(seed: int, count: int) -> np.ndarray:
    """Postures within the limits; many with joints at 0, the roll at +-90 deg or next to it."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(0.9 * LOWER, 0.9 * UPPER, (count, 5))
    q[rng.random((count, 5)) < 0.1] = 0.0
    sides = rng.choice([UPRIGHT, -UPRIGHT, UPRIGHT + 1e-9, 1e-16], count)
    q[:, 4] = np.where(rng.random(count) < 0.4, sides, q[:, 4])
    return q


def solved(kinematics: Kinematics, q: np.ndarray, rotation, position):
    """One tick from q to a pose, with nothing in its way."""
    wide = np.full(5, np.pi)
    source = np.full(5, BoundSource.POSITION, dtype=np.int8)
    bounds = StepBounds(-wide, wide, source, source)
    problem = TickProblem(
        kinematics.target(rotation, position), q, bounds, Posture(np.ones(5), q), np.ones(5, dtype=bool)
    )
    return TickSolver(kinematics, ProxQpSolver()).solve(problem, thorough=False)


def test_poses_are_those_on_paper(arm) -> None:
    for q in postures(1, 50):
        rotation, position = arm.tool_pose(q)
        due = pose(q)
        np.testing.assert_allclose(rotation, due[0], atol=1e-15)
        np.testing.assert_allclose(position, due[1], atol=1e-15)


def test_link_lengths_of_the_cell(tmp_path) -> None:
    """[robot.origins] makes a longer arm of it."""
    (tmp_path / "c.toml").write_text(
        '[robot]\nmodel = "irb6"\n[robot.origins]\nupper_rod = { xyz = [0, 0, 500] }\n'
        "forearm_rod = { xyz = [700, 0, 0] }\njoint_5 = { rpy = [0, 0, 0] }\n",
        encoding="utf-8",
    )
    longer = Kinematics(load_cell(tmp_path / "c.toml").robot)
    lengths = (LENGTHS[0], 0.5, 0.7, LENGTHS[3])
    for q in postures(2, 10):
        for found, due in zip(longer.tool_pose(q), pose(q, lengths), strict=True):
            np.testing.assert_allclose(found, due, atol=1e-15)


@pytest.mark.parametrize("count", first(1, [200, STEPS]))
def test_steps_in_closed_form(arm, count: int) -> None:
    """Displacement and turn of the tool against five joint steps, terms of second order taken off."""
    rng, worst = np.random.default_rng(3), 0.0
    for q in postures(4, count):
        moved, turned = 1e-6 * rng.normal(size=(2, 3))
        rotation, position = pose(q)
        ends = []
        for sign in (1.0, -1.0):
            found = solved(arm, q, pin.exp3(sign * turned) @ rotation, position + sign * moved)
            assert found.solved
            ends.append(found.q)
        step = 0.5 * (ends[0] - ends[1])
        due = joint_step(q, moved, turned)
        worst = max(worst, float(np.max(np.abs(step - due)) / np.max(np.abs(due))))
    print(f"largest difference: {worst:.3g} of the step")
    assert worst < 1e-8


@pytest.mark.parametrize("count", first(1, [200, STEPS]))
def test_poses_along_paths(arm, count: int) -> None:
    """From pose to pose along curves of the joints: where the inverse on paper is, to rounding."""
    worst = 0.0
    for seed in range(5):
        begin, end = 0.5 * postures(10 + seed, 2)
        begin[4], end[4] = np.radians([-100.0, 100.0])
        # Past both sides of the tool and over its middle.
        q = begin
        for share in np.linspace(0.0, 1.0, count // 5):
            wanted = begin + share * (end - begin) + 0.05 * np.sin(7.0 * share + np.arange(5.0))
            rotation, position = pose(wanted)
            found = solved(arm, q, rotation, position)
            assert found.solved
            q = found.q
            worst = max(worst, float(np.max(np.abs(q - posture(rotation, position)))))
    print(f"largest difference: {worst:.3g} rad")
    assert worst < 1e-13


@pytest.mark.parametrize("roll", [90.0, -90.0, 0.0, 37.0])
def test_on_the_circle_about_the_base_only_the_base_turns(arm, roll: float) -> None:
    """Exactly dt1 = ds / L0, all other steps 0: whatever the roll, in one tick of any size."""
    q = np.radians([10.0, -12.0, 9.0, 35.0, roll])
    rotation, position = pose(q)
    for angle in (1e-9, 1e-4, 0.1, -0.5):
        turn = pin.exp3(np.array([0.0, 0.0, angle]))
        found = solved(arm, q, turn @ rotation, turn @ position)
        assert found.solved
        length = radius(q)
        np.testing.assert_allclose(found.q - q, [angle * length / length, 0, 0, 0, 0], atol=2e-15)
        # So the differential decomposition says, too.
        sideways = np.array([-position[1], position[0], 0.0])
        due = joint_step(q, angle * sideways, np.array([0.0, 0.0, angle]))
        np.testing.assert_allclose(due, [angle, 0, 0, 0, 0], atol=1e-16)


def test_rows_in_the_tool_frame_are_singular_on_the_side_those_in_the_wrist_are_not(robot, arm) -> None:
    """det J is as the cosine of the roll in the one, and does not know the roll in the other."""
    own = Kinematics(replace(robot, task_frame=None))
    q = np.radians([10.0, -12.0, 9.0, 35.0, 0.0])
    whole = np.linalg.det(arm.here(q)[1])
    for roll in np.radians([0.0, 30.0, 60.0, 89.0, 90.0, -90.0, 150.0]):
        q[4] = roll
        assert np.linalg.det(arm.here(q)[1]) == pytest.approx(whole, rel=1e-12)
        # Its rows of the tool mix pitch and sideways tilt: position rows turn as a whole.
        assert abs(np.linalg.det(own.here(q)[1])) == pytest.approx(abs(whole * np.cos(roll)), abs=1e-15)


def test_in_the_tool_frame_the_tie_of_the_tools_direction_is_not_seen(robot) -> None:
    """Where the determinant is 0 the pitch is in no row: off the circle about the base there is no step."""
    own = Kinematics(replace(robot, task_frame=None))
    q = np.radians([10.0, -12.0, 9.0, 35.0, 90.0])
    lean = np.radians([10.0, -12.0, 9.0, 36.0, 90.0])
    assert solved(Kinematics(robot), q, *pose(lean)).solved
    found = solved(own, q, *pose(lean))
    assert found.status is not TickStatus.SOLVED or np.max(np.abs(found.q - lean)) > 1e-3
    assert np.linalg.matrix_rank(own.here(q)[1], tol=1e-12) == 4


def test_the_rest_of_a_turn_may_be_as_large_as_it_likes(arm) -> None:
    """A target that leans sideways is met in position, pitch and roll; the lean is all that is left."""
    q = np.radians([10.0, -12.0, 9.0, 35.0, 60.0])
    rotation, position = pose(q)
    n = arm.task_frames(q[None])[0][:, 2]
    for lean in (1e-6, 0.1, 1.0, 2.5):
        target = arm.target(pin.exp3(lean * n) @ rotation, position)
        left, _ = arm.difference(q, target)
        np.testing.assert_allclose(left, 0.0, atol=1e-15)
        np.testing.assert_allclose(arm.left_of(arm.following, q, target), [lean], atol=1e-14)


@pytest.mark.parametrize("seed", range(6))
def test_the_matrix_is_the_derivative_however_far_the_rest_is(robot, seed: int) -> None:
    """Central differences, near and far from the target, for frames before, at and behind the wrist."""
    rng = np.random.default_rng(seed)
    link = ["base_link", "column", "forearm", "wrist", "flange", "tool"][seed]
    kinematics = Kinematics(replace(robot, task_frame=link))
    for size in (1e-8, 0.2, 0.9):
        q = rng.uniform(-1.0, 1.0, 5)
        turn, shift = rng.normal(size=(2, 3)) * size
        target = kinematics.target(*kinematics.tool_pose(q)) * pin.SE3(pin.exp3(turn), shift)
        _, matrix = kinematics.difference(q, target)
        for joint in range(5):
            step = 1e-6 * np.eye(5)[joint]
            ahead, behind = (kinematics.difference(q + s, target)[0] for s in (step, -step))
            np.testing.assert_allclose(matrix[:, joint], (behind - ahead) / 2e-6, atol=2e-8)


def test_in_the_tool_frame_both_forms_agree(robot, arm) -> None:
    rng = np.random.default_rng(8)
    for q in postures(9, 10):
        apart = pin.SE3(pin.exp3(rng.normal(size=3)), rng.normal(size=3))
        target = arm.target(*arm.tool_pose(q)) * apart
        _, jacobian = arm.tool_difference(q, target)
        at = arm.target(*arm.tool_pose(q))
        one = partial_difference(arm.task, at, jacobian, target)
        other = framed_difference(arm.task, at.rotation, at, jacobian, jacobian[3:], target)
        for a, b in zip(one, other, strict=True):
            np.testing.assert_allclose(a, b, atol=1e-12)


def slope(function, q: np.ndarray, h: float = 1e-4) -> np.ndarray:
    """Derivative by q: central differences of fourth order."""
    columns = []
    for step in h * np.eye(q.size):
        one, two = function(q + step) - function(q - step), function(q + 2 * step) - function(q - 2 * step)
        columns.append((8.0 * one - two) / (12.0 * h))
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("link", [None, "column", "forearm", "wrist", "flange"])
@pytest.mark.parametrize("kind", [Manipulability, SmallestSingularValue, DynamicManipulability])
def test_gradients_of_measures_of_its_rows(robot, kind, link: str | None) -> None:
    """The rows turn with the frame: their derivative has a part of that."""
    measure = kind(Kinematics(replace(robot, task_frame=link)))
    rng = np.random.default_rng(21)
    for _ in range(3):
        q = rng.uniform(-0.6, 0.6, 5)
        due = slope(measure.value, q)
        np.testing.assert_allclose(measure.gradient(q), due, atol=1e-7 * max(1.0, np.max(np.abs(due))))


def test_manipulability_does_not_know_the_roll(arm) -> None:
    measure = Manipulability(arm)
    for q in postures(22, 5):
        assert abs(measure.gradient(q)[4]) < 1e-14
        assert measure.value(q) == pytest.approx(abs(np.linalg.det(arm.here(q)[1])) / 1.465**3, rel=1e-9)
