"""Rows of a link on a path: finite differences, closed forms on lines and circles, what joints can break."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest

from irlx.cell.load import load_cell
from irlx.pacing.moved_constraints import SomeRows, moved_constraints
from irlx.robot.equality import LinearConstraint
from irlx.robot.kinematics import Kinematics
from irlx.robot.link_path import LinkPath
from irlx.robot.path_constraint import PathConstraint
from irlx.robot.relation import JointRelation

pytestmark = pytest.mark.req("TRF-22")

WAVE = ((0.0, 0.0), (0.8, 0.2), (1.6, -0.2), (2.4, 0.3))
RING = tuple((float(np.cos(a)), float(np.sin(a))) for a in np.arange(24) * np.pi / 12)


@cache
def kinematics(model: str) -> Kinematics:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "cell.toml"
        path.write_text(f'[robot]\nmodel = "{model}"\n', encoding="utf-8")
        return Kinematics(load_cell(path).robot)


def on_path(model: str, link: str, points, closed: bool = False, heading: bool = True) -> PathConstraint:
    return PathConstraint(LinkPath("aisle", link, points, closed, heading), kinematics(model))


@pytest.mark.parametrize(
    ("model", "link", "points", "closed"),
    [
        ("mobile9", "platform", WAVE, False),
        ("mobile9", "platform", RING, True),
        ("mobile9", "forearm", WAVE, False),
        ("mobile9", "tool", WAVE, False),
        ("mobile8", "platform", WAVE, False),
        ("gantry9", "mast", RING, True),
        ("snake20", "link_12", ((0.0, 0.3), (1.0, 0.2)), False),
    ],
)
@pytest.mark.parametrize("seed", range(4))
def test_the_derivative_is_exact(model: str, link: str, points, closed: bool, seed: int) -> None:
    """Central differences anywhere the nearest point moves on smoothly: on the path and well off it."""
    constraint, rng = on_path(model, link, points, closed), np.random.default_rng(seed)
    n, step = kinematics(model).joints, 1e-6
    q = rng.uniform(-0.4, 0.4, n)
    left, exact = constraint.rows(q)
    np.testing.assert_array_equal(left, constraint.residual(q))
    np.testing.assert_array_equal(exact, constraint.derivative(q))
    for joint in range(n):
        way = np.eye(n)[joint] * step
        slope = (constraint.residual(q + way) - constraint.residual(q - way)) / (2.0 * step)
        np.testing.assert_allclose(exact[:, joint], slope, rtol=1e-7, atol=1e-8)


def test_on_a_line_and_on_a_circle_it_is_what_the_eye_sees() -> None:
    line = on_path("mobile9", "platform", ((1.0, 0.5), (2.0, 0.5)))
    q = np.zeros(9)
    q[:3] = -3.0, 0.7, 0.2
    np.testing.assert_allclose(line.residual(q), [0.2, 0.2], atol=1e-15)
    ring = on_path("mobile9", "platform", RING, closed=True)
    for angle in np.linspace(-3.0, 3.0, 13):
        q[:3] = 1.02 * np.cos(angle), 1.02 * np.sin(angle), angle + np.pi / 2 + 0.1
        # The spline through 24 points of a circle differs from it by 1e-5. Outside is to the right.
        np.testing.assert_allclose(ring.residual(q), [-0.02, 0.1], atol=3e-4)


def test_the_opposite_way_does_not_keep_a_heading() -> None:
    line = on_path("mobile9", "platform", ((0.0, 0.0), (1.0, 0.0)))
    q = np.zeros(9)
    q[2] = np.pi
    np.testing.assert_allclose(np.abs(line.residual(q)), [0.0, np.pi])


@pytest.mark.parametrize(
    ("frozen", "points", "heading", "kept"),
    [
        ((), WAVE, True, [True, True]),
        ((0, 1, 2), WAVE, True, [False, False]),
        ((0, 1), WAVE, True, [False, True]),
        ((2,), WAVE, True, [True, True]),
        ((0,), WAVE, False, [True]),
        ((0, 1), WAVE, False, [False]),
        ((3, 4, 5, 6, 7, 8), WAVE, True, [True, True]),
        # On a straight line along y a frozen x leaves nothing of the path, and driving turns nobody.
        ((0,), ((0.0, 0.0), (0.0, 1.0)), True, [False, True]),
        ((0, 2), ((0.0, 0.0), (0.0, 1.0)), True, [False, False]),
        ((1,), ((0.0, 0.0), (0.0, 1.0)), True, [True, True]),
    ],
)
def test_equations_rest_with_the_joints_that_could_break_them(frozen, points, heading, kept) -> None:
    constraint = on_path("mobile9", "platform", points, heading=heading)
    robot, q, free = kinematics("mobile9").description, np.zeros(9), np.ones(9, dtype=bool)
    free[list(frozen)] = False
    found = moved_constraints([constraint], robot, q, free)
    assert len(found) == bool(any(kept))
    for one in found:
        left, derivative = one.rows(q)
        np.testing.assert_array_equal(left, constraint.residual(q)[kept])
        np.testing.assert_array_equal(one.residual(q), left)
        np.testing.assert_array_equal(derivative, constraint.derivative(q)[kept])
        np.testing.assert_array_equal(one.derivative(q), derivative)
        assert isinstance(one, SomeRows) == (not all(kept))


def test_a_relation_rests_with_all_of_its_joints() -> None:
    robot = kinematics("mobile9").description
    pair = LinearConstraint(
        JointRelation("pair", (("joint_1", 1.0), ("joint_2", -2.0)), 0.0), robot.joint_names
    )
    q = np.zeros(9)
    for frozen, count in (((), 1), ((3,), 1), ((3, 4), 0), ((4, 5), 1)):
        free = np.ones(9, dtype=bool)
        free[list(frozen)] = False
        assert len(moved_constraints([pair], robot, q, free)) == count
