"""What is said of pairs that come too near: true to the last digit."""

from __future__ import annotations

import numpy as np
import pytest

from drawn_scenes import cell_of
from irlx.diagnostics import Place
from irlx.motion.plan_path import PlannedPath
from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.impossible import Surroundings, _too_near, explain_failure
from irlx.pacing.path_motion import Failure
from irlx.pacing.slowdown.planned import Refusal
from irlx.pacing.too_near import told
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle, Waypoint
from irlx.scene.watched_pair import watched_pairs
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere
from irlx.transform.clearance import Clearance, TooNear
from irlx.transform.tick import TickSolution, TickStatus
from machines import machine

pytestmark = pytest.mark.req("MOT-22")


def around_a_ball(room: float) -> tuple[Surroundings, np.ndarray]:
    """arm7 at its start beside a ball, `room` (m) above the ball's margin; the move began farther away."""
    cell, kinematics = cell_of("arm7")
    place = Placement((0.25, 0.45, 0.75))

    def clearance(margin: float) -> Clearance:
        ball = Obstacle("ball", (Solid(Sphere(0.05)),), place, margin, 1.0)
        return Clearance(Distances(kinematics, watched_pairs(kinematics, [ball], None)))

    any_margin = clearance(0.0)
    gap = any_margin.nearest(cell.start, cell.start)
    assert gap is not None
    away = cell.start + np.array([-0.4, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    farther = any_margin.nearest(away, away)
    assert farther is not None
    assert farther.distance > gap.distance + 1e-3
    around = Surroundings(
        kinematics,
        cell.limits,
        np.ones(7, dtype=bool),
        clearance=clearance(gap.distance - room),
        start=away,
    )
    return around, cell.start


@pytest.mark.parametrize(("room", "kept"), [(-2e-3, 0.0), (5e-5, 1e-4)])
def test_what_is_kept_is_more_than_what_would_be_left(room, kept) -> None:
    """A plan keeps 0.1 mm beside a margin: where that decides, it counts as kept."""
    around, q = around_a_ball(room)
    solution = TickSolution(TickStatus.TOO_NEAR, q, np.zeros(7, dtype=np.int8), np.zeros(6), 3)
    found = _too_near(Refusal(0.1, solution=solution, reserve=1e-4), around)
    assert found is not None
    assert found.distance - found.floor == pytest.approx(room - kept, abs=1e-12)
    assert found.distance < found.floor


@pytest.mark.parametrize(
    ("distance", "floor", "words"),
    [
        (0.015, 0.02, ("15 mm", "20 mm")),
        (0.0123456, 0.0234567, ("12.35 mm", "23.46 mm")),
        (0.0199999, 0.02, ("19.9999 mm", "20 mm")),
        (-0.001, 0.0, ("-1 mm (they overlap)", "0 mm")),
        (0.02 - 1.1e-6, 0.02, ("19.999 mm", "20 mm")),
        (0.02 - 1e-15, 0.02, ("less than 20 mm", "20 mm")),
    ],
)
def test_digits_tell_distances_apart(distance, floor, words) -> None:
    around, _ = around_a_ball(0.0)
    assert around.clearance is not None
    said = told(around.clearance, TooNear(0, distance, floor))
    assert (said["distance"], said["floor"]) == words


@pytest.mark.parametrize("elapsed", [0.0, 1.5])
def test_obstacles_that_move_are_told_where_they_are_then(elapsed) -> None:
    cell, kinematics = cell_of("arm7")
    way = (Waypoint(0.0, Placement((0.25, 0.9, 0.75))), Waypoint(2.0, Placement((0.25, 0.3, 0.75))))
    ball = Obstacle("ball", (Solid(Sphere(0.05)),), way[0].placement, 0.5, 1.0, way)
    pairs = watched_pairs(kinematics, [ball], None)
    distances = Distances(kinematics, pairs)
    clearance = Clearance(Distances(kinematics, pairs)).beginning(0.0)
    around = Surroundings(kinematics, cell.limits, np.ones(7, dtype=bool), clearance=clearance)
    solution = TickSolution(TickStatus.TOO_NEAR, cell.start, np.zeros(7, dtype=np.int8), np.zeros(6), 3)
    found = _too_near(Refusal(0.1, solution=solution, elapsed=elapsed), around)
    distances.at_time(elapsed)
    every = distances.of(cell.start, np.arange(len(pairs))).distance
    assert found is not None
    assert found.distance == pytest.approx(every.min(), abs=1e-12)


@pytest.mark.parametrize(("room", "blamed"), [(5e-4, True), (1.5e-3, False)])
def test_a_posture_that_is_only_out_of_reach_blames_no_obstacle_far_off(room, blamed) -> None:
    """What is more than a millimetre beyond its margin did not keep the joints from going on."""
    around, q = around_a_ball(room)
    solution = TickSolution(TickStatus.NO_STEP, q, np.zeros(7, dtype=np.int8), np.zeros(6), 3)
    found = _too_near(Refusal(0.1, solution=solution), around)
    assert (found is not None) is blamed


def test_a_motion_that_is_refused_for_an_obstacle_names_it_and_where() -> None:
    """At 105 mm of 400 mm at a steady speed: more than 10 of 40 ticks after the 7th, and less than 11."""
    around, q = around_a_ball(-2e-3)
    path = machine("arm7").line((0.4, 0.0, 0.0), (0.0, 0.0, 0.0))
    law = Trapezoid.fastest(path.length, 1.0, 1e6)
    plan = PlannedPath(path, law, 40, law)
    solution = TickSolution(TickStatus.TOO_NEAR, q, np.zeros(7, dtype=np.int8), np.zeros(6), 3)
    failure = Failure(None, None, Refusal(0.105, solution=solution))
    told_of = explain_failure(failure, around, plan, 7, None, Place("t.irl"))
    assert told_of.code == "IRL560"
    assert "'ball'" in told_of.data["pair"]
    assert (told_of.data["way"], told_of.data["length"], told_of.data["tick"]) == ("105", "400 mm", 17)
