"""Lines against own slerp and finite differences: straight, one turn axis, both ends together."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.motion.line import Line
from long_run import first

pytestmark = [pytest.mark.req("MOT-02"), pytest.mark.req("MOT-11")]

SEEDS = first(20, range(40))
X = np.array([1.0, 0.0, 0.0])
EXTENTS = [0.0, 1e-6, 1.0, 20.0]


def random_line(kit, seed: int) -> tuple[Line, np.ndarray, np.ndarray]:
    """Line with special cases mixed in, and the quaternions of its ends."""
    rng = np.random.default_rng(seed)
    p0 = rng.normal(size=3) * rng.choice(EXTENTS)
    p1 = p0 + rng.normal(size=3) * rng.choice([1e-5, 1.0, 20.0])
    a = kit.quaternion(rng)
    axis = rng.choice([0.0, 1.0, -1.0], size=3)
    axis = axis / np.linalg.norm(axis) if np.any(axis) else np.array([0.0, 0.0, 1.0])
    angle = rng.choice([0.0, 1e-16, 1e-5, rng.uniform(0.0, 3.0), np.pi - 1e-3])
    b = kit.multiply(a, np.concatenate([[np.cos(angle / 2)], np.sin(angle / 2) * axis]))
    return Line(p0, kit.matrix(a), p1, kit.matrix(b)), a, b


@pytest.mark.parametrize("seed", SEEDS)
def test_positions_lie_straight_and_evenly(kit, seed: int) -> None:
    line, _, _ = random_line(kit, seed)
    s = np.concatenate([[0.0, line.length], np.random.default_rng(seed).uniform(0.0, line.length, 50)])
    poses = line.poses(s)
    extent = max(1.0, float(np.max(np.abs([line.start_position, line.end_position]))))
    direction = (line.end_position - line.start_position) / line.translation
    away = poses.position - line.start_position
    # A direction out of a short line's ends carries their rounding: compare along the way only.
    across = away - np.outer(away @ direction, direction)
    assert np.max(np.linalg.norm(across, axis=1)) < 1e-12 * extent
    np.testing.assert_allclose(away @ direction, s, atol=1e-12 * extent)


@pytest.mark.parametrize("seed", SEEDS)
def test_orientation_equals_own_slerp(kit, seed: int) -> None:
    line, a, b = random_line(kit, seed)
    shares = np.concatenate([[0.0, 1.0], np.random.default_rng(seed).uniform(0.0, 1.0, 20)])
    rotations = line.poses(shares * line.length).rotation
    for share, rotation in zip(shares, rotations, strict=True):
        np.testing.assert_allclose(
            rotation, kit.matrix(kit.slerp(a, b, share)), atol=2e-12, err_msg=f"{seed}"
        )


@pytest.mark.parametrize("seed", SEEDS)
def test_turn_axis_is_constant(kit, seed: int) -> None:
    line, _, _ = random_line(kit, seed)
    rotations = line.poses(np.linspace(0.0, line.length, 12)).rotation
    total = Rotation.from_matrix(line.start_rotation.T @ line.end_rotation).as_rotvec()
    for k, rotation in enumerate(rotations):
        turned = Rotation.from_matrix(line.start_rotation.T @ rotation).as_rotvec()
        assert np.max(np.abs(turned - k / 11.0 * total)) < 1e-12 * 3.2, f"seed {seed}, step {k}"


@pytest.mark.parametrize("seed", SEEDS)
def test_derivatives_equal_central_differences(kit, seed: int) -> None:
    line, _, _ = random_line(kit, seed)
    h = 1e-4 * line.length
    s = np.linspace(0.1, 0.9, 5) * line.length
    along, turning = line.derivatives(s)
    before, after = line.poses(s - h), line.poses(s + h)
    extent = max(1.0, float(np.max(np.abs(line.end_position))))
    noise = 1e-15 / h
    difference = (after.position - before.position) / (2 * h)
    np.testing.assert_allclose(along, difference, atol=1e-9 + 4 * noise * extent)
    for k in range(5):
        turn = Rotation.from_matrix(after.rotation[k] @ before.rotation[k].T).as_rotvec() / (2 * h)
        np.testing.assert_allclose(turning[k], turn, atol=1e-8 + 4 * noise, err_msg=f"seed {seed}")
    assert np.linalg.norm(turning[0]) == pytest.approx(line.turn_rate, rel=1e-12)


@pytest.mark.parametrize("seed", SEEDS)
def test_last_pose_is_the_target_to_the_last_bit(kit, seed: int) -> None:
    line, _, _ = random_line(kit, seed)
    last = line.poses(np.array([0.5 * line.length, line.length]))
    np.testing.assert_array_equal(last.position[-1], line.end_position)
    np.testing.assert_array_equal(last.rotation[-1], line.end_rotation)


def test_pure_turn_has_its_angle_as_length(kit) -> None:
    start = kit.turned(np.eye(3), [0.3, -0.2, 0.9])
    position = np.array([1.0, -2.0, 0.5])
    line = Line(position, start, position + 1e-10, kit.turned(start, [0.0, 0.8, 0.0]))
    assert line.is_pure_turn
    assert line.length == pytest.approx(0.8, abs=1e-14)
    assert line.turn_rate == pytest.approx(1.0)
    middle = line.poses(np.array([0.4]))
    np.testing.assert_allclose(middle.rotation[0], kit.turned(start, [0.0, 0.4, 0.0]), atol=1e-14)
    np.testing.assert_allclose(middle.position[0], position, atol=1e-10)


@pytest.mark.parametrize("residue", [0.0, 1e-16, 0.9e-9])
def test_nothing_moves_below_a_billionth(kit, residue: float) -> None:
    start = np.array([1.0, 2.0, 3.0])
    line = Line(start, np.eye(3), start + residue * X, kit.turned(np.eye(3), [residue, 0, 0]))
    assert line.is_nothing
    assert not Line(start, np.eye(3), start + 2e-9 * X, np.eye(3)).is_nothing
    assert not Line(start, np.eye(3), start, kit.turned(np.eye(3), [2e-9, 0, 0])).is_nothing


@pytest.mark.parametrize(("short", "defined"), [(0.0, False), (1e-8, False), (0.9e-6, False), (2e-6, True)])
def test_half_a_turn_has_no_axis(kit, short: float, defined: bool) -> None:
    axis = np.array([1.0, -2.0, 2.0]) / 3.0
    line = Line(np.zeros(3), np.eye(3), np.ones(3), kit.turned(np.eye(3), (np.pi - short) * axis))
    assert line.axis_is_defined is defined


@pytest.mark.parametrize("seed", SEEDS[::8])
def test_second_derivatives_are_zero(kit, seed: int) -> None:
    line, _, _ = random_line(kit, seed)
    bend, turn_bend = line.second_derivatives(np.linspace(0.0, line.length, 7))
    np.testing.assert_array_equal(bend, np.zeros((7, 3)))
    np.testing.assert_array_equal(turn_bend, np.zeros((7, 3)))
    assert (line.curvature, line.turn_bend) == (0.0, 0.0)
