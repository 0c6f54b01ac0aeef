"""Streams made to deceive: whole motions pretended with all else made to fit, and files that nobody writes.

Each stream claims to come from a program that irlx ran. What the robot does in it is something else,
its tool poses and checksums are right: the verifier names the check that does not hold.
"""

from __future__ import annotations

import json
import os
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import irlx
from adversary import (
    CYCLE,
    CYCLE_IDS,
    DOWN,
    KOCH_PLACES,
    NO_LIMITS,
    SLOW,
    THERE,
    TOO_EARLY,
    Job,
    Make,
    arm_cell,
    ids,
    job,
    koch_cell,
    led_to,
    left_open,
    of_meta,
    with_comment,
    with_meta,
)
from irlx.blocks import JointRange, LimitSwitchBlock
from irlx.cell.load import load_cell
from irlx.cli.main import main
from irlx.streams import JointStream, write_stream
from irlx.verifier import Report
from irlx.verifier.geometry.forward import forward

pytestmark = pytest.mark.req("STR-06")


@pytest.fixture(scope="module")
def make(tmp_path_factory) -> Make:
    """Runs a program of some statements, each in its own folder and once."""
    return cache(lambda *texts: job(tmp_path_factory.mktemp("job"), *texts))


def names(report: Report) -> set[str]:
    return {check.name for check in report.failed}


def refused(honest: Job, stream: JointStream, *checks: str, **given: Path | None) -> Report:
    """Report on a stream that fails these checks and no other; that of the honest run fails none."""
    assert (good := honest.verify(honest.stream, **given)).passed, str(good)
    report = honest.verify(stream, **given)
    assert names(report) == set(checks), str(report)
    return report


# ---- Records at another tick than that at which their statement was reached


@pytest.mark.parametrize(
    "pretend",
    TOO_EARLY,
    ids=lambda f: f.__name__,
)
def test_records_at_another_tick(make: Make, pretend) -> None:
    """A statement counts from the row in which the one before it ended, not from where its record says."""
    claimed, stream, block, end = pretend(make)
    report = refused(claimed, stream, "blocks")
    words = f"at tick 0: block {block} was recorded at tick 0, but the robot came to rest at {end}"
    assert report["blocks"].detail == words


@pytest.mark.parametrize("ending", [".irdata", ".npz"])
def test_no_record_at_all(make: Make, ending: str) -> None:
    """Any motion under an id that no record has, in formats that carry blocks."""
    claimed = make("MOVE LIN a, p;")
    swing = np.sin(np.pi * np.linspace(0.0, 1.0, 301)) ** 2
    q = claimed.stream.q[0] + swing[:, None] * np.radians([30, 20, 0, 0, 0, 0, 0])
    stream = claimed.pretending(np.vstack([q, q[-1:]]), np.r_[0, np.full(301, 7)], ())
    report = claimed.verify(stream, ending)
    assert names(report) == {"blocks"}, str(report)
    assert report["blocks"].detail == "at tick 1: no recorded move has the id 7"
    assert report["program"].status == "not checked"


# ---- Paths that are not run


def test_rounds_without_a_row(make: Make) -> None:
    """Two rounds in 10 s are claimed to be done where they begin."""
    claimed = make(
        f"{THERE};\nMOVE CIRCLE POSITION(480, 230, 300), POSITION(450, 250, 280) ANGLE := 720, TIME := 10;"
    )
    end, stream = claimed.ends[0], claimed.stream
    report = refused(
        claimed, claimed.pretending(stream.q[: end + 1], stream.block[: end + 1]), "path progress"
    )
    start, via, goal = stream.tool[end, :3], np.array([0.48, 0.23, 0.3]), np.array([0.45, 0.25, 0.28])
    a, b, c = via - start, goal - start, goal - via
    sides, area = np.prod([np.linalg.norm(side) for side in (a, b, c)]), np.linalg.norm(np.cross(a, b)) / 2
    first = report["path progress"].first
    assert first is not None
    assert first.tick == end
    assert first.value == pytest.approx(4 * np.pi * sides / (4 * area), rel=1e-6)


