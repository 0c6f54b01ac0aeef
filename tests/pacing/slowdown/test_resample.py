"""Rows at given ways: on their poses to rounding, and as the curve has them."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.resample import resample
from machines import least_motion, machine
from slow_cases import WAYS, free_rows, grid_of

pytestmark = pytest.mark.req("MOT-20")

robots = pytest.mark.parametrize("name", ["arm7", "koch11"])


def curve_of(name: str) -> JointCurve:
    return JointCurve(grid_of(name).s, free_rows(name))


def ways(name: str, rows: int = 200) -> np.ndarray:
    s = grid_of(name).s
    return np.append(np.sort(np.random.default_rng(0).uniform(0.0, s[-1], rows)), s[-1])


def path_of(name: str):
    return machine(name).line(WAYS[name], (0.1, -0.2, 0.15))


@robots
def test_rows_are_on_their_poses_to_rounding(name: str) -> None:
    s = ways(name)
    poses = path_of(name).poses(s)
    q = resample(machine(name).model(machine(name).unlimited()), curve_of(name), s, poses)
    assert max(machine(name).errors(q, poses)) < 1e-12 * max(1.0, np.abs(poses.position).max())


@robots
def test_rows_move_no_further_from_the_curve_than_its_own_error(name: str) -> None:
    curve, s = curve_of(name), ways(name)
    q = resample(machine(name).model(machine(name).unlimited()), curve, s, path_of(name).poses(s))
    assert np.max(np.abs(q - curve.at(s))) < 1e-6


@robots
def test_a_curve_that_is_on_the_path_is_left_as_it_is(name: str) -> None:
    """The knots themselves lie on their poses: nothing moves but by rounding."""
    robot, s = machine(name), grid_of(name).s
    poses = path_of(name).poses(s[1:])
    knots = np.vstack([robot.start, least_motion(robot, poses, robot.start)])
    q = resample(robot.model(robot.unlimited()), JointCurve(s, knots), s, path_of(name).poses(s))
    np.testing.assert_allclose(q, knots, atol=1e-12)


@robots
def test_the_last_row_is_the_last_knot_to_the_bit(name: str) -> None:
    s = ways(name)
    q = resample(machine(name).model(machine(name).unlimited()), curve_of(name), s, path_of(name).poses(s))
    assert np.all(q[-1] == free_rows(name)[-1])


def test_frozen_joints_keep_their_bits() -> None:
    robot, s = machine("koch11"), ways("koch11")
    curve = JointCurve(grid_of("koch11").s, np.where(np.arange(11) == 4, robot.start, free_rows("koch11")))
    q = resample(robot.model(robot.unlimited(), (4,)), curve, s, path_of("koch11").poses(s))
    assert np.all(q[:, 4] == robot.start[4])


def test_a_hair_beyond_a_limit_is_taken_back_and_the_others_correct() -> None:
    """The limit is put through the middle of what correction moves: rows stay inside and on the path."""
    robot, s = machine("arm7"), ways("arm7")
    poses = path_of("arm7").poses(s)
    exact = resample(robot.model(robot.unlimited()), curve_of("arm7"), s, poses)
    joint = 2
    upper = np.full(7, np.inf)
    upper[joint] = exact[:, joint].max() - 1e-7
    lim = robot.unlimited().with_pair("position", -upper, upper)
    free = exact[:, joint] <= upper[joint]
    assert not np.all(free)
    inside = curve_of("arm7")
    held = JointCurve(inside.s, np.where(np.arange(7) == joint, np.minimum(inside.q, upper[joint]), inside.q))
    q = resample(robot.model(lim), held, s[:-1], path_of("arm7").poses(s[:-1]))
    assert np.all(q[:, joint] <= upper[joint])
    assert max(robot.errors(q, path_of("arm7").poses(s[:-1]))) < 1e-9
