"""Rows of a dry run's look at a motion whose postures are a polynomial that is known."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.polynomial import Chebyshev

from irlx.motion.trapezoid import Trapezoid
from irlx.pacing.glance import _AT, NODES, ROW_STEP, Glanced, Undisturbed, _curve, _rows
from irlx.transform.criteria.posture import Posture
from machines import machine

DT, TICKS, FIRST = 0.01, 190, 41
FROZEN = 2


def postures(s: np.ndarray, size: float) -> np.ndarray:
    """Cubics of s for all joints but the frozen one."""
    robot = machine("arm7")
    way = size * (np.outer(s, np.arange(1.0, 8.0)) + np.outer(s**3, np.arange(7.0, 0.0, -1.0)))
    way[:, FROZEN] = 0.0
    return robot.start + way


@pytest.mark.parametrize(("size", "more"), [(1e-3, False), (0.3, True)])
def test_rows_are_on_the_polynomial_close_enough_and_at_ticks_of_the_law(size: float, more: bool) -> None:
    """Two pieces. A joint that is frozen keeps its bits, the last row is the last node itself."""
    robot = machine("arm7")
    path = robot.line((0.0, -0.4, 0.0))
    law = Trapezoid.fastest(path.length, 0.25, 1.5)
    breaks = np.array([0.0, 0.25, path.length])
    nodes = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * _AT[:-1]).ravel(), breaks[-1])
    values = np.array([postures(nodes[:7], size), postures(nodes[6:], size)])
    curve = Undisturbed(breaks, values, nodes, path.poses(nodes))
    motion = Glanced(path, law, TICKS, robot.start, None, DT, FIRST)
    found = _rows(motion, robot.model(frozen=(FROZEN,)), curve)
    s, rows = found.demands.s, len(found.q)
    assert (rows > len(nodes) - 1) is more
    assert np.all(np.isin(nodes[1:], s))
    np.testing.assert_allclose(found.q, postures(s, size), atol=1e-12)
    assert np.max(np.abs(np.diff(found.q, axis=0, prepend=robot.start[None]))) <= 1.5 * ROW_STEP
    assert np.all(found.q[:, FROZEN] == robot.start[FROZEN])
    assert np.array_equal(found.q[-1], values[-1, -1])
    ticks = found.demands.tick - (FIRST - 1)
    assert ticks[-1] == TICKS
    assert np.all(np.diff(ticks) >= 0)
    due = law.times_at(s[:-1]) / DT
    assert np.all((ticks[:-1] >= due - 1e-6) & (ticks[:-1] <= np.maximum(due + 1.0, 1.0)))
    np.testing.assert_allclose(found.demands.position, path.poses(s).position, atol=1e-14)
    # Nobody of a dry run asks for twists; there is one for every row all the same.
    assert found.demands.twist.shape == (rows, 6)
    assert np.all(np.isnan(found.demands.twist))


@pytest.mark.parametrize("degree", [NODES - 3, NODES - 2, NODES - 1])
def test_the_tail_of_a_chebyshev_polynomial_is_its_factor(degree: int) -> None:
    """Of one whose degree is not one of the last two there is none."""
    values = 3e-4 * Chebyshev.basis(degree)(1.0 - 2.0 * _AT)
    curve = Undisturbed(np.array([0.0, 1.0]), values[None, :, None], _AT, None)
    expected = 3e-4 if degree >= NODES - 2 else 0.0
    np.testing.assert_allclose(curve.tails, [expected], rtol=1e-12, atol=1e-18)


def test_the_criterion_of_each_node_is_asked_for_by_place_and_way() -> None:
    """The place of a node, and the way there from the one before; two pieces."""
    robot = machine("arm7")
    path = robot.line((0.0, -0.05, 0.0))
    asked: list[tuple[float, float]] = []

    def at(s: float, way: float) -> Posture:
        asked.append((s, way))
        return Posture(robot.weights, robot.start)

    motion = Glanced(path, Trapezoid.fastest(0.05, 0.25, 1.5), 30, robot.start, SimpleNamespace(at=at), DT, 1)
    curve = _curve(motion, robot.model(), np.array([0.0, 0.02, path.length]))
    assert curve is not None
    nodes = np.unique([*(0.02 * _AT), *(0.02 + (path.length - 0.02) * _AT)])
    places, ways = np.array(asked).T
    np.testing.assert_allclose(places, nodes[1:], rtol=1e-12)
    np.testing.assert_allclose(ways, np.diff(nodes), rtol=1e-9)
    np.testing.assert_allclose(curve.nodes, nodes, rtol=1e-12)
