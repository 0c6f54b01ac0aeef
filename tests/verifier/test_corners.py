"""The distance of a blend that rows took, told by rows on the second half of a circle."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import ArcCourse, PoseTarget
from irlx.verifier.geometry.arcs import arc_shape
from irlx.verifier.geometry.corners import Corner, distance_taken
from irlx.verifier.geometry.curves import ArcCurve, LineCurve, rounds
from made_chains import lines, pose_at
from passing_moves import arc, way_of

pytestmark = [pytest.mark.req("MOT-06"), pytest.mark.req("STR-06")]

RADIUS, ANGLE = 5e-5, 5.84
STILL = np.eye(3)
TAKEN = 0.35 * RADIUS * ANGLE


@pytest.fixture(scope="module")
def legs():
    """A line and an arc of most of a circle, by irlx and made by hand."""
    (first,) = lines((np.zeros(3), Rotation.identity()), [(0.005, 0.0, 0.0)], [(0.0, 0.0, 0.0)])
    here = pose_at(first, first.length)[0]
    centre = here + RADIUS * np.array([0.28, 0.96, 0.0])
    second = arc(here, centre, [0, 0, 1], ANGLE, Rotation.identity(), (0.0, 0.0, 0.0))
    via, end = (pose_at(second, share * second.length)[0] for share in (0.4, 1.0))
    shape = arc_shape(here, via, end, None)
    assert shape is not None
    line = LineCurve((np.zeros(3), STILL), (here, STILL))
    return (
        (line, ArcCurve(shape, ArcCourse(PoseTarget((0.0, 0.0, 0.0), None)), (STILL,) * 3)),
        (first, second),
    )


def test_rows_on_the_second_half_of_a_circle_tell_the_blend(legs) -> None:
    """None of them lies on the first half, and none farther away than the blend may reach."""
    told, made = legs
    way = way_of(list(made), [TAKEN])
    ways = np.append(
        np.arange(0.0048, way.length - 4.6 * RADIUS, 2e-5), way.length - RADIUS * np.array([1.6, 0.8])
    )
    rows = way.poses(ways)
    corner = Corner(0.5 * told[1].length, may_be_less=True)
    near = float(ways[0])
    assert distance_taken(told, corner, rows, near, False) == pytest.approx(TAKEN, abs=1e-10)
    assert distance_taken(told, corner, tuple(part[:-2] for part in rows), near, False) is None
    assert distance_taken(told, corner, tuple(part[:-1] for part in rows), near, False) is None


def test_a_circle_comes_by_its_points_in_every_round(legs) -> None:
    line, curve = legs[0]
    way = np.array([-1.0, 0.5]) * RADIUS
    assert len(rounds(line, way)) == 1
    found = rounds(curve, way)
    assert [values.tolist() for values in found] == [
        way.tolist(),
        pytest.approx((way + 2.0 * np.pi * RADIUS).tolist()),
    ]
    assert curve.points(found[1]) == pytest.approx(curve.points(way), abs=1e-15)


def test_steps_of_more_than_half_a_turn_lead_forwards_where_they_may(legs) -> None:
    shape = legs[0][1]._shape
    course, turns = ArcCourse(PoseTarget((0.0, 0.0, 0.0), None)), (STILL,) * 3
    ways = RADIUS * np.array([0.1, 4.1, 8.1])
    found = ArcCurve(shape, course, turns, 4.5).nearest(shape.points(ways / RADIUS), 0.0)
    assert found == pytest.approx(ways, abs=1e-12)
    back = RADIUS * np.array([2.0, 1.0, -0.5])
    found = ArcCurve(shape, course, turns, 3.0).nearest(shape.points(back / RADIUS), 0.0)
    assert found == pytest.approx(back, abs=1e-12)
