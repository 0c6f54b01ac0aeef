"""The curve that a link stays on: SciPy's splines, nearest points by brute force, the verifier's."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar

from irlx.cell.link_path_faults import LEAST_RADIUS, fault_of_curve, fault_of_points
from irlx.robot.plane_curve import PlaneCurve
from irlx.verifier.geometry.plane_paths import PlanePath

pytestmark = pytest.mark.req("TRF-22")

WAVE = [(0.0, 0.0), (1.0, 0.3), (2.0, -0.3), (3.5, 0.2), (4.0, 1.2)]
RING = [(1.0, 0.0), (0.1, 0.9), (-1.0, 0.2), (-0.2, -1.1)]
LINE = [(-1.0, 2.0), (1.0, 3.0)]
CORNER = [(0.0, 0.0), (1e-3, 0.0), (1.5, 0.0), (1.5, 1.0)]
CURVES = [(WAVE, False), (RING, True), (LINE, False), (CORNER, False), (RING[:3], True), (LINE * 1, False)]


def of_scipy(points, closed) -> CubicSpline:
    ends = np.array([*points, *(points[:1] if closed else ())])
    at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(ends, axis=0), axis=1))])
    if len(ends) == 2:
        return CubicSpline(at, ends, bc_type=((2, [0.0, 0.0]), (2, [0.0, 0.0])))
    return CubicSpline(at, ends, bc_type="periodic" if closed else "natural")


def brute(spline: CubicSpline, point: np.ndarray, closed: bool) -> tuple[float, float]:
    """Parameter and distance of the nearest point, the straight ends left out."""
    length = spline.x[-1]
    grid = np.linspace(0.0, length, 4001)
    best = grid[np.argmin(np.linalg.norm(spline(grid) - point, axis=1))]
    step = grid[1]

    def apart(u: float) -> float:
        inside = u % length if closed else min(max(u, 0.0), length)
        return float(np.sum((spline(inside) - point) ** 2))

    found = minimize_scalar(
        apart, bounds=(best - step, best + step), method="bounded", options={"xatol": 1e-12}
    )
    return float(found.x), float(np.sqrt(found.fun))


@pytest.mark.parametrize(("points", "closed"), CURVES)
def test_it_is_the_spline_of_scipy(points, closed) -> None:
    curve, spline = PlaneCurve(np.array(points), closed), of_scipy(points, closed)
    np.testing.assert_allclose(curve.samples, spline(curve.parameters), atol=1e-13)
    rate, change = spline(curve.parameters, 1), spline(curve.parameters, 2)
    bend = (rate[:, 0] * change[:, 1] - rate[:, 1] * change[:, 0]) / np.linalg.norm(rate, axis=1) ** 3
    np.testing.assert_allclose(curve.curvatures(), bend, atol=1e-9)
    steps = np.linalg.norm(np.diff(curve.samples, axis=0), axis=1)
    assert np.max(steps) <= 0.012


@pytest.mark.parametrize(("points", "closed"), CURVES)
@pytest.mark.parametrize("off", [0.0, 1e-16, 1e-9, 1e-3, 0.02, -0.02])
def test_points_beside_it_have_their_distance(points, closed, off) -> None:
    """Set off along the normal of SciPy's spline: foot, tangent and signed distance come back."""
    curve, spline = PlaneCurve(np.array(points), closed), of_scipy(points, closed)
    rng = np.random.default_rng(3)
    length = spline.x[-1]
    for u in [0.0, length, *spline.x.tolist(), *rng.uniform(0.0, length, 12)]:
        rate = spline(u, 1)
        tangent = rate / np.linalg.norm(rate)
        point = spline(u) + off * np.array([-tangent[1], tangent[0]])
        found = curve.nearest(*point.tolist())
        assert found.offset == pytest.approx(off, abs=1e-14)
        np.testing.assert_allclose([found.x, found.y], spline(u), atol=1e-12)
        np.testing.assert_allclose([found.tx, found.ty], tangent, atol=1e-11)


@pytest.mark.parametrize(("points", "closed"), CURVES)
def test_the_nearest_point_is_the_nearest_of_all(points, closed) -> None:
    curve, spline = PlaneCurve(np.array(points), closed), of_scipy(points, closed)
    rng = np.random.default_rng(7)
    for point in rng.uniform(-1.5, 4.5, (40, 2)):
        found = curve.nearest(*point.tolist())
        _, apart = brute(spline, point, closed)
        reached = np.hypot(found.x - point[0], found.y - point[1])
        assert reached <= apart + 1e-9
        # On the normal: nothing is left along the tangent.
        along = found.tx * (point[0] - found.x) + found.ty * (point[1] - found.y)
        assert abs(along) <= 1e-9


