"""Types of expressions at check time: what may stand where, row by row, and what is said where it may not."""

import pytest

INT_MAX = 2**63 - 1
DECLARATIONS = """TYPE RECORD REAL: a; ENDRECORD = one; RECORD INT: n; POSITION: p; ENDRECORD = two;
ARRAY [1..3] OF REAL = triple; RECORD REAL: a1.max, a2.max; ENDRECORD = dotted;
CONST INT: four := 4, zero := 0; REAL: half := 0.5; BOOL: yes := TRUE;
VAR INT: i, j; REAL: x, y; BOOL: b, c; STRING: s, t; CHAR: k, l; FILE: f;
POSITION: v, w; ORIENTATION: o; POSE: p, q; MAIN_JOINT: m; JOINT: jt; ROBTARGET: rt;
one: e1; two: e2; dotted: d; triple: tr; ARRAY [1..3, -2..2] OF INT: g; ARRAY [1..2] OF POSE: rack;
FUNCTION twice(REAL: r): REAL; BEGIN RETURN r * 2; ENDFCT; FUNCTION six: INT; BEGIN RETURN 6; ENDFCT;
PROCEDURE go(REAL: r); BEGIN ENDPROC;
"""


def program(statement, declarations=DECLARATIONS):
    return f"PROGRAM t;\n{declarations}BEGIN\n{statement}\nENDPROGRAM"


GOOD = [
    # literals and INT -> REAL
    "i := 3;",
    "x := 3;",
    "x := 3.5;",
    "i := -9223372036854775808;",
    "b := TRUE;",
    "s := 'text';",
    "k := 'a';",
    "x := i;",
    "x := -i;",
    "x := +half;",
    # arithmetic
    "i := 7 DIV 2 * j MOD 3;",
    "x := 7 / 2;",
    "x := i + x - 1 * 2.5;",
    "i := i + j - 3 * 4;",
    "i := four + zero;",
    # comparisons and logic
    "b := 1 < 2.5;",
    "b := i = j;",
    "b := x >= i;",
    "b := s = t;",
    "b := s <> 'abc';",
    "b := k = 'a';",
    "b := (b = c) AND NOT c;",
    "b := b EXOR (c OR yes);",
    "b := i > 3 AND x < 2 OR NOT b;",
    # geometry
    "v := v + w - POSITION(1, 2, 3);",
    "v := v * 2;",
    "v := 2.5 * v / 3;",
    "p := p + v;",
    "p := p - POSITION(0, 0, 10);",
    "p := p @ q;",
    "v := p @ v;",
    "o := o @ o;",
    "v := o * v;",
    # aggregates
    "v := (1, 2., 3);",
    "p := ((1, 2, 3), (1, 0, 0, 0));",
    "p := (v, o);",
    "p := ((x, i, 3), ORIZYX(0, 180, 0));",
    "e1 := (3);",
    "e1 := (e1);",
    "e1 := ((e1));",
    "e2 := (4, (1, 2, 3));",
    "tr := (1, x, 3);",
    "d := (1, 2);",
    "rack := (p, ((1, 2, 3), o));",
    "g := (1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);",
    "m := (1, 2, 3, 4, 5, 6, 7);",
    "m := (1, 2, 3);",
    "x := (3);",
    "v := (v);",
    # parts
    "x := p.pos.x + p.ORI.q4;",
    "x := d.a1.max;",
    "x := m.a7 + m.A12;",
    "x := jt.m_joint.a1;",
    "p := rt.pse;",
    "i := rt.status;",
    "i := g[four - 1, -2];",
    "x := rack[i].pos.y;",
    "tr[3] := 1;",
    # functions
    "x := SIN(30) + ATAN2(1, 2) + SQRT(i);",
    "i := ABS(-3);",
    "x := ABS(-3.5);",
    "i := ROUND(2.5) + TRUNC(x) + LEN(s) + ORD(k);",
    "k := CHR(65);",
    "x := FLOAT(i);",
    "p := INV(p);",
    "o := INV(o);",
    "p := INV((v, o));",
    "v := CROSS(v, (1, 0, 0));",
    "x := DOT(v, w) + NORM((3, 4, 12));",
    "x := DISTANCE(p, v);",
    "o := ORIVANG((0, 0, 1), 90);",
    "o := ORIMAT(v, w, VECTORA(o));",
    "x := ROTANGLE(o) + QUATA(o) + ANGLEX('XYZ', o);",
    "o := ORIRS(v, w, (1, 2, 3));",
    # texts and characters
    "s := s + t; s := s + 'x' + k; s := k + l; s := 'a' + 'b';",
    "k := s[2]; k := s[i + 1]; s := s[1]; b := s[1] = 'a';",
    "s := k;",
    "b := k < l; b := k >= 'a'; b := ('z') > s[i];",
    "v := ROTAXIS(o);",
    "p := FK(m);",
    "p := FK(jt);",
    "m := IK(p, m);",
    "m := POSTURE(v);",
    "x := MANIPULABILITY(R_JOINT_ACT);",
    "x := twice(3) + six + six();",
    "e1 := one(3);",
    "tr := triple(1, 2, 3);",
    "p := POSE(POSITION(1, 2, 3), ORIQUAT(1, 0, 0, 0));",
    "rt := ROBTARGET(p);",
    # values in parts that are not evaluated
    "b := FALSE AND 1 DIV 0 = 1;",
    "b := TRUE OR 1 DIV zero = 1;",
]


