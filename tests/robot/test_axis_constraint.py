"""The axis of a link along a direction: closed forms, finite differences, and the opposite direction."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from irlx.cell.load import load_cell
from irlx.robot.axis_constraint import AxisConstraint, across
from irlx.robot.axis_direction import AxisDirection
from irlx.robot.kinematics import Kinematics
from irlx.verifier.geometry.link_poses import link_poses

pytestmark = pytest.mark.req("TRF-12")


@cache
def kinematics(model: str) -> Kinematics:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "cell.toml"
        path.write_text(f'[robot]\nmodel = "{model}"\n', encoding="utf-8")
        return Kinematics(load_cell(path).robot)


def unit(vector: np.ndarray) -> tuple[float, float, float]:
    x, y, z = (vector / np.linalg.norm(vector)).tolist()
    return x, y, z


def turned(axis: np.ndarray, angle: float, rng: np.random.Generator) -> np.ndarray:
    """The axis turned by an angle about something at a right angle to it."""
    aside = np.cross(axis, rng.normal(size=3))
    return np.cos(angle) * axis + np.sin(angle) * aside / np.linalg.norm(aside)


@pytest.mark.parametrize("angle", [0.0, 1e-16, 1e-9, 1e-5, 0.99e-4, 1.01e-4, 0.1, 1.5, np.pi / 2, 2.5, 3.14])
@pytest.mark.parametrize(("model", "link"), [("arm7", "forearm_2"), ("koch11", "arm_7"), ("mobile8", "tool")])
def test_what_is_left_is_the_angle_and_its_derivative_exact(model: str, link: str, angle: float) -> None:
    robot = kinematics(model)
    rng = np.random.default_rng([11, round(1e6 * angle)])
    q = rng.uniform(-1.0, 1.0, robot.joints)
    axis = unit(rng.normal(size=3))
    rotation = link_poses(robot.description, q[None], {link})[link][1][0]
    direction = turned(rotation @ axis, angle, rng)
    constraint = AxisConstraint(AxisDirection("level", link, axis, unit(direction)), robot)
    assert np.linalg.norm(constraint.residual(q)) == pytest.approx(angle, abs=1e-15, rel=1e-12)
    step = 1e-6
    # Near the opposite the direction of what is left turns quickly: there the differences are worse.
    near = 1e-8 if angle < 3.0 else 1e-3
    exact = np.array(constraint.derivative(q))
    for joint in range(robot.joints):
        way = np.eye(robot.joints)[joint] * step
        slope = (constraint.residual(q + way) - constraint.residual(q - way)) / (2.0 * step)
        np.testing.assert_allclose(exact[:, joint], slope, rtol=near, atol=1e-8)


def test_the_opposite_direction_does_not_keep_it() -> None:
    """A sine would be zero there: what is left is half a circle, and its derivative is made of numbers."""
    robot, q = kinematics("arm7"), np.array([0.3, -0.4, 0.2, 1.1, 0.5, -0.7, 0.1])
    rotation = link_poses(robot.description, q[None], {"tool"})["tool"][1][0]
    for axis in np.eye(3):
        against = AxisDirection("level", "tool", unit(axis), unit(-rotation @ axis))
        constraint = AxisConstraint(against, robot)
        assert np.linalg.norm(constraint.residual(q)) == pytest.approx(np.pi, abs=1e-15)
        assert np.all(np.isfinite(constraint.derivative(q)))
        assert "180 deg off" in constraint.in_words(q)


def test_newton_leads_to_the_direction_from_far_off() -> None:
    """Half a turn but for a little, and every angle between: short steps end on the direction."""
    robot, rng = kinematics("arm7"), np.random.default_rng(5)
    for angle in np.linspace(0.0, 3.1, 12):
        q = rng.uniform(-1.0, 1.0, 7)
        rotation = link_poses(robot.description, q[None], {"tool"})["tool"][1][0]
        direction = turned(rotation[:, 2], float(angle), rng)
        constraint = AxisConstraint(AxisDirection("level", "tool", (0.0, 0.0, 1.0), unit(direction)), robot)
        for _ in range(40):
            step = -np.linalg.pinv(constraint.derivative(q), rcond=1e-3) @ constraint.residual(q)
            q = q + step * min(1.0, 0.5 / max(float(np.linalg.norm(step)), 1e-300))
        reached = link_poses(robot.description, q[None], {"tool"})["tool"][1][0][:, 2]
        assert np.linalg.norm(reached - direction) <= 1e-12


def test_a_link_that_no_joint_moves_has_no_derivative() -> None:
    robot = kinematics("rail6")
    upright = AxisDirection("level", robot.description.root, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    constraint = AxisConstraint(upright, robot)
    np.testing.assert_allclose(np.linalg.norm(constraint.residual(np.zeros(7))), np.pi / 2)
    np.testing.assert_array_equal(constraint.derivative(np.zeros(7)), np.zeros((2, 7)))


@pytest.mark.parametrize("direction", [*np.eye(3), *-np.eye(3), [1, 1, 1], [1, 1e-16, 0], [0.6, 0.0, -0.8]])
def test_what_lies_across(direction) -> None:
    d = np.array(unit(np.array(direction, dtype=float)))
    frame = np.vstack([across(d), d])
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-15)
