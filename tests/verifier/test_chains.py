"""Blended moves and moves along a PATH, made by hand: good ones pass."""

from __future__ import annotations

import pytest

from irlx.blocks import Blend
from irlx.verifier import verify_stream
from made_chains import (
    CORNER,
    passed_anyhow,
    polyline,
    reversal,
    slow_then_fast,
    smooth_path,
    stopping_anyway,
    stopping_polyline,
    straight_on,
    three_lines,
    tiny_steps,
    with_an_arc,
)
from small_circles import (
    nothing_left,
    onto_the_second_half,
    round_before_a_line,
    round_before_a_ptp,
    round_in_two_ticks,
    there_and_back,
)

pytestmark = [pytest.mark.req("MOT-06"), pytest.mark.req("STR-06"), pytest.mark.req("MOT-20")]


GOOD = {
    made.__name__: made
    for made in (
        three_lines,
        with_an_arc,
        polyline,
        stopping_polyline,
        smooth_path,
        passed_anyhow,
        straight_on,
        tiny_steps,
        stopping_anyway,
        reversal,
        slow_then_fast,
        round_in_two_ticks,
        onto_the_second_half,
        nothing_left,
        round_before_a_line,
    )
} | {
    "polyline passed anyhow": lambda kit: polyline(kit, Blend(), (0.03, 0.02, 0.01)),
    "polyline that may be blended and stops": lambda kit: polyline(kit, CORNER, (0.0, 0.0, 0.05), stops=True),
}


@pytest.mark.parametrize("name", GOOD)
def test_good_chains_pass(name: str, gantry_kit, robot) -> None:
    report = verify_stream(GOOD[name](gantry_kit).stream(), robot)
    assert report.passed, str(report)
    for check in ("goal position", "path position", "path orientation", "path progress"):
        assert report[check].status == "ok", str(report)
        assert report[check].worst.value < 2e-8, str(report[check])


@pytest.mark.parametrize("made", [round_before_a_ptp, there_and_back], ids=lambda made: made.__name__)
def test_ways_that_a_tick_is_enough_for_may_be_run_unseen(made, gantry_kit, robot) -> None:
    """In a corner to a PTP, and where legs lead back to where the tool was."""
    report = verify_stream(made(gantry_kit).stream(), robot)
    assert report.passed, str(report)
    assert report["path progress"].worst.value > 1e-6