def test_rounds_in_hold_rows(make: Make) -> None:
    """Ten rounds of radius 20 mm at 130 mm/s are claimed to take one tick of 1 s and its hold row."""
    claimed = make(
        "MOVE CIRCLE s + POSITION(20, 20, 0), s + POSITION(0, 40, 0) "
        "SPEED := 130, ACC := 1000 ANGLE := 3600;",
        arm_cell(1000, NO_LIMITS),
    )
    stream = claimed.pretending(claimed.stream.q[[0, 0, 0]], [0, 1, 1])
    first = refused(claimed, stream, "programmed time")["programmed time"].first
    assert first is not None
    assert first.tick == 2
    assert first.value == pytest.approx(10 * 2 * np.pi * 0.02 / 0.13 + 0.13 / 1.0 - 1.0, rel=1e-6)


def test_a_tick_of_eleven_days(make: Make) -> None:
    """Ticks so long that two rows a move suffice for every speed: nothing of the paths is run."""
    claimed = make(
        "MOVE LIN a;\nMOVE CIRCLE POSITION(480, 230, 300), POSITION(450, 250, 280) ANGLE := 720;\n"
        "MOVE LIN a + POSITION(0, 0, 9) TIME := 3;"
    )
    rows = [0, *np.repeat(claimed.ends, 2)]
    stream = claimed.pretending(
        claimed.stream.q[rows], claimed.stream.block[rows], claimed.records_at(0, 2, 4), tick_ns=10**15
    )
    report = refused(claimed, stream, "ticks")
    assert "a tick of 1e+09 ms" in report["ticks"].detail


def test_creeping_back(make: Make) -> None:
    """A PTP creeps back from half its way by less a row than the tolerance, 20000 rows long."""
    claimed = make("MOVE PTP (39.9, 29, -13, 95, 9, 48, -13);", arm_cell(0.25))
    way = claimed.stream.q[:, 0]
    half = way[0] + (way - way[0]) / 2
    back = half[-1] - np.sign(way[-1] - way[0]) * 0.95e-9 * np.arange(1, 20001)
    rest = back[-1] + (way - way[0]) / (way[-1] - way[0]) * (way[-1] - back[-1])
    column = np.r_[half, back, back[-1], back[-1], rest[1:]]
    column[-2:] = way[-1]
    q = np.repeat(claimed.stream.q[:1], len(column), axis=0)
    q[:, 0] = column
    stream = claimed.pretending(q, np.r_[0, np.ones(len(q) - 1)])
    check = refused(claimed, stream, "PTP progress")["PTP progress"]
    assert check.first is not None
    assert check.worst is not None
    # The first row back is still within 1e-9.
    assert (check.first.tick, check.first.value) == (len(half) + 1, pytest.approx(1.9e-9, rel=1e-6))
    assert check.worst.value == pytest.approx(20000 * 0.95e-9, rel=1e-6)


def test_a_short_turn_with_another_acceleration(make: Make) -> None:
    """ACC := 1 run as if it said 99: 0.6 mm, over which the tool turns by 40 degrees."""
    line = (
        "MOVE LIN POSE(s + POSITION(0, 0, -0.6), ORIVANG((0, 0, 1), 40) @ o) "
        "SPEED := 1000, ACC := {}, SPEED_ORI := 300, ACC_ORI := 3000;"
    )
    claimed, hurried = make(line.format(1)), make(line.format(99))
    stream = claimed.pretending(hurried.stream.q, hurried.stream.block)
    report = refused(claimed, stream, "programmed acceleration", "programmed time")
    first, late = report["programmed acceleration"].first, report["programmed time"].first
    assert first is not None
    assert late is not None
    assert (first.tick, late.tick) == (1, len(stream.q) - 1)


# ---- Cycles that do not close


def closure_refused(claimed: Job, stream: JointStream, start: int) -> None:
    """Refused for the cyclic closure alone, with the joint that is furthest from its value."""
    report = claimed.verify(stream)
    assert names(report) == {"cyclic closure"}, str(report)
    first = report["cyclic closure"].first
    gap = np.abs(stream.q[-1] - stream.q[start])
    assert first is not None
    assert (first.tick, first.joint) == (len(stream.q) - 1, f"joint_{np.argmax(gap) + 1}")
    assert first.value == pytest.approx(gap.max(), rel=1e-9)
    assert gap.max() > 1e-4


