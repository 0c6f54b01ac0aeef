"""Built-in functions on numbers, texts and positions, and constructors named like types."""

import pytest

INT_MAX = 2**63 - 1

VALUES = [
    ("CROSS((1, 0, 0), (0, 1, 0))", (0.0, 0.0, 1.0)),
    ("CROSS((1, 2, 3), (4, 5, 6))", (-3.0, 6.0, -3.0)),
    ("DOT((1, 2, 3), (4, 5, 6))", 32.0),
    ("DISTANCE(POSITION(1, 2, 3), POSITION(4, 6, 3))", 5.0),
    ("DISTANCE(((0, 0, 0), (1, 0, 0, 0)), POSITION(0, 0, 2))", 2.0),
    ("ROUND(2.5)", 3),
    ("ROUND(-2.5)", -3),
    ("ROUND(3.5)", 4),
    ("ROUND(0.49999999999999994)", 0),
    ("ROUND(-0.2)", 0),
    ("ROUND(7)", 7),
    ("TRUNC(2.9)", 2),
    ("TRUNC(-2.9)", -2),
    ("FLOAT(3)", 3.0),
    ("ORD('A')", 65),
    ("ORD(CHR(8364))", 8364),
    ("CHR(65)", "A"),
    ("LEN('')", 0),
    ("LEN('żółw')", 4),
    ("'ab' + 'cd'", "abcd"),
    ("'ab' + CHR(99)", "abc"),
    ("CHR(97) < CHR(98)", True),
    ("CHR(97) >= 'b'", False),
    ("'a' = CHR(97)", True),
    ("'ab' = 'a' + 'b'", True),
    ("ORIENTATION(0, 1, 0, 0)", (0.0, 1.0, 0.0, 0.0)),
    ("MAIN_JOINT(1, 2, 3, 4, 5, 6, 7)", (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0)),
    ("JOINT((1, 2, 3, 4, 5, 6, 7))", ((1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0), ())),
    ("JOINT((1, 2, 3, 4, 5, 6, 7), ADD_JOINT())", ((1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0), ())),
    ("ROBTARGET(((1, 2, 3), (1, 0, 0, 0)), 5)", (((1.0, 2.0, 3.0), (1.0, 0.0, 0.0, 0.0)), 5, (0,) * 7, ())),
]


def opened(value):
    return tuple(map(opened, value.values)) if hasattr(value, "values") else value


@pytest.mark.req("LANG-34")
@pytest.mark.parametrize(("expression", "expected"), VALUES)
def test_values(value, expression, expected):
    found = opened(value(expression))
    assert found == expected
    assert type(found) is type(expected)


WRONG = [
    ("ROUND(1E300)", "IRL503"),
    ("TRUNC(-1E19)", "IRL503"),
    ("ROUND(9223372036854775807.0)", "IRL503"),
    ("CHR(-1)", "IRL506"),
    ("CHR(1114112)", "IRL506"),
    ("CHR(55296)", "IRL506"),
    ("ORD('ab')", "IRL222"),
    ("ORD('')", "IRL222"),
    ("ORD(65)", "IRL222"),
    ("CHR('a')", "IRL222"),
    ("LEN(3)", "IRL222"),
    ("FLOAT('a')", "IRL222"),
    ("CROSS((1, 2), (3, 4, 5))", "IRL223"),
    ("MAIN_JOINT(1, 2)", "IRL223"),
    ("JOINT()", "IRL223"),
    ("ROBTARGET(((1, 2, 3), (1, 0, 0, 0)), 1.5)", "IRL222"),
    ("CHR(97) < 'ab'", "IRL227"),
    ("'a' + 1", "IRL227"),
    ("'a' - 'b'", "IRL227"),
]


@pytest.mark.req("LANG-34")
@pytest.mark.parametrize(("expression", "code"), WRONG)
def test_what_has_no_value(value_error, expression, code):
    assert value_error(expression)[0] == code


@pytest.mark.req("LANG-32")
def test_types_of_the_program_are_constructors(value):
    declarations = "TYPE RECORD INT: n; STRING: s; ENDRECORD = pack; ARRAY [1..2] OF pack = two;"
    assert opened(value("two(pack(1, 'a'), (2, 'b'))", declarations)) == ((1, "a"), (2, "b"))


TEXTS = [
    ("c := 'x';", "c", "x"),
    ("c := s[2];", "c", "b"),
    ("s := s[1] + s[3];", "s", "ac"),
    ("s := 'x';", "s", "x"),
    ("s := c;", "s", "q"),
    ("r.c := s[LEN(s)]; c := r.c;", "c", "c"),
    ("l[2] := l[1][1] + l[2];", "l", ("up", "udown")),
]


