"""Runs that slow down: summary, events, streams, one tick explained, and how slow is too slow."""

from __future__ import annotations

import itertools
import json

import numpy as np
import pytest

import irlx
from irlx.cli.main import main

PROGRAM = """PROGRAM p;
VAR MAIN_JOINT: back;
BEGIN
  back := R_JOINT_ACT.M_JOINT;
  MOVE LIN POSITION(11000, 850, 3400);
  MOVE CIRCLE POSITION(10900, 950, 3400), POSITION(11000, 1050, 3400) ANGLE := 200;
  RECONFIGURATION back;
  MOVE PTP back;
ENDPROGRAM
"""
ONE_MOVE = "".join(PROGRAM.splitlines(keepends=True)[:5]) + "ENDPROGRAM\n"
"""Its line alone, for what one slowed move tells."""
CELL = """[robot]
model = "koch11"
[robot.limits]
position = [180, [-150, 0], [-180, 0], [0, 180], [-180, 0], [-180, 0], 180, 60, 180, 500, [-20, 60]]
speed = [3, 1.8, 1.8, 1.8, 3, 2, 2, 3, 2, 2, 3]
acceleration = [9, 9, 9, 9, 9, 9, 9, 9, 9, 90, 9]
[motion]
tick_ms = 50
speed = 1000
acc = 2000
"""
DT = 0.05


