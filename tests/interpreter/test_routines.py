"""Procedures and functions: parameters, scopes, recursion, and the order in which things happen."""

import pytest

pytestmark = [pytest.mark.req("LANG-10"), pytest.mark.req("LANG-11")]

ROUTINES = """
CONST INT: ten := 10;
TYPE RECORD INT: n; ARRAY [1..2] OF INT: list; ENDRECORD = pack;
VAR INT: i := 1, j := 2, calls := 0; REAL: x; ARRAY [1..3] OF INT: a := (1, 2, 3), b;
    pack: p := (5, (6, 7)), q; POSITION: v := (1, 2, 3); BOOL: t; STRING: s := '';
PROCEDURE set(VAR INT: target; INT: value); BEGIN target := value; ENDPROC;
PROCEDURE swap(VAR INT: m, n); VAR INT: kept := m; BEGIN m := n; n := kept; ENDPROC;
PROCEDURE change(IN ARRAY [1..3] OF INT: list; VAR INT: sum);
  BEGIN list[1] := 100; sum := list[1] + list[2]; ENDPROC;
PROCEDURE change_whole(VAR ARRAY [1..3] OF INT: list); BEGIN list[1] := 100; b := list; list[2] := 9; ENDPROC;
PROCEDURE twice(VAR INT: n); BEGIN set(n, 2 * n); ENDPROC;
PROCEDURE both(VAR INT: m, n); BEGIN m := 7; n := n + m; ENDPROC;
PROCEDURE early(VAR INT: n); BEGIN n := 1; IF n = 1 THEN RETURN; ENDIF; n := 2; ENDPROC;
PROCEDURE hide; CONST INT: ten := 20; VAR INT: i := ten; BEGIN j := i; ENDPROC;
PROCEDURE bare; BEGIN calls := calls + 1; ENDPROC;
FUNCTION counted(INT: n): INT; BEGIN calls := calls + 1; RETURN n; ENDFCT;
FUNCTION fresh: INT; VAR INT: n := 0; BEGIN n := n + 1; RETURN n; ENDFCT;
FUNCTION half(REAL: y): REAL; BEGIN RETURN y / 2; ENDFCT;
FUNCTION whole: REAL; BEGIN RETURN 3; ENDFCT;
FUNCTION yes(BOOL: told): BOOL; BEGIN calls := calls + 1; RETURN told; ENDFCT;
FUNCTION bump: INT; BEGIN i := i + 1; RETURN i; ENDFCT;
FUNCTION factorial(INT: n): INT; BEGIN
  IF n <= 1 THEN RETURN 1; ENDIF; RETURN n * factorial(n - 1); ENDFCT;
FUNCTION even(INT: n): BOOL; BEGIN IF n = 0 THEN RETURN TRUE; ENDIF; RETURN odd(n - 1); ENDFCT;
FUNCTION odd(INT: n): BOOL; BEGIN IF n = 0 THEN RETURN FALSE; ENDIF; RETURN even(n - 1); ENDFCT;
FUNCTION ackermann(INT: m, n): INT; BEGIN
  IF m = 0 THEN RETURN n + 1; ELSIF n = 0 THEN RETURN ackermann(m - 1, 1); ENDIF;
  RETURN ackermann(m - 1, ackermann(m, n - 1)); ENDFCT;
FUNCTION filled(INT: n): ARRAY [1..3] OF INT; VAR ARRAY [1..3] OF INT: r := (0, 0, 0); INT: k;
  BEGIN FOR k := 1 TO 3 DO r[k] := n; ENDFOR; RETURN r; ENDFCT;
FUNCTION above(POSITION: at; REAL: h): POSITION; BEGIN at.z := at.z + h; RETURN at; ENDFCT;
FUNCTION lost(INT: n): INT; BEGIN IF n > 0 THEN RETURN 1; ENDIF; ENDFCT;
"""

