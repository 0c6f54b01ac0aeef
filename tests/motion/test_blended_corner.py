"""One blend by itself: where it comes nearest to the corner, how it is turned there, how little it bends."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import PPoly
from scipy.spatial.transform import Rotation

from irlx.blocks import MotionLaw
from irlx.motion.arc import Arc, Circle
from irlx.motion.blended_corner import _flattest, blended_corner
from irlx.motion.fastest_law import fastest_trapezoids
from irlx.motion.hermite import Jet, quintic
from irlx.motion.line import Line
from irlx.motion.polynomial_curve import PolynomialCurve
from irlx.motion.sections import Shape, bounds_of
from irlx.motion.turn import Turn

pytestmark = pytest.mark.req("MOT-06")


def corner_of(seed: int) -> tuple[Line, Line]:
    """Two lines that meet, the orientation turning about another axis on each."""
    rng = np.random.default_rng(seed)
    points = np.cumsum(rng.normal(size=(3, 3)), axis=0)
    turns = Rotation.from_rotvec(0.7 * rng.normal(size=(3, 3))).as_matrix()
    return Line(points[0], turns[0], points[1], turns[1]), Line(points[1], turns[1], points[2], turns[2])


@pytest.mark.parametrize("seed", range(4))
def test_what_it_misses_the_corner_by(seed: int) -> None:
    before, after = corner_of(seed)
    blend = blended_corner(before, after, 0.2)
    poses = blend.path.poses(np.linspace(0.0, blend.path.length, 4001))
    distances = np.linalg.norm(poses.position - before.end_position, axis=1)
    assert blend.miss == pytest.approx(np.min(distances), rel=1e-6)
    (there,) = blend.path.poses(np.array([blend.corner])).rotation
    missed = Rotation.from_matrix(before.end_rotation.T @ there).magnitude()
    assert missed > 1e-3
    assert blend.miss_angle == pytest.approx(missed, rel=1e-9)


@pytest.mark.parametrize("seed", range(4))
def test_it_begins_and_ends_on_the_paths_with_their_derivatives(seed: int) -> None:
    before, after = corner_of(seed)
    path = blended_corner(before, after, 0.2).path
    sides = ((before, before.length - 0.2, 0.0), (after, 0.2, path.length))
    for whole, there, here in sides:
        for one, other in zip(
            whole.derivatives(np.array([there])), path.derivatives(np.array([here])), strict=True
        ):
            assert np.allclose(one, other, rtol=0.0, atol=1e-9)
        poses = whole.poses(np.array([there])), path.poses(np.array([here]))
        assert np.allclose(poses[0].position, poses[1].position, rtol=0.0, atol=1e-12)
        assert np.allclose(poses[0].rotation, poses[1].rotation, rtol=0.0, atol=1e-12)


def peak_bend(start: Jet, end: Jet, tangent: float) -> float:
    """Largest curvature of the quintic whose tangents are so long."""
    jets = [Jet(jet.value, tangent * jet.rate, tangent**2 * jet.bend) for jet in (start, end)]
    curve = PPoly(quintic(*jets, 1.0)[:, None, :], [0.0, 1.0])
    u = np.linspace(0.0, 1.0, 401)
    slope, bend = curve.derivative(1)(u), curve.derivative(2)(u)
    return float(np.max(np.linalg.norm(np.cross(slope, bend), axis=1) / np.linalg.norm(slope, axis=1) ** 3))


@pytest.mark.parametrize("seed", range(2))
def test_no_other_length_of_the_tangents_bends_much_less(seed: int) -> None:
    """Fifteen lengths are tried; between two of them lies 5 %, which makes few per cent of the bend."""
    before, after = corner_of(seed)
    path = blended_corner(before, after, 0.2).path
    ends = [
        Jet(whole.poses(s).position[0], whole.derivatives(s)[0][0], whole.second_derivatives(s)[0][0])
        for whole, s in ((before, np.array([before.length - 0.2])), (after, np.array([0.2])))
    ]
    chord = np.linalg.norm(ends[1].value - ends[0].value)
    least = min(peak_bend(*ends, tangent) for tangent in chord * np.linspace(0.6, 2.5, 40))
    assert np.max(path.shape.curvature) < 1.05 * least


def test_of_curves_that_bend_alike_the_most_even_one_is_taken() -> None:
    """Straight on all of them are straight; at 0.9 of the way the speed over the parameter varies little."""
    turn = np.eye(3)
    before, after = (
        Line(np.array([x, 0.0, 0.0]), turn, np.array([x + 1.0, 0.0, 0.0]), turn) for x in (0.0, 1.0)
    )
    slope = blended_corner(before, after, 0.25).path.curve.velocities(np.array([0.0]))
    assert slope[0] == pytest.approx([0.45, 0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize("scale", [2.0**-20, 2.0**20])
def test_the_curve_does_not_depend_on_the_unit_of_length(scale: float) -> None:
    """By powers of two all numbers are scaled exactly, and so is the choice among the tangents."""
    turned = np.array([np.cos(2.0), np.sin(2.0), 0.0])
    jets = [Jet(np.zeros(3), np.eye(3)[0], np.zeros(3)), Jet(np.array([0.2, 0.3, 0.0]), turned, np.zeros(3))]
    scaled = [Jet(scale * jet.value, jet.rate, jet.bend / scale) for jet in jets]
    np.testing.assert_allclose(_flattest(*scaled), scale * _flattest(*jets), rtol=1e-12, atol=1e-15 * scale)


@pytest.mark.parametrize("seed", range(3))
def test_largest_values_are_those_of_the_derivatives(seed: int) -> None:
    """Of sections, each looked at in five places: near the largest of a fine search, not far above it."""
    before, after = corner_of(seed)
    path = blended_corner(before, after, 0.2).path
    s = np.linspace(0.0, path.length, 2001)
    rates, (bends, turns) = path.derivatives(s)[1], path.second_derivatives(s)
    fine = [float(np.max(np.linalg.norm(values, axis=1))) for values in (rates, bends, turns)]
    assert [path.turn_rate, path.curvature, path.turn_bend] == pytest.approx(fine, rel=0.02)


def arc_from(start: np.ndarray, angle: float, radius: float, travel: float) -> Arc:
    """A circle in a plane that is left at an angle."""
    tangent = np.array([np.cos(angle), np.sin(angle), 0.0])
    circle = Circle(start, tangent, np.array([-tangent[1], tangent[0], 0.0]), radius, 1.0, 2.0)
    return Arc(circle, travel, circle.point_after(travel), np.eye(3), Turn(np.eye(3), np.eye(3)))


def circles_of(seed: int) -> tuple[Arc, Arc]:
    """Two circles, of up to more than a turn, that meet at any angle."""
    rng = np.random.default_rng(seed)
    before = arc_from(np.zeros(3), 0.0, rng.uniform(0.02, 0.05), rng.uniform(1.0, 8.0))
    heading = np.arctan2(*before.derivatives(np.array([before.length]))[0][0, 1::-1])
    angle, radius = heading + rng.uniform(-3.1, 3.1), rng.uniform(0.02, 0.05)
    return before, arc_from(before.end_position, angle, radius, 8.0)


NARROW = [216, 305, 125, 304, 213, 93, 58]
"""Seeds of blends with a bend that five samples a section miss, by 3 % up to a factor of 5e7."""


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize("seed", [*range(5), *NARROW])
def test_no_section_bends_more_than_it_says_and_narrow_bends_have_narrow_ones(seed: int) -> None:
    """Against dense samples; between them a cusp may rise higher."""
    before, after = circles_of(seed)
    path = blended_corner(before, after, 0.5 * min(before.length, after.length)).path
    u = path.cuts[:-1, None] + np.diff(path.cuts)[:, None] * np.linspace(0.0, 1.0, 2001)
    true = np.linalg.norm(path.curve.along(u.ravel())[1], axis=1).reshape(u.shape)
    said = path.shape.curvature
    assert np.all(true.max(axis=1) < said * (1.0 + 1e-6)), f"seed {seed}"
    if seed in NARROW:
        slow = said > 0.25 * said.max()
        assert len(said) > 16
        assert np.sum(path.shape.lengths[slow]) * said.max() < 40.0


LAW = MotionLaw(speed=0.3, acc=2.0, speed_ori=3.0, acc_ori=10.0)
CUSP = 21, 0.052150377871959995
"""Seed of `circles_of`, and the distance at which their blend has a cusp, to rounding."""


@pytest.mark.req("MOT-03")
def test_blends_near_a_cusp_and_on_it_are_measured_and_timed_alike() -> None:
    """The way through the bend against chords that grow with the distance from it; one that is 1e-6 of the
    distance off still has the time of a cusp, in which the tool all but stands."""
    before, after = circles_of(CUSP[0])
    times = []
    for off in (0.0, 1e-8, 1e-6):
        path = blended_corner(before, after, CUSP[1] * (1.0 - off)).path
        shape, curve = path.shape, path.curve
        narrowest = int(np.argmax(shape.curvature))
        cusp = path.cuts[narrowest : narrowest + 2].mean()
        u = cusp + 10.0 ** np.linspace(-7.0, -1.0, 801)
        steps = np.diff(curve.length_at(u))
        chords = np.linalg.norm(np.diff(curve.points(u), axis=0), axis=1)
        np.testing.assert_allclose(steps, chords, rtol=1e-3, atol=1e-15)
        assert len(shape.lengths) < 150
        assert np.all(shape.lengths > 1e-13)
        law = fastest_trapezoids(bounds_of(shape, LAW), path.length)
        times.append(law.duration)
        assert law.rates_at(curve.length_at(np.array([cusp])))[0] < 2e-6
    assert times == pytest.approx([times[0]] * len(times), rel=2e-3)


def test_the_rate_changes_steadily_round_a_corner() -> None:
    """It falls to each of the two sharpest places and rises behind it, whatever the borders of sections."""
    first = Line(np.zeros(3), np.eye(3), np.array([0.2, 0.0, 0.0]), np.eye(3))
    second = Line(first.end_position, np.eye(3), np.array([0.2, 0.2, 0.0]), np.eye(3))
    shape = blended_corner(first, second, 0.02).path.shape
    joined = Shape.joined([straight := Shape(np.array([0.18]), *np.zeros((3, 1))), shape, straight])
    law = fastest_trapezoids(bounds_of(joined, LAW), float(np.sum(joined.lengths)))
    inside = law.starts[(law.ways[:-1] > 0.17) & (law.ways[1:] < law.length - 0.17)]
    assert len(inside) > 10
    assert np.count_nonzero(np.abs(inside) < 1e-6) <= 3, "no waiting for the next border"
    signs = np.sign(law.starts[np.abs(law.starts) > 1e-6])
    assert np.count_nonzero(np.diff(signs)) == 5, "up from rest, down, up, down, up, down to rest"


def test_the_curvature_of_a_cusp_is_that_of_a_point() -> None:
    """(u^2, u^3) stands still at 0; behind it the curvature is 6 / (4 + 9 u^2)^1.5 / u."""
    coefficients = np.array([[[0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0]], [[0.0] * 3], [[0.0] * 3]])
    curve = PolynomialCurve(np.array([0.0, 1.0]), coefficients)
    u = np.array([0.0, 1e-14, 1e-9, 0.01, 0.5])
    expected = [1e12, 1e12, *(6.0 / (4.0 + 9.0 * u[2:] ** 2) ** 1.5 / u[2:])]
    np.testing.assert_allclose(curve.curvature(u), expected, rtol=1e-9)
