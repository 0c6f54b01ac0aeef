"""The spline through the knots against functions it must reproduce."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.slowdown.curve import JointCurve

pytestmark = pytest.mark.req("MOT-21")

S = np.concatenate([np.linspace(0.0, 0.3, 12), np.linspace(0.3, 2.0, 25)[1:]])


def test_cubics_are_reproduced_with_their_derivatives() -> None:
    """Not-a-knot splines are exact for cubics, on uneven knots too."""
    cubic, line = np.polynomial.Polynomial([0.3, -1.0, 2.0, 0.7]), np.polynomial.Polynomial([1.0, 4.0])
    curve = JointCurve(S, np.column_stack([cubic(S), line(S)]))
    s = np.linspace(0.0, 2.0, 301)
    first, second = curve.derivatives(s)
    for column, polynomial in enumerate((cubic, line)):
        np.testing.assert_allclose(curve.at(s)[:, column], polynomial(s), atol=1e-13)
        np.testing.assert_allclose(first[:, column], polynomial.deriv()(s), atol=1e-11)
        np.testing.assert_allclose(second[:, column], polynomial.deriv(2)(s), atol=1e-9)


def test_knots_are_met_and_derivatives_are_those_of_the_values() -> None:
    curve = JointCurve(S, np.sin(3.0 * S)[:, None])
    np.testing.assert_allclose(curve.at(S), curve.q, atol=1e-15)
    s, h = np.linspace(0.01, 1.99, 97), 1e-5
    first, second = curve.derivatives(s)
    np.testing.assert_allclose(first, (curve.at(s + h) - curve.at(s - h)) / (2 * h), atol=1e-8)
    np.testing.assert_allclose(
        second, (curve.derivatives(s + h)[0] - curve.derivatives(s - h)[0]) / (2 * h), atol=1e-3
    )


def test_joints_that_rest_keep_their_bits() -> None:
    q = np.column_stack([np.sin(S), np.full(S.size, 0.1 + 0.2), np.full(S.size, 1.0 / 3.0)])
    curve = JointCurve(S, q)
    s = np.linspace(0.0, 2.0, 1001)
    assert np.all(curve.at(s)[:, 1:] == q[0, 1:])
    assert np.all(curve.derivatives(s)[0][:, 1:] == 0.0)
