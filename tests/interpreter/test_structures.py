"""Records, arrays, aggregates, constants, and values that are not there yet."""

import pytest


def number(lines, declarations, statements, expression):
    """Value of an expression after statements, read from the X of a MOVE target."""
    body = f"{statements} MOVE LIN POSITION({expression}, 0, 0);"
    (line,) = lines(declarations, body)
    return float(line.split("(")[1].split()[0])


@pytest.mark.req("LANG-24")
@pytest.mark.parametrize(
    ("declarations", "expression", "expected"),
    [
        ("VAR POSITION: p := (1, 2, 3);", "p.Y", 2),
        ("VAR POSITION: p := (1., 2, 3);", "p.x", 1),
        ("VAR POSITION: p := ((1, 2, 3));", "p.z", 3),
        ("VAR POSE: p := ((1, 2, 3), (1, 0, 0, 0));", "p.POS.Z", 3),
        ("VAR POSE: p := ((1, 2, 3), ORIZYX(90, 0, 0));", "p.ori.q1 * p.ori.q1", 0.5),
        ("VAR POSITION: a := (1, 2, 3); POSE: p := (a, ORIXYZ(0, 0, 0));", "p.pos.y", 2),
        ("TYPE RECORD REAL: a; ENDRECORD = one; VAR one: v := (3);", "v.a", 3),
        ("TYPE RECORD INT: n; POSITION: p; ENDRECORD = two; VAR two: v := (4, (1, 2, 3));", "v.n + v.p.y", 6),
        ("VAR ARRAY [1..1] OF REAL: v := (3);", "v[1]", 3),
        ("VAR ARRAY [1..3] OF INT: v := (4, 5, 6);", "v[2]", 5),
        ("VAR ARRAY [-1..1] OF INT: v := (4, 5, 6);", "v[-1] * 10 + v[1]", 46),
        ("VAR ARRAY [0..1, 1..3] OF INT: v := (1, 2, 3, 4, 5, 6);", "v[1, 2] * 10 + v[0, 3]", 53),
        ("VAR ARRAY [1..2] OF ARRAY [1..2] OF INT: v := ((1, 2), (3, 4));", "v[2][1]", 3),
        ("VAR ARRAY [1..2] OF POSITION: v := ((1, 2, 3), (4, 5, 6));", "v[2].y", 5),
    ],
)
def test_aggregates(lines, declarations, expression, expected):
    assert number(lines, declarations, "", expression) == pytest.approx(expected)


@pytest.mark.req("LANG-24")
@pytest.mark.parametrize(
    ("declarations", "expected"),
    [
        (
            "VAR POSITION: p := (1, 2);",
            ("IRL223", "POSITION takes 3 values, found 2", "(1, 2)"),
        ),
        (
            "VAR POSITION: p := (1, 2, 3, 4);",
            ("IRL223", "POSITION takes 3 values, found 4", "(1, 2, 3, 4)"),
        ),
        (
            "VAR POSE: p := ((1, 2, 3, 4), (1, 0, 0, 0));",
            ("IRL223", "POSITION takes 3 values, found 4", "(1, 2, 3, 4)"),
        ),
        (
            "VAR ARRAY [1..3] OF INT: v := (1, 2);",
            ("IRL223", "ARRAY [1..3] OF INT takes 3 values, found 2", "(1, 2)"),
        ),
        ("VAR ARRAY [1..2] OF INT: v := (1, 2.5);", ("IRL222", "expected INT, found REAL", "2.5")),
        ("VAR REAL: x := (1, 2);", ("IRL222", "expected REAL, found 2 values", "(1, 2)")),
        ("VAR POSITION: p := 3;", ("IRL222", "expected POSITION, found INT", "3")),
        (
            "VAR POSITION: p := ORIXYZ(0, 0, 0);",
            ("IRL222", "expected POSITION, found ORIENTATION", "ORIXYZ(0, 0, 0)"),
        ),
        ("VAR INT: i := 5.0;", ("IRL222", "expected INT, found REAL", "5.0")),
        ("VAR INT: i := 4 / 2;", ("IRL222", "expected INT, found REAL", "4 / 2")),
        ("VAR BOOL: b := 1;", ("IRL222", "expected BOOL, found INT", "1")),
        ("VAR REAL: x := TRUE;", ("IRL222", "expected REAL, found BOOL", "TRUE")),
        ("VAR STRING: s := 1;", ("IRL222", "expected STRING, found INT", "1")),
        (
            "VAR POSE: p := ((1, 2, 3), (0, 0, 0, 2));",
            ("IRL230", "an orientation needs a quaternion of length 1, found length 2", "(0, 0, 0, 2)"),
        ),
    ],
)
def test_aggregates_that_do_not_fit(run_error, declarations, expected):
    assert run_error(declarations, "") == expected


