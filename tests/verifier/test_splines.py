"""Places on the verifier's splines: of points of the curve, whatever else of it is near."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.verifier.geometry.splines import SplineCurve


def curve_through(*points: tuple[float, float, float]) -> SplineCurve:
    return SplineCurve([(np.array(point), np.eye(3)) for point in points])


CURVES = {
    "a long piece and three of a millimetre": (
        (0.612171, -0.605983, 0.181442),
        (0.627902, -0.201402, -0.087218),
        (0.627495, -0.201816, -0.086052),
        (0.627834, -0.201894, -0.087782),
        (0.628762, -0.202037, -0.086125),
    ),
    "a long piece on which short ones lie": (
        (0.0, 0.0, 0.0),
        (0.5, 0.0, 0.0),
        (0.498, 0.0005, 0.0),
        (0.496, 0.0, 0.0005),
        (0.494, 0.0, 0.0),
    ),
    "pieces alike": ((0.0, 0.0, 0.0), (0.1, 0.1, 0.0), (0.2, 0.0, 0.1), (0.3, 0.1, 0.0)),
}


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("name", CURVES)
@pytest.mark.parametrize("steps", [300, 2500])
def test_rows_on_a_curve_are_placed_where_they_are(name: str, steps: int) -> None:
    curve = curve_through(*CURVES[name])
    ways = np.linspace(0.0, curve.length, steps)
    found = curve.nearest(curve.points(ways), 0.0)
    np.testing.assert_allclose(found, ways, rtol=0.0, atol=1e-9)
