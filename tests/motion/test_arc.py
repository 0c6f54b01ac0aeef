"""Arcs against circles made from centre, frame and radius, and against finite differences."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.motion.arc import NEAREST_POINTS, Arc, Circle, spread
from irlx.motion.errors import MotionError
from irlx.motion.plan_circle import circle_path
from long_run import first

pytestmark = [pytest.mark.req("MOT-01"), pytest.mark.req("MOT-11")]

SEEDS = first(30, range(60))


@dataclass(frozen=True)
class Truth:
    """A circle from its centre: point(phi) = centre + r (cos phi e1 + sin phi e2)."""

    centre: np.ndarray
    e1: np.ndarray
    e2: np.ndarray
    radius: float

    def points(self, phi) -> np.ndarray:
        phi = np.atleast_1d(phi)[:, None]
        return self.centre + self.radius * (np.cos(phi) * self.e1 + np.sin(phi) * self.e2)


def random_truth(seed: int) -> tuple[Truth, float, float]:
    """A circle with special cases mixed in, and the angles of via and end point."""
    rng = np.random.default_rng(seed)
    axes = np.eye(3) if seed % 5 == 0 else Rotation.random(random_state=seed).as_matrix()
    radius = float(rng.choice([1e-4, 0.1, 1.0, 7.5, 300.0]))
    centre = rng.normal(size=3) * rng.choice([0.0, 1.0, 20.0])
    via, end = np.sort(rng.uniform(0.3, 6.0, 2))
    if seed % 3 == 0:
        via, end = rng.choice([(np.pi / 2, np.pi), (np.pi, 1.5 * np.pi), (1.0, 2 * np.pi - 0.3), (0.2, 0.4)])
    return Truth(centre, axes[:, 0], axes[:, 1], radius), float(via), float(max(end, via + 0.1))


def arc_of(kit, truth: Truth, via: float, end: float, **course) -> Arc:
    start, middle, last = truth.points([0.0, via, end])
    return circle_path(kit.circle(middle, last, **course), np.eye(3), start, kit.place)


def extent_of(truth: Truth) -> float:
    return max(1.0, float(np.max(np.abs(truth.centre))) + truth.radius)


def rounding_of(truth: Truth, via: float, end: float) -> float:
    """What the rounding of the three points' coordinates may move the circle between them, m."""
    start, middle, last = truth.points([0.0, via, end])
    grain = 2.3e-16 * (np.max(np.abs(truth.centre)) + truth.radius)
    return grain * (truth.radius / spread(start, middle, last).height) ** 2


def test_distances_and_the_height_over_the_longest_side() -> None:
    """A triangle of 3, 4 and 5 parts is 2.4 of them high, wherever it lies and however large it is."""
    for scale in (1e-9, 1.0, 1e9):
        corners = scale * Rotation.random(random_state=3).apply(
            [(0.0, 0.0, 0.0), (3.0, 0.0, 0.0), (0.0, 4.0, 0.0)]
        )
        found = spread(*corners)
        sides = found.start_via, found.via_end, found.start_end
        np.testing.assert_allclose(sides, scale * np.array([3.0, 5.0, 4.0]), rtol=1e-13)
        assert found.height == pytest.approx(2.4 * scale, rel=1e-13)


@pytest.mark.parametrize("seed", SEEDS)
def test_positions_equal_the_closed_form(kit, seed: int) -> None:
    truth, via, end = random_truth(seed)
    arc = arc_of(kit, truth, via, end)
    shares = np.concatenate([[0.0, 1.0], np.random.default_rng(seed).uniform(0, 1, 40)])
    bound = 1e-12 * extent_of(truth) + 20 * rounding_of(truth, via, end)
    assert abs(arc.length - truth.radius * end) < bound, f"seed {seed}"
    off = arc.poses(shares * arc.length).position - truth.points(shares * end)
    assert np.max(np.abs(off)) < bound, f"seed {seed}"


