"""Obstacles switched on and off in a stream: its blocks are read, and what they excuse."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.blocks import ObstacleBlock
from irlx.verifier.checks import verify_stream

pytestmark = [pytest.mark.req("LANG-64"), pytest.mark.req("STR-06")]
START = np.array([0.0, 0.5, 0.25, 0.4, 0.3, 0.2, -0.1])


@pytest.fixture
def returned(gantry_kit, robot):
    """The report on a return with the rail off its value, some switches before the first move."""

    def run(*switches: tuple[str, bool]):
        maker = gantry_kit.Maker(START)
        maker.record(gantry_kit.CyclicBlock, active=True)
        for name, active in switches:
            maker.record(ObstacleBlock, name=name, active=active)
        maker.lin((0.7, 0.25, 0.4), rail=0.1)
        maker.lin((0.5, 0.25, 0.4), rail=-0.05)
        return verify_stream(maker.stream(), robot)

    return run


def test_a_return_with_an_obstacle_on_is_not_judged(returned) -> None:
    closure = returned(("Wall", True))["cyclic closure"]
    assert closure.status == "not checked"
    assert "1 of 1 returns not judged" in closure.detail
    assert "an obstacle" in closure.detail


def test_one_that_was_on_before_the_motion_only_excuses_nothing(returned, gantry_kit, robot) -> None:
    assert returned()["cyclic closure"].status == "failed"
    maker = gantry_kit.Maker(START)
    for name, active in (("Wall", True), ("all", True), ("WALL", False), ("All", False)):
        maker.record(ObstacleBlock, name=name, active=active)
    maker.record(gantry_kit.CyclicBlock, active=True)
    maker.lin((0.7, 0.25, 0.4), rail=0.1)
    maker.lin((0.5, 0.25, 0.4), rail=-0.05)
    assert verify_stream(maker.stream(), robot)["cyclic closure"].status == "failed"


def test_a_good_stream_with_obstacles_passes(gantry_kit, robot) -> None:
    maker = gantry_kit.Maker(START)
    maker.record(ObstacleBlock, name="ściana_1", active=True)
    maker.lin((0.7, 0.25, 0.4))
    maker.record(ObstacleBlock, name="ściana_1", active=False)
    report = verify_stream(maker.stream(), robot)
    assert not report.failed, str(report)
