"""Limits met from afar: q + (limit - q) rounds, yet no row may pass the limit by a bit."""

from __future__ import annotations

import numpy as np
import pytest

from long_run import first

pytestmark = pytest.mark.req("MOT-20")


def meeting_the_limit(kit, seed: int, dt: float):
    """A gantry whose rail starts below zero and may go a little above it, for a way of both slides."""
    rng = np.random.default_rng(seed)
    position = np.full(7, 5.0)
    position[0] = rng.uniform(0.001, 0.02)
    start = np.array([-rng.uniform(0.0, position[0]), 0.5, 0.0, 0.0, 0.0, 0.0, 0.0])
    return kit.shop(limits=kit.limits(position, 3.0), dt=dt, start=start), kit.position(start)


def test_ptp_to_a_pose_that_puts_a_joint_on_its_limit(kit) -> None:
    for seed in (11, 12, 13):
        shop, position = meeting_the_limit(kit, seed, 0.01)
        rows = shop.ptp_pose(position + np.array([1.0, 0.0, 0.0]))
        assert rows.q[-1, 0] == shop.limits.position_upper[0], f"seed {seed}"


@pytest.mark.parametrize("seeds", first(1, [range(40), range(40, 100)]), ids=str)
def test_line_that_puts_a_joint_on_its_limit_within_one_tick(kit, seeds: range) -> None:
    for seed in seeds:
        shop, position = meeting_the_limit(kit, seed, 0.05)
        rows = shop.line(position + np.array([0.3, 0.0, 0.0]), speed=1.0, acc=9.0)
        assert np.max(rows.q[:, 0]) == shop.limits.position_upper[0], f"seed {seed}"
