"""What progress says of a run: which move, how far, how fast, planning, and the line of the program."""

from __future__ import annotations

import io
import sys
import time

import pytest
from rich.cells import cell_len

from irlx.blocks import JointTarget, MotionLaw, MoveBlock, MoveKind, Origin, WaitBlock
from irlx.diagnostics import Place, SourceText, Span
from irlx.report.progress import Course, LineProgress, LiveProgress, Progress

pytestmark = pytest.mark.req("REP-01")

TEXT = "PROGRAM p;\nBEGIN\n  MOVE  PTP\ta\x1b;  { here }\n  MOVE LIN żółć;\nENDPROGRAM;\n"
LAW = MotionLaw(speed=1.0, acc=1.0, speed_ori=1.0, acc_ori=1.0)


def locate(origin: Origin) -> Place:
    return Place.in_text(SourceText("p.irl", TEXT), Span(origin.start, origin.end))


def move(number: int, line: int) -> MoveBlock:
    start = sum(len(part) + 1 for part in TEXT.split("\n")[: line - 1])
    origin = Origin("p.irl", start, start + 3, line)
    return MoveBlock(id=number, origin=origin, kind=MoveKind.PTP, target=JointTarget((0.0,)), law=LAW)


@pytest.fixture
def clock(monkeypatch):
    """A clock that stands until it is put on."""
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    return now


def test_from_the_first_move_to_the_verifier(clock) -> None:
    progress = Progress(Course(0.01, 2, locate))
    assert progress.state == ("starting", "", "")
    first, second = move(1, 3), move(2, 4)
    progress.begins(first, 0)
    clock[0] += 2.0
    progress.ticked(100)
    assert progress.state == ("move 1 of 2  1.00 s  0.5 x real time", "", "line 3: MOVE PTP a; { here }")
    progress.plans()
    assert progress.state[1] == "planning"
    clock[0] += 3.4
    assert progress.state[1] == "planning 3 s"
    progress(first, 2.0)
    progress.begins(second, 200)
    assert progress.state[0].startswith("move 2 of 2  2.00 s")
    assert progress.state[1:] == ("", "line 4: MOVE LIN żółć;")
    # A motion that stops on its way comes in parts, and behind the last move there is no other.
    progress(second, 2.5)
    progress(second, 3.0)
    assert progress.state[0].startswith("move 2 of 2  3.00 s")
    progress.says("verifying p.irdata")
    assert progress.state == ("verifying p.irdata", "", "")


def test_where_nobody_knows_how_many_there_are(clock) -> None:
    progress = Progress(Course(0.01, None, lambda origin: Place(origin.file, key="line 7")))
    progress.begins(move(1, 3), 0)
    progress(move(1, 3), 1.0)
    progress(WaitBlock(id=2, origin=move(1, 3).origin, duration=1.0), 2.0)
    progress.begins(move(3, 4), 200)
    clock[0] += 1.0
    assert progress.state == ("move 2  2.00 s  2.0 x real time", "", "line 4")


@pytest.mark.parametrize(("width", "encoding"), [(80, "utf-8"), (40, "utf-8"), (40, "ascii"), (12, "ascii")])
def test_the_line_fits_and_can_be_printed(monkeypatch, width: int, encoding: str) -> None:
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setenv("COLUMNS", str(width))
    progress = LiveProgress(Course(0.01, 2, locate))
    progress.begins(move(1, 4), 0)
    progress.plans()
    line = progress._line().plain
    assert cell_len(line) < width
    line.encode(encoding)
    assert "move" in line
    assert line.endswith(("...", "\N{HORIZONTAL ELLIPSIS}", ";"))


def test_a_clock_that_jumps_back(clock) -> None:
    """As in machines that were asleep: what is shown goes on, and nothing becomes negative."""
    progress = Progress(Course(0.01, 2, locate))
    progress.begins(move(1, 3), 0)
    progress.plans()
    for jump in (-50.0, 0.0, -1e9, 2e9):
        clock[0] += jump
        progress.ticked(100)
        assert progress.state[0].startswith("move 1 of 2  1.00 s")
        assert "-" not in progress.state[0] + progress.state[1]


def test_a_run_that_is_interrupted_leaves_the_cursor_visible(monkeypatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    shown = Terminal()
    monkeypatch.setattr(sys, "stderr", shown)
    monkeypatch.setenv("TERM", "xterm")
    progress = LiveProgress(Course(0.01, 2, locate))
    with pytest.raises(KeyboardInterrupt), progress:
        raise KeyboardInterrupt
    assert shown.getvalue().count("\x1b[?25l") == 1
    assert shown.getvalue().rfind("\x1b[?25h") > shown.getvalue().rfind("\x1b[?25l")


def test_a_terminal_that_can_only_add_lines(clock, capsys) -> None:
    progress = LineProgress(Course(0.01, 2, locate))
    for tick in range(1000):
        progress.begins(move(1, 3), tick) if tick == 0 else progress.ticked(tick)
        clock[0] += 0.01
    told = capsys.readouterr().err.splitlines()
    assert len(told) == 1
    assert told[0].startswith("move 1 of 2  5.0")
    progress.silence()
    clock[0] += 100.0
    progress.ticked(1000)
    assert capsys.readouterr().err == ""
