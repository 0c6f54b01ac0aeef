"""Statements that decide what runs next: IF, CASE, loops, EXIT, GOTO, HALT, PAUSE."""

import pytest

from irlx.blocks import HaltBlock, MoveBlock, PauseBlock
from irlx.language.analysis import analyse
from irlx.language.source import source_text

pytestmark = pytest.mark.req("LANG-40")

VARIABLES = """VAR INT: i := 0, j, k := 0, n := 3; REAL: x, y := 0; BOOL: b := FALSE; CHAR: c := 'b';
STRING: s := ''; ARRAY [1..4] OF INT: a := (1, 2, 3, 4);"""

RUNS = [
    ("IF n = 3 THEN i := 1; ENDIF;", {"i": 1}),
    ("IF n = 4 THEN i := 1; ENDIF;", {"i": 0}),
    ("IF n = 4 THEN i := 1; ELSE i := 2; ENDIF;", {"i": 2}),
    ("IF n = 4 THEN i := 1; ELSIF n = 3 THEN i := 2; ELSIF n > 0 THEN i := 3; ELSE i := 4; ENDIF;", {"i": 2}),
    ("IF n = 4 THEN i := 1; ELSIF n = 5 THEN i := 2; ELSE i := 4; ENDIF;", {"i": 4}),
    ("IF n > 0 THEN IF n > 2 THEN i := 7; ENDIF; k := 1; ENDIF;", {"i": 7, "k": 1}),
    ("IF TRUE THEN ENDIF; IF FALSE THEN ELSE ENDIF; i := 1;", {"i": 1}),
    ("CASE n OF WHEN 1: i := 1; WHEN 3: i := 3; ENDCASE;", {"i": 3}),
    ("CASE n OF WHEN 1, 2: i := 1; WHEN 5, 3, 4: i := 3; ENDCASE;", {"i": 3}),
    ("CASE n OF WHEN 1..2: i := 1; WHEN 3..9: i := 3; WHEN 10: i := 4; ENDCASE;", {"i": 3}),
    # Of labels that the text does not tell, the first one counts; a range may turn out to be empty.
    ("CASE n OF WHEN 1..k + 2: i := 1; WHEN k + 3..9: i := 3; WHEN n: i := 4; ENDCASE;", {"i": 3}),
    ("CASE n OF WHEN n: i := 3; WHEN 1..5: i := 1; ENDCASE;", {"i": 3}),
    ("CASE n OF WHEN n + 2..n - 2: i := 1; DEFAULT: i := 9; ENDCASE;", {"i": 9}),
    ("CASE n OF WHEN -3..-1: i := 1; ENDCASE; k := 1;", {"i": 0, "k": 1}),
    ("CASE n * 2 OF WHEN n + 3: i := 1; ENDCASE;", {"i": 1}),
    ("CASE c OF WHEN 'a': i := 1; WHEN 'b': i := 2; ENDCASE;", {"i": 2}),
    ("CASE c OF WHEN '0'..'9': i := 1; WHEN 'a'..'z', '_': i := 2; ENDCASE;", {"i": 2}),
    ("CASE 'up' OF WHEN 'down': i := 1; WHEN 'up': i := 2; ENDCASE;", {"i": 2}),
    ("CASE n > 2 OF WHEN FALSE: i := 1; WHEN TRUE: i := 2; ENDCASE;", {"i": 2}),
    ("FOR i := 1 TO 4 DO k := k * 10 + i; ENDFOR;", {"k": 1234, "i": 4}),
    ("FOR i := 4 DOWNTO 1 DO k := k * 10 + i; ENDFOR;", {"k": 4321, "i": 1}),
    ("FOR i := 1 TO 8 STEP 3 DO k := k * 10 + i; ENDFOR;", {"k": 147, "i": 7}),
    ("FOR i := 9 DOWNTO 1 STEP 4 DO k := k * 10 + i; ENDFOR;", {"k": 951}),
    ("FOR i := 1 TO 0 DO k := 9; ENDFOR;", {"k": 0, "i": 0}),
    ("FOR i := 1 DOWNTO 2 DO k := 9; ENDFOR;", {"k": 0}),
    ("FOR i := 1 TO n DO n := 9; k := k + 1; ENDFOR;", {"k": 3}),
    ("FOR i := 1 TO 3 DO k := k + 1; i := 7; ENDFOR;", {"k": 3, "i": 7}),
    ("FOR x := 0 TO 0.3 STEP 0.1 DO k := k + 1; ENDFOR;", {"k": 4, "x": 0.30000000000000004}),
    ("FOR x := 1 DOWNTO 0 STEP 0.25 DO k := k + 1; ENDFOR;", {"k": 5, "x": 0.0}),
    ("FOR a[2] := 1 TO 3 DO k := k + a[2]; ENDFOR;", {"k": 6}),
    ("i := 1; FOR a[i] := 5 TO 7 DO i := 2; k := k + a[1]; ENDFOR;", {"k": 18, "i": 2}),
    ("FOR i := 1 TO 3 DO FOR j := 1 TO i DO k := k + 1; ENDFOR; ENDFOR;", {"k": 6}),
    ("FOR i := 9223372036854775806 TO 9223372036854775807 DO k := k + 1; ENDFOR;", {"k": 2}),
    ("WHILE k < 5 DO k := k + 2; ENDWHILE;", {"k": 6}),
    ("WHILE FALSE DO k := 9; ENDWHILE;", {"k": 0}),
    ("REPEAT k := k + 1; UNTIL k >= 4;", {"k": 4}),
    ("REPEAT k := k + 1; UNTIL TRUE;", {"k": 1}),
    ("REPEAT UNTIL TRUE;", {"k": 0}),
    ("FOR i := 1 TO 9 DO IF i = 4 THEN EXIT; ENDIF; k := i; ENDFOR;", {"k": 3, "i": 4}),
    ("WHILE TRUE DO k := k + 1; IF k = 7 THEN EXIT; ENDIF; ENDWHILE;", {"k": 7}),
    ("REPEAT k := k + 1; EXIT; UNTIL FALSE; i := 5;", {"k": 1, "i": 5}),
    (
        "FOR i := 1 TO 2 DO FOR j := 1 TO 9 DO k := k + 1; IF j = 3 THEN EXIT; ENDIF; ENDFOR; ENDFOR;",
        {"k": 6},
    ),
    ("again: k := k + 1; IF k < 5 THEN GOTO again; ENDIF;", {"k": 5}),
    ("GOTO past; k := 9; past: i := 1;", {"k": 0, "i": 1}),
    ("GOTO end; k := 9; end:", {"k": 0}),
    ("FOR i := 1 TO 9 DO WHILE TRUE DO GOTO out; ENDWHILE; ENDFOR; k := 9; out: n := i;", {"k": 0, "n": 1}),
    ("IF TRUE THEN GOTO b1; k := 9; b1: i := 2; ENDIF;", {"k": 0, "i": 2}),
    ("k := 1; RETURN; k := 2;", {"k": 1}),
    ("k := 1; HALT; k := 2;", {"k": 1}),
    ("k := 1; PAUSE; k := 2;", {"k": 2}),
    (";;; k := 1;;", {"k": 1}),
]