@pytest.mark.parametrize(
    "angle", [None, 0.5, np.pi, 2 * np.pi, 5.0, 9 * np.pi, -0.5, -2 * np.pi, -20.0, 700.0]
)
@pytest.mark.parametrize("seed", SEEDS[::6])
def test_radius_and_plane_are_constant(kit, seed: int, angle: float | None) -> None:
    truth, via, end = random_truth(seed)
    arc = arc_of(kit, truth, via, end, angle=angle)
    positions = arc.poses(np.linspace(0.0, arc.length, 301)).position
    circle = arc.circle
    offsets = positions - circle.start - circle.radius * circle.normal
    axis = np.cross(circle.tangent, circle.normal)
    bound = 1e-12 * extent_of(truth)
    assert np.max(np.abs(np.linalg.norm(offsets, axis=1) - circle.radius)) < bound, f"seed {seed}"
    assert np.max(np.abs(offsets @ axis)) < bound, f"seed {seed}"
    # Equal steps of s are equal angles about the centre, in one sense.
    steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    np.testing.assert_allclose(steps, steps[0], atol=4 * bound)


@pytest.mark.parametrize("seed", SEEDS[::4])
@pytest.mark.parametrize("angle", [0.7, 2 * np.pi, 7.0, -1.3, -8.0])
def test_angle_turns_on_from_the_start(kit, seed: int, angle: float) -> None:
    truth, via, end = random_truth(seed)
    arc = arc_of(kit, truth, via, end, angle=angle)
    bound = 1e-12 * extent_of(truth) + 200 * rounding_of(truth, via, end)
    assert arc.length == pytest.approx(truth.radius * abs(angle), abs=bound)
    shares = np.linspace(0.0, 1.0, 23)
    off = arc.poses(shares * arc.length).position - truth.points(shares * angle)
    assert np.max(np.abs(off)) < bound, f"seed {seed}"
    np.testing.assert_array_equal(arc.poses(np.array([arc.length])).position[0], arc.end_position)


@pytest.mark.parametrize("seed", SEEDS[::4])
@pytest.mark.parametrize("rounds", [1, 2, 3, 7, -1, -3, 100])
def test_whole_turns_end_in_the_very_start_pose(kit, seed: int, rounds: int) -> None:
    truth, via, end = random_truth(seed)
    arc = arc_of(kit, truth, via, end, angle=float(np.radians(360.0 * rounds)))
    ends = arc.poses(np.array([0.0, arc.length]))
    np.testing.assert_array_equal(ends.position[1], truth.points(0.0)[0])
    np.testing.assert_array_equal(ends.position[0], ends.position[1])
    np.testing.assert_array_equal(ends.rotation[1], np.eye(3))
    # The formula itself comes there too: nothing jumps at the last sample.
    before = arc.poses(np.array([np.nextafter(arc.length, 0.0)])).position[0]
    assert np.max(np.abs(before - ends.position[1])) < 1e-14 * extent_of(truth) * (1 + abs(rounds))


@pytest.mark.parametrize("seed", SEEDS)
def test_last_pose_is_the_target_to_the_last_bit(kit, seed: int) -> None:
    truth, via, end = random_truth(seed)
    turned = Rotation.from_rotvec([0.4, -0.3, 0.2]).as_quat()
    start, middle, last = truth.points([0.0, via, end])
    arc = circle_path(kit.circle(middle, last, turns=(None, turned)), np.eye(3), start, kit.place)
    poses = arc.poses(np.array([0.5 * arc.length, arc.length]))
    np.testing.assert_array_equal(poses.position[-1], last)
    np.testing.assert_array_equal(poses.rotation[-1], Rotation.from_quat(turned).as_matrix())
    nearly = arc.poses(np.array([np.nextafter(arc.length, 0.0)]))
    bound = 1e-13 * extent_of(truth) + 20 * rounding_of(truth, via, end)
    assert np.max(np.abs(nearly.position[0] - last)) < bound, f"seed {seed}"


