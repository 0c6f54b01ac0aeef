"""programs/window: the arm reaches through a window, clear of its frame with OBSTACLE, into it without.

Distances are measured anew from the URDF and the cell (tests/support/nearness.py).
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.report.terminal import summary_text
from nearness import least, nearest

pytestmark = pytest.mark.req("TRF-13")

FOLDER = Path(__file__).parents[1] / "programs" / "window"
CELL = FOLDER / "window.toml"
MARGIN = 0.020
START = np.array([0.37, 0.0, 0.48])
CORNERS = np.array([[0.69, 0.0, 0.48], [0.69, 0.05, 0.48], [0.69, -0.05, 0.48], [0.69, 0.0, 0.48], START])
VIA = np.array([0.69, 0.0, 0.51])


@cache
def run_of(name: str) -> irlx.Run:
    return irlx.run(FOLDER / f"{name}.irl")


@cache
def distances(name: str) -> dict[tuple[str, str], np.ndarray]:
    return nearest(run_of(name), CELL)


@pytest.mark.parametrize("name", ["window", "window_plain"])
def test_it_runs_without_a_word_and_verifies(name: str) -> None:
    run = run_of(name)
    assert run.complete
    assert [str(told) for told in run.diagnostics] == []
    assert irlx.check(FOLDER / f"{name}.irl", cell=CELL) == []
    assert irlx.verify(run, program=FOLDER / f"{name}.irl", cell=CELL).passed
    assert run.summary.slowed == ()


def test_with_least_motion_the_forearm_runs_into_the_frame() -> None:
    found = distances("window_plain")
    assert least(found) == pytest.approx(-0.011, abs=2e-3)
    assert min(found, key=lambda pair: found[pair].min())[1] == "window_top"
    assert {link for (link, _), rows in found.items() if rows.min() < 0.0} <= {"forearm_1", "forearm_2"}


def test_with_the_option_every_link_keeps_the_margin() -> None:
    found = distances("window")
    assert least(found) >= MARGIN
    # It is no detour around the wall: three links get through, and close to the frame.
    assert least(found) < 0.04
    assert run_of("window").summary.clearance.distance == pytest.approx(least(found), abs=1e-5)


def test_the_margin_is_far_enough_at_the_start() -> None:
    assert min(rows[0] for rows in distances("window").values()) > 0.08


@pytest.mark.req("MOT-20")
@pytest.mark.parametrize("name", ["window", "window_plain"])
def test_the_tool_is_on_its_lines_and_its_arc(name: str) -> None:
    run = run_of(name)
    blocks = [block for block in dict.fromkeys(run.block.tolist()) if block][-5:]
    ends = np.vstack([START, CORNERS])
    # The circle through (y, z) = (0.05, 0.48), (0, 0.51), (-0.05, 0.48).
    radius = (0.05**2 + 0.03**2) / (2 * 0.03)
    centre = np.array([0.69, 0.0, 0.51 - radius])
    moves = [block for block in blocks if np.ptp(run.tool[run.block == block][:, :3], axis=0).max() > 1e-3]
    assert len(moves) == 5
    for k, block in enumerate(moves):
        at = run.tool[run.block == block][:, :3]
        np.testing.assert_allclose(at[-1], ends[k + 1], atol=1e-6)
        if k == 2:
            np.testing.assert_allclose(np.linalg.norm(at - centre, axis=1), radius, atol=1e-6)
            np.testing.assert_allclose(at[:, 0], 0.69, atol=1e-6)
            assert at[:, 2].max() > 0.5
        else:
            unit = (ends[k + 1] - ends[k]) / np.linalg.norm(ends[k + 1] - ends[k])
            assert np.max(np.linalg.norm(np.cross(at - ends[k], unit), axis=1)) < 1e-6


def test_both_take_the_same_time_and_the_elbow_goes_aside() -> None:
    clear, plain = run_of("window"), run_of("window_plain")
    np.testing.assert_array_equal(clear.t, plain.t)
    np.testing.assert_allclose(clear.tool[:, :3], plain.tool[:, :3], atol=1e-9)
    assert np.max(np.abs(clear.q - plain.q)) > np.radians(20.0)


@pytest.mark.req("REP-02")
def test_the_summary_shown_in_the_reference() -> None:
    page = (FOLDER.parents[1] / "docs" / "reference" / "interface.md").read_text(encoding="utf-8")
    shown = page.split("$ irlx run programs/window/window.irl\n")[1].split("```")[0].splitlines()
    told = summary_text(run_of("window").summary, True).splitlines()
    figures = "path error"
    assert [line for line in shown[:-1] if figures not in line] == [
        line for line in told if figures not in line
    ]
    assert shown[-1].split()[0] == "written"
