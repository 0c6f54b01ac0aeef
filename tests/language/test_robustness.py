"""Programs without measure and beginnings of programs: findings, soon; and the speed of the front end."""

import subprocess
import sys
import time
from math import inf

import pytest

from irlx.diagnostics.text import render_text
from irlx.language import tree
from irlx.language.analysis import analyse
from irlx.language.source import source_text
from long_programs import long_program
from long_run import first

PROGRAM = """PROGRAM demo;
VAR REAL: x; ARRAY [1..5] OF POSE: rack; OUTPUT BOOL: lamp AT 1;
PROCEDURE pick(IN POSE: at; VAR INT: n);
BEGIN
  IF n > 3 THEN n := 0; ELSIF n = 2 THEN RETURN; ELSE n := n + 1; ENDIF;
ENDPROC;
FUNCTION f(REAL: a): REAL; BEGIN RETURN a * 2. + 1; ENDFCT;
BEGIN
  FOR x := 1 TO 5 STEP 2 DO MOVE LIN rack[x], (1, 2, 3) SPEED := 100. WITH CRITERION c WEIGHT := 2; ENDFOR;
  CASE x OF WHEN 1, 3..5: lamp := TRUE; DEFAULT: EXIT; ENDCASE;
  WHILE NOT lamp DO WAIT FOR x TIMEOUT 5 SEC; ENDWHILE;
  REPEAT x := f(x); UNTIL x > 5;
ENDPROGRAM
"""


def check(text):
    points = source_text("t.dat", text)
    analysis = analyse(source_text("t.irl", text), data_lists=lambda *_: points, lints=True)
    length = len(analysis.source.text)
    for finding in analysis.diagnostics:
        assert finding.place.span.end <= length
        render_text(finding)
    # Twenty of the text, and as many of a data list.
    assert sum(d.is_error and d.code.startswith("IRL1") for d in analysis.diagnostics) <= 40
    if analysis.tree is not None:
        for node in tree.walk(analysis.tree):
            assert node.span.end <= length
        hash(analysis.tree)
        repr(analysis.tree)


HOSTILE = {
    "open comments": lambda n: "{\n" * n,
    "comments in comments": lambda n: "{ { \n" * (n // 4) + "}",
    "open texts": lambda n: "x := '\n" * n,
    "wrong characters": lambda n: "§ " * n,
    "calls that look like keywords": lambda n: "CYCLICSTRT;\n" * n,
    "unknown calls": lambda n: "".join(f"call{i};\n" for i in range(n)),
    "warnings": lambda n: "x = 5;\n" * n,
    "ends": lambda n: "ENDIF; " * n,
    "plain ends": lambda n: "END; " * n,
    "else if": lambda n: "IF a THEN\n" + "ELSE IF a THEN\n" * n,
    "nested blocks": lambda n: "IF a THEN\n" * (n // 2) + "ENDIF;\n" * (n // 2),
    "nested parentheses": lambda n: "x := " + "(" * (n // 2) + ")" * (n // 2) + ";",
    "one long list": lambda n: "x := (" + "1, " * (5 * n // 2) + "1);",
    "one long sum": lambda n: "x := " + "1 + " * n + "1;",
    "commas": lambda n: "MOVE LIN p,\n" * n,
    "a long name": lambda n: "x" * (25 * n) + " := 1;",
    "a long number": lambda n: "x := " + "9" * (25 * n) + ";",
    "slashes": lambda n: "/" * (5 * n),
    "typographic quotes": lambda n: "‘" * (5 * n // 2),
}
"""Programs of some n lines."""


@pytest.mark.req("QA-08")
@pytest.mark.req("BEN-03")
@pytest.mark.parametrize("size", first(1, [3_000, 20_000]))
@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_programs_end_soon(name, size):
    text = f"PROGRAM t; VAR REAL: x; BOOL: a; POSE: p;\nBEGIN\n{HOSTILE[name](size)}\nENDPROGRAM\n"
    start = time.process_time()
    analyse(source_text("t.irl", text))
    # A line takes 0.2 ms at the promised speed, the rest is room for a slow machine.
    assert time.process_time() - start < 0.5e-3 * size


@pytest.mark.slow
@pytest.mark.req("QA-08")
@pytest.mark.req("LANG-76")
def test_a_hundred_thousand_lines(tmp_path):
    """Within a minute and 1 GB, sound or with a mistake that has the text read twice."""
    code = (
        "import resource, sys; from irlx.cli.main import main; main(['check', sys.argv[1]]);"
        "print('memory', resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
    )
    sound = long_program(100_000)
    for text in (sound, sound.replace("ENDIF;", "", 1)):
        (tmp_path / "long.irl").write_text(text, encoding="utf-8")
        command = [sys.executable, "-c", code, str(tmp_path / "long.irl")]
        done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120)
        kilobytes = int(done.stdout.split("memory ")[1])
        assert kilobytes < 1_000_000


def test_every_beginning_of_a_program_is_bearable():
    for cut in range(0, len(PROGRAM), 3):
        check(PROGRAM[:cut])


@pytest.mark.req("LANG-76")
def test_speed_of_the_front_end():
    part = (
        "  x := y * 2 + 2.5; { comment }\n  MOVE LIN p SPEED := 200. ACC := 500;\n"
        "  IF x > 3 AND y < 2 THEN\n    p := ((1, 2, 3), ORIZYX(0, 180, 0));\n  ENDIF;\n"
    )
    text = "PROGRAM big;\nVAR REAL: x, y; POSE: p;\nBEGIN\n" + part * 400 + "ENDPROGRAM\n"
    source = source_text("big.irl", text)
    times = [inf]
    # A machine may be slow for a while; one try that is quick enough is enough.
    while len(times) < 12 and source.line_count / min(times) <= 5_000:
        start = time.process_time()
        analysis = analyse(source)
        times.append(time.process_time() - start)
    assert not analysis.diagnostics
    # Computing time, so that other work on the machine counts little; benchmarks/front_end.py says more.
    assert source.line_count / min(times) > 5_000


@pytest.mark.req("LANG-76")
def test_a_cold_check(tmp_path):
    (tmp_path / "long.irl").write_text(long_program(1000), encoding="utf-8")
    times = []
    for _ in range(3):
        start = time.perf_counter()
        command = [sys.executable, "-m", "irlx", "check", "long.irl"]
        subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)
        times.append(time.perf_counter() - start)
        # The aim is 0.5 s; a machine that does other work or keeps no bytecode may take three times as long.
        if times[-1] < 1.5:
            return
    pytest.fail(f"three checks took {times} s")