@pytest.mark.parametrize(("body", "expected"), RUNS)
def test_what_runs(final, body, expected):
    found = final(VARIABLES, body)
    assert {name: found[name] for name in expected} == expected


WRONG = [
    ("IF 1 THEN k := 1; ENDIF;", ("IRL222", "expected BOOL, found INT", "1")),
    ("WHILE y DO k := 1; ENDWHILE;", ("IRL222", "expected BOOL, found REAL", "y")),
    ("REPEAT UNTIL 'a';", ("IRL222", "expected BOOL, found STRING", "'a'")),
    ("CASE 1.5 OF WHEN 1: ENDCASE;", ("IRL222", "expected INT, CHAR, STRING or BOOL, found REAL", "1.5")),
    ("CASE n OF WHEN 'a': ENDCASE;", ("IRL222", "expected INT, found STRING", "'a'")),
    ("CASE c OF WHEN 'ab': ENDCASE;", ("IRL222", "expected CHAR, found STRING", "'ab'")),
    ("FOR b := 1 TO 3 DO ENDFOR;", ("IRL222", "expected a variable of type INT or REAL, found BOOL", "b")),
    ("FOR i := 1 TO 2.5 DO ENDFOR;", ("IRL222", "expected INT, found REAL", "2.5")),
    ("FOR i := 1 TO 3 STEP k DO ENDFOR;", ("IRL505", "STEP must be greater than 0, found 0", "k")),
    ("FOR i := 3 DOWNTO 1 STEP -1 DO ENDFOR;", ("IRL505", "STEP must be greater than 0, found -1", "-1")),
    (
        "k := -1234567890; FOR i := 1 TO 3 STEP k DO ENDFOR;",
        ("IRL505", "STEP must be greater than 0, found -1234567890", "k"),
    ),
    (
        "FOR x := -1.7E308 TO 1.7E308 STEP 1.E308 DO ENDFOR;",
        ("IRL503", "the way from the first value of FOR to the last leaves the range of REAL", "1.7E308"),
    ),
    ("IF j = 1 THEN ENDIF;", ("IRL501", "'j' has no value yet", "j")),
    ("RETURN 3;", ("IRL514", "RETURN has no value outside of a function", "RETURN 3")),
]


