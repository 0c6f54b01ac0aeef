"""Random and damaged text: findings, never an exception; and the speed of the front end."""

import random
import time
from pathlib import Path

import pytest

from irlx.diagnostics.text import render_text
from irlx.language import tree
from irlx.language.analysis import analyse
from irlx.language.keywords import keyword_table
from irlx.language.source import source_text

FORMS = (Path(__file__).parent / "data" / "forms.irl").read_text(encoding="utf-8")
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
LIST = """DATALIST points;
  POSE: p0 := ((600, 0, 400), ORIZYX(0, 180, 0)), datalist := p0 @ INV(p0);
  ARRAY [1..2] OF RECORD REAL: u; ENDRECORD: rack := ((1), (2));
ENDDATALIST
"""
PIECES = [*keyword_table().values(), "x", "1", "1.5", "'a'", "'", "{", "}", "(*", "*)", "\n", "§", "\0"]
PIECES += [";", ":", ":=", "=", ",", ".", "..", "(", ")", "[", "]", "+", "-", "*", "/", "@", "<", ">="]


def mutated(chance, text):
    words = text.split(" ")
    for _ in range(chance.randint(1, 6)):
        if not words:
            break
        place = chance.randrange(len(words))
        action = chance.randrange(4)
        if action == 0:
            del words[place]
        elif action == 1:
            words.insert(place, chance.choice(PIECES))
        elif action == 2:
            words[place] = chance.choice(PIECES)
        else:
            words = words[: place + 1]
    text = " ".join(words)
    cut = chance.randrange(len(text) + 1)
    return text[:cut] + text[cut + chance.randint(0, 2) :]


def check(text):
    points = source_text("t.dat", text)
    analysis = analyse(source_text("t.irl", text), data_lists=lambda *_: points, lints=True)
    length = len(analysis.source.text)
    for finding in analysis.diagnostics:
        assert finding.place.span.end <= length
        render_text(finding)
    assert sum(d.is_error for d in analysis.diagnostics) <= 60
    if analysis.tree is not None:
        for node in tree.walk(analysis.tree):
            assert node.span.end <= length
        hash(analysis.tree)
        repr(analysis.tree)


@pytest.mark.parametrize("seed", range(4))
def test_mutated_programs_never_raise(seed):
    chance = random.Random(seed)
    end = time.monotonic() + 0.8
    while time.monotonic() < end:
        check(mutated(chance, chance.choice([PROGRAM, FORMS, LIST])))


@pytest.mark.parametrize("seed", range(2))
def test_random_words_never_raise(seed):
    chance = random.Random(seed)
    end = time.monotonic() + 0.6
    while time.monotonic() < end:
        start = chance.choice(["", "PROGRAM t;\n", "PROGRAM t; BEGIN\n", "MODULE m;", "DATALIST d;"])
        check(start + " ".join(chance.choices(PIECES, k=chance.randint(0, 60))))


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
    times = []
    for _ in range(3):
        start = time.perf_counter()
        analysis = analyse(source)
        times.append(time.perf_counter() - start)
    assert not analysis.diagnostics
    # The aim is 5,000 lines/s; the bound leaves room for a machine that does other work.
    assert source.line_count / min(times) > 2_000
