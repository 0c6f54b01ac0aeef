"""Rows of hand-made ways on the parts of a chain: together or one by one, they lie where they were put."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import ArcCourse, PoseTarget
from irlx.promises import PATH_POSITION
from irlx.verifier.geometry.arcs import arc_shape
from irlx.verifier.geometry.bends import stretches_between
from irlx.verifier.geometry.chain_parts import ChainParts, Leg, Part
from irlx.verifier.geometry.chains import FEW, ChainWay
from irlx.verifier.geometry.corners import Corner
from irlx.verifier.geometry.curves import ArcCurve, LineCurve
from passing_moves import Curve, arc, line, way_of

pytestmark = [pytest.mark.req("MOT-06"), pytest.mark.req("STR-06")]

STILL, UPRIGHT = np.eye(3), Rotation.identity()
ANYHOW = Corner(np.inf, may_be_less=True)


def straight(*points: tuple[float, float]) -> list[Curve]:
    """Lines in a plane from point to point, mm."""
    at = [np.array([x, y, 0.0]) * 1e-3 for x, y in points]
    return [line(a, b, UPRIGHT, np.zeros(3)) for a, b in pairwise(at)]


def leg_of(curve: Curve, corner: Corner) -> Leg:
    """The same curve as the verifier rebuilds it; an arc by its first third and two thirds of a turn."""
    start, end = curve.point(np.array([0.0, curve.length]))
    bend = np.linalg.norm(curve.bend(0.0))
    if bend == 0.0:
        return Leg(LineCurve((start, STILL), (end, STILL)), corner)
    via, goal = curve.point(np.array([2.0, 4.0]) / bend)
    shape = arc_shape(start, via, goal, curve.length * bend)
    assert shape is not None
    return Leg(ArcCurve(shape, ArcCourse(PoseTarget((0.0, 0.0, 0.0), None)), (STILL,) * 3, 1.0), corner)


def legs_of(curves: list[Curve], corners: list[Corner]) -> list[Leg]:
    """With room for half of the shorter neighbour at each corner."""
    found = []
    for curve, following, corner in zip(
        curves, [*curves[1:], curves[-1]], [*corners, Corner(0.0)], strict=True
    ):
        room = min(corner.distance, 0.5 * curve.length, 0.5 * following.length)
        found.append(leg_of(curve, Corner(room, corner.may_be_less, corner.may_stop)))
    return found


def taken(
    legs: list[Leg], points: np.ndarray, reach: float, together: int
) -> tuple[np.ndarray, np.ndarray, ChainWay]:
    """How far rows are off, and along the way, given so many at a time; those that wait are given again."""
    way, begin = ChainWay(legs, reach), 0
    off, along = np.empty((2, len(points)))
    attitudes = np.tile(STILL, (len(points), 1, 1))
    for end in [*range(together, len(points), together), len(points)]:
        placed = way.take(points[begin:end], attitudes[begin:end], end == len(points))
        here = slice(begin, begin + len(placed.along))
        off[here], along[here], begin = placed.position, placed.along, here.stop
    assert begin == len(points)
    return off, along, way


@pytest.mark.parametrize("together", [1, 3, 1000])
def test_rounds_of_a_circle_tell_nothing_of_the_corner_behind_it(together: int) -> None:
    """A whole circle comes by the corner when it begins: no row lies beside the corner itself, and the way is
    no longer than it was run."""
    radius, taken_at = 2e-3, 4e-4
    (lead,) = straight((0.0, 0.0), (2.6, 0.0))
    start = np.zeros(3)
    round_ = arc(start, start + np.array([0.0, radius, 0.0]), [0, 0, 1], 2.0 * np.pi, UPRIGHT, np.zeros(3))
    assert np.allclose(round_.point(np.array([round_.length])), start)
    way = way_of([round_, lead], [taken_at])
    step = 9.7e-4
    # The last row before the corner, and the first one behind it, lie on circle and line.
    before = np.arange(round_.length - taken_at - 1e-4, 0.0, -step)[::-1]
    s = np.concatenate([before, np.arange(before[-1] + step, way.length, step), [way.length]])
    points = way.poses(s)[0]
    off, along, chain = taken(legs_of([round_, lead], [ANYHOW]), points, 2.0 * step, together)
    assert off.max() < 1e-9
    assert np.diff(along).max() < step * (1.0 + 1e-6)
    assert chain.left - along[-1] == pytest.approx(0.0, abs=1e-9)


SHORT = straight((0, 0), (3, 0), (3, 0.02), (2.97, 0.05), (0, 0.05))
"""There and back: legs of 20 and 42 um between long ones."""


@pytest.mark.parametrize("told", [(), (1,), (0, 2)], ids=str)
def test_rows_lie_where_they_do_however_many_are_given_together(told: tuple[int, ...]) -> None:
    """Corners that are run within a tick, some of which rows have to tell of."""
    corners = [Corner(1e-5) if k in told else ANYHOW for k in range(3)]
    distances = [1e-5 if k in told else at for k, at in enumerate((8e-6, 7e-6, 1.5e-5))]
    way, legs, step = way_of(SHORT, distances), legs_of(SHORT, corners), 1.5e-4
    points = way.poses(np.append(np.arange(0.0027, 0.0036, step), way.length))[0]
    off, along, _ = taken(legs, points, 2.0 * step, 1000)
    assert off.max() < 1e-8
    assert np.diff(along)[:-1].max() < step * (1.0 + 1e-6)
    assert taken(legs, points, 2.0 * step, 2)[1] == pytest.approx(along, abs=1e-12)


def test_as_many_rows_tell_of_unseen_corners_whichever_are_given_together() -> None:
    """The first row behind them waits until there are so many, or no more."""
    corners = [Corner(1e-5), ANYHOW, Corner(1e-5)]
    way, step = way_of(SHORT, [1e-5, 7e-6, 1e-5]), 1.5e-4
    points = way.poses(np.arange(0.00277, 0.0058, step))[0]
    still, before = np.tile(STILL, (len(points), 1, 1)), int(np.argmax(points[:, 1] > 4e-5))
    for given in (before + 1, before + FEW - 1):
        chain = ChainWay(legs_of(SHORT, corners), 2.0 * step)
        assert len(chain.take(points[:given], still[:given], False).along) == before
        rest = slice(before, before + FEW)
        assert len(chain.take(points[rest], still[rest], False).along) == FEW
        assert chain.leg == 3
    chain = ChainWay(legs_of(SHORT, corners), 2.0 * step)
    assert len(chain.take(points[: before + 1], still[: before + 1], True).along) == before + 1


def test_a_row_off_the_way_waits_for_none_where_all_corners_are_known() -> None:
    curves = straight((0, 0), (3, 0), (3, 3))
    chain = ChainWay(legs_of(curves, [Corner(1e-3)]), 1e-3)
    points = way_of(curves, [1e-3]).poses(np.arange(5e-4, 5.4e-3, 5e-4))[0]
    points[-1, 0] += 1e-4
    placed = chain.take(points, np.tile(STILL, (len(points), 1, 1)), False)
    assert placed.position[:-1].max() < 1e-9
    assert placed.position[-1] == pytest.approx(1e-4)


def test_a_row_within_the_tolerance_of_two_parts_lies_on_the_nearer_one() -> None:
    curves = straight((0, 0), (3, 0), (0, 1.2))
    chain = ChainWay(legs_of(curves, [Corner(4e-7)]), 1e-3)
    points = np.array([[0.0025, 0.0, 0.0], curves[1].point(np.array([2e-6]))[0]])
    assert abs(points[1, 1]) < PATH_POSITION
    placed = chain.take(points, np.tile(STILL, (2, 1, 1)), False)
    assert placed.leg.tolist() == [0, 1]
    assert placed.position.max() < 1e-12


@pytest.mark.parametrize("corner", [ANYHOW, Corner(1e-3)], ids=["C_PASS", "C_CP"])
def test_only_blends_that_are_told_bend_between_two_rows(corner: Corner) -> None:
    parts = ChainParts(legs_of(straight((0, 0), (3, 0), (3, 3)), [corner]))
    parts.settle(1e-3)
    found = stretches_between(parts, (Part(0, False), 0.001), (Part(1, False), 0.002))
    blend = parts.blends[0]
    assert blend is not None
    assert found.ways.sum() == pytest.approx(0.002 + blend.length, abs=1e-12)
    assert found.bends[[0, -1]].tolist() == [0.0, 0.0]
    assert found.bends.max() == 0.0 if corner is ANYHOW else found.bends.max() > 500.0
