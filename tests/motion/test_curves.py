"""Rotation vectors and polynomial curves, against differences and quadrature."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from irlx.motion.polynomial_curve import PolynomialCurve
from irlx.motion.rotation_vector import angular_rates, vector_rates
from irlx.motion.turn_curve import TurnCurve, TurnJet

pytestmark = pytest.mark.req("MOT-01")


@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-3, 0.0499, 0.0501, 1.0, 3.0])
def test_angular_rates_by_differences(size: float) -> None:
    rng = np.random.default_rng(4)
    direction = rng.normal(size=3)
    r0 = size * direction / np.linalg.norm(direction)
    r1, r2 = rng.normal(size=(2, 3))

    def rotation(t: float) -> Rotation:
        return Rotation.from_rotvec(r0 + t * r1 + 0.5 * t * t * r2)

    def rate(t: float) -> np.ndarray:
        h = 1e-4
        return (rotation(t + h) * rotation(t - h).inv()).as_rotvec() / (2.0 * h)

    found, bend = angular_rates(r0[None], r1[None], r2[None])
    assert np.max(np.abs(found[0] - rate(0.0))) < 1e-7
    assert np.max(np.abs(bend[0] - (rate(1e-4) - rate(-1e-4)) / 2e-4)) < 1e-6
    back = vector_rates(r0[None], found, bend)
    assert np.max(np.abs(back[0][0] - r1)) < 1e-12
    assert np.max(np.abs(back[1][0] - r2)) < 1e-12


def test_factors_meet_where_series_end() -> None:
    axis, dr, ddr = np.array([[0.6, 0.0, 0.8]]), np.array([[1.0, 2.0, 3.0]]), np.array([[-1.0, 0.5, 2.0]])
    sides = [angular_rates(angle * axis, dr, ddr) for angle in (0.05 * (1 - 1e-12), 0.05 * (1 + 1e-12))]
    for near, far in zip(*sides, strict=True):
        assert np.max(np.abs(near - far)) < 1e-10


def test_small_and_large_vectors_side_by_side() -> None:
    """Each gets what it gets alone, whatever stands beside it: a series near 0, closed forms elsewhere."""
    rng = np.random.default_rng(12)
    r = rng.normal(size=(6, 3)) * np.array([1e-3, 1.0, 0.0, 2.0, 1e-9, 0.3])[:, None]
    dr, ddr = rng.normal(size=(2, 6, 3))
    for together, alone in (
        (
            angular_rates(r, dr, ddr),
            [angular_rates(*(part[k : k + 1] for part in (r, dr, ddr))) for k in range(6)],
        ),
        (
            vector_rates(r, dr, ddr),
            [vector_rates(*(part[k : k + 1] for part in (r, dr, ddr))) for k in range(6)],
        ),
    ):
        for found, each in zip(together, zip(*alone, strict=True), strict=True):
            np.testing.assert_allclose(found, np.concatenate(each), rtol=1e-12, atol=1e-12)


def test_arc_length() -> None:
    rng = np.random.default_rng(8)
    curve = PolynomialCurve(np.array([0.0, 0.4, 1.0]), rng.normal(size=(4, 2, 3)))
    u = np.array([0.0, 0.1, 0.4, 0.77, 1.0])

    def speed(x: float) -> float:
        return float(curve.speeds(np.array([x]))[0])

    for value, found in zip(u, curve.length_at(u), strict=True):
        exact = quad(
            lambda x: float(curve.speeds(np.array([x]))[0]),
            0.0,
            value,
            points=[0.4],
            epsabs=1e-13,
            epsrel=1e-13,
        )[0]
        assert found == pytest.approx(exact, abs=1e-12)
    s = np.linspace(0.0, curve.length, 301)
    assert np.max(np.abs(curve.length_at(curve.parameters_at(s)) - s)) < 1e-14 * curve.length


@pytest.mark.parametrize("slowest", np.linspace(0.01, 0.99, 12))
def test_arc_length_of_a_curve_that_all_but_stands(slowest: float) -> None:
    """P = (u^2/2 - c u, e u, 0) runs at sqrt((u - c)^2 + e^2), whose integral is closed form."""
    e = 1e-3
    curve = PolynomialCurve(
        np.array([0.0, 1.0]), np.array([[[0.5, 0, 0]], [[-slowest, e, 0]], [[0.0, 0, 0]]])
    )

    def primitive(x: float) -> float:
        return 0.5 * (x * np.hypot(x, e) + e * e * np.arcsinh(x / e))

    exact = primitive(1.0 - slowest) - primitive(-slowest)
    assert curve.length == pytest.approx(exact, rel=1e-12)


def test_turn_curve_meets_its_jets() -> None:
    rng = np.random.default_rng(9)
    rotations = Rotation.from_rotvec(0.6 * rng.normal(size=(3, 3))).as_matrix()
    jets = [TurnJet(rotation, *rng.normal(size=(2, 3))) for rotation in rotations]
    breaks = np.array([0.0, 0.7, 1.1])
    curve = TurnCurve.through(breaks, rotations[:-1], [(jets[0], jets[1]), (jets[1], jets[2])])
    for at in (breaks, breaks[1:2] - 1e-12):
        rates, bends = curve.rates(at)
        wanted = jets if len(at) > 1 else jets[1:2]
        assert np.allclose(curve.rotations(at), [jet.rotation for jet in wanted], atol=1e-9)
        assert np.allclose(rates, [jet.rate for jet in wanted], atol=1e-9)
        assert np.allclose(bends, [jet.bend for jet in wanted], atol=1e-8)
