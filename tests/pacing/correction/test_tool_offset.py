"""A correction as six numbers, against SciPy's rotations and differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.pacing.correction.tool_offset import corrected_pose, correction_between, parts, twist_of_rate


def drawn(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    return Rotation.random(random_state=seed).as_matrix(), rng.normal(size=3), 0.8 * rng.normal(size=6)


@pytest.mark.parametrize("seed", range(4))
def test_it_is_a_pose_in_the_frame_of_the_programmed_tool(seed: int) -> None:
    rotation, position, correction = drawn(seed)
    pose = corrected_pose(rotation, position, correction)
    np.testing.assert_allclose(pose.translation, position + rotation @ correction[:3], rtol=0, atol=1e-14)
    turned = rotation @ Rotation.from_rotvec(correction[3:]).as_matrix()
    np.testing.assert_allclose(pose.rotation, turned, rtol=0, atol=1e-14)
    back = correction_between(rotation, position, (pose.rotation, pose.translation))
    np.testing.assert_allclose(back, correction, rtol=0, atol=1e-13)


@pytest.mark.parametrize("seed", range(4))
def test_its_rate_moves_the_tool_as_differences_say(seed: int) -> None:
    """Velocity of the origin and angular velocity, both in the frame of the corrected tool."""
    rotation, position, correction = drawn(seed)
    rate, h = np.random.default_rng(seed + 50).normal(size=6), 1e-6
    ahead, behind = (corrected_pose(rotation, position, correction + side * h * rate) for side in (1, -1))
    now = corrected_pose(rotation, position, correction).rotation
    linear = now.T @ (ahead.translation - behind.translation) / (2 * h)
    angular = Rotation.from_matrix(behind.rotation.T @ ahead.rotation).as_rotvec() / (2 * h)
    np.testing.assert_allclose(
        twist_of_rate(correction) @ rate, np.concatenate([linear, angular]), rtol=0, atol=1e-8
    )


def test_its_two_parts() -> None:
    assert parts(np.array([2.0, 3.0, 6.0, 0.2, 0.3, 0.6])) == pytest.approx((7.0, 0.7))