@pytest.mark.req("LANG-21")
@pytest.mark.parametrize(
    ("statements", "expression", "expected"),
    [
        ("a := b; a.x := 9;", "b.x", 1),
        ("a := b; b.x := 9;", "a.x", 1),
        ("p.pos := b; b.x := 9;", "p.pos.x", 1),
        ("p.pos := b; p.pos.x := 9;", "b.x", 1),
        ("r[1] := b; r[2] := r[1]; r[2].x := 9;", "r[1].x", 1),
        ("s := r0; s[1] := 9;", "r0[1]", 4),
        ("r[2] := (7, 8, 9); b := r[2]; b.y := 0;", "r[2].y", 8),
        ("b.X := 5; B.x := b.x + 1;", "b.x", 6),
    ],
)
def test_assignment_copies(lines, statements, expression, expected):
    declarations = """VAR POSITION: a, b := (1, 2, 3); POSE: p; ARRAY [1..2] OF POSITION: r;
    ARRAY [1..2] OF INT: r0 := (4, 5), s;"""
    assert number(lines, declarations, statements, expression) == expected


DOTTED = """TYPE RECORD REAL: a1.max, a2.max; ENDRECORD = upper;
RECORD REAL: max; ENDRECORD = inner; RECORD inner: a1; REAL: a1.s.max; ENDRECORD = mixed;
VAR upper: u := (1, 2); mixed: m := ((3), 4); """


@pytest.mark.req("LANG-06")
@pytest.mark.parametrize(
    ("statements", "expression", "expected"),
    [
        ("", "u.a1.max", 1),
        ("", "U.A2.MAX", 2),
        ("u.a2.max := 7;", "u.a2.max * 10 + u.a1.max", 71),
        ("", "m.a1.max", 3),
        ("", "m.a1.s.max", 4),
        ("m.a1.max := 5;", "m.a1.max * 10 + m.a1.s.max", 54),
    ],
)
def test_dotted_fields_longest_first(lines, statements, expression, expected):
    assert number(lines, DOTTED, statements, expression) == expected


@pytest.mark.req("LANG-06")
def test_a_record_whose_dotted_fields_are_ambiguous(run_error):
    declarations = """TYPE RECORD REAL: max; ENDRECORD = inner;
    RECORD inner: a1; REAL: a1.max; ENDRECORD = both; VAR both: v;"""
    code, message, text = run_error(declarations, "")
    assert (code, text) == ("IRL226", "a1.max")
    assert message == "'a1.max' could mean the field a1.max, or max of the field a1"


@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        (
            "x := u.a3.max;",
            ("IRL225", "upper has no field 'a3.max'; did you mean 'a2.max' or 'a1.max'?", ".a3"),
        ),
        ("x := u.zz;", ("IRL225", "upper has no field 'zz'", ".zz")),
        ("x.y := 1;", ("IRL225", "REAL has no field 'y'", ".y")),
        ("x[1] := 1;", ("IRL222", "expected an ARRAY before [, found REAL", "[1]")),
    ],
)
def test_parts_that_are_not_there(run_error, statement, expected):
    code, message, text = run_error(DOTTED + "REAL: x;", statement)
    assert (code, text) == (expected[0], expected[2])
    assert message.split(";")[0] == expected[1].split(";")[0]
    assert ("did you mean" in message) is ("did you mean" in expected[1])


@pytest.mark.req("LANG-21")
@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("v[i] := 1;", ("IRL504", "index 4 of 'v' is outside 1..3", "i")),
        ("x := v[0];", ("IRL504", "index 0 of 'v' is outside 1..3", "0")),
        ("w[2, -3] := 1;", ("IRL504", "index -3 of 'w' is outside -2..2", "-3")),
        ("w[4, 0] := 1;", ("IRL504", "index 4 of 'w' is outside 1..3", "4")),
        ("v[1.5] := 1;", ("IRL222", "expected INT, found REAL", "1.5")),
        ("v[TRUE] := 1;", ("IRL222", "expected INT, found BOOL", "TRUE")),
        ("v[1, 2] := 1;", ("IRL223", "ARRAY [1..3] OF REAL takes 1 index, found 2", "[1, 2]")),
    ],
)
def test_indices(run_error, statement, expected):
    declarations = """VAR ARRAY [1..3] OF REAL: v; ARRAY [1..3, -2..2] OF REAL: w; INT: i := 4; REAL: x;"""
    assert run_error(declarations, statement) == expected