@pytest.mark.req("LANG-20")
@pytest.mark.parametrize(("body", "name", "expected"), TEXTS)
def test_characters_and_texts(final, body, name, expected):
    declarations = """TYPE RECORD CHAR: c; ENDRECORD = one; VAR CHAR: c := 'q'; CHARACTER: d;
    STRING: s := 'abc'; one: r; ARRAY [1..2] OF STRING: l := ('up', 'down');"""
    assert final(declarations, body)[name] == expected


WRONG_TEXTS = [
    ("c := s;", ("IRL222", "expected CHAR, found STRING", "s")),
    ("c := 'ab';", ("IRL222", "expected CHAR, found STRING", "'ab'")),
    ("c := '';", ("IRL222", "expected CHAR, found STRING", "''")),
    ("c := s[0];", ("IRL504", "index 0 of 's' is outside 1..3", "0")),
    ("c := s[4];", ("IRL504", "index 4 of 's' is outside 1..3", "4")),
    ("s[1] := 'x';", ("IRL222", "expected a variable, found a character of a text", "s[1]")),
    ("c := e[1];", ("IRL504", "index 1 of 'e' is outside 1..0", "1")),
    ("c := d;", ("IRL501", "'d' has no value yet", "d")),
]


@pytest.mark.req("LANG-20")
@pytest.mark.parametrize(("body", "expected"), WRONG_TEXTS)
def test_wrong_characters(run_error, body, expected):
    assert run_error("VAR CHAR: c, d; STRING: s := 'abc', e := '';", body) == expected


@pytest.mark.req("LANG-21")
@pytest.mark.req("LANG-20")
def test_arrays_of_several_dimensions(final):
    declarations = "VAR ARRAY [0..2, -1..1] OF INT: m; INT: i, j; ARRAY [0..2, -1..1] OF INT: kept;"
    body = """FOR i := 0 TO 2 DO FOR j := -1 TO 1 DO m[i, j] := 10 * i + j; ENDFOR; ENDFOR;
    kept := m; m[1, 0] := 99;"""
    found = final(declarations, body)
    assert found["m"] == (-1, 0, 1, 9, 99, 11, 19, 20, 21)
    assert found["kept"] == (-1, 0, 1, 9, 10, 11, 19, 20, 21)


SHARING = [
    ("b := a; b[1][1] := 9;", {"a": ((1, 2), (3, 4)), "b": ((9, 2), (3, 4))}),
    ("b := a; a[2] := a[1]; a[1][2] := 9;", {"a": ((1, 9), (1, 2)), "b": ((1, 2), (3, 4))}),
    ("a[2] := a[1]; a[2][1] := 7; a[1][1] := 8;", {"a": ((8, 2), (7, 2))}),
    ("r.l := a[1]; r.l[1] := 9; s := r; s.l[2] := 8; r.l[1] := 7;", {"r": ((7, 2),), "s": ((9, 8),)}),
    ("r.l := a[1]; q[1] := r; q[2] := r; q[1].l[1] := 5;", {"q": (((5, 2),), ((1, 2),)), "r": ((1, 2),)}),
    ("b[1] := (5, 6); b[2] := b[1]; b[1][1] := 0;", {"b": ((0, 6), (5, 6))}),
]


@pytest.mark.req("LANG-21")
@pytest.mark.parametrize(("body", "expected"), SHARING)
def test_assignment_copies_arrays_in_arrays_and_records(final, body, expected):
    declarations = """TYPE RECORD ARRAY [1..2] OF INT: l; ENDRECORD = rec;
    ARRAY [1..2] OF ARRAY [1..2] OF INT = two;
    VAR two: a := ((1, 2), (3, 4)), b; rec: r, s; ARRAY [1..2] OF rec: q;"""
    found = final(declarations, body)
    assert {name: found[name] for name in expected} == expected


@pytest.mark.req("LANG-50")
@pytest.mark.req("LANG-22")
def test_a_robtarget_is_moved_to_by_its_pose(lines):
    declarations = "VAR ROBTARGET: t := (((1, 2, 3), (1, 0, 0, 0)), 1, (0, 1, -1), ADD_JOINT());"
    body = "t.pse.pos.x := 5; t.turns[2] := 3; MOVE LIN t; MOVE CIRCLE t, t;"
    straight, arc = lines(declarations, body, joints=3)
    assert straight.startswith("1 MOVE LIN to (5 2 3) (0 0 0 1) in R_BASE")
    assert arc.startswith("2 MOVE CIRCLE via (5 2 3) (0 0 0 1) in R_BASE to (5 2 3)")
