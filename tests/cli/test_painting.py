"""Program text in colours: the same text once they are taken off, whatever stands above a line."""

import re
import time
from pathlib import Path

import pytest

from irlx.cli.output import print_diagnostics
from irlx.cli.painting import painted_line
from irlx.diagnostics import Place, SourceText, Span, report
from long_programs import long_program

PROGRAMS = Path(__file__).parents[2] / "programs"
ESCAPE = re.compile("\x1b\\[[0-9;]*m")


class Terminal(list):
    """A stream that keeps what is written, and says that it is a terminal."""

    encoding = "utf-8"

    def isatty(self):
        return True

    def write(self, text):
        self.append(text)


@pytest.fixture
def told(monkeypatch):
    """What is printed of diagnostics on a terminal."""

    def run(diagnostics):
        found = Terminal()
        with monkeypatch.context() as patch:
            patch.setenv("TERM", "xterm")
            patch.delenv("NO_COLOR", raising=False)
            patch.setattr("sys.stderr", found)
            print_diagnostics(diagnostics)
        return "".join(found)

    return run


def test_colours_change_no_letter():
    for path in PROGRAMS.rglob("*.irl"):
        source = SourceText(path.name, path.read_text(encoding="utf-8"))
        coloured = [painted_line(source, line) for line in range(1, source.line_count + 1)]
        assert [ESCAPE.sub("", line) for line in coloured] == source.text.split("\n")
        assert any(ESCAPE.search(line) for line in coloured)


def test_a_line_within_a_comment_is_one():
    source = SourceText("t.irl", "{ one\nMOVE LIN p;\n three } MOVE PTP p;\r\nMOVE LIN 'a';")
    assert painted_line(source, 2) == "\x1b[2mMOVE LIN p;\x1b[0m"
    assert painted_line(source, 3) == "\x1b[2m three }\x1b[0m \x1b[94mMOVE\x1b[0m \x1b[94mPTP\x1b[0m p;"
    assert painted_line(source, 4) == "\x1b[94mMOVE\x1b[0m \x1b[94mLIN\x1b[0m \x1b[32m'a'\x1b[0m;"


def test_an_excerpt_on_a_terminal(told):
    source = SourceText("t.irl", "BEGIN\n\tMOVE LIN q;\nENDPROGRAM")
    shown = told([report("IRL201", Place.in_text(source, Span(16, 17)), name="q", near="")])
    assert shown.splitlines()[:3] == [
        "t.irl:2:11: \x1b[1;31merror IRL201\x1b[0m: unknown name 'q'",
        " 2 |     \x1b[94mMOVE\x1b[0m \x1b[94mLIN\x1b[0m q;",
        "   |              \x1b[1;31m^\x1b[0m",
    ]


def test_long_programs_are_told_quickly(told):
    text = long_program(4000)
    source = SourceText("t.irl", text)
    found = [
        report("IRL201", Place.in_text(source, Span(at, at + 1)), name="q", near="")
        for at in range(0, len(text), len(text) // 20)
    ]
    began = time.process_time()
    shown = told(found)
    assert time.process_time() - began < 2
    assert len(text) > 100_000
    assert shown.count("\x1b[94m") > 10
    source = SourceText("t.irl", text * 10)
    assert painted_line(source, 1) == source.line_text(1)