def test_a_cycle_begun_beside_its_pose(make: Make) -> None:
    """CYCLICSTART 5e-8 m beside the pose, within its tolerance: the return is one all the same."""
    free, claimed = left_open(make), make(CYCLE)
    first, second, last = free.ends
    positions, rotations = forward(free.robot, free.stream.q)
    there = np.linalg.norm(positions - positions[0], axis=1)
    away = np.linalg.norm(positions - positions[first], axis=1)
    beside = 5e-8 * np.minimum(there / there[first], 1.0)
    beside[first:] = 5e-8 * np.maximum(1.0 - away[first:] / away[second], 0.0)
    beside[second + 1 :] = 0.0
    positions[:, 0] += beside
    q = led_to(free.robot, free.stream.q, positions, rotations)
    q[0] = free.stream.q[0]
    for end in (first, second, last):
        q[end] = q[end - 1]
    records = claimed.records_at(0, first, first, second, last)
    closure_refused(claimed, claimed.pretending(q, ids(free, *CYCLE_IDS), records), first)


@pytest.mark.parametrize(
    ("last_speed", "moves", "new"),
    [
        ("0", "MOVE LIN p;\nMOVE LIN a;\nMOVE LIN p;", CYCLE_IDS),
        pytest.param(
            *("[-60, 0]", "MOVE LIN p;\nFREEZESTART 11;\nMOVE LIN a;\nMOVE LIN p;", [0, 1, 2, 3, 4]),
            marks=pytest.mark.slow,
        ),
    ],
    ids=["may not move", "may not move on"],
)
def test_a_limit_of_zero_excuses_no_cycle(make: Make, last_speed: str, moves: str, new) -> None:
    """The cyclic option ignored where a joint stands at its speed limit of 0, which kept no other joint."""
    claimed = make(CYCLE, koch_cell(last_speed), KOCH_PLACES)
    free = make(moves, koch_cell(last_speed), KOCH_PLACES)
    first, second, last = free.ends
    records = claimed.records_at(0, first, first, second, last)
    closure_refused(claimed, claimed.pretending(free.stream.q, ids(free, *new), records), first)


# ---- Values


def test_a_tool_quaternion_of_zeros(make: Make) -> None:
    """No orientation at all written where the orientation is the identity."""
    claimed = make("MOVE LIN a;", koch_cell("false"), KOCH_PLACES)
    tool = claimed.stream.tool.copy()
    tool[:, 3:] = 0.0
    first = refused(claimed, replace(claimed.stream, tool=tool), "tool orientation")["tool orientation"].first
    assert first is not None
    assert first.tick == 0


def test_a_reconfiguration_in_one_tick(make: Make) -> None:
    """A robot without speed limits jumps to its new posture."""
    claimed = make(
        "RECONFIGURATION (10, -60, -60, 60, -60, -60, 0, 0, 0, 0, 10);", koch_cell("false"), KOCH_PLACES
    )
    q = claimed.stream.q[[0, -1, -1]]
    step = np.abs(q[1] - q[0])
    report = refused(claimed, claimed.pretending(q, [0, 1, 1]), "reconfiguration speed")
    first = report["reconfiguration speed"].first
    assert first is not None
    assert (first.tick, first.joint) == (1, f"joint_{np.argmax(step) + 1}")
    assert first.value == pytest.approx(step.max() / 0.05, rel=1e-9)


def test_limits_of_the_header_widened(make: Make) -> None:
    """Eight times as fast under wider limits, and only the program given: its own cell is found."""
    claimed = make(f"{THERE};")
    own, last = claimed.stream.header.limits, claimed.ends[0]
    wide = own.with_pair("speed", own.speed_lower * 99, own.speed_upper * 99)
    wide = wide.with_pair("acceleration", own.acceleration_lower * 1e4, own.acceleration_upper * 1e4)
    q = claimed.stream.q[[0, *range(1, last, 8), last, last]]
    stream = claimed.pretending(q, np.r_[0, np.ones(len(q) - 1)], limits=wide)
    report = refused(claimed, stream, "robot limits", cell=None)
    assert report["robot limits"].detail.startswith("least speed of joint_1 in the stream: -207.3")


def test_the_cell_of_another_robot(make: Make, tmp_path: Path) -> None:
    """A cell whose robot has 11 joints for a stream of 7: a report, not an exception."""
    claimed = make(f"{THERE};")
    (tmp_path / "koch.toml").write_text(koch_cell("false"), encoding="utf-8")
    report = claimed.verify(claimed.stream, cell=tmp_path / "koch.toml", program=None)
    assert names(report) == {"robot"}, str(report)
    assert report["tool position"].status == "not checked"


# ---- Honest runs that look odd

