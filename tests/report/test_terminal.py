"""The summary as people read it: the verdict first, long lists shortened, nothing wider than need be."""

from __future__ import annotations

import re
from dataclasses import replace
from math import radians
from pathlib import Path

import pytest

import irlx
from irlx.report.clearances import SmallestClearance
from irlx.report.events import LimitActive, Slowed
from irlx.report.lines import Tone, columns, plain_text
from irlx.report.returns import Return
from irlx.report.summary import Closure, LimitUse, Summary
from irlx.report.terminal import file_lines, headline, stop_line, summary_lines, summary_text
from irlx.verifier import Report
from irlx.verifier.findings.finding import FAILED, NOT_CHECKED, OK, Check

pytestmark = pytest.mark.req("REP-02")

ROOT = Path(__file__).resolve().parents[2]
PLAIN = Summary(
    program="p.irl",
    complete=True,
    duration=1.0,
    samples=101,
    moves=2,
    path_position_error=1.25e-15,
    path_orientation_error=0.0,
    limit_use=(),
    active=(),
    slowed=(),
    planned=0,
    closure=None,
    iterations_per_tick=1.0,
    joint_names=("rail", "a1", "a2"),
    joint_units=("m", "rad", "rad"),
)


def active(joint: str, kind: str, side: str, first: int, last: int) -> LimitActive:
    return LimitActive(joint, kind, side, first, last, first / 100, last / 100)


def slow(line: int, first: int, lost: float, joint: str = "a1", last: int = 0) -> Slowed:
    last = last or line
    kind, bound = ("speed", radians(20.0)) if joint else ("", 0.0)
    times = first / 100, (first + 50) / 100
    return Slowed(
        line, first, first + 50, *times, 0.1, 2.0, False, 1.0, 0.25, joint, kind, bound, lost, line, last
    )


FULL = replace(
    PLAIN,
    planned=1,
    limit_use=(
        LimitUse("position", "rail", -0.5, -0.5, 1.0, 7),
        LimitUse("speed", "a1", radians(19.9), radians(20.0), 0.995, 31),
    ),
    active=(
        active("a1", "acceleration", "upper", 1, 2),
        active("rail", "position", "lower", 10, 19),
        active("a1", "acceleration", "lower", 30, 30),
        active("rail", "position", "lower", 40, 49),
    ),
    slowed=(slow(4, 10, 0.31, last=5), slow(5, 60, 0.05, "")),
    closure=Closure("a2", radians(72.7)),
    returns=(
        Return(9, 80, 3, (0.0, 0.0, 1e-9), ""),
        Return(12, 90, 3, (0.002, radians(-1.5), 0.0), "rail at its upper position limit"),
    ),
    clearance=SmallestClearance("hand", "table", 0.0275204, 0.02, 44),
)
MANY = replace(
    PLAIN,
    active=tuple(active(f"j{k}", "position", "upper", 10 * k, 10 * k + k) for k in range(7)),
    slowed=tuple(slow(k, 10 * k, 0.1 * k) for k in range(1, 8)),
    returns=tuple(Return(k, k, 1, tuple(0.1 * (j + 1) for j in range(6)), "a1 frozen") for k in range(6)),
    joint_names=tuple(f"j{k}" for k in range(6)),
    joint_units=("rad",) * 6,
)


def test_a_plain_run() -> None:
    assert summary_text(PLAIN, True) == (
        "p.irl: complete, verified, 1 s, not slowed\n"
        "moves       2\n"
        "path error  1.2e-15 m, 0 rad at worst\n"
        "at a limit  no joint was held by one"
    )


def test_a_slowed_run_is_not_said_to_meet_no_limit() -> None:
    # A plan that slows the tool for a joint's limit need not meet it in any tick.
    assert "at a limit" not in summary_text(replace(PLAIN, slowed=(slow(4, 10, 0.31),)))


def test_a_run_with_all_there_is_to_tell() -> None:
    assert summary_text(FULL, True).splitlines() == [
        "p.irl: complete, verified, 1 s, slowed by 0.36 s, nearest 27.5 mm",
        "moves       2 (1 planned as a whole to keep limits)",
        "slowed      0.36 s longer than programmed at 2 places, the path is kept",
        "            lines 4-5  0.1-0.6 s  +0.31 s  250 of 1000 mm/s  a1: 20 deg/s",
        "            line 5     0.6-1.1 s  +0.05 s  250 of 1000 mm/s",
        "path error  1.2e-15 m, 0 rad at worst",
        "limit use   position   100 %  rail  -500 of -500 mm   tick 7",
        "            speed     99.5 %  a1    19.9 of 20 deg/s  tick 31",
        "at a limit  a1    acceleration    0.03 s  0.01-0.3 s, 2 times",
        "            rail  lower position   0.2 s  0.1-0.49 s, 2 times",
        "clearance   27.52 mm at least (margin 20 mm): hand and table, tick 44",
        "closure     the tool ends where it began, but a2 is off by 72.7 deg",
        "cyclic      back in the posture of CYCLICSTART once, to 1e-09 rad|m",
        "            line 12: not back in the posture of line 3, held by rail at its upper position limit",
        "              off: a1 -1.5 deg, rail 2 mm",
    ]


