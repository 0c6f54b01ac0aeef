"""Rows that lead from one motion into another one."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.pacing.transition import transition
from irlx.robot.limits import JointLimits
from long_run import first

pytestmark = pytest.mark.req("MOT-06")

DT = 0.01
WIDE = np.full(3, np.inf)


def limits(speed: float = np.inf, acceleration: float = np.inf) -> JointLimits:
    v, a = np.full(3, speed), np.full(3, acceleration)
    return JointLimits(-WIDE, WIDE, -v, v, -a, a)


def sides(rng: np.random.Generator, ticks: int) -> tuple[np.ndarray, np.ndarray]:
    """Three rows of two motions, with zeros and equal joints mixed in."""
    v, w = rng.choice([0.0, 1e-9, 0.01], size=(2, 3)) * rng.normal(size=(2, 3))
    a, b = rng.choice([0.0, 1e-4], size=(2, 3)) * rng.normal(size=(2, 3))
    start, k = rng.normal(size=3), np.arange(-2.0, 1.0)[:, None]
    end = start + ticks * (v + w) / 2 + rng.choice([0.0, 0.01]) * rng.normal(size=3)
    return start + k * v + k * k * a / 2, end + (k + 2) * w + (k + 2) ** 2 * b / 2


def test_a_polynomial_of_fifth_degree_is_found_again() -> None:
    """Rows of q(k) between its own: off by what backward differences are off, of order 1/N."""
    count = 400
    k = np.arange(-2.0, count + 3.0) / count
    q = np.outer(k**5 - 2 * k**4 + 0.5 * k**3 + 0.1 * k**2 + 0.3 * k, [1.0, -2.0, 0.5])
    rows = transition(q[:3], q[count + 2 :], count, limits(), DT, alike=True)
    assert np.abs(rows - q[3 : count + 2]).max() < 0.01


@pytest.mark.parametrize("seed", first(20, range(60)))
@pytest.mark.parametrize("alike", [False, True])
def test_posture_and_speed_are_met_and_limits_kept(seed, alike) -> None:
    rng = np.random.default_rng(seed)
    print(f"seed {seed}")
    ticks = int(rng.integers(2, 60))
    before, behind = sides(rng, ticks)
    bound = limits(rng.choice([1.5, np.inf]), rng.choice([5.0, 20.0, np.inf]))
    rows = transition(before, behind, ticks, bound, DT, alike)
    if rows is None:
        assert np.isfinite(bound.speed_upper).any() or np.isfinite(bound.acceleration_upper).any()
        return
    assert rows.shape == (ticks - 1, 3)
    q = np.vstack([before[1:], rows, behind[:2]])
    speeds = np.diff(q, axis=0) / DT
    assert np.all(np.abs(speeds[1:]) <= bound.speed_upper + 1e-9)
    assert np.all(np.abs(np.diff(speeds, axis=0) / DT) <= bound.acceleration_upper + 1e-6)


def test_relations_between_joints_are_kept() -> None:
    rng = np.random.default_rng(3)
    relation = np.array([1.0, -2.0, 0.5])
    onto = np.eye(3) - np.outer(relation, relation) / (relation @ relation)
    before, behind = (rows @ onto for rows in sides(rng, 30))
    rows = transition(before, behind, 30, limits(acceleration=30.0), DT, alike=True)
    assert np.abs(rows @ relation).max() < 1e-14


def test_what_stands_keeps_its_bits() -> None:
    before, behind = sides(np.random.default_rng(4), 20)
    before[:, 1] = behind[:, 1] = 0.1 + 0.2
    rows = transition(before, behind, 20, limits(), DT, alike=False)
    assert (rows[:, 1] == 0.1 + 0.2).all()


def test_where_no_shape_keeps_the_limits_there_is_none() -> None:
    before = np.array([[-0.02] * 3, [-0.01] * 3, [0.0] * 3])
    behind = np.array([[0.0] * 3, [-0.01] * 3, [-0.02] * 3])
    # From 1 per s to -1 per s in 0.05 s takes 40 per s2 on average.
    assert transition(before, behind, 4, limits(acceleration=39.0), DT, alike=False) is None
    assert transition(before, behind, 4, limits(acceleration=41.0), DT, alike=False) is not None