FAST_ROUNDS = (
    f"{DOWN}\nMOVE CIRCLE s + POSITION(20, 20, -20), POSE(s + POSITION(0, 40, -20), "
    "ORIVANG((0, 0, 1), 10) @ o) SPEED := 250, ACC := 1000 ANGLE := 3600;"
)


@pytest.mark.parametrize(
    ("body", "cell"),
    [
        pytest.param(
            "MOVE LIN s;\nMOVE LIN s - POSITION(0, 0, 299.00009) SPEED := 100, ACC := 10000;",
            arm_cell(1000, NO_LIMITS),
            id="a line of 3.0000009 ticks",
        ),
        pytest.param(FAST_ROUNDS, arm_cell(1000, NO_LIMITS), id="rounds faster than a tick"),
        pytest.param(
            "MOVE PTP (40.0000001, 29, -13, 95, 9, 48, -13) TIME := 20;", arm_cell(1), id="a tiny PTP"
        ),
    ],
)
def test_odd_but_honest(make: Make, body: str, cell: str) -> None:
    """Motions at the edges of time and length pass."""
    honest = make(body, cell)
    report = honest.verify(honest.stream)
    assert report.passed, str(report)
    assert not report.unchecked


def test_a_limit_on_the_way_leads_away(make: Make) -> None:
    """A limit keeps the posture away, and the last 0.1 mm are too short to come back: not judged."""
    low, high = "(-170, -115, -10.5, 5, -170, -120, -175)", "(170, 115, 170, 145, 170, 120, 175)"
    honest = make(
        f"MOVE LIN p;\nCYCLICSTART;\nMOVE LIN b;\nMOVE LIN p + POSITION(0, 0, 0.1) WITH JOINTLIMIT {low}, "
        f"{high};\nMOVE LIN p;\nCYCLICEND;",
        '[robot]\nmodel = "arm7"\n[motion]\nspeed = 200\nacc = 1000\nspeed_ori = 90\nacc_ori = 300\n',
        "VAR POSITION: p := (450, 260, 330), b := (380, 330, 250);\n",
    )
    report = honest.verify(honest.stream)
    assert report.passed, str(report)
    assert [check.name for check in report.unchecked] == ["cyclic closure"]


@pytest.mark.parametrize("body", ["HALT;", "", "FREEZESTART 7;\nFREEZEEND;", "MOVE LIN s;"])
def test_a_csv_in_which_nothing_moves(make: Make, body: str, monkeypatch, capsys) -> None:
    """A stream of one row without blocks: written, verified, accepted."""
    honest = make(body)
    monkeypatch.chdir(honest.folder)
    assert main(["run", "p.irl", "-o", "p.csv"]) == 0, capsys.readouterr()
    assert {path.suffix for path in honest.folder.iterdir()} == {".toml", ".irl", ".csv"}
    assert main(["verify", "p.csv", "--program", "p.irl"]) == 0, capsys.readouterr()
    assert honest.verify(honest.stream, ".csv").passed


# ---- Files that nobody writes: a message or a failed check, never a traceback


@pytest.fixture(scope="module")
def plain(tmp_path_factory) -> Job:
    """A limit switch and a PTP of some rows."""
    return job(tmp_path_factory.mktemp("plain"), f"{SLOW};\nMOVE PTP (39.9, 29, -13, 95, 9, 48, -13);")


def judged(file: Path, capsys) -> str:
    """What the command says of a file that it refuses, program and cell not given."""
    assert main(["verify", str(file)]) == 1
    said = capsys.readouterr()
    assert "Traceback" not in said.out + said.err
    assert "IRL090" not in said.out + said.err
    return str(said.out)