RUNS = [
    ("set(i, 5);", {"i": 5}),
    ("set(a[2], 5);", {"a": (1, 5, 3)}),
    ("set(a[j], 5);", {"a": (1, 5, 3)}),
    ("set(p.n, 9); set(p.list[2], 8);", {"p": (9, (6, 8))}),
    ("swap(i, j);", {"i": 2, "j": 1}),
    ("swap(a[1], a[3]);", {"a": (3, 2, 1)}),
    ("change(a, i);", {"a": (1, 2, 3), "i": 102}),
    ("change_whole(a);", {"a": (100, 9, 3), "b": (100, 2, 3)}),
    ("twice(j);", {"j": 4}),
    ("twice(a[3]);", {"a": (1, 2, 6)}),
    ("both(i, i);", {"i": 14}),
    ("early(i);", {"i": 1}),
    ("hide;", {"i": 1, "j": 20}),
    ("bare; bare();", {"calls": 2}),
    ("i := fresh + fresh();", {"i": 2}),
    ("x := half(3);", {"x": 1.5}),
    ("x := whole;", {"x": 3.0}),
    ("i := counted(2) + counted(3) * counted(4);", {"i": 14, "calls": 3}),
    ("i := factorial(20);", {"i": 2432902008176640000}),
    ("t := even(41);", {"t": False}),
    ("i := ackermann(2, 3);", {"i": 9}),
    ("a := filled(4); b := a; a[1] := 0;", {"a": (0, 4, 4), "b": (4, 4, 4)}),
    ("v := above(v, 10) + above((1, 1, 1), 1);", {"v": (2.0, 3.0, 15.0)}),
    # All in the order of the text, and nothing twice.
    ("j := i + bump;", {"j": 3, "i": 2}),
    ("j := bump + i;", {"j": 4}),
    ("j := (i * 10 + bump) * 10 + bump;", {"j": 123}),
    ("a[i] := bump;", {"a": (2, 2, 3)}),
    ("a[bump] := bump;", {"a": (1, 3, 3)}),
    ("set(a[i], bump);", {"a": (2, 2, 3)}),
    ("i := a[bump] + a[bump];", {"i": 5}),
    ("i := ATAN2(bump - 2, 1) = 0 OR TRUE;".replace("i :=", "t :="), {"t": True}),
    ("v := (bump, i, bump);", {"v": (2.0, 2.0, 3.0)}),
    ("t := yes(FALSE) AND yes(TRUE);", {"t": False, "calls": 1}),
    ("t := yes(TRUE) OR yes(TRUE);", {"t": True, "calls": 1}),
    ("t := yes(TRUE) AND yes(FALSE) OR yes(TRUE);", {"t": True, "calls": 3}),
    ("t := i = 2 AND bump = 2;", {"t": False, "i": 1}),
    ("t := bump = 3 EXOR i = 2;", {"t": True}),
    ("WHILE bump < 5 DO calls := calls + 1; ENDWHILE;", {"i": 5, "calls": 3}),
    ("REPEAT calls := calls + 1; UNTIL bump = 4;", {"i": 4, "calls": 3}),
    ("FOR j := bump TO bump STEP bump DO calls := calls + 1; ENDFOR;", {"i": 4, "calls": 1}),
    ("IF bump = 3 THEN j := 0; ELSIF bump = 3 THEN j := 5; ENDIF;", {"i": 3, "j": 5}),
    ("CASE bump OF WHEN 2: j := 8; ENDCASE;", {"j": 8}),
    ("counted(3);", {"calls": 1}),
    ("q := p; q.list[1] := 0; p.n := 1;", {"p": (1, (6, 7)), "q": (5, (0, 7))}),
]


@pytest.mark.parametrize(("body", "expected"), RUNS)
def test_what_calls_do(final, body, expected):
    found = final(ROUTINES, body)
    assert {name: found[name] for name in expected} == expected