@pytest.mark.req("LANG-20")
@pytest.mark.req("LANG-24")
@pytest.mark.req("LANG-30")
@pytest.mark.req("LANG-31")
@pytest.mark.req("LANG-32")
@pytest.mark.req("LANG-33")
@pytest.mark.req("LANG-34")
@pytest.mark.parametrize("statement", GOOD)
def test_well_typed(told_of, statement):
    assert told_of(program(statement)) == []


BAD = {
    # another type than expected
    "i := 2.5;": ("IRL222", "expected INT, found REAL", "2.5"),
    "i := 7 / 2;": ("IRL222", "expected INT, found REAL", "7 / 2"),
    "i := x;": ("IRL222", "expected INT, found REAL", "x"),
    "x := TRUE;": ("IRL222", "expected REAL, found BOOL", "TRUE"),
    "x := 'a';": ("IRL222", "expected REAL, found STRING", "'a'"),
    "b := 1;": ("IRL222", "expected BOOL, found INT", "1"),
    "s := 1;": ("IRL222", "expected STRING, found INT", "1"),
    "k := s;": ("IRL222", "expected CHAR, found STRING", "s"),
    "k := 'ab';": ("IRL222", "expected CHAR, found STRING", "'ab'"),
    "k := s + t;": ("IRL222", "expected CHAR, found STRING", "s + t"),
    "k := s[1.5];": ("IRL222", "expected INT, found REAL", "1.5"),
    "k := s[1, 2];": ("IRL223", "STRING takes 1 index, found 2", "[1, 2]"),
    "k := s[1][1];": ("IRL222", "expected an ARRAY before [, found STRING", "[1]"),
    "s[1] := 'a';": ("IRL222", "expected a variable, found a character of a text", "s[1]"),
    "x := ANGLEX(1, o);": ("IRL222", "expected STRING, found INT", "1"),
    "o := ORIRS(v, w);": ("IRL228", "ORIRS takes 3 values, found 2", "ORIRS(v, w)"),
    "v := o;": ("IRL222", "expected POSITION, found ORIENTATION", "o"),
    "p := v;": ("IRL222", "expected POSE, found POSITION", "v"),
    "m := jt;": ("IRL222", "expected MAIN_JOINT, found JOINT", "jt"),
    "e2 := e1;": ("IRL222", "expected two, found one", "e1"),
    "tr := rack;": ("IRL222", "expected ARRAY [1..3] OF REAL, found ARRAY [1..2] OF POSE", "rack"),
    "x := (1, 2);": ("IRL222", "expected REAL, found 2 values", "(1, 2)"),
    "x := (TRUE);": ("IRL222", "expected REAL, found BOOL", "TRUE"),
    # aggregates
    "v := (1, 2);": ("IRL223", "POSITION takes 3 values, found 2", "(1, 2)"),
    "v := (1, 2, 3, 4);": ("IRL223", "POSITION takes 3 values, found 4", "(1, 2, 3, 4)"),
    "p := (1, 2, 3, 4);": ("IRL223", "POSE takes 2 values, found 4", "(1, 2, 3, 4)"),
    "p := ((1, 2), o);": ("IRL223", "POSITION takes 3 values, found 2", "(1, 2)"),
    "tr := (1, 2);": ("IRL223", "ARRAY [1..3] OF REAL takes 3 values, found 2", "(1, 2)"),
    "v := (1, TRUE, 3);": ("IRL222", "expected REAL, found BOOL", "TRUE"),
    "e2 := (1.5, v);": ("IRL222", "expected INT, found REAL", "1.5"),
    "m := (1, 2, 'a');": ("IRL222", "expected REAL, found STRING", "'a'"),
    "e1 := (v);": ("IRL222", "expected REAL, found POSITION", "v"),
    "o := (1, 1, 0, 0);": (
        "IRL230",
        "an orientation needs a quaternion of length 1, found length 1.41421356",
        "(1, 1, 0, 0)",
    ),
    "o := ORIQUAT(2, 0, 0, 0);": (
        "IRL230",
        "an orientation needs a quaternion of length 1, found length 2",
        "ORIQUAT(2, 0, 0, 0)",
    ),
    # operators
    "x := TRUE + 1;": ("IRL227", "+ is not defined for BOOL and INT", "TRUE + 1"),
    "i := 7.0 DIV 2;": ("IRL227", "DIV is not defined for REAL and INT", "7.0 DIV 2"),
    "i := 7 MOD x;": ("IRL227", "MOD is not defined for INT and REAL", "7 MOD x"),
    "b := b < c;": ("IRL227", "< is not defined for BOOL and BOOL", "b < c"),
    "b := s < t;": ("IRL227", "< is not defined for STRING and STRING", "s < t"),
    "b := 1 = TRUE;": ("IRL227", "= is not defined for INT and BOOL", "1 = TRUE"),
    "b := p = q;": ("IRL227", "= is not defined for POSE and POSE", "p = q"),
    "b := 1 EXOR b;": ("IRL227", "EXOR is not defined for INT and BOOL", "1 EXOR b"),
    "s := s + i;": ("IRL227", "+ is not defined for STRING and INT", "s + i"),
    "s := s - t;": ("IRL227", "- is not defined for STRING and STRING", "s - t"),
    "b := 'a' < 'b';": ("IRL227", "< is not defined for STRING and STRING", "'a' < 'b'"),
    "b := k < s;": ("IRL227", "< is not defined for CHAR and STRING", "k < s"),
    "x := i @ j;": ("IRL227", "@ is not defined for INT and INT", "i @ j"),
    "p := v @ p;": ("IRL227", "@ is not defined for POSITION and POSE", "v @ p"),
    "p := p + p;": ("IRL227", "+ is not defined for POSE and POSE", "p + p"),
    "v := v * w;": ("IRL227", "* is not defined for POSITION and POSITION", "v * w"),
    "v := v * o;": ("IRL227", "* is not defined for POSITION and ORIENTATION", "v * o"),
    "v := 2 / v;": ("IRL227", "/ is not defined for INT and POSITION", "2 / v"),
    "b := NOT 1;": ("IRL227", "NOT is not defined for INT", "NOT 1"),
    "x := -b;": ("IRL227", "- is not defined for BOOL", "-b"),
    "v := -v;": ("IRL227", "- is not defined for POSITION", "-v"),
    "b := 1 AND b;": ("IRL222", "expected BOOL, found INT", "1"),
    "b := b AND 1;": ("IRL222", "expected BOOL, found INT", "1"),
    "b := b OR s;": ("IRL222", "expected BOOL, found STRING", "s"),
    # parts
    "x := p.height;": ("IRL225", "POSE has no field 'height'", ".height"),
    "x := p.pos.zz;": ("IRL225", "POSITION has no field 'zz'; did you mean 'Z'?", ".zz"),
    "x := i.x;": ("IRL225", "INT has no field 'x'", ".x"),
    "x := d.a3.max;": ("IRL225", "dotted has no field 'a3.max'; did you mean 'a2.max' or 'a1.max'?", ".a3"),
    "x := m.b1;": ("IRL225", "MAIN_JOINT has no field 'b1'", ".b1"),
    "x := i[1];": ("IRL222", "expected an ARRAY before [, found INT", "[1]"),
    "x := tr[1, 2];": ("IRL223", "ARRAY [1..3] OF REAL takes 1 index, found 2", "[1, 2]"),
    "x := tr[1.5];": ("IRL222", "expected INT, found REAL", "1.5"),
    "x := tr[b];": ("IRL222", "expected INT, found BOOL", "b"),
    "x := tr[4];": ("IRL504", "index 4 of 'tr' is outside 1..3", "4"),
    "tr[0] := 1;": ("IRL504", "index 0 of 'tr' is outside 1..3", "0"),
    "i := g[2, -3];": ("IRL504", "index -3 of 'g' is outside -2..2", "-3"),
    "i := g[four, 0];": ("IRL504", "index 4 of 'g' is outside 1..3", "four"),
    # functions
    "x := SIN();": ("IRL228", "SIN takes 1 value, found 0", "SIN()"),
    "x := ATAN2(1);": ("IRL228", "ATAN2 takes 2 values, found 1", "ATAN2(1)"),
    "v := POSITION(1, 2);": ("IRL228", "POSITION takes 3 values, found 2", "POSITION(1, 2)"),
    "m := POSTURE();": ("IRL228", "POSTURE takes 1 or 2 values, found 0", "POSTURE()"),
    "x := SIN(TRUE);": ("IRL222", "expected REAL, found BOOL", "TRUE"),
    "x := NORM(p);": ("IRL222", "expected POSITION, found POSE", "p"),
    "i := ABS(-3.5);": ("IRL222", "expected INT, found REAL", "ABS(-3.5)"),
    "x := ABS(b);": ("IRL222", "expected INT or REAL, found BOOL", "b"),
    "p := INV(v);": ("IRL222", "expected POSE or ORIENTATION, found POSITION", "v"),
    "x := ROTANGLE(p);": ("IRL222", "expected ORIENTATION, found POSE", "p"),
    "i := LEN(1);": ("IRL222", "expected STRING, found INT", "1"),
    "p := FK(v);": ("IRL222", "expected MAIN_JOINT or JOINT, found POSITION", "v"),
    "x := twice();": ("IRL228", "twice takes 1 value, found 0", "twice()"),
    "x := twice;": ("IRL228", "twice takes 1 value, found 0", "twice"),
    "x := twice(b);": ("IRL222", "expected REAL, found BOOL", "b"),
    "i := twice(1);": ("IRL222", "expected INT, found REAL", "twice(1)"),
    "x := go(1);": ("IRL250", "'go' is a procedure, not a function", "go"),
    "x := go;": ("IRL250", "'go' is a procedure, not a value", "go"),
    "e1 := one(TRUE);": ("IRL222", "expected REAL, found BOOL", "TRUE"),
    "tr := triple(1, 2);": ("IRL228", "triple takes 3 values, found 2", "triple(1, 2)"),
    # values that the text tells
    f"i := {INT_MAX + 1};": ("IRL503", f"the number {INT_MAX + 1} leaves the range of INT", f"{INT_MAX + 1}"),
    f"i := {INT_MAX} + 1;": ("IRL503", "the result leaves the range of INT", f"{INT_MAX} + 1"),
    f"i := -{INT_MAX} - 2;": ("IRL503", "the result leaves the range of INT", f"-{INT_MAX} - 2"),
    "x := 1E308 * 10;": ("IRL503", "the result leaves the range of REAL", "1E308 * 10"),
    "x := 1 / 0;": ("IRL502", "division by zero", "1 / 0"),
    "x := y / 0.0;": ("IRL502", "division by zero", "y / 0.0"),
    "i := i MOD zero;": ("IRL502", "division by zero", "i MOD zero"),
    "i := 5 DIV (2 - 2);": ("IRL502", "division by zero", "5 DIV (2 - 2)"),
    "v := v / 0;": ("IRL502", "division by zero", "v / 0"),
    "b := TRUE AND 1 DIV 0 = 1;": ("IRL502", "division by zero", "1 DIV 0"),
}