@pytest.mark.req("QA-06")
@pytest.mark.parametrize(
    ("keys", "value", "word"),
    [
        (("header", "tick_ns"), 2**63, "tick_ns"),
        (("header", "tick_ns"), 10**400, "tick_ns"),
        (("header", "weights", 2), 10**400, "weights"),
        (("header", "limits", "speed_upper", 0), 10**400, "limits.speed_upper"),
        (("header", "limits", "position_lower", 6), -(10**400), "limits.position_lower"),
    ],
    ids=["tick 2**63", "tick 10**400", "weight", "speed", "position"],
)
def test_huge_numbers_in_a_header(plain: Job, tmp_path: Path, capsys, keys, value: int, word: str) -> None:
    """Whole numbers that neither 64 bits nor a float can hold, in NPZ and CSV."""
    assert irlx.verify(with_meta(plain.stream, tmp_path / "a.npz", lambda _: None)).passed
    header: dict = {}
    with_meta(plain.stream, tmp_path / "a.npz", lambda meta: header.update(meta["header"]))
    of_meta(*keys[1:])(value)(header)
    text = json.dumps(header[keys[1]])
    for file in (
        with_meta(plain.stream, tmp_path / "a.npz", of_meta(*keys)(value)),
        with_comment(plain.stream, tmp_path / "a.csv", keys[1], text),
    ):
        assert names(report := irlx.verify(file)) == {"file"}, str(report)
        assert report["file"].detail.startswith("IRL701")
        assert word in report["file"].detail
        assert "IRL701" in judged(file, capsys)


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("first", [0.9, "0", False, None])
def test_runs_of_ticks_that_are_no_counts(plain: Job, tmp_path: Path, capsys, first: object) -> None:
    """What rounds or turns into the right count is no count; None stands for counts that are no pairs."""
    rows = len(plain.stream.ticks)
    runs = [0, rows] if first is None else [[first, rows]]
    assert irlx.verify(with_meta(plain.stream, tmp_path / "a.npz", of_meta("ticks")([[0, rows]]))).passed
    file = with_meta(plain.stream, tmp_path / "a.npz", of_meta("ticks")(runs))
    assert names(report := irlx.verify(file)) == {"file"}, str(report)
    assert report["file"].detail.startswith("IRL701")
    assert "ticks" in report["file"].detail
    assert "IRL701" in judged(file, capsys)


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("count", [0, 1, 6, 8])
def test_a_switch_of_another_robot_and_no_move(plain: Job, capsys, count: int) -> None:
    """The records of all moves are gone; the limit switch has more or fewer numbers than there are joints."""
    switch = plain.stream.records[0]
    assert isinstance(switch.block, LimitSwitchBlock)
    bounds = JointRange((-1.0,) * count, (1.0,) * count)
    records = (replace(switch, block=replace(switch.block, range=bounds)),)
    report = plain.verify(replace(plain.stream, records=records))
    assert names(report) == {"blocks"}, str(report)
    assert report["blocks"].detail == "at tick 0: block 1: its limits are not those of 7 joints"
    assert "its limits are not those" in judged(plain.folder / "pretended.irdata", capsys)


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("name", ["cell.toml", "../cell.toml", "/dev/zero", "pipe", ".", ""])
def test_where_a_recorded_cell_is_looked_for(plain: Job, tmp_path: Path, monkeypatch, name: str) -> None:
    """Only a plain file beside the stream: no device, pipe or folder, and nothing anywhere else."""
    inside = tmp_path / "inside"
    inside.mkdir()
    os.mkfifo(inside / "pipe")
    own = inside if name == "cell.toml" else tmp_path
    (own / "cell.toml").write_bytes(plain.cell.read_bytes())
    opened = []

    def spied(path: Path):
        opened.append(path.resolve())
        assert path.is_file(), path
        return load_cell(path)

    monkeypatch.setattr("irlx.verification.load_cell", spied)
    monkeypatch.chdir(inside)
    header = replace(plain.stream.header, cell_name=name)
    write_stream(replace(plain.stream, header=header), inside / "a.irdata")
    report = irlx.verify("a.irdata")
    assert report.passed, str(report)
    assert opened == ([inside / name] if name == "cell.toml" else [])
    assert report["robot limits"].status == ("ok" if name == "cell.toml" else "not checked")


@pytest.mark.req("QA-06")
@pytest.mark.parametrize("ending", [".irdata", ".npz", ".csv"])
def test_names_that_steer_a_terminal(plain: Job, tmp_path: Path, capsys, ending: str) -> None:
    """Joint, program and robot names with escape sequences are printed as escapes."""
    stream = plain.stream
    joints = ("\x1b[2J\x1b[31m", "\u202eback", *stream.header.joint_names[2:])
    header = replace(stream.header, joint_names=joints, robot_name="\x1b]0;a\x07", program_name="\x9b1m")
    q = stream.q.copy()
    q[5, 0] += 1.0
    write_stream(replace(stream, header=header, q=q), file := tmp_path / f"a{ending}")
    said = judged(file, capsys)
    assert "joint \\x1b[2J\\x1b[31m" in said
    assert "program \\x9b1m, robot \\x1b]0;a\\x07" in said
    assert all(line.isprintable() for line in said.split("\n"))
