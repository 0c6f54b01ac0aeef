"""Where rows are on a last circle before the corner to a PTP: rounds are counted from its end."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.blocks import ArcCourse, PoseTarget
from irlx.verifier.geometry.arcs import arc_shape
from irlx.verifier.geometry.curves import ArcCurve
from irlx.verifier.judges.chain_end import ways_on_last_circle

pytestmark = [pytest.mark.req("MOT-06"), pytest.mark.req("STR-06")]

RADIUS, ROUNDS = 0.01, 2.5
ROUND = 2.0 * np.pi * RADIUS
REACH = 0.1 * ROUND
CENTRE = np.array([0.3, 0.2, 0.1])


def points(ways: np.ndarray) -> np.ndarray:
    angles = np.asarray(ways)[:, None] / RADIUS
    return CENTRE + RADIUS * np.hstack([np.cos(angles), np.sin(angles), 0.0 * angles])


@pytest.fixture(scope="module")
def circle() -> ArcCurve:
    shape = arc_shape(*points(RADIUS * np.array([0.0, 2.0, 4.0])), ROUNDS * 2.0 * np.pi)
    assert shape is not None
    return ArcCurve(shape, ArcCourse(PoseTarget((0.0, 0.0, 0.0), None)), (np.eye(3),) * 3)


ON = ROUND * (ROUNDS - 0.1 - np.array([0.2, 0.13, 0.05, 0.02]))
"""Ways of rows in the last round, up to a fiftieth of it before the corner."""
IN_CORNER = ROUND * (ROUNDS - np.array([0.06, 0.03, 0.0]))
OFF = np.array([[0.0, 0.0, 1e-4]])


@pytest.mark.parametrize("by_chance", [1, 2])
def test_a_row_that_lies_on_the_circle_by_chance_does_not_count(circle, by_chance: int) -> None:
    corner = points(IN_CORNER) + OFF
    corner[by_chance] -= OFF[0]
    ways = ways_on_last_circle(circle, np.concatenate([points(ON), corner]), None, REACH)
    assert ways[:4] == pytest.approx(ON, abs=1e-12)
    assert (ways[4:] == circle.length).all()


def test_where_none_follows_another_the_last_one_counts(circle) -> None:
    rows = points(ON) + np.outer([0.0, 1.0, 0.0, 1.0], OFF[0])
    ways = ways_on_last_circle(circle, rows, None, REACH)
    assert ways[2] == pytest.approx(ON[2], abs=1e-12)
    assert ways[3] == circle.length


def test_from_a_known_place_rounds_are_counted_on(circle) -> None:
    rows = np.concatenate([points(ON), points(IN_CORNER) + OFF])
    ways = ways_on_last_circle(circle, rows, float(ON[0]) - ROUND - 0.07 * ROUND, REACH)
    assert ways[:4] == pytest.approx(ON - ROUND, abs=1e-12)
    assert (ways[4:] == circle.length).all()


def test_rows_beside_the_circle_are_all_in_the_corner(circle) -> None:
    assert (ways_on_last_circle(circle, points(ON) + OFF, None, REACH) == circle.length).all()