@pytest.fixture
def place(tmp_path, monkeypatch):
    (tmp_path / "p.irl").write_text(PROGRAM, encoding="utf-8")
    (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def shorter(place):
    (place / "p.irl").write_text(ONE_MOVE, encoding="utf-8")
    return place


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("slowed")
    (folder / "p.irl").write_text(PROGRAM, encoding="utf-8")
    (folder / "p.toml").write_text(CELL, encoding="utf-8")
    return irlx.run(folder / "p.irl")


@pytest.mark.req("MOT-21")
def test_the_summary_says_where_how_much_and_why(run):
    summary = run.summary
    assert summary.planned >= 1
    assert summary.slowed
    names = run.joint_names
    for event in summary.slowed:
        assert event.line in (5, 6)
        assert event.joint in names
        assert event.kind in ("speed", "acceleration")
        assert 0.0 < event.achieved < event.requested <= 1.0 + 1e-9
        assert 0.0 <= event.way <= event.length
        assert 0 < event.first_tick <= event.last_tick < len(run.t)
        assert event.lost > 0.0
        limits = run.stream.header.limits.pair(event.kind)
        assert event.bound == limits[1][names.index(event.joint)]
    assert set(summary.slowed) <= set(run.events)


@pytest.mark.req("MOT-21")
def test_the_time_lost_is_the_time_it_takes_longer(run):
    """The line alone would take a trapezoid's time; what it took longer is what its events say."""
    way = float(np.linalg.norm([500.0, 150.0, 100.0])) * 1e-3
    programmed = way / 1.0 + 1.0 / 2.0
    ticks = np.count_nonzero(run.block == 1) - 1
    lost = sum(event.lost for event in run.summary.slowed if event.line == 5)
    assert lost == pytest.approx(DT * ticks - programmed, abs=1.1 * DT)


@pytest.mark.req("MOT-20")
def test_the_path_is_kept_and_the_stream_verified(run, place):
    assert run.summary.path_position_error <= 1e-9
    report = irlx.verify(run, program=place / "p.irl", cell=place / "p.toml")
    assert report.passed


@pytest.fixture(scope="module")
def samples(tmp_path_factory):
    """Of the same program, one by one."""
    folder = tmp_path_factory.mktemp("streamed")
    (folder / "p.irl").write_text(PROGRAM, encoding="utf-8")
    (folder / "p.toml").write_text(CELL, encoding="utf-8")
    return list(irlx.stream(folder / "p.irl"))


@pytest.mark.req("MOT-10")
def test_the_stream_is_the_run_bit_for_bit(run, samples):
    for name in ("t", "q", "qd", "qdd", "tool", "block"):
        np.testing.assert_array_equal(np.array([getattr(s, name) for s in samples]), getattr(run, name))


@pytest.mark.req("MOT-10")
@pytest.mark.parametrize("share", [0.6, 0.1, 0.35, 0.9])
def test_any_first_part_of_the_stream_keeps_its_bounds(run, samples, share):
    """A prefix is no other motion: each of its rows keeps the limits of speed and acceleration."""
    count = int(share * len(run.t))
    part = np.array([sample.q for sample in samples[:count]])
    np.testing.assert_array_equal(part, run.q[:count])
    limits, dt = run.stream.header.limits, DT
    speeds = np.diff(np.vstack([part[:1], part]), axis=0) / dt
    accelerations = np.diff(np.vstack([np.zeros((1, 11)), speeds]), axis=0) / dt
    assert np.all(np.abs(speeds) <= limits.speed_upper * (1.0 + 1e-9) + 1e-12)
    assert np.all(np.abs(accelerations) <= limits.acceleration_upper * (1.0 + 1e-9) + 1e-9)


def test_the_terminal_tells_it(shorter, capsys):
    """How a tick came about, then the run and its places."""
    assert main(["run", "p.irl", "-o", "out.npz", "--explain-tick", "24"]) == 0
    explained, verdict, told = capsys.readouterr().out.partition("p.irl: complete, verified, ")
    lines = (verdict + told).splitlines()
    assert ", slowed by " in lines[0]
    assert any(line.startswith("moves       1 (") and "planned as a whole" in line for line in lines)
    (first,) = [number for number, line in enumerate(lines) if line.startswith("slowed      ")]
    assert "s longer than programmed at " in lines[first]
    places = list(itertools.takewhile(lambda line: line.startswith("            line "), lines[first + 1 :]))
    assert any(line.startswith("            line 5  ") and " of 1000 mm/s " in line for line in places)
    assert explained.startswith("tick 24 (1.2 s), line 5: MOVE LIN, row of a motion planned as a whole\n")
    for word in ("demand ", "criterion ", "active ", "joint_11", "deg", "mm", "least motion"):
        assert word in explained


def test_json_has_the_events(shorter, capsys):
    assert main(["run", "p.irl", "-o", "out.npz", "--json", "--explain-tick", "24"]) == 0
    plain = json.loads(capsys.readouterr().out)
    (first, *_) = plain["summary"]["slowed"]
    assert first["event"] == "slowed"
    assert {"line", "joint", "kind", "bound", "requested", "achieved", "lost"} <= set(first)
    assert plain["tick"]["tick"] == 24
    assert len(plain["tick"]["joints"]) == 11


def test_a_tick_is_explained(run, shorter):
    tick = 24
    found = irlx.run(shorter / "p.irl", explain_tick=tick).explanation
    assert (found.tick, found.line, found.motion) == (tick, 5, "MOVE LIN")
    assert found.way_of_pacing == "row of a motion planned as a whole"
    np.testing.assert_array_equal([joint.value for joint in found.joints], run.q[tick])
    np.testing.assert_array_equal([joint.step for joint in found.joints], run.q[tick] - run.q[tick - 1])
    assert all(joint.lower <= joint.step <= joint.upper for joint in found.joints)
    assert {joint.upper_source for joint in found.joints} <= {"position", "speed", "acceleration", "braking"}
    np.testing.assert_allclose(found.path.position, run.tool[tick, :3], atol=1e-12)
    assert found.path.rate <= found.path.programmed_rate
    (criterion,) = found.criteria
    weights = np.array(run.stream.header.weights)
    step = run.q[tick] - run.q[tick - 1]
    assert criterion.chosen
    assert criterion.value == pytest.approx(0.5 * (weights * step) @ step)


def test_ticks_without_a_path_are_explained_too(place):
    """The program without its circle, and with a line too short to be slowed."""
    text = "".join(line for line in PROGRAM.splitlines(keepends=True) if "CIRCLE" not in line)
    (place / "p.irl").write_text(text.replace("11000, 850, 3400", "11300, 940, 3460"), encoding="utf-8")
    run = irlx.run(place / "p.irl")
    for block, motion in ((2, "RECONFIGURATION"), (3, "MOVE PTP")):
        tick = int(np.flatnonzero(run.block == block)[5])
        found = irlx.run(place / "p.irl", explain_tick=tick).explanation
        assert found.motion == motion
        assert found.path is None
        assert [joint.value for joint in found.joints] == list(run.q[tick])


def test_a_tick_that_no_motion_has(shorter, capsys):
    (shorter / "p.irl").write_text("PROGRAM p;\nBEGIN\n  MOVE_INC LIN POSITION(0, 0, 5);\nENDPROGRAM\n")
    assert main(["run", "p.irl", "-o", "out.npz", "--no-verify", "--explain-tick", "100000"]) == 0
    assert "tick 100000: no motion has it" in capsys.readouterr().out


def test_too_slow_is_an_error_where_the_user_says_so(shorter, capsys):
    assert main(["run", "p.irl", "-o", "out.npz", "--max-slow", "1.05"]) == 1
    error = capsys.readouterr().err
    assert "p.irl:5:3: error IRL525" in error
    assert "1.05 times is allowed" in error
    assert irlx.run(shorter / "p.irl", max_slow=50.0).complete
    with pytest.raises(irlx.IrlxError, match="IRL006"):
        irlx.run(shorter / "p.irl", max_slow=0.9)
    with pytest.raises(irlx.IrlxError, match="IRL525"):
        next(itertools.islice(irlx.stream(shorter / "p.irl", max_slow=1.0), 1, None))