@pytest.mark.parametrize(("body", "expected"), WRONG)
def test_what_is_wrong(run_error, body, expected):
    assert run_error(VARIABLES, body) == expected


CHOSEN_BEFORE = [
    (
        "CASE n OF WHEN 1..2: i := 1; WHEN 3..9: i := 3; WHEN 3: i := 4; ENDCASE;",
        ("IRL252", "3 is chosen by an earlier label of this CASE", "3"),
    ),
    (
        "CASE n OF WHEN 3: i := 3; WHEN 1..5: i := 1; ENDCASE;",
        ("IRL252", "1..5 is chosen by an earlier label of this CASE", "1..5"),
    ),
    (
        "CASE n OF WHEN 5..1: i := 1; DEFAULT: i := 9; ENDCASE;",
        ("IRL508", "the range 5..1 is empty", "5..1"),
    ),
]


@pytest.mark.parametrize(("body", "expected"), CHOSEN_BEFORE)
def test_labels_are_judged_before_the_program_runs(body, expected):
    text = f"PROGRAM t;\n{VARIABLES}\nBEGIN\n{body}\nENDPROGRAM"
    (found,) = (d for d in analyse(source_text("t.irl", text)).diagnostics if d.is_error)
    assert (found.code, found.message, text[found.place.span.start : found.place.span.end]) == expected


def test_what_is_wrong_is_told_when_the_program_gets_there(final):
    assert (
        final(VARIABLES, "IF n = 4 THEN k := a[n + 1]; MOVE_INC LIN (1, 2, 3); ELSE k := 1; ENDIF;")["k"] == 1
    )


def test_blocks_come_as_their_statements_run(blocks):
    body = """FOR i := 1 TO 3 DO MOVE LIN POSITION(i, 0, 0); IF i = 2 THEN PAUSE; ENDIF; ENDFOR;
    HALT; CYCLICSTART;"""
    found = blocks(VARIABLES, body)
    assert [type(block) for block in found] == [MoveBlock, MoveBlock, PauseBlock, MoveBlock, HaltBlock]
    assert [block.id for block in found] == [1, 2, 3, 4, 5]


def test_a_program_is_pulled_and_not_run_ahead(generator):
    text = """PROGRAM t; VAR INT: i;
    BEGIN FOR i := 1 TO 1000000000 DO MOVE LIN POSITION(i, 0, 0); ENDFOR; ENDPROGRAM"""
    source = generator(text)
    assert [next(source).target.position[0] for _ in range(3)] == pytest.approx([1e-3, 2e-3, 3e-3])


def test_pause_as_text(lines):
    assert lines("", "PAUSE;") == ["1 PAUSE line 4"]