@pytest.mark.req("LANG-20")
@pytest.mark.req("LANG-21")
@pytest.mark.req("LANG-24")
@pytest.mark.req("LANG-30")
@pytest.mark.req("LANG-31")
@pytest.mark.req("LANG-34")
@pytest.mark.parametrize("statement", BAD)
def test_wrongly_typed(told_of, statement):
    assert told_of(program(statement)) == [BAD[statement]]


@pytest.mark.parametrize(
    "statement",
    [
        "x := nothing + TRUE;",
        "x := nothing.a[2].b;",
        "x := nothing(1, 2, TRUE);",
        "p := ((nothing, 1, 2), o);",
        "b := nothing AND nothing > 3;",
        "b := NOT nothing;",
        "x := -nothing;",
        "tr[nothing] := nothing;",
        "x := SIN(nothing) * nothing;",
        "v := nothing * v + nothing;",
        "nothing := (1, (2, TRUE));",
        "nothing[1] := 'a';",
    ],
)
def test_what_is_unknown_is_told_once(told_of, statement):
    ((code, message, marked),) = told_of(program(statement))
    assert code in ("IRL201", "IRL206")
    assert marked == "nothing"
    assert message.startswith("unknown ")


@pytest.mark.parametrize(
    "statement",
    ["x := (b + 1) * 2 + v;", "i := p.zz + 1;", "x := SIN(1, 2) + TRUE * 1;", "v := (go * 2) / 3;"],
)
def test_a_mistake_does_not_spread(told_of, statement):
    """Whatever surrounds a mistake is silent about it; a second mistake of its own may still be told."""
    assert len(told_of(program(statement))) == (2 if "TRUE" in statement else 1)