def test_an_array_that_is_too_large(run_error):
    code, message, text = run_error("VAR ARRAY [1..5000, 1..5000] OF REAL: v;", "")
    assert code == "IRL507"
    assert message == "an array of 25000000 elements is too large; at most 10000000 are kept"
    assert text == "ARRAY [1..5000, 1..5000] OF REAL"


def test_an_array_without_elements(run_error):
    code, message, text = run_error("VAR ARRAY [3..1] OF REAL: v;", "")
    assert (code, text) == ("IRL508", "3..1")
    assert message == "the range 3..1 is empty"


@pytest.mark.parametrize(
    ("declarations", "statement", "expected"),
    [
        ("VAR REAL: x, y;", "x := y;", ("IRL501", "'y' has no value yet", "y")),
        ("VAR POSITION: p; REAL: x;", "p.x := 1; x := p.y;", ("IRL501", "'p.y' has no value yet", "p.y")),
        ("VAR POSITION: p;", "p.x := 1; MOVE LIN p;", ("IRL501", "'p.Y' has no value yet", "p")),
        ("VAR POSITION: p;", "MOVE LIN p;", ("IRL501", "'p' has no value yet", "p")),
        (
            "VAR ARRAY [1..2, 0..1] OF POSE: v, w;",
            "v[1, 0].pos.x := 1; w := v;",
            ("IRL501", "'v[1, 0].POS.Y' has no value yet", "v"),
        ),
        (
            "VAR JOINT: c, d;",
            "c.m_joint.a1 := 1; d := c;",
            ("IRL501", "'c.M_JOINT.A2' has no value yet", "c"),
        ),
        (
            "VAR ARRAY [1..2] OF REAL: v; REAL: x;",
            "v[1] := 1; x := v[2];",
            ("IRL501", "'v[2]' has no value yet", "v[2]"),
        ),
        ("CONST REAL: c;", "MOVE LIN POSITION(c, 0, 0);", ("IRL501", "'c' has no value yet", "c")),
    ],
)
def test_values_that_are_not_there_yet(run_error, declarations, statement, expected):
    assert run_error(declarations, statement) == expected


CONSTANTS = "CONST REAL: Full := 2 * 3; POSITION: Corner := (Full, 0, 0);"


def test_constants(lines):
    assert number(lines, CONSTANTS, "", "full + corner.x") == 12


@pytest.mark.parametrize(
    ("statement", "name", "marked"),
    [("full := 2;", "Full", "full"), ("corner.x := 2;", "Corner", "corner.x")],
)
def test_constants_cannot_be_set(run_error, statement, name, marked):
    assert run_error(CONSTANTS, statement) == ("IRL211", f"'{name}' is a constant and cannot be set", marked)


def test_the_posture_of_the_robot_cannot_be_set(run_error):
    code, message, _ = run_error("", "R_JOINT_ACT.M_JOINT.A1 := 3;")
    assert code == "IRL211"
    assert message.startswith("'R_JOINT_ACT' is ")


# Types and constants are declared before variables, those of a kind one after the other.
@pytest.mark.parametrize(
    ("declarations", "code", "marked"),
    [
        ("VAR REAL: x := y; REAL: y := 1;", "IRL201", "y"),
        ("TYPE mine = other; RECORD REAL: a; ENDRECORD = mine;", "IRL204", "mine"),
    ],
)
def test_names_used_before_their_declaration(run_error, declarations, code, marked):
    found, message, text = run_error(declarations, "")
    assert (found, text) == (code, marked)
    assert message.endswith(" further down")


def test_parenthesised_variable_of_a_one_field_type(lines):
    declarations = "TYPE RECORD REAL: a; ENDRECORD = one; VAR one: v, w := (4);"
    assert number(lines, declarations, "v := w;", "v.a") == 4


def test_parentheses_around_a_one_field_variable(lines):
    declarations = "TYPE RECORD REAL: a; ENDRECORD = one; VAR one: v, w := (4);"
    for form in ("(w)", "((w))", "(w.a)", "((w.a))", "(4)"):
        assert number(lines, declarations, f"v := {form};", "v.a") == 4, form