def test_it_goes_on_straight_beyond_its_ends() -> None:
    curve = PlaneCurve(np.array(WAVE))
    first, last = curve.ends
    for end, side in ((first, -1.0), (last, 1.0)):
        for way in (1e-12, 0.3, 5.0):
            x = end.x + side * way * end.tx - 0.01 * end.ty
            y = end.y + side * way * end.ty + 0.01 * end.tx
            found = curve.nearest(x, y)
            assert found.offset == pytest.approx(0.01, abs=1e-13)
            assert found.curvature == pytest.approx(0.0, abs=1e-9)


def test_a_closed_curve_is_smooth_where_it_closes() -> None:
    curve = PlaneCurve(np.array(RING), closed=True)
    found = [curve.nearest(1.02, y) for y in np.linspace(-1e-3, 1e-3, 41)]
    for values in zip(*found, strict=True):
        steps = np.abs(np.diff(values))
        assert np.max(steps) <= 2.0 * np.median(steps) + 1e-12


@pytest.mark.parametrize(("points", "closed"), CURVES)
def test_the_verifier_reads_the_same_curve(points, closed) -> None:
    """Two splines written apart, one by powers and one by control points."""
    curve, other = PlaneCurve(np.array(points), closed), PlanePath(np.array(points), closed)
    rng = np.random.default_rng(5)
    near = curve.samples[rng.integers(0, len(curve.samples), 60)] + rng.normal(size=(60, 2)) * 0.003
    first, last = curve.ends
    far = [[first.x - 2.0 * first.tx, first.y - 2.0 * first.ty], [last.x + last.tx, last.y + last.ty]]
    positions = near if closed else np.vstack([near, far])
    apart, tangents = other.beside(positions)
    for row, distance, tangent in zip(positions, apart, tangents, strict=True):
        found = curve.nearest(*row.tolist())
        assert abs(found.offset) == pytest.approx(distance, abs=1e-12)
        np.testing.assert_allclose([found.tx, found.ty], tangent, atol=1e-9)


@pytest.mark.parametrize(
    ("points", "closed", "says"),
    [
        ([], False, "a path needs 2 points, found 0"),
        ([(0.0, 0.0)], False, "a path needs 2 points, found 1"),
        (LINE, True, "a closed path needs 3 points, found 2"),
        ([(0.0, 0.0), (0.0, 0.0)], False, "points 1 and 2 are less than 1 mm apart"),
        ([(0.0, 0.0), (1.0, 0.0), (1.0, 0.9e-3)], False, "points 2 and 3 are less than 1 mm apart"),
        ([(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)], True, "points 3 and 1 are less than 1 mm apart"),
        ([(0.0, 0.0), (1e297, 1.0)], False, "the path is longer than 1 km"),
        (WAVE, False, ""),
        (RING, True, ""),
    ],
)
def test_faults_of_points(points, closed, says) -> None:
    assert fault_of_points(tuple(points), closed) == says


@pytest.mark.parametrize(
    ("points", "closed", "says"),
    [
        # There and back on the same line, a loop, an eight, ends that meet beyond.
        ([(0.0, 0.0), (1.0, 0.0), (0.5, 0.0)], False, "comes as near to itself as"),
        ([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 0.5), (0.5, -1.0)], False, "comes as near to itself as"),
        ([(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)], True, "comes as near to itself as"),
        ([(0.0, 0.0), (0.0, 1.0), (0.3, 1.3), (0.6, 1.0), (0.45, 0.1)], False, "comes as near to itself as"),
        ([(0.0, 0.0), (0.02, 0.0), (0.02, 0.02)], False, "bends to a radius of"),
        (WAVE, False, ""),
        (RING, True, ""),
        (LINE, False, ""),
        ([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], True, ""),
        ([(0.0, 0.0), (1.0, 0.0), (1.0, 0.1), (0.0, 0.1)], False, "comes as near to itself as"),
        ([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], False, ""),
    ],
)
def test_faults_of_curves(points, closed, says) -> None:
    found = fault_of_curve(tuple(points), closed)
    assert found.startswith(says) if says else found == ""


def test_a_tube_about_a_good_curve_has_one_nearest_point_everywhere() -> None:
    """What the bounds of bends and of nearness are for: the foot of what lies inside it moves on smoothly."""
    curve = PlaneCurve(np.array(RING), closed=True)
    for side in (-0.9, 0.9):
        feet = []
        for x, y in curve.samples[:200]:
            at = curve.nearest(x, y)
            foot = curve.nearest(x - side * LEAST_RADIUS * at.ty, y + side * LEAST_RADIUS * at.tx)
            assert foot.offset == pytest.approx(side * LEAST_RADIUS, abs=1e-12)
            feet.append((foot.x, foot.y))
        np.testing.assert_allclose(feet, curve.samples[:200], atol=1e-10)