def turning_arc(kit, seed: int, through: bool, angle: float | None = None) -> Arc:
    truth, via, end = random_truth(seed)
    rng = np.random.default_rng(1000 + seed)
    turns = [
        Rotation.from_rotvec(v / np.linalg.norm(v) * rng.uniform(0, 2.5)) for v in rng.normal(size=(3, 3))
    ]
    start, middle, last = truth.points([0.0, via, end])
    block = kit.circle(
        middle, last, turns=(turns[1].as_quat(), turns[2].as_quat()), turns_through_via=through, angle=angle
    )
    return circle_path(block, turns[0].as_matrix(), start, kit.place)


def inner(arc: Arc, through: bool) -> np.ndarray:
    """Parameters between the corners of the second derivative."""
    if not through:
        return np.linspace(0.1, 0.9, 9) * arc.length
    via = arc.orientation.via_share
    corners = np.array([0.0, 0.5 * via, via, 0.5 * (1.0 + via), 1.0])
    widths = np.diff(corners)
    return np.concatenate([corners[:-1] + part * widths for part in (0.1, 0.45, 0.9)]) * arc.length


@pytest.mark.parametrize("through", [False, True])
@pytest.mark.parametrize("seed", SEEDS)
def test_derivatives_equal_central_differences(kit, seed: int, through: bool) -> None:
    arc = turning_arc(kit, seed, through)
    s, h = inner(arc, through), 2e-4 * arc.length * (0.05 if through else 1.0)
    first, second = arc.derivatives(s), arc.second_derivatives(s)
    before, after = arc.poses(s - h), arc.poses(s + h)
    extent = max(1.0, float(np.max(np.abs(before.position))))
    noise = 4e-16 / h
    moved = (after.position - before.position) / (2 * h)
    np.testing.assert_allclose(first[0], moved, atol=1e-6 + 4 * noise * extent, err_msg=f"seed {seed}")
    turned = np.array(
        [
            Rotation.from_matrix(b @ a.T).as_rotvec() / (2 * h)
            for a, b in zip(before.rotation, after.rotation, strict=True)
        ]
    )
    scale = arc.turn_rate
    np.testing.assert_allclose(first[1], turned, atol=1e-6 * (1 + scale) + 4 * noise, err_msg=f"seed {seed}")
    changes = [(b - a) / (2 * h) for a, b in zip(arc.derivatives(s - h), arc.derivatives(s + h), strict=True)]
    np.testing.assert_allclose(second[0], changes[0], rtol=1e-5, atol=1e-6 * arc.curvature + 4 * noise)
    np.testing.assert_allclose(
        second[1], changes[1], rtol=1e-5, atol=1e-6 * (1e-9 + arc.turn_bend) + 4 * noise * scale
    )


@pytest.mark.parametrize("through", [False, True])
@pytest.mark.parametrize("seed", SEEDS[::3])
def test_largest_values_are_those_of_the_derivatives(kit, seed: int, through: bool) -> None:
    arc = turning_arc(kit, seed, through)
    s = np.linspace(0.0, arc.length, 400)
    along, turning = arc.derivatives(s)
    bend, turn_bend = arc.second_derivatives(s)
    np.testing.assert_allclose(np.linalg.norm(along, axis=1), 1.0, rtol=1e-13)
    np.testing.assert_allclose(np.linalg.norm(bend, axis=1), arc.curvature, rtol=1e-12)
    assert arc.curvature == pytest.approx(1.0 / arc.circle.radius, rel=1e-13)
    assert np.max(np.linalg.norm(turning, axis=1)) == pytest.approx(arc.turn_rate, rel=1e-12)
    assert np.max(np.linalg.norm(turn_bend, axis=1)) == pytest.approx(arc.turn_bend, rel=1e-12)
    np.testing.assert_allclose(np.sum(along * bend, axis=1), 0.0, atol=1e-12 * arc.curvature)


@pytest.mark.req("MOT-02")
@pytest.mark.parametrize("angle", [None, 7.0, -1.0])
@pytest.mark.parametrize("seed", SEEDS[::4])
def test_orientation_is_one_slerp_in_step(kit, seed: int, angle: float | None) -> None:
    arc = turning_arc(kit, seed, False, angle)
    shares = np.linspace(0.0, 1.0, 13)
    rotations = Rotation.from_matrix(arc.poses(shares * arc.length).rotation)
    from_start = (rotations[0].inv() * rotations).as_rotvec()
    np.testing.assert_allclose(from_start, shares[:, None] * from_start[-1], atol=1e-12)


