"""Conditions whose equations joints can break or not, by a condition whose derivative is known."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.moved_constraints import SomeRows, moved_constraints
from irlx.robot.equality import Constraint

Q = np.array([0.3, -0.4, 0.2, 0.7, -0.1, 0.5, 0.9])


class Two(Constraint):
    """q0 q1 - 1 = 0 and sin q3 + q4 = 0."""

    name = "two"

    def residual(self, q: np.ndarray) -> np.ndarray:
        return np.array([q[0] * q[1] - 1.0, np.sin(q[3]) + q[4]])

    def derivative(self, q: np.ndarray) -> np.ndarray:
        found = np.zeros((2, q.size))
        found[0, :2], found[1, 3], found[1, 4] = q[1::-1], np.cos(q[3]), 1.0
        return found


@pytest.mark.parametrize("row", [0, 1])
def test_some_rows_are_those_of_the_whole_and_their_derivative_is_that_of_their_values(row: int) -> None:
    some, h = SomeRows(Two(), np.arange(2) == row), 1e-6
    assert some.name == "two"
    assert some.residual(Q) == Two().residual(Q)[[row]]
    slope = [(some.residual(Q + h * one) - some.residual(Q - h * one)) / (2.0 * h) for one in np.eye(7)]
    np.testing.assert_allclose(some.derivative(Q), np.array(slope).T, atol=1e-9)
    left, derivative = some.rows(Q)
    assert np.array_equal(left, some.residual(Q))
    assert np.array_equal(derivative, some.derivative(Q))


@pytest.mark.parametrize(
    ("free", "rows"),
    [((0, 1, 2, 3, 4, 5, 6), [0, 1]), ((0, 4), [0, 1]), ((1,), [0]), ((3, 5), [1]), ((2,), [])],
)
def test_equations_that_no_free_joint_moves_are_left_out(kit, free: tuple[int, ...], rows: list[int]) -> None:
    mask = np.isin(np.arange(7), free)
    found = moved_constraints([Two()], kit.gantry(), Q, mask)
    left = [value for item in found for value in item.residual(Q)]
    assert left == Two().residual(Q)[rows].tolist()
