"""Splines: through their points, smooth, straight where the points are, and no turn that swings past."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from irlx.blocks import MoveKind
from irlx.motion.errors import MotionError
from irlx.motion.line import Line
from irlx.motion.plan_chain import PlannedChain, plan_chain
from irlx.motion.polynomial_curve import PolynomialCurve
from irlx.motion.spline_path import _refined

pytestmark = pytest.mark.req("MOT-01")

POINTS = np.array([[0.1, 0.1, 0.0], [0.15, 0.02, 0.1], [0.3, 0.0, 0.0], [0.31, 0.05, 0.02]])


def turns_about_z(*degrees: float) -> list[np.ndarray]:
    return [Rotation.from_euler("z", angle, degrees=True).as_quat() for angle in degrees]


def plan(kit, points, turns=None, start=(0.0, 0.0, 0.0), **law: object) -> PlannedChain:
    block = kit.path(MoveKind.SPLINE, points, turns, kit.law(**law))
    return plan_chain([kit.leg(block)], np.eye(3), np.array(start), 0.01)


def test_it_runs_through_its_points_as_the_spline_of_scipy_does(kit) -> None:
    planned = plan(kit, POINTS)
    (marks,) = planned.marks
    passed = planned.path.poses(np.array(marks)).position
    assert np.max(np.abs(passed - POINTS)) < 1e-12
    assert passed[-1].tolist() == POINTS[-1].tolist()
    knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(POINTS, axis=0, prepend=0.0), axis=1))])
    curve = CubicSpline(knots, np.vstack([np.zeros(3), POINTS]), bc_type="natural")
    fine = curve(np.linspace(0.0, knots[-1], 50_001))
    assert planned.path.length == pytest.approx(
        float(np.sum(np.linalg.norm(np.diff(fine, axis=0), axis=1))), rel=1e-9
    )
    on_it = planned.path.poses(np.linspace(0.0, planned.path.length, 50)).position
    nearest = [np.min(np.linalg.norm(fine - point, axis=1)) for point in on_it]
    assert max(nearest) < 1e-5


def test_points_on_a_line_make_a_line(kit) -> None:
    way = np.array([0.3, -0.2, 0.1])
    planned = plan(kit, [0.2 * way, 0.9 * way, way])
    s = np.linspace(0.0, planned.path.length, 1001)
    along = way / np.linalg.norm(way)
    assert planned.path.length == pytest.approx(np.linalg.norm(way), abs=1e-14)
    assert np.max(np.abs(planned.path.poses(s).position - s[:, None] * along)) < 1e-12


def test_one_point_is_a_line(kit) -> None:
    assert isinstance(plan(kit, POINTS[:1]).path, Line)
    assert isinstance(plan(kit, [(0, 0, 0), POINTS[0]]).path, Line)


def test_the_start_may_stand_first(kit) -> None:
    with_start = plan(kit, [(0, 0, 0), *POINTS])
    without = plan(kit, POINTS)
    assert with_start.path.length == without.path.length
    assert with_start.marks[0] == (0.0, *without.marks[0])


def test_orientations_are_met_and_smooth(kit) -> None:
    rng = np.random.default_rng(2)
    turns = [Rotation.from_rotvec(vector).as_quat() for vector in 0.9 * rng.normal(size=(4, 3))]
    planned = plan(kit, POINTS, turns)
    met = Rotation.from_matrix(planned.path.poses(np.array(planned.marks[0])).rotation)
    assert np.max((met * Rotation.from_quat(turns).inv()).magnitude()) < 1e-12
    step = 1e-7
    s = np.concatenate([planned.marks[0][:-1], np.linspace(0.01, planned.path.length - 0.01, 300)])
    for order in (1, 2):
        values = [
            (planned.path.derivatives(at) if order == 1 else planned.path.second_derivatives(at))[1]
            for at in (s - step, s + step)
        ]
        assert np.max(np.abs(values[1] - values[0])) < 1e-3 * np.max(np.abs(values[0]))


@pytest.mark.parametrize("angles", [(0, 90, 90, 0), (0, 90, 91, 92), (0, 1, 120, 121)])
def test_turns_do_not_swing_past_their_ends(kit, angles) -> None:
    """Points very near to each other make the rates of other interpolants swing by whole turns."""
    points = [(0.1, 0, 0), (0.2, 0.1, 0), (0.2, 0.101, 0), (0.3, 0.2, 0)]
    planned = plan(kit, points, turns_about_z(*angles))
    s = np.linspace(0.0, planned.path.length, 4001)
    found = np.degrees(np.unwrap(Rotation.from_matrix(planned.path.poses(s).rotation).as_rotvec()[:, 2]))
    ends = (0.0, *planned.marks[0])
    values = (0, *angles)
    for k in range(4):
        here = found[(s >= ends[k]) & (s <= ends[k + 1])]
        low, high = sorted(values[k : k + 2])
        assert np.min(here) > low - 1e-6
        assert np.max(here) < high + 1e-6


BAD = {
    "the same point twice": ([POINTS[0], POINTS[0], POINTS[1]], None, "IRL434", "point 1 and point 2"),
    "less than a micrometre": (
        [POINTS[0], POINTS[0] + [5e-7, 0, 0], POINTS[1]],
        None,
        "IRL434",
        "point 1 and point 2",
    ),
    "the last one": ([POINTS[0], POINTS[1], POINTS[1]], None, "IRL434", "point 2 and point 3"),
    "the start, turned": (
        [(0, 0, 0), POINTS[1]],
        turns_about_z(10, 20),
        "IRL434",
        "the start and point 1",
    ),
    "straight back": ([(0.1, 0, 0), (0, 0, 0)], None, "IRL435", "point 1"),
    "straight back later": ([(0.1, 0, 0), (0.2, 0, 0), (0.1, 0, 0)], None, "IRL435", "point 2"),
    "half a turn": (POINTS[:2], turns_about_z(0, 180), "IRL422", "180"),
}


@pytest.mark.parametrize(("points", "turns", "code", "words"), BAD.values(), ids=BAD)
def test_what_is_no_spline(kit, points, turns, code: str, words: str) -> None:
    with pytest.raises(MotionError) as caught:
        plan(kit, points, turns)
    (found,) = caught.value.diagnostics
    assert found.code == code
    assert words in found.message
    assert found.place is not None


def test_coincident_points_of_a_polyline(kit) -> None:
    points = [(0.1, 0, 0), (0.1, 0, 0), (0.2, 0, 0)]
    leg = kit.leg(kit.path(MoveKind.LIN, points))
    with pytest.raises(MotionError) as caught:
        plan_chain([leg], np.eye(3), np.zeros(3), 0.01)
    assert caught.value.diagnostics[0].code == "IRL434"
    turning = kit.leg(kit.path(MoveKind.LIN, points, turns_about_z(0, 30, 30)))
    planned = plan_chain([turning], np.eye(3), np.zeros(3), 0.01)
    assert (planned.legs, planned.points) == (0, 1)
    following = planned.rest([turning])
    assert plan_chain(following, np.eye(3), np.array([0.1, 0, 0]), 0.01).path.is_pure_turn


def test_it_slows_down_just_where_it_bends(kit) -> None:
    planned = plan(kit, [(0.3, 0, 0), (0.31, 0.005, 0), (0.31, 0.3, 0)], speed=1.0, acc=2.0)
    s = np.linspace(0.0, planned.path.length, 2001)
    rates = planned.programmed.rates_at(s)
    curvature = np.linalg.norm(planned.path.second_derivatives(s)[0], axis=1)
    assert np.all(rates**2 * curvature <= 2.0 * (1 + 1e-3))
    middle = (s > 0.1) & (s < planned.path.length - 0.1)
    assert np.argmin(np.where(middle, rates, 9.0)) == pytest.approx(
        int(np.argmax(np.where(middle, curvature, 0.0))), abs=60
    )


def test_time(kit) -> None:
    free = plan(kit, POINTS)
    timed = plan(kit, POINTS, duration=4.0)
    assert timed.programmed.duration == pytest.approx(4.0, rel=1e-9)
    assert timed.ticks == 400
    with pytest.raises(MotionError) as caught:
        plan(kit, POINTS, duration=0.9 * free.programmed.duration)
    assert caught.value.diagnostics[0].code == "IRL421"


def test_beyond_all_measure(kit) -> None:
    for far in (1e10, 1e200):
        with pytest.raises(MotionError) as caught:
            plan(kit, far * POINTS)
        assert caught.value.diagnostics[0].code == "IRL425"


def test_points_of_the_rest_keep_their_postures(kit) -> None:
    from irlx.blocks import JointTarget, PathCourse

    block = kit.path(MoveKind.LIN, [(0.1, 0, 0), (0.1, 0.1, 0), (0.2, 0.1, 0)])
    postures = tuple(JointTarget((float(k),)) for k in range(2))
    block = replace(block, course=PathCourse(block.course.points, postures))
    leg = kit.leg(block)
    planned = plan_chain([leg], np.eye(3), np.zeros(3), 0.01)
    (rest,) = planned.rest([leg])
    assert rest.block.course == PathCourse(block.course.points[1:], postures[1:])


def test_sections_are_cut_where_the_curvature_changes_fast() -> None:
    """y = x^6: within a section it grows by half at most, or turns the tangent by 0.02 rad at most."""
    powers = np.zeros((7, 1, 3))
    powers[5, 0, 0] = powers[0, 0, 1] = 1.0
    curve, even = PolynomialCurve(np.array([0.0, 1.0]), powers), np.linspace(0.0, 1.0, 5)
    cuts = _refined(curve, even)
    assert np.all(np.isin(even, cuts))
    assert len(cuts) > 2 * len(even)
    x = np.stack([cuts[:-1], 0.5 * (cuts[:-1] + cuts[1:]), cuts[1:]])
    curvature = 30.0 * x**4 / (1.0 + 36.0 * x**10) ** 1.5
    steady = np.max(curvature, axis=0) <= 1.5 * np.min(curvature, axis=0) * (1.0 + 1e-9)
    turned = np.diff(np.arctan(6.0 * cuts**5))
    assert np.all(steady | (turned <= 0.02))
    assert np.any(np.diff(cuts) == 0.25 * 0.25)
    assert not np.any(steady & (np.diff(cuts) < 0.01))
