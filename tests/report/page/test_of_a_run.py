"""The page of a run of the 11-joint robot: it shows what the run is, and opens in time."""

import json
import time
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.report.replay.page import page_of
from page_data import read_page

KOCH = Path(__file__).parents[3] / "programs" / "koch"
TICK = 100.0
"""ms: what is looked at is there at half the ticks of the cell, too."""
LAST = 130
POSE = 1e-6
"""How far the pose that the page shows may be from that of the run, m and rad."""
OPENS = 8.0
"""Seconds in which a page of a minute opens: 2 on a machine of its own, tests share theirs."""


@pytest.fixture(scope="module")
def run():
    return irlx.run(KOCH / "square_cyclic.irl", tick_ms=TICK)


@pytest.fixture(scope="module")
def page(run, tmp_path_factory):
    path = tmp_path_factory.mktemp("koch") / "square.html"
    run.save(path)
    return path


@pytest.fixture(scope="module")
def shown(page, open_page):
    with open_page(page, drawn=False) as opened:
        yield opened


@pytest.mark.req("REP-04")
def test_a_minute_at_50_frames_a_second_opens_in_time(page, open_page, tmp_path):
    """First, so that the others find its tab."""
    data = json.loads(read_page(page.read_text(encoding="utf-8")).data)
    frames = data["frames"]
    for name in ("line", "tool_speed", "turn_speed", "singular", "clearance", "nearest"):
        frames[name] = (frames[name] * 24)[:3001]
    for name in ("q", "speed", "tool"):
        frames[name] = [(column * 24)[:3001] for column in frames[name]]
    frames["tick"], data["tick_s"] = list(range(3001)), 0.02
    path = tmp_path / "minute.html"
    path.write_bytes(page_of("minute", json.dumps(data).encode()))
    begin = time.monotonic()
    with open_page(path, width=1440, height=900, where="#t=30", drawn=False) as shown:
        took = time.monotonic() - begin
        assert shown.run("() => irlx.frame") == 1500
    assert took < OPENS


@pytest.mark.req("REP-04")
def test_the_tool_is_where_the_run_has_it(run, shown):
    assert shown.run("() => irlx.frames") == len(run.t)
    for frame in (0, 1, 35, 64, 100, LAST):
        shown.seek(frame)
        pose = np.array(shown.run("() => irlx.toolPose()"))
        assert np.abs(pose[:3] - run.tool[frame, :3]).max() < POSE
        assert min(np.linalg.norm(pose[3:] - sign * run.tool[frame, 3:]) for sign in (1, -1)) < POSE / 2


def test_what_stands_beside_the_robot(run, shown):
    shown.seek(60)
    held = shown.page.locator("#joints .held .joint-name").all_inner_texts()
    assert held == ["joint_10", "joint_11"]
    assert shown.page.locator("#program .lit").inner_text().endswith("MOVE LIN p4 TIME := 2.5;")
    assert "line 17" in shown.page.locator("#status").inner_text()
    value = float(shown.page.locator("#joints .joint-value").nth(6).inner_text().replace("\u2212", "-"))
    assert value == pytest.approx(np.degrees(run.q[60, 6]), abs=0.005)
    shown.page.get_by_role("tab", name="Summary").click()
    assert "complete, 13 s" in shown.page.locator("#summary").inner_text()
