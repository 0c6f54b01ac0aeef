"""Floors of ticks, postures that come too near, and the first of many, beside a ball."""

from __future__ import annotations

import numpy as np
import pytest

from drawn_scenes import cell_of
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle, Waypoint
from irlx.scene.watched_pair import watched_pairs
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere
from irlx.transform.clearance import APPROACH_TIME, RESERVE, Clearance

pytestmark = pytest.mark.req("MOT-22")

MARGIN, INFLUENCE, DT = 0.03, 0.25, 0.01


def beside(away, margin: float = MARGIN, moving=None) -> tuple[Clearance, np.ndarray, np.ndarray]:
    """A ball at `away` m from the tool of an arm; the clearance, the start, and the numbers of all pairs."""
    cell, kinematics = cell_of("arm7")
    at = kinematics.tool_pose(cell.start)[1] + np.array(away)
    place = Placement(tuple(at.tolist()))
    way = (
        ()
        if moving is None
        else (Waypoint(0.0, place), Waypoint(1.0, Placement(tuple((at + moving).tolist()))))
    )
    ball = Obstacle("ball", (Solid(Sphere(0.05)),), place, margin, INFLUENCE, way)
    distances = Distances(kinematics, watched_pairs(kinematics, [ball], None))
    return Clearance(distances), cell.start, np.arange(len(distances.pairs))


def way_into(start: np.ndarray, rows: int = 120) -> np.ndarray:
    """Postures that lead the arm towards the ball in front of it, and through it."""
    return start + np.linspace(0.0, 1.0, rows)[:, None] * np.array([0.0, 0.5, 0.0, -0.7, 0.0, 0.2, 0.0])