def test_long_lists_are_shortened_with_a_count() -> None:
    lines = summary_text(MANY).splitlines()
    assert lines[0] == "p.irl: complete, 1 s, slowed by 2.8 s"
    slowed = lines.index("slowed      2.8 s longer than programmed at 7 places, the path is kept")
    told = lines[slowed + 1 : slowed + 6]
    assert [words.split()[1] for words in told[:4]] == ["4", "5", "6", "7"]
    assert told[4] == "            and 3 more, for less time"
    held = next(number for number, line in enumerate(lines) if line.startswith("at a limit"))
    assert [line[12:].split()[0] for line in lines[held : held + 4]] == ["j3", "j4", "j5", "j6"]
    assert lines[held + 4] == "            and 3 more, for less time"
    assert lines[-1] == "            and 2 more returns that did not close"
    assert "and 3 more joints" in lines[-2]
    assert len(lines) < 30


@pytest.mark.parametrize("summary", [PLAIN, FULL, MANY], ids=["plain", "full", "many"])
def test_lines_fit_a_terminal(summary: Summary) -> None:
    """But for what a name makes long: here the words on what held a posture."""
    wide = [line for line in summary_text(summary, True).splitlines() if len(line) > 80]
    assert all("held by" in line for line in wide)


def test_the_verdict() -> None:
    assert headline(PLAIN, True).tone is Tone.GOOD
    failed = headline(PLAIN, False)
    assert (failed.words, failed.tone) == ("p.irl: complete, VERIFICATION FAILED, 1 s, not slowed", Tone.BAD)
    early = replace(PLAIN, complete=False)
    assert headline(early).words == "p.irl: INCOMPLETE, 1 s, not slowed"
    assert headline(early).tone is Tone.BAD
    stopped = stop_line(replace(early, moves=1), "IRL520 at line 6")
    assert stopped.words == "p.irl: INCOMPLETE, 1 move in 1 s until IRL520 at line 6"
    assert summary_lines(PLAIN, True)[0] == headline(PLAIN, True)


def test_files_and_what_the_verifier_says_of_them() -> None:
    good = Report((Check("a", OK), Check("b", OK), Check("c", NOT_CHECKED, detail="no cell")))
    bad = Report((Check("a", OK), Check("b", FAILED, detail="off\x1b[1m")))
    lines = file_lines(PLAIN, ["p.irdata", "p.long.npz", "p.csv"], {"p.irdata": good, "p.long.npz": bad})
    assert plain_text(lines).splitlines() == [
        "written     p.irdata    101 samples, 2 checks passed, 1 not made",
        "written     p.long.npz  101 samples",
        "written     p.csv       101 samples",
        "VERIFY      p.long.npz: FAILED: 1 of 2 checks; b: off\\x1b[1m",
    ]


def test_columns() -> None:
    assert columns([("a", "1", "x"), ("bcd", "22", "")], right=(1,)) == ["a     1  x", "bcd  22"]


def test_in_python_it_is_printed_in_the_same_way() -> None:
    assert str(FULL) == summary_text(FULL)
    assert repr(FULL) == "<Summary of p.irl: complete, 1 s, slowed by 0.36 s, nearest 27.5 mm>"
    assert {"joint_names", "joint_units"}.isdisjoint(FULL.to_plain())
    assert set(FULL.to_plain()["closure"]) == {"joint", "difference"}


def test_a_run_of_a_program(tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text('[robot]\nmodel = "arm7"\n', encoding="utf-8")
    (tmp_path / "p.irl").write_text(
        "PROGRAM p;\nBEGIN\n  MOVE_INC LIN POSITION(0, 10, 0);\nENDPROGRAM;\n", encoding="utf-8"
    )
    run = irlx.run(tmp_path / "p.irl")
    size = f"{len(run.t)} samples of 7 joints"
    verdict = f"p.irl: complete, {run.t[-1]:.6g} s, not slowed"
    assert repr(run) == f"<Run of {verdict}; {size}>"
    assert repr(run.stream) == f"<JointStream of p.irl: {size}>"
    assert repr(run.clearances) == f"<Clearances of {len(run.t)} samples: nothing was near>"
    assert str(run) == str(run.summary)
    assert str(run).splitlines()[0] == verdict
    assert re.search(
        r"^limit use   position +[\d.]+ %  joint_\d  -?[\d.]+ of -?\d+ deg +tick \d+$", str(run), re.M
    )
