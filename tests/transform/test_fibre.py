"""Postures of one pose: which joints lead back onto it, and how the distance to a posture changes."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.transform.fibre import Fibre


def fibre_of(arm, q: np.ndarray, konf: np.ndarray | None = None, free=None, coarse: bool = False) -> Fibre:
    konf = arm.q + 0.3 if konf is None else konf
    free = np.ones(arm.n, dtype=bool) if free is None else free
    return Fibre(arm.kinematics, arm.pose(q), konf, arm.weights, (arm.lower, arm.upper), free, coarse)


def chosen(*joints: int) -> np.ndarray:
    found = np.zeros(7, dtype=bool)
    found[[joint - 1 for joint in joints]] = True
    return found


@pytest.mark.req("TRF-15")
@pytest.mark.parametrize(
    ("joints", "leads"),
    [
        ((1, 2, 3, 4, 5, 6, 7), True),
        ((2, 3, 4, 5, 6, 7), True),
        ((3, 4, 5, 6, 7), False),
        ((5, 6, 7), False),
        ((2,), False),
    ],
)
def test_joints_lead_back_that_move_all_that_the_free_ones_move(arm7, joints, leads: bool) -> None:
    assert fibre_of(arm7, arm7.q).leads_back(arm7.q, chosen(*joints)) is leads


@pytest.mark.req("TRF-15")
def test_joints_that_undo_each_other_lead_back_to_what_they_move(arm7) -> None:
    """With joint 2 at zero the first and the third turn about one axis: two joints for one coordinate."""
    q = arm7.q.copy()
    q[1] = 0.0
    fibre = fibre_of(arm7, q)
    assert fibre.rank(q, chosen(1, 3)) == 1
    assert fibre.leads_back(q, chosen(1, 3))
    assert not fibre.leads_back(q, chosen(1, 4))


@pytest.mark.req("TRF-15")
@pytest.mark.parametrize("coarse", [False, True])
def test_slope_and_curvature_of_the_distance_by_differences_along_the_fibre(arm7, coarse: bool) -> None:
    """Postures on both sides are found by Newton steps back onto the pose."""
    fibre = fibre_of(arm7, arm7.q, arm7.q + np.array([0.2, -0.3, 0.4, 0.1, -0.2, 0.3, -0.1]), coarse=coarse)
    tangent = fibre.tangent(arm7.q)
    assert tangent.basis.shape == (7, 1)
    way, h = tangent.basis[:, 0], 2e-3
    # Of unit length by the weights.
    assert way @ (arm7.weights * way) == pytest.approx(1.0)
    sides = [fibre.onto_pose(arm7.q + side * h * way) for side in (1, -1)]
    steps = [abs(way @ (arm7.weights * (side - arm7.q))) for side in sides]
    ahead, here, behind = (fibre.distance(q) for q in (sides[0], arm7.q, sides[1]))
    assert steps == pytest.approx([h, h], rel=1e-4)
    assert tangent.gradient @ way == pytest.approx((ahead - behind) / (2 * h), rel=1e-4)
    bend = (ahead - 2 * here + behind) / h**2
    assert fibre.curvature(arm7.q, tangent)[0, 0] == pytest.approx(bend, rel=2e-3)
    assert fibre.decrease(sides[0], sides[1]) == pytest.approx(ahead - behind, rel=1e-9)


@pytest.mark.req("TRF-15")
def test_the_distance_counts_free_joints_by_their_weights(arm7) -> None:
    free = chosen(1, 2, 3, 5, 6, 7)
    away = np.array([0.1, -0.2, 0.3, 9.0, 0.0, 0.5, -0.1])
    fibre = fibre_of(arm7, arm7.q, arm7.q - away, free)
    wanted = 0.5 * sum(w * a * a for w, a, f in zip(arm7.weights, away, free, strict=True) if f)
    assert fibre.distance(arm7.q) == pytest.approx(wanted, rel=1e-14)
