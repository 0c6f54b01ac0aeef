"""Places on the join that rounds a corner, found again in narrow bends."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from irlx.blocks import ArcCourse, PoseTarget
from irlx.verifier.geometry.arcs import ArcShape, arc_shape
from irlx.verifier.geometry.blends import Blend
from irlx.verifier.geometry.curves import ArcCurve, LineCurve

pytestmark = [pytest.mark.req("MOT-06"), pytest.mark.req("STR-06")]

START, CORNER = np.array([0.0762206, 0.7461615, 0.0]), np.array([-0.1047929, 0.7140762, 0.0])
VIA, END = np.array([-0.0725035, 0.7265509, 0.0]), np.array([-0.0610517, 0.6831348, 0.0])


@pytest.fixture(scope="module")
def hairpin() -> Blend:
    """From a line into a circle that leads back: of a tangent that all but vanishes in between."""
    shape = arc_shape(CORNER, VIA, END, None)
    assert shape is not None
    still = np.eye(3)
    circle = ArcCurve(shape, ArcCourse(PoseTarget((0.0, 0.0, 0.0), None)), (still, still, still))
    return Blend(LineCurve((START, still), (CORNER, still)), circle, 0.5 * circle.length)


def test_places_in_a_narrow_bend_are_found_again(hairpin: Blend) -> None:
    u = np.linspace(0.6, 0.9, 1201)
    turned = np.unwrap(np.arctan2(*np.diff(hairpin.points(u)[:, :2], axis=0).T[::-1]))
    assert np.ptp(turned) > 2.5, "no hairpin"
    assert hairpin.nearest(hairpin.points(u)) == pytest.approx(u, abs=1e-9)


def test_the_length_of_a_narrow_bend(hairpin: Blend) -> None:
    def rate(u: float) -> float:
        near = hairpin.points(np.array([u - 1e-6, u + 1e-6]))
        return float(np.linalg.norm(near[1] - near[0])) / 2e-6

    for low, high in ((0.1, 0.5), (0.7, 0.85)):
        found = hairpin.way(np.array([low, high]))
        true = quad(rate, low, high, limit=400, epsrel=1e-10, points=np.linspace(low, high, 21)[1:-1])[0]
        assert found[1] - found[0] == pytest.approx(true, rel=1e-7)


def test_rows_beyond_its_ends_lie_at_them(hairpin: Blend) -> None:
    ends, inner = hairpin.points(np.array([0.0, 1.0])), hairpin.points(np.array([1e-6, 1.0 - 1e-6]))
    outward = ends - inner
    beyond = np.add(ends, 1e-5 * outward / np.linalg.norm(outward, axis=1)[:, None])
    assert hairpin.nearest(beyond) == pytest.approx([0.0, 1.0], abs=1e-12)


def circle(start: np.ndarray, heading: float, radius: float, travel: float) -> ArcCurve:
    """To the left of a heading, rad, in the plane."""
    forward, inward = np.array(
        [[np.cos(heading), np.sin(heading), 0.0], [-np.sin(heading), np.cos(heading), 0.0]]
    )
    shape = ArcShape(start, forward, inward, 1.0 / radius, 2.0, travel)
    still = np.eye(3)
    return ArcCurve(shape, ArcCourse(PoseTarget((0.0, 0.0, 0.0), None), angle=travel), (still, still, still))


def test_places_of_a_join_that_crosses_itself_near_its_end_are_found_again() -> None:
    """Of some the nearest sample is the end, which they lie behind."""
    first = circle(np.zeros(3), 0.0, 0.041456804, 5.8421997)
    second = circle(first.points(np.array([first.length]))[0], 5.8421997 - 0.3398037, 0.0364748, 8.0)
    join = Blend(first, second, 0.5 * first.length)
    u = np.linspace(0.0, 1.0, 1201)
    assert join.nearest(join.points(u)) == pytest.approx(u, abs=1e-9)
