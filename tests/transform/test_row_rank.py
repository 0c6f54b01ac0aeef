"""How much of a tool pose joints can move: at nearly all postures, whatever the posture at hand."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.slowdown.model import Model
from irlx.robot.limits import JointLimits
from irlx.robot.pose_targets import PoseTargets
from irlx.transform.row_rank import independent_rows, usual_rank

pytestmark = pytest.mark.req("TRF-15")

ELBOW = 3


def moving_but(n: int, *standing: int) -> np.ndarray:
    return ~np.isin(np.arange(n), standing)


def jacobian_at(arm, q: np.ndarray) -> np.ndarray:
    return np.array(arm.kinematics.difference(q, arm.pose(q))[1])


def test_the_rank_of_joints(arm7, koch11) -> None:
    """Without its elbow an arm with spherical shoulder and wrist lacks one coordinate, else none."""
    for joint in range(7):
        assert usual_rank(arm7.kinematics, arm7.q, moving_but(7, joint)) == (5 if joint == ELBOW else 6)
    assert usual_rank(arm7.kinematics, arm7.q, moving_but(7)) == 6
    assert usual_rank(arm7.kinematics, arm7.q, moving_but(7, 0, ELBOW)) == 5
    assert usual_rank(arm7.kinematics, arm7.q, ~moving_but(7, 0, 6)) == 2
    assert usual_rank(arm7.kinematics, arm7.q, np.zeros(7, dtype=bool)) == 0
    assert usual_rank(koch11.kinematics, koch11.q, moving_but(11)) == 6
    assert usual_rank(koch11.kinematics, koch11.q, moving_but(11, 0, 2, 4, 6)) == 6


def test_a_singular_posture_does_not_change_the_rank(arm7) -> None:
    """All at zero the arm is stretched out, and lacks two coordinates there."""
    stretched = np.zeros(7)
    assert np.linalg.matrix_rank(jacobian_at(arm7, stretched), tol=1e-9) < 5
    assert usual_rank(arm7.kinematics, stretched, moving_but(7)) == 6
    assert usual_rank(arm7.kinematics, stretched, moving_but(7, ELBOW)) == 5


def test_independent_rows_have_the_null_space_of_all(arm7) -> None:
    rng = np.random.default_rng(2)
    moving = moving_but(7, ELBOW)
    for _ in range(50):
        q = rng.uniform(-2.5, 2.5, 7)
        jacobian = jacobian_at(arm7, q)[:, moving]
        rows = independent_rows(jacobian, arm7.kinematics.row_scale, 5) @ jacobian
        assert rows.shape == (5, 6)
        along = np.linalg.svd(rows)[2][-1]
        assert np.max(np.abs(jacobian @ along)) < 1e-13
        assert np.array_equal(independent_rows(jacobian, arm7.kinematics.row_scale, 6), np.eye(6))


def test_many_jacobians_at_once_give_the_rows_of_each(arm7) -> None:
    rng, scale = np.random.default_rng(3), arm7.kinematics.row_scale
    moving = moving_but(7, ELBOW)
    several = np.array([jacobian_at(arm7, rng.uniform(-2.5, 2.5, 7))[:, moving] for _ in range(9)])
    together = independent_rows(several, scale, 5)
    assert together.shape == (9, 5, 6)
    for rows, jacobian in zip(together, several, strict=True):
        np.testing.assert_allclose(rows, independent_rows(jacobian, scale, 5), rtol=0, atol=1e-12)
    assert independent_rows(several, scale, 6).shape == (9, 6, 6)


def test_postures_come_onto_a_pose_that_joints_can_reach_although_their_rows_depend(arm7) -> None:
    """The way of the joints that may move is the W-shortest, up to its own second order."""
    moving = moving_but(7, ELBOW)
    model = Model(arm7.kinematics, JointLimits.unlimited(7), arm7.weights, moving)
    rng = np.random.default_rng(4)
    on = np.array([np.where(moving, rng.uniform(-2.5, 2.5, 7), arm7.q) for _ in range(40)])
    on = on[np.abs(np.sin(on[:, 5])) > 0.1]
    off = on + 1e-4 * rng.normal(size=on.shape) * moving
    targets = PoseTargets(*arm7.kinematics.tool_poses(on))
    found = model.onto_path(off, targets, 3).q
    assert np.array_equal(found[:, ELBOW], on[:, ELBOW])
    for row, start, target in zip(found, off, targets, strict=True):
        assert np.max(np.abs(arm7.kinematics.difference(row, target)[0])) < 1e-13
        along = np.linalg.svd(jacobian_at(arm7, row)[:, moving])[2][-1]
        assert abs(along @ (arm7.weights * (row - start))[moving]) < 1e-6
