"""Volumes of ellipsoids where they are known: products of semi-axes, nothing where one is next to nothing."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.transform.measures.ellipsoid import volume, volume_derivative

pytestmark = pytest.mark.req("TRF-15")


def with_axes(*lengths: float, columns: int | None = None) -> np.ndarray:
    """A matrix with these singular values, turned at random on both sides."""
    rng = np.random.default_rng(len(lengths))
    n = columns or len(lengths)
    left, right = (np.linalg.qr(rng.normal(size=(k, k)))[0] for k in (len(lengths), n))
    return left @ np.eye(len(lengths), n) * 1.0 @ np.diag([*lengths, *[0.0] * (n - len(lengths))]) @ right


@pytest.mark.parametrize(("lengths", "columns"), [((2.0, 3.0, 0.5), 3), ((2.0, 3.0, 0.5), 6), ((4.0,), 3)])
def test_it_is_the_product_of_the_axes(lengths, columns) -> None:
    matrix = with_axes(*lengths, columns=columns)
    assert volume(matrix) == pytest.approx(np.prod(lengths), rel=1e-12)
    assert volume(matrix.T) == pytest.approx(np.prod(lengths), rel=1e-12)
    gram = np.linalg.det(matrix @ matrix.T)
    assert volume(matrix) == pytest.approx(np.sqrt(gram), rel=1e-9)


def test_an_axis_counts_as_nothing_beside_the_longest_one() -> None:
    """Whatever lies between them: 1E-13 is nothing beside 1, 1E-11 is something."""
    assert volume(np.diag([1.0, 1e-6, 1e-13])) == 0.0
    assert volume(np.diag([1.0, 1e-6, 1e-11])) == pytest.approx(1e-17, rel=1e-9)
    np.testing.assert_array_equal(volume_derivative(np.diag([1.0, 1e-6, 1e-13])), np.zeros((3, 3)))


def test_its_derivative_by_the_entries() -> None:
    matrix, way, h = with_axes(2.0, 0.7, 0.3, columns=5), np.random.default_rng(4).normal(size=(3, 5)), 1e-6
    slope = (volume(matrix + h * way) - volume(matrix - h * way)) / (2 * h)
    assert np.sum(volume_derivative(matrix) * way) == pytest.approx(slope, rel=1e-7)
