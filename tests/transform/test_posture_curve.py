"""Evenly spaced curves through iterates, where every posture is on the pose: closed forms."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from irlx.transform.posture_curve import RESERVE, SPACING, even_curve


class EveryPosture:
    """A fibre that holds all postures; `together` is what comes of bringing them onto the pose at once."""

    def __init__(self, lower, upper, together=lambda points: None) -> None:
        self.lower, self.upper = np.array(lower), np.array(upper)
        self.all_onto_pose = together
        self.sought: list[np.ndarray] = []

    def within(self, lower, upper):
        return SimpleNamespace(onto_pose=self.onto_pose, lower=lower, upper=upper)

    def onto_pose(self, point):
        self.sought.append(point)
        return point.copy()


def test_the_reserve_of_a_short_way_is_a_thousandth_of_it():
    """Along a limit, further from it than a thousandth of the way, the curve stays as straight as it is."""
    fibre = EveryPosture([-1.0, 0.0], [1.0, 1.0])
    start, end = np.array([0.0, 1e-5]), np.array([0.01, 1.1e-5])
    assert end[0] * 1e-3 <= start[1] < RESERVE / 3
    iterates = start + np.linspace(0.0, 1.0, 12)[:, None] * (end - start)
    curve = even_curve(fibre, iterates, 0.001)
    straight = start + np.linspace(0.0, 1.0, len(curve))[:, None] * (end - start)
    np.testing.assert_allclose(curve, straight, rtol=0, atol=1e-15)


def test_what_came_onto_the_pose_far_off_is_sought_anew():
    """All at once, a point may come out elsewhere on the pose, on either side of where it should be."""
    off = np.array([[0.0], [0.4], [-0.6], [0.6], [-0.4]]) * SPACING

    def together(points):
        return points + np.resize(off, (len(points), 1))

    fibre = EveryPosture([-9.0, -9.0], [9.0, 9.0], together)
    iterates = np.linspace(0.0, 0.5, 26)[:, None] * [0.6, 0.8]
    curve = even_curve(fibre, iterates, 0.02, all_at_once=True)
    even = np.linspace(0.0, 0.5, len(curve))[:, None] * [0.6, 0.8]
    moved = np.resize(off, (len(curve), 1)) * (np.abs(np.resize(off, (len(curve), 1))) < 0.5 * SPACING)
    moved[[0, -1]] = 0.0
    np.testing.assert_allclose(curve, even + moved, rtol=0, atol=1e-12)
    assert len(fibre.sought) == np.count_nonzero(np.abs(np.resize(off, len(curve))[1:-1]) > 0.5 * SPACING)