def test_values_of_which_no_target_is_made_are_looked_at_one_by_one(told_of):
    """Four values fit no kind of target; what is wrong inside of them is told all the same."""
    whole = "(1, (2, 3 + TRUE), 4, 5)"
    expected = "expected POSE or POSITION or MAIN_JOINT, found 4 values"
    wanted = {("IRL222", expected, whole), ("IRL227", "+ is not defined for INT and BOOL", "3 + TRUE")}
    found = told_of(program(f"MOVE LIN {whole};"))
    assert len(found) == 2
    assert set(found) == wanted


# ---- Pascal (LANG-30)

READINGS = {
    "b := b = c AND c = yes;": ("(b = c) AND (c = yes)", "(b = (c AND c)) = yes"),
    "b := b = TRUE AND c = TRUE;": ("(b = TRUE) AND (c = TRUE)", "(b = (TRUE AND c)) = TRUE"),
    "b := b AND c = yes;": ("b AND (c = yes)", "(b AND c) = yes"),
    "b := b OR c EXOR yes;": ("b OR (c EXOR yes)", "(b OR c) EXOR yes"),
    "b := b <> c OR yes;": ("(b <> c) OR yes", "b <> (c OR yes)"),
}


@pytest.mark.req("LANG-30")
@pytest.mark.parametrize("statement", READINGS)
def test_what_pascal_would_read_differently(told_of, statement):
    ours, pascals = READINGS[statement]
    message = f"this means {ours}; Pascal would read {pascals}"
    assert told_of(program(statement)) == [("IRL280", message, statement[5:-1])]


@pytest.mark.req("LANG-30")
@pytest.mark.parametrize(
    "statement",
    [
        "b := (b = c) AND (c = yes);",
        "b := i = 3 AND j = 4;",
        "b := b AND i > 3 OR c;",
        "b := b OR c AND yes;",
        "b := b AND c AND NOT yes;",
        "b := b EXOR c EXOR yes;",
        "b := b EXOR c AND yes;",
        "b := b = (c AND yes);",
        "b := b = c;",
        "b := nothing = TRUE AND c = TRUE;",
    ],
)
def test_what_pascal_would_read_alike_or_refuse(told_of, statement):
    assert [code for code, _, _ in told_of(program(statement))] in ([], ["IRL201"])