@pytest.mark.req("MOT-02")
@pytest.mark.parametrize("seed", SEEDS[::2])
def test_via_orientation_is_passed_at_the_via_point(kit, seed: int) -> None:
    truth, via, end = random_truth(seed)
    arc = turning_arc(kit, seed, True)
    at = arc.orientation.via_share * arc.length
    pose = arc.poses(np.array([at]))
    bound = 1e-12 * extent_of(truth) + 20 * rounding_of(truth, via, end)
    assert np.max(np.abs(pose.position[0] - truth.points(via)[0])) < bound, f"seed {seed}"
    np.testing.assert_allclose(pose.rotation[0], arc.orientation.second.start, atol=1e-12)
    # Each half keeps its axis, and the turn comes to rest in between: no jump of the rate.
    share = np.array([0.3 * at, 0.8 * at, at + 0.2 * (arc.length - at), at + 0.9 * (arc.length - at)])
    rates = arc.derivatives(share)[1]
    for pair in (rates[:2], rates[2:]):
        sine = np.linalg.norm(np.cross(*pair)) / np.prod(np.linalg.norm(pair, axis=1))
        assert sine < 1e-9, f"seed {seed}"
    eps = 1e-9 * arc.length
    slow = np.linalg.norm(arc.derivatives(np.array([at - eps, at, at + eps]))[1], axis=1)
    assert np.max(slow) < 1e-6 * arc.turn_rate, f"seed {seed}"


@pytest.mark.parametrize("height", [1.1e-6, 1e-5, 1e-3])
@pytest.mark.parametrize("chord", [1e-3, 1.0, 20.0])
@pytest.mark.parametrize("seed", first(4, range(8)))
def test_flat_arcs_stay_between_their_points(kit, seed: int, chord: float, height: float) -> None:
    """Nearly a line: the radius is up to 5e7 m, and the arc still passes the via point."""
    axes = Rotation.random(random_state=seed).as_matrix()
    rng = np.random.default_rng(seed)
    start = rng.normal(size=3)
    share = rng.uniform(0.3, 0.7)
    middle = start + share * chord * axes[:, 0] + height * axes[:, 1]
    last = start + chord * axes[:, 0]
    arc = circle_path(kit.circle(middle, last), np.eye(3), start, kit.place)
    positions = arc.poses(np.linspace(0.0, arc.length, 2001)).position
    extent = max(1.0, chord)
    assert np.max(np.abs((positions - start) @ axes[:, 2])) < 1e-9 * height * extent + 1e-14
    off = (positions - start) @ axes[:, 1]
    assert np.min(off) > -1e-13 * extent
    assert np.max(off) < 1.3 * height + 1e-13
    at_via = arc.circle.radius * arc.circle.via_angle
    np.testing.assert_allclose(arc.poses(np.array([at_via])).position[0], middle, atol=1e-12 * extent)
    before_end = arc.circle.points(np.array([arc.travel]))[0]
    np.testing.assert_allclose(before_end, last, atol=1e-12 * extent)


@pytest.mark.parametrize("scale", [1e-5, 1.0, 1e3])
def test_an_arc_that_is_nearly_a_whole_circle(kit, scale: float) -> None:
    truth = Truth(np.array([1.0, 2.0, 3.0]), np.eye(3)[0], np.eye(3)[1], scale)
    end = 2 * np.pi - 0.2
    arc = arc_of(kit, truth, np.pi, end)
    assert arc.travel == pytest.approx(end, abs=1e-9)


def raised(kit, start, via, end, **course) -> MotionError:
    with pytest.raises(MotionError) as caught:
        circle_path(kit.circle(via, end, **course), np.eye(3), np.array(start, dtype=float), kit.place)
    assert caught.value.reason.place == kit.place
    return caught.value.reason


A, B, C = (0.0, 0.0, 0.0), (1.0, 1.0, 0.0), (2.0, 0.0, 0.0)
CLOSE = 0.9e-6


