"""Tasks of fewer than six coordinates, and conditions between joints: differences and closed forms."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from irlx.cell.load import load_cell
from irlx.robot.description import COORDINATES
from irlx.robot.equality import Constraint, LinearConstraint
from irlx.robot.kinematics import Kinematics
from irlx.robot.relation import JointRelation
from irlx.robot.task import Task, partial_difference, pose_errors

SUBSETS = [part for size in (1, 2, 3, 5) for part in combinations(COORDINATES, size)]
LINKS = [0.4, 0.3, 0.25, 0.15]


def robot(tmp_path: Path, model: str):
    path = tmp_path / "cell.toml"
    path.write_text(f'[robot]\nmodel = "{model}"\n', encoding="utf-8")
    return load_cell(path).robot


def planar_pose(q: np.ndarray) -> tuple[float, float, float]:
    angles = np.cumsum(q)
    return float(LINKS @ np.cos(angles)), float(LINKS @ np.sin(angles)), float(angles[-1])


def random_pose(rng: np.random.Generator, size: float) -> pin.SE3:
    turn = rng.normal(size=3)
    angle = rng.choice([0.0, 1e-9, 0.3, 2.0, 3.1]) * size
    return pin.SE3(pin.exp3(angle * turn / np.linalg.norm(turn)), rng.normal(size=3) * size)


@pytest.mark.req("TRF-21")
@pytest.mark.parametrize("seed", range(12))
def test_the_matrix_of_a_part_is_its_derivative_however_far_the_rest_is(tmp_path, seed: int) -> None:
    """Central differences of the coordinates along random joints, near and far from the target."""
    kinematics, rng = Kinematics(robot(tmp_path, "arm7")), np.random.default_rng(seed)
    q, step = rng.uniform(-2.0, 2.0, 7), 1e-6
    _, jacobian = kinematics.tool_difference(q, pin.SE3.Identity())
    pose = kinematics.target(*kinematics.tool_pose(q))
    target = pose * random_pose(rng, float(rng.choice([1e-8, 0.1, 0.9])))
    ahead, behind = (
        [kinematics.target(*kinematics.tool_pose(q + side * joint)) for joint in np.eye(7)]
        for side in (step, -step)
    )
    for coordinates in SUBSETS:
        task = Task(coordinates)
        _, matrix = partial_difference(task, pose, jacobian, target)
        moved = [
            partial_difference(task, one, jacobian, target)[0]
            - partial_difference(task, other, jacobian, target)[0]
            for one, other in zip(ahead, behind, strict=True)
        ]
        slopes = -np.transpose(moved) / (2.0 * step)
        np.testing.assert_allclose(matrix, slopes, atol=2e-8, err_msg=str(coordinates))


@pytest.mark.req("TRF-21")
def test_coordinates_that_are_met_are_met_whatever_the_free_ones_are() -> None:
    """A tool turned about its own axis by any angle misses nothing but that turn."""
    task, whole = Task(COORDINATES[:5]), Task()
    for angle in (0.0, 1e-12, 1.0, -2.5, np.pi):
        turned = pin.SE3(pin.exp3(np.array([0.0, 0.0, angle])), np.zeros(3))
        left, _ = partial_difference(task, pin.SE3.Identity(), np.zeros((6, 0)), turned)
        np.testing.assert_allclose(left, 0.0, atol=1e-15)
        left, _ = partial_difference(whole, pin.SE3.Identity(), np.zeros((6, 0)), turned)
        assert np.linalg.norm(left) == pytest.approx(abs(angle))


@pytest.mark.req("TRF-21")
@pytest.mark.parametrize("seed", range(5))
def test_a_planar_arm_in_closed_form(tmp_path, seed: int) -> None:
    kinematics, rng = Kinematics(robot(tmp_path, "planar4")), np.random.default_rng(seed)
    q = rng.choice([0.0, 1.0], size=4) * rng.uniform(-2.0, 2.0, 4)
    x, y, angle = planar_pose(q)
    rotation, position = kinematics.tool_pose(q)
    np.testing.assert_allclose(position, [x, y, 0.0], atol=1e-15)
    np.testing.assert_allclose(rotation, pin.exp3(np.array([0.0, 0.0, angle])), atol=1e-15)
    turn, shift = rng.uniform(-3.0, 3.0), rng.normal(size=2)
    target = pin.SE3(
        pin.exp3(np.array([0.0, 0.0, angle + turn])), np.array([x + shift[0], y + shift[1], 0.0])
    )
    left, _ = kinematics.difference(q, target)
    back = pin.exp3(np.array([0.0, 0.0, -angle]))[:2, :2] @ shift
    np.testing.assert_allclose(left, [*back, turn], atol=1e-14)
    assert kinematics.rows == 3
    assert kinematics.immovable.coordinates == ("z", "rx", "ry")


@pytest.mark.req("TRF-21")
def test_nothing_is_immovable_where_the_task_is_whole(tmp_path) -> None:
    assert Kinematics(robot(tmp_path, "arm7")).immovable.size == 0


@pytest.mark.req("TRF-21")
def test_errors_of_poses_count_what_the_task_counts() -> None:
    wanted = np.eye(3)[None], np.zeros((1, 3))
    tilted = pin.exp3(np.array([0.3, 0.0, 0.0]))[None], np.array([[0.0, 0.2, 0.1]])
    distance, angle = pose_errors(Task(), wanted, tilted)
    np.testing.assert_allclose([*distance, *angle], [np.hypot(0.2, 0.1), 0.3])
    distance, angle = pose_errors(Task(("x", "ry", "rz")), wanted, tilted)
    np.testing.assert_allclose([*distance, *angle], [0.0, 0.0], atol=1e-15)
    distance, angle = pose_errors(Task(("x", "y", "rx")), wanted, tilted)
    # Seen from the tilted tool the way to the origin has y = -(0.2 cos 0.3 + 0.1 sin 0.3).
    np.testing.assert_allclose([*distance, *angle], [0.2 * np.cos(0.3) + 0.1 * np.sin(0.3), 0.3])


class Circle(Constraint):
    """q1^2 + q2^2 = 1: a condition that is no straight line."""

    name = "circle"

    def residual(self, q: np.ndarray) -> np.ndarray:
        return np.array([0.5 * (q[0] ** 2 + q[1] ** 2 - 1.0)])

    def derivative(self, q: np.ndarray) -> np.ndarray:
        row = np.zeros((1, q.size))
        row[0, :2] = q[:2]
        return row


@pytest.mark.req("TRF-12")
@pytest.mark.parametrize("model", ["arm7", "planar4"])
def test_rows_of_constraints_follow_those_of_the_tool(tmp_path, model: str) -> None:
    plain = Kinematics(robot(tmp_path, model))
    n = plain.joints
    relation = JointRelation("pair", (("joint_3", 2.0), ("joint_1", -1.0)), 0.25)
    kinematics = plain.constrained([LinearConstraint(relation, plain.description.joint_names), Circle()])
    rng = np.random.default_rng(3)
    q, target = rng.uniform(-1.0, 1.0, n), pin.SE3.Identity()
    left, matrix = kinematics.difference(q, target)
    bare, rows = plain.difference(q, target)
    tool = plain.rows
    np.testing.assert_array_equal(left[:tool], bare)
    np.testing.assert_array_equal(matrix[:tool], rows)
    np.testing.assert_allclose(left[tool:], [0.25 - 2.0 * q[2] + q[0], 0.5 - 0.5 * (q[0] ** 2 + q[1] ** 2)])
    for joint in range(n):
        step = np.eye(n)[joint] * 1e-6
        behind, ahead = (kinematics.difference(q + side, target)[0] for side in (-step, step))
        slope = (behind - ahead) / 2e-6
        exact = -kinematics.difference_derivative(q, target)[1]
        np.testing.assert_allclose(matrix[tool:, joint], slope[tool:], atol=1e-9)
        np.testing.assert_allclose(exact[:, joint], slope, atol=1e-8)
    assert kinematics.row_names == (*plain.task.coordinates, "pair", "circle")
    np.testing.assert_allclose(kinematics.row_scale[tool:], 1.0)
    np.testing.assert_allclose(kinematics.row_scale[: plain.task.linear], 1.0 / plain.description.reach)
    sizes = kinematics.sizes(left)
    assert sizes.condition == pytest.approx(np.max(np.abs(left[tool:])))
    assert sizes.distance == pytest.approx(np.linalg.norm(left[: plain.task.linear]))
