"""Lints (LANG-73): what they find, what they leave alone, and that shipped programs have none."""

from pathlib import Path

import pytest

import irlx

PROGRAMS = Path(__file__).parents[2] / "programs"


def lints(told_of, declarations, body, **more):
    found = told_of(f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM", lints=True, **more)
    return [(code, marked) for code, _, marked in found]


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize("path", sorted(PROGRAMS.rglob("*.irl")), ids=lambda path: path.name)
def test_shipped_programs_are_clean(path):
    assert [str(finding) for finding in irlx.check(path)] == []


NAMES = {
    ("VAR INT: n;", ""): [("IRL281", "n")],
    ("CONST INT: n := 1;", ""): [("IRL281", "n")],
    ("VAR INT: n;", "n := 1;"): [],
    ("VAR INT: n; INT: m;", "m := n;"): [("IRL282", "n")],
    ("VAR INT: n; INT: m;", "m := n; n := 1;"): [],
    ("VAR POSITION: p;", "MOVE LIN p;"): [("IRL282", "p")],
    ("VAR POSITION: p;", "p.x := 1; MOVE LIN p;"): [],
    ("VAR ARRAY [1..2] OF POSITION: p; INT: i := 1;", "p[i] := (1, 2, 3); MOVE LIN p[1];"): [],
    ("VAR INT: i; REAL: x;", "FOR i := 1 TO 3 DO x := i; ENDFOR;"): [],
    ("VAR INT: n; PROCEDURE p(VAR INT: m); BEGIN m := 1; ENDPROC;", "p(n); n := n + 1;"): [],
    ("VAR INT: n; PROCEDURE p(INT: m); BEGIN ENDPROC;", "p(n);"): [("IRL282", "n")],
    ("VAR FILE: f; INT: n;", "OPEN(f, 'a', 'READ'); READ(f, n); n := n + 1; CLOSE(f);"): [],
    ("VAR OUTPUT BOOL: lamp AT 1; INPUT BOOL: part AT 1;", ""): [],
    ("VAR SEMAPHORE: s;", ""): [("IRL281", "s")],
    ("VAR INT: n; PROCEDURE p; BEGIN n := 1; ENDPROC;", ""): [],
    ("PROCEDURE p; VAR INT: n; BEGIN ENDPROC;", ""): [("IRL281", "n")],
    ("PROCEDURE p; VAR INT: n; BEGIN n := n + 1; ENDPROC;", ""): [],
    ("PROCEDURE p(INT: n); BEGIN ENDPROC;", ""): [],
    ("CONST INT: n := 3; VAR ARRAY [1..n] OF INT: a;", "a[1] := 2;"): [],
    ("VAR INT: n; EXPORT n;", ""): [],
    ("VAR FILE: log; STANDARD_OUT = log;", ""): [],
    ("IMPORT DATALIST points; VAR POSE: p;", "p := q;"): [],
}


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize(("declarations", "body"), NAMES)
def test_names(told_of, declarations, body):
    assert lints(told_of, declarations, body) == NAMES[declarations, body]


FLOW = {
    "x := 1; HALT; x := 2; x := 3;": [("IRL283", "x := 2")],
    "HALT;": [],
    "GOTO there; x := 1; there: x := 2;": [("IRL283", "x := 1")],
    "again: x := 1; IF x > 3 THEN HALT; ENDIF; GOTO again;": [],
    "again: x := 1; GOTO again; x := 2;": [("IRL283", "x := 2")],
    "RETURN; x := 1;": [("IRL283", "x := 1")],
    "IF x > 1 THEN HALT; x := 2; ENDIF;": [("IRL283", "x := 2")],
    "IF x > 1 THEN HALT; ELSE RETURN; ENDIF; x := 2;": [("IRL283", "x := 2")],
    "IF x > 1 THEN HALT; ENDIF; x := 2;": [],
    "CASE i OF WHEN 1: HALT; DEFAULT: HALT; ENDCASE; x := 2;": [("IRL283", "x := 2")],
    "CASE i OF WHEN 1: HALT; ENDCASE; x := 2;": [],
    "CASE i OF WHEN 1: HALT; DEFAULT: x := 1; ENDCASE; x := 2;": [],
    "CASE i OF WHEN 1: x := 1; DEFAULT: HALT; ENDCASE; x := 2;": [],
    "IF x > 1 THEN x := 1; ELSE RETURN; ENDIF; x := 2;": [],
    "IF x > 1 THEN HALT; ELSE x := 1; ENDIF; x := 2;": [],
    "WHILE x > 1 DO EXIT; x := 2; ENDWHILE;": [("IRL283", "x := 2")],
    "WHILE x > 1 DO HALT; ENDWHILE; x := 2;": [],
    "FOR i := 1 TO 3 DO HALT; ENDFOR; x := 2;": [],
    "WHILE TRUE DO x := x + 1; ENDWHILE;": [("IRL284", "WHILE TRUE DO x := x + 1; ENDWHILE")],
    "REPEAT x := x + 1; UNTIL FALSE;": [("IRL284", "REPEAT x := x + 1; UNTIL FALSE")],
    "WHILE (TRUE) DO x := 1; ENDWHILE; x := 2;": [("IRL284", "WHILE (TRUE) DO x := 1; ENDWHILE")],
    "WHILE TRUE DO x := x + 1; IF x > 3 THEN EXIT; ENDIF; ENDWHILE; x := 3;": [],
    "WHILE TRUE DO IF x > 3 THEN HALT; ENDIF; x := 2; ENDWHILE; x := 3;": [("IRL283", "x := 3")],
    "WHILE TRUE DO IF x > 3 THEN GOTO out; ENDIF; ENDWHILE; out: x := 3;": [],
    "WHILE TRUE DO again: x := 1; GOTO again; ENDWHILE;": [
        ("IRL284", "WHILE TRUE DO again: x := 1; GOTO again; ENDWHILE")
    ],
    "WHILE TRUE DO WHILE b DO EXIT; ENDWHILE; ENDWHILE;": [
        ("IRL284", "WHILE TRUE DO WHILE b DO EXIT; ENDWHILE; ENDWHILE")
    ],
    "WHILE TRUE DO CASE i OF WHEN 1: EXIT; ENDCASE; ENDWHILE; x := 1;": [],
    "WHILE TRUE DO CASE i OF WHEN 1: x := 1; DEFAULT: EXIT; ENDCASE; ENDWHILE; x := 1;": [],
    "WHILE TRUE DO IF b THEN x := 1; ELSE EXIT; ENDIF; ENDWHILE; x := 1;": [],
    "WHILE TRUE DO stop; ENDWHILE;": [],
    "WHILE TRUE DO x := 1; ENDWHILE; REPEAT x := 1; UNTIL TRUE;": [
        ("IRL284", "WHILE TRUE DO x := 1; ENDWHILE")
    ],
    "REPEAT x := 1; UNTIL x > 3;": [],
    "WAIT FOR b;": [("IRL285", "WAIT FOR b")],
    "WAIT FOR b TIMEOUT 5 SEC;": [],
    "b := x = 0.3;": [("IRL286", "x = 0.3")],
    "b := i <> x;": [("IRL286", "i <> x")],
    "b := x <= 0.3;": [],
    "b := i = 3;": [],
    "IF b = TRUE THEN x := 1; ENDIF;": [],
}


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize("body", FLOW)
def test_ways(told_of, body):
    names = "VAR REAL: x := 0; INT: i := 1; BOOL: b := FALSE; PROCEDURE stop; BEGIN HALT; ENDPROC;"
    assert lints(told_of, names, f"x := i; b := x > 1;\n{body}") == FLOW[body]


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize(
    ("body", "ends"),
    [
        ("RETURN 1;", False),
        ("", True),
        ("IF a > 1 THEN RETURN 1; ENDIF;", True),
        ("IF a > 1 THEN RETURN 1; ELSE RETURN 2; ENDIF;", False),
        ("IF a > 1 THEN RETURN 1; ELSE HALT; ENDIF;", False),
        ("WHILE TRUE DO IF a > 1 THEN RETURN 1; ENDIF; ENDWHILE;", False),
        ("WHILE TRUE DO IF a > 1 THEN EXIT; ENDIF; ENDWHILE;", True),
        ("WHILE a > 1 DO RETURN 1; ENDWHILE;", True),
        ("again: IF a > 1 THEN RETURN 1; ENDIF; GOTO again;", False),
    ],
)
def test_functions_that_end_without_a_value(told_of, body, ends):
    text = (
        f"PROGRAM t; VAR INT: x; FUNCTION f(REAL: a): INT; BEGIN {body} ENDFCT; BEGIN x := f(1); ENDPROGRAM"
    )
    found = [(code, marked) for code, _, marked in told_of(text, lints=True)]
    assert found == ([("IRL287", "f")] if ends else [])


BOUNDS = {
    "JOINTLIMIT (1, 2, 3), (4, 5, 6); JOINTLIMITEND;": [],
    "JOINTLIMIT (1, 2, 3), (4, 1, 6); JOINTLIMITEND;": [("IRL310", "(1, 2, 3)")],
    "JOINTLIMIT lo, hi; JOINTLIMITEND;": [("IRL310", "lo")],
    "lo := (0, 0, 0); JOINTLIMIT lo, hi; JOINTLIMITEND;": [],
    "lo.a1.min := 0; JOINTLIMIT lo, hi; JOINTLIMITEND;": [],
    "JOINTLIMIT lo, (5, 5, 5); JOINTLIMITEND;": [],
    "MOVE LIN POSITION(1, 2, 3) WITH JOINTLIMIT lo, hi;": [("IRL310", "lo")],
    "JOINTSPEEDLIMIT slow, (1, 1, 1); JOINTSPEEDLIMITEND; slow := (2, 0, 0);": [("IRL310", "slow")],
    "JOINTSPEEDLIMIT slow, (x, 1, 1); JOINTSPEEDLIMITEND; slow := (2, 0, 0);": [],
}


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize("body", BOUNDS)
def test_bounds(told_of, body):
    names = """VAR MAIN_JOINT_MIN: lo := (1, 2, 3); MAIN_JOINT_MAX: hi := (4, 1, 6); REAL: x := 1;
    MAIN_JOINT_SPEED_MIN: slow;"""
    found = lints(told_of, names, body)
    assert [one for one in found if one[0] not in ("IRL281", "IRL282")] == BOUNDS[body]


CYCLES = {
    "MOVE LIN a; CYCLICSTART; MOVE LIN b, a; CYCLICEND;": 0,
    "MOVE LIN a; CYCLICSTART; MOVE LIN a, b; CYCLICEND;": 1,
    "MOVE LIN a; CYCLICSTART; MOVE LIN b, same; CYCLICEND;": 0,
    "MOVE LIN a; CYCLICSTART; MOVE LIN b; MOVE CIRCLE b, a; CYCLICEND;": 0,
    "MOVE LIN a; CYCLICSTART; MOVE LIN b; MOVE CIRCLE a, b; CYCLICEND;": 1,
    "MOVE LIN a; CYCLICSTART; MOVE CIRCLE a, b ANGLE := 360; CYCLICEND;": 0,
    "CYCLICSTART; MOVE LIN a, b; CYCLICEND;": 0,
    "MOVE LIN a; CYCLICSTART; CYCLICEND;": 0,
    "MOVE LIN a; CYCLICSTART; MOVE LIN later; CYCLICEND; later := (1, 2, 3); later := a;": 0,
    "later := (1, 2, 3); MOVE LIN a; CYCLICSTART; MOVE LIN later; CYCLICEND;": 1,
    "MOVE LIN a; CYCLICSTART; MOVE LIN (5, 0, 0); CYCLICEND;": 1,
    "MOVE LIN (1, 0, 0); CYCLICSTART; MOVE LIN b, a; CYCLICEND;": 0,
    "MOVE LIN p; CYCLICSTART; MOVE LIN b, a; CYCLICEND;": 0,
    "MOVE LIN p; CYCLICSTART; MOVE LIN a, b; CYCLICEND;": 1,
    "MOVE LIN POSE(b, ORIZYX(0, 0, 0)); CYCLICSTART; MOVE LIN a; CYCLICEND;": 0,
    "MOVE LIN POSE((5, 5, 5), ORIZYX(0, 0, 0)); CYCLICSTART; MOVE LIN a; CYCLICEND;": 1,
    "MOVE LIN a; IF x > 1 THEN MOVE LIN b; ENDIF; CYCLICSTART; MOVE LIN b; CYCLICEND;": 0,
    "MOVE LIN a; CYCLICSTART; IF x > 1 THEN MOVE LIN a; ENDIF; MOVE LIN b; CYCLICEND;": 0,
    "MOVE LIN a; CYCLICSTART; FREEZESTART 1; MOVE LIN b; FREEZEEND; CYCLICEND;": 1,
    "MOVE LIN a; R_BASE := p; CYCLICSTART; MOVE LIN b; CYCLICEND;": 0,
    "MOVE LIN a; CYCLICSTART; MOVE_INC LIN (1, 0, 0); CYCLICEND;": 0,
    "MOVE PTP (1, 2, 3, 4); CYCLICSTART; MOVE LIN b; CYCLICEND;": 0,
}


@pytest.mark.req("LANG-61")
@pytest.mark.req("LANG-73")
@pytest.mark.parametrize("body", CYCLES)
def test_paths_that_do_not_come_back(told_of, body):
    names = """VAR POSITION: a := (1, 0, 0), b := (2, 0, 0), same := (1., 0, 0), later;
    POSE: p := ((1, 0, 0), ORIZYX(0, 90, 0)); REAL: x := 1;"""
    found = [one for one in lints(told_of, names, body) if one[0] == "IRL311"]
    assert found == [("IRL311", "CYCLICSTART")] * CYCLES[body]


def test_without_being_asked_for_there_are_none(told_of):
    assert told_of("PROGRAM t; VAR INT: n; BEGIN HALT; WHILE TRUE DO ENDWHILE; ENDPROGRAM") == []


def test_an_incomplete_text_has_none(told_of):
    found = told_of("PROGRAM t; VAR INT: n; BEGIN HALT; n := ; HALT; ENDPROGRAM", lints=True)
    assert [code for code, _, _ in found] == ["IRL101"]