def least_of(clearance: Clearance, q: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    return clearance.distances.of(q, pairs).distance.copy()


@pytest.mark.parametrize("away", [(0.16, 0.0, 0.0), (0.25, 0.0, 0.05), (0.5, 0.1, 0.1)])
def test_the_first_posture_that_is_too_near_is_found_as_one_by_one(away) -> None:
    clearance, start, pairs = beside(away)
    q = way_into(start)
    rooms = np.array([least_of(clearance, row, pairs) - MARGIN for row in q])
    wanted = np.flatnonzero(np.min(rooms, axis=1) < -1e-6)
    found = Clearance(clearance.distances).first_short(q, start)
    if not len(wanted):
        assert found is None
        return
    assert found is not None
    row, near = found
    assert row == wanted[0]
    assert near.pair == int(np.argmin(rooms[row]))
    assert near.distance == pytest.approx(rooms[row].min() + MARGIN, abs=1e-9)
    assert near.floor == MARGIN


@pytest.mark.parametrize("away", [(0.16, 0.0, 0.0), (0.35, 0.0, 0.05), (3.0, 0.0, 0.0)])
def test_rows_before_the_influence_are_counted(away) -> None:
    clearance, start, pairs = beside(away)
    q = way_into(start)
    inside = [np.min(least_of(clearance, row, pairs)) < INFLUENCE for row in q]
    wanted = inside.index(True) if any(inside) else len(q)
    fresh = Clearance(clearance.distances)
    assert fresh.far_rows(q) == wanted
    assert fresh.untouched(q) is (wanted == len(q))


def test_what_is_inside_its_margin_at_the_start_may_stay_as_near() -> None:
    clearance, start, pairs = beside((0.16, 0.0, 0.0), margin=0.2)
    here = least_of(clearance, start, pairs)
    floors = clearance.floors(pairs, start)
    np.testing.assert_allclose(floors, np.minimum(0.2, here), rtol=0, atol=1e-12)
    assert np.any(here < 0.2)
    assert clearance.short(start, start) is None
    nearer, farther = way_into(start)[6], way_into(start)[0] - (way_into(start)[6] - start)
    found = clearance.short(nearer, start)
    assert found is not None
    assert found.floor == pytest.approx(here[found.pair], abs=1e-12)
    assert clearance.short(farther, start) is None
    # From another start, other floors.
    np.testing.assert_allclose(
        clearance.floors(pairs, nearer), np.minimum(0.2, least_of(clearance, nearer, pairs)), atol=1e-12
    )
    np.testing.assert_allclose(clearance.floors(pairs, start), floors, rtol=0, atol=1e-12)
    deepest = clearance.inside_margin(start)
    assert deepest is not None
    assert (deepest.distance, deepest.floor) == (pytest.approx(np.min(here)), 0.2)
    assert beside((3.0, 0.0, 0.0))[0].inside_margin(start) is None


def test_a_ball_that_comes_is_looked_at_where_it_is_then() -> None:
    """It comes 0.48 m nearer in a second, from 0.5 m away: the robot stands."""
    clearance, start, pairs = beside((0.5, 0.0, 0.0), moving=np.array([-0.48, 0.0, 0.0]))
    times = np.linspace(0.0, 1.0, 41)
    rooms = []
    for time in times:
        clearance.after(float(time))
        rooms.append(np.min(least_of(clearance, start, pairs)) - MARGIN)
    wanted = int(np.flatnonzero(np.array(rooms) < -1e-6)[0])
    found = clearance.first_short(np.tile(start, (41, 1)), start, times)
    assert found is not None
    assert found[0] == wanted > 5
    assert clearance.first_short(np.tile(start, (41, 1)), start, 0.0 * times) is None
    assert not clearance.untouched(np.tile(start, (3, 1)))
    nearest = clearance.nearest(start, start, elapsed=float(times[wanted]))
    assert nearest is not None
    assert nearest.distance == pytest.approx(rooms[wanted] + MARGIN, abs=1e-9)


@pytest.mark.parametrize("paced", [True, False])
def test_floors_of_a_tick_let_a_part_of_the_room_go(paced: bool) -> None:
    """dt / tau of what is left above margin and reserve, or all of it."""
    clearance, start, _ = beside((0.2, 0.0, 0.0))
    tick = clearance.tick(start, DT, paced=paced)
    assert tick is not None
    left = tick.near.distance - MARGIN - RESERVE
    assert np.all(left > 0.0)
    share = DT / APPROACH_TIME if paced else 1.0
    np.testing.assert_allclose(tick.floors, tick.near.distance - share * left, rtol=0, atol=1e-12)
    far = beside((3.0, 0.0, 0.0))[0]
    first = far.tick(start, DT)
    assert first is None or not len(first.near.pairs)
    assert far.tick(start, DT) is None


def test_rows_of_a_tick_are_distances_linearised_where_it_is() -> None:
    """d(q + S) >= floor to first order about the step so far; looked at again where that has gone far."""
    clearance, start, _ = beside((0.2, 0.0, 0.0))
    tick = clearance.tick(start, DT)
    assert tick is not None
    floors, pairs = tick.floors.copy(), tick.near.pairs.copy()
    looked = np.zeros(7)
    for whole in (np.zeros(7), np.full(7, 2e-5), np.full(7, 0.02), -np.full(7, 0.03)):
        rows = tick.rows(whole)
        if np.max(np.abs(whole - looked)) > 1e-4:
            looked = whole
        here = clearance.distances.of(start + looked, pairs).distance
        step = 1e-6
        for joint in range(7):
            ahead = clearance.distances.of(start + looked + step * np.eye(7)[joint], pairs).distance.copy()
            behind = clearance.distances.of(start + looked - step * np.eye(7)[joint], pairs).distance
            np.testing.assert_allclose(
                rows.matrix[:, joint], (ahead - behind) / (2 * step), rtol=0, atol=2e-4
            )
        wanted = floors - here - rows.matrix @ (whole - looked)
        np.testing.assert_allclose(rows.lower, wanted, rtol=0, atol=1e-9)


def test_a_step_that_breaks_a_floor_is_not_kept() -> None:
    clearance, start, _ = beside((0.2, 0.0, 0.0))
    tick = clearance.tick(start, DT)
    assert tick is not None
    assert tick.kept(np.zeros(7))
    into = way_into(start)[12] - start
    ended = clearance.distances.of(start + into, tick.near.pairs).distance
    assert np.any(ended < tick.floors - 1e-6)
    assert not tick.kept(into)
    loose = clearance.tick(start, DT).without(tick.near.pairs)
    assert not len(loose.near.pairs)


@pytest.mark.parametrize(("rows", "clear"), [(2, False), (200, True)])
def test_a_way_stays_clear_where_its_steps_are_short(rows: int, clear: bool) -> None:
    """A turn past a ball that is far from the way; in one step the joints might go anywhere between."""
    clearance, start, _ = beside((3.0, 0.0, 0.0))
    turn = np.linspace(-1.5, 1.5, rows)[:, None] * np.eye(7)[0]
    assert clearance.stays_clear(start + turn) is clear


def test_a_way_through_a_ball_between_two_rows_is_not_clear() -> None:
    clearance, start, pairs = beside((0.1, 0.0, 0.0))
    ends = start + np.outer([-1.4, 1.4], np.eye(7)[0])
    assert all(np.min(least_of(clearance, end, pairs)) > INFLUENCE for end in ends)
    assert np.min(least_of(clearance, start, pairs)) < 0.1
    assert clearance.stays_clear(ends) is False
    assert Clearance(clearance.distances).stays_clear(ends[:1]) is True


@pytest.mark.parametrize("scale", [-1.0, 0.1, 0.5, 0.9, 1.1, 2.0])
def test_whether_a_step_that_goes_on_stays_clear(scale: float) -> None:
    """To first order, by differences: up to where the nearest pair has come to margin and reserve."""
    clearance, start, _ = beside((0.2, 0.0, 0.0))
    tick = clearance.tick(start, DT)
    assert tick is not None
    pairs, whole, way = tick.near.pairs.copy(), np.full(7, 1e-3), way_into(start)[-1] - start
    here = least_of(clearance, start + whole, pairs)
    there = least_of(clearance, start + whole + 1e-6 * way, pairs)
    slope = (there - here) / 1e-6
    coming = slope < 0.0
    assert np.any(coming)
    reached = float(np.min((here - MARGIN - RESERVE)[coming] / -slope[coming]))
    assert tick.stays_clear(whole, scale * reached * way) is (scale < 1.0)
