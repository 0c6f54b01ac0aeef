"""What people see of commands at a terminal, and what a pipe gets."""

from __future__ import annotations

import re

import pytest

import irlx
from terminal import bare, seen, seen_inside

CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 10\n'
# Joints this slow make the tool slow down, for which the motion is planned as a whole.
MOVES = """PROGRAM p;
VAR MAIN_JOINT_SPEED_MIN: down := (-9, -9, -9, -9, -9, -9, -9);
    MAIN_JOINT_SPEED_MAX: up := (9, 9, 9, 9, 9, 9, 9);
BEGIN
  JOINTSPEEDLIMIT down, up;
  MOVE_INC LIN POSITION(0, 0, -40);  { a comment that is longer than the terminal of the test is wide }
  MOVE_INC LIN POSITION(0, 90, 60);
ENDPROGRAM;
"""
SPEAKS = """PROGRAM p;
BEGIN
  MOVE_INC LIN POSITION(0, 0, -5);
  WRITELN('first');
  MOVE_INC LIN POSITION(0, 0, 5);
  WRITELN('second');
ENDPROGRAM;
"""
ESCAPE = "\x1b"
COLOUR = re.compile(r"\x1b\[[0-9;]*3[0-9]")
LIVE = re.compile(r"\x1b\[2K")


@pytest.fixture(scope="module")
def place(tmp_path_factory):
    folder = tmp_path_factory.mktemp("terminal")
    for name, text in (("moves", MOVES), ("speaks", SPEAKS)):
        (folder / f"{name}.irl").write_text(text.replace("PROGRAM p;", f"PROGRAM {name};"), encoding="utf-8")
        (folder / f"{name}.toml").write_text(CELL, encoding="utf-8")
    return folder


def lines_of(text: str) -> list[str]:
    return [line.rstrip() for line in re.split(r"[\r\n]+", bare(text)) if line.strip()]


@pytest.mark.req("REP-01")
@pytest.mark.req("REP-02")
def test_progress_and_a_summary_in_colour(place):
    code, told, _ = seen(["run", "moves.irl"], place, columns=72)
    assert code == 0
    lines = lines_of(told)
    verdict = next(number for number, line in enumerate(lines) if "moves.irl: complete" in line)
    progress = [line for line in lines[:verdict] if "warning" not in line]
    summary = lines[verdict:]
    assert all(len(line) < 72 for line in progress)
    for words in (
        "move 1 of 2  ",
        "move 2 of 2  ",
        "planning",
        "line 6: MOVE_INC ",
        "verifying moves",
    ):
        assert any(words in line for line in progress), words
    # Nothing of it stays: the line is cleared and the cursor comes back.
    assert told.rindex("\x1b[?25h") < told.index("moves.irl: complete")
    assert summary[0].startswith("\N{CHECK MARK} moves.irl: complete, verified, ")
    assert "\x1b[1;32m" in told
    assert any(line.startswith("slowed      ") for line in summary)


@pytest.mark.req("REP-01")
def test_it_never_mixes_with_what_the_program_says(place):
    code, told, _ = seen_inside(["run", "speaks.irl"], place, {"NO_COLOR": "1"})
    assert code == 0
    assert not COLOUR.search(told)
    before, after = told.split("first\r\n")
    assert "move 1 of 2" in bare(before) or "starting" in bare(before)
    assert before.endswith("\x1b[2K") or bare(before).endswith(("\r", "\n"))
    assert not LIVE.search(after)
    assert lines_of(after)[:2] == ["second", lines_of(after)[1]]
    assert lines_of(after)[1].startswith("speaks.irl: complete, verified, ")


@pytest.mark.req("REP-01")
@pytest.mark.req("QA-09")
def test_a_plain_terminal(place):
    """No escapes, and no character that its encoding lacks."""
    plain = {"TERM": "dumb", "PYTHONIOENCODING": "ascii"}
    code, told, _ = seen_inside(["run", "speaks.irl"], place, plain)
    assert code == 0
    assert ESCAPE not in told
    assert told.isascii()
    assert lines_of(told)[2].startswith("speaks.irl: complete, verified, ")


@pytest.mark.req("REP-01")
def test_stdout_elsewhere_gets_nothing_but_results(place):
    code, told, out = seen_inside(["run", "speaks.irl"], place, piped=True)
    assert code == 0
    assert ESCAPE not in out
    assert out.startswith("first\nsecond\nspeaks.irl: complete, verified, ")
    assert "move 2 of 2" in bare(told) or "verifying" in bare(told)


@pytest.mark.req("REP-01")
@pytest.mark.parametrize("option", ["--quiet", "--json"])
def test_nothing_is_shown_to_whom_wants_nothing(place, inside, monkeypatch, option):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True, raising=False)
    done = inside("run", place / "speaks.irl", option)
    assert (done.returncode, done.stderr) == (0, "")
    assert ESCAPE not in done.stdout


@pytest.mark.req("QA-09")
@pytest.mark.parametrize(
    "arguments",
    [["check", "moves.irl"], ["robots"], ["robots", "arm7"], ["explain", "IRL203"], ["explain"]],
    ids=" ".join,
)
def test_other_commands(place, inside, arguments):
    """A pipe gets plain text (`inside` has no terminal); so does a terminal that wants none."""
    arguments = [place / word if word.endswith(".irl") else word for word in arguments]
    done = inside(*arguments)
    assert done.returncode == 0
    assert ESCAPE not in done.stdout + done.stderr
    assert done.stdout.strip()


@pytest.mark.req("STR-06")
def test_the_verdict_of_the_verifier(place, inside):
    (place / "cut.irdata").write_text("100, 1 ;\n", encoding="utf-8")
    code, told, _ = seen_inside(["verify", "cut.irdata"], place)
    assert code == 1
    assert lines_of(told)[-1].startswith("\N{BALLOT X} FAILED: ")
    done = inside("verify", place / "cut.irdata")
    assert done.stdout.splitlines()[-1].startswith("FAILED: ")
    assert done.stdout == f"{irlx.verify(place / 'cut.irdata')}\n"


def test_mistakes_are_coloured_at_a_terminal_alone(place, inside):
    (place / "wrong.irl").write_text("PROGRAM wrong;\nBEGIN\n  MOVE LIN;\nENDPROGRAM;\n", encoding="utf-8")
    code, told, _ = seen_inside(["check", "wrong.irl"], place)
    assert code == 1
    assert COLOUR.search(told)
    done = inside("check", place / "wrong.irl")
    assert ESCAPE not in done.stderr
    assert irlx.check(place / "wrong.irl")