WRONG = [
    ("set(i);", ("IRL228", "set takes 2 values, found 1", "set(i)")),
    ("bare(1);", ("IRL228", "bare takes 0 values, found 1", "bare(1)")),
    ("i := fresh(1);", ("IRL228", "fresh takes 0 values, found 1", "fresh(1)")),
    (
        "set(3, 4);",
        ("IRL249", "the VAR parameter 'target' of set needs a variable, found a number", "3"),
    ),
    ("set(ten, 4);", ("IRL211", "'ten' is a constant and cannot be set", "ten")),
    ("set(x, 4);", ("IRL222", "expected INT, found REAL", "x")),
    ("set(i, 1.5);", ("IRL222", "expected INT, found REAL", "1.5")),
    ("set(a[4], 1);", ("IRL504", "index 4 of 'a' is outside 1..3", "4")),
    ("i := bare;", ("IRL222", "expected a value, found the procedure bare", "bare")),
    ("i := bare();", ("IRL222", "expected a value, found the procedure bare", "bare()")),
    ("bare := 1;", ("IRL222", "expected a variable, found the procedure bare", "bare")),
    ("i;", ("IRL222", "expected a procedure, found the variable i", "i")),
    ("i := half(1);", ("IRL222", "expected INT, found REAL", "half(1)")),
    ("i := lost(0);", ("IRL514", "RETURN must end the function with a value", "lost")),
    ("i := counted(1 DIV 0);", ("IRL502", "division by zero", "1 DIV 0")),
]


@pytest.mark.parametrize(("body", "expected"), WRONG)
def test_wrong_calls(run_error, body, expected):
    assert run_error(ROUTINES, body) == expected


BODIES = [
    (
        "FUNCTION f: INT; BEGIN RETURN; ENDFCT; VAR INT: i;",
        "i := f;",
        "RETURN needs the value of the function",
    ),
    ("PROCEDURE f; BEGIN RETURN 1; ENDPROC;", "f;", "RETURN has no value outside of a function"),
]


@pytest.mark.parametrize(("declarations", "body", "message"), BODIES)
def test_return_fits_its_routine(run_error, declarations, body, message):
    assert run_error(declarations, body)[:2] == ("IRL514", message)


def test_local_types_and_bounds(final):
    declarations = """CONST INT: n := 2; VAR INT: sum := 0;
    PROCEDURE f; CONST INT: m := n + 1; TYPE ARRAY [1..m] OF INT = line; VAR line: l := (1, 2, 3); INT: k;
    BEGIN FOR k := 1 TO m DO sum := sum + l[k]; ENDFOR; ENDPROC;"""
    assert final(declarations, "f;")["sum"] == 6


def test_bounds_are_the_same_in_every_call(run_error):
    declarations = "PROCEDURE f(INT: n); VAR ARRAY [1..n] OF INT: l; BEGIN ENDPROC;"
    what = "a bound or constant that is not the same in every call"
    message = f"this version of irlx reads {what} but does not execute it yet"
    assert run_error(declarations, "f(3);") == ("IRL590", message, "n")


def test_locals_begin_anew_in_every_call(run_error):
    declarations = """VAR INT: i; FUNCTION f(BOOL: first): INT; VAR INT: n;
    BEGIN IF first THEN n := 1; ENDIF; RETURN n; ENDFCT;"""
    assert run_error(declarations, "i := f(TRUE); i := f(FALSE);") == ("IRL501", "'n' has no value yet", "n")


def test_initial_values_may_call_and_ask(final):
    declarations = """FUNCTION f(INT: n): INT; BEGIN RETURN n + k; ENDFCT;
    VAR INT: k := 2, l := f(k), m := l * 2; JOINT: j := R_JOINT_ACT;"""
    found = final(declarations, "", posture=(0.0, 0.0), joints=2)
    assert (found["l"], found["m"], found["j"]) == (4, 8, ((0.0, 0.0), ()))


def test_a_name_of_the_program_hides_a_built_in(final):
    assert (
        final("FUNCTION SQRT(REAL: x): REAL; BEGIN RETURN -x; ENDFCT; VAR REAL: y;", "y := SQRT(4);")["y"]
        == -4.0
    )