@pytest.mark.parametrize(
    ("start", "via", "end", "points"),
    [
        (A, A, C, "start and via point"),
        (A, (CLOSE, 0.0, 0.0), C, "start and via point"),
        (A, B, (1.0, 1.0, CLOSE), "via and end point"),
        (A, C, C, "via and end point"),
        (A, B, A, "start and end point"),
        (A, A, A, "start and via point"),
    ],
)
def test_points_that_coincide_are_named(kit, start, via, end, points: str) -> None:
    reason = raised(kit, start, via, end)
    assert (reason.code, reason.data["points"]) == ("IRL427", points)
    assert raised(kit, start, via, end, angle=1.0).code == "IRL427"


@pytest.mark.parametrize("scale", [1e-4, 1.0, 1e9, 1e200])
@pytest.mark.parametrize("order", [(A, (1.0, 0.0, 0.0), C), (A, C, (1.0, 0.0, 0.0)), (C, A, (5.0, 0.0, 0.0))])
def test_points_on_a_line_are_refused(kit, order, scale: float) -> None:
    reason = raised(kit, *(np.array(point) * scale for point in order))
    assert (reason.code, reason.data["height"]) == ("IRL428", "0")


@pytest.mark.parametrize(("height", "refused"), [(0.9 * NEAREST_POINTS, True), (1.1 * NEAREST_POINTS, False)])
def test_how_near_to_a_line_is_too_near(kit, height: float, refused: bool) -> None:
    via = np.array([1.0, height, 0.0])
    if refused:
        assert raised(kit, A, via, C).code == "IRL428"
    else:
        circle = Circle.through(np.array(A), via, np.array(C))
        assert circle.radius == pytest.approx(1.0 / (2 * height), rel=1e-6)


@pytest.mark.parametrize("angle", [0.5, np.pi / 2, -0.5, -1.5 * np.pi])
def test_a_via_orientation_that_is_not_passed_is_refused(kit, angle: float) -> None:
    reason = raised(kit, A, B, C, angle=angle, turns_through_via=True)
    assert reason.code == "IRL429"
    assert reason.data["angle"] == f"{np.degrees(angle):.6g}"
    assert reason.data["via"] == ("90" if angle > 0 else "270")


@pytest.mark.parametrize("angle", [np.pi / 2 + 1e-3, 7.0, -1.5 * np.pi - 1e-3])
def test_a_via_orientation_that_is_passed_counts(kit, angle: float) -> None:
    turn = Rotation.from_rotvec([0.0, 0.5, 0.0])
    block = kit.circle(B, C, turns=(turn.as_quat(), None), angle=angle, turns_through_via=True)
    arc = circle_path(block, np.eye(3), np.array(A), kit.place)
    at = (np.pi / 2 if angle > 0 else 1.5 * np.pi) * arc.circle.radius
    poses = arc.poses(np.array([at, arc.length]))
    np.testing.assert_allclose(poses.position[0], B, atol=1e-14)
    np.testing.assert_allclose(poses.rotation, [turn.as_matrix(), np.eye(3)], atol=1e-8)


def test_a_tiny_angle_is_a_pure_turn_or_nothing(kit) -> None:
    turn = Rotation.from_rotvec([0.0, 0.5, 0.0]).as_quat()
    arc = circle_path(kit.circle(B, C, turns=(None, turn), angle=1e-10), np.eye(3), np.array(A), kit.place)
    assert arc.is_pure_turn
    assert arc.length == pytest.approx(0.5)
    assert arc.turn_rate == pytest.approx(1.0)
    poses = arc.poses(np.array([0.0, 0.25, arc.length]))
    np.testing.assert_allclose(Rotation.from_matrix(poses.rotation).magnitude(), [0, 0.25, 0.5], atol=1e-14)
    nothing = circle_path(kit.circle(B, C, angle=1e-10), np.eye(3), np.array(A), kit.place)
    assert nothing.is_nothing
    np.testing.assert_array_equal(nothing.poses(np.zeros(2)).position, [A, A])
