"""Types of declarations at check time: definitions, arrays, records, constants, data lists, signals."""

import pytest

from irlx.language.source import source_text

ROWS = {
    # values where they are declared
    "VAR INT: i := 3, j := i;": [],
    "VAR REAL: x := 3;": [],
    "VAR INT: i := 3.5;": [("IRL222", "expected INT, found REAL", "3.5")],
    "VAR POSE: p := ((1, 2, 3), ORIXYZ(0, 0, 0));": [],
    "VAR SEMAPHORE: s := 1; FILE: f; CHAR: c := 'c';": [],
    "VAR CHAR: c := 'cc';": [("IRL222", "expected CHAR, found STRING", "'cc'")],
    "CONST REAL: c;": [("IRL251", "the constant 'c' has no value", "c")],
    "CONST INT: c := TRUE;": [("IRL222", "expected INT, found BOOL", "TRUE")],
    "CONST INT: c := 5 DIV 0;": [("IRL502", "division by zero", "5 DIV 0")],
    # names before their declaration
    "VAR REAL: x := y; REAL: y := 1;": [("IRL201", "unknown name 'y'; it is declared further down", "y")],
    "CONST REAL: c := v; VAR REAL: v := 1;": [
        ("IRL201", "unknown name 'v'; it is declared further down", "v")
    ],
    "VAR t2: a; TYPE ARRAY [1..2] OF INT = t2;": [],
    "TYPE mine = other; RECORD REAL: a; ENDRECORD = mine;": [
        ("IRL204", "unknown type 'mine'; it is defined further down", "mine")
    ],
    "TYPE RECORD REAL: a; rec: b; ENDRECORD = rec;": [],
    # arrays
    "VAR ARRAY [1..3] OF INT: a := (1, 2, 3);": [],
    "CONST INT: n := 3; VAR ARRAY [1..n, 0..n - 1] OF INT: a := (1, 2, 3, 4, 5, 6, 7, 8, 9);": [],
    "CONST INT: n := 3; VAR ARRAY [1..n] OF INT: a := (1, 2);": [
        ("IRL223", "ARRAY [1..3] OF INT takes 3 values, found 2", "(1, 2)")
    ],
    "VAR INT: n := 3; ARRAY [1..n] OF INT: a := (1, 2);": [],
    "VAR ARRAY [1..2.5] OF INT: a;": [("IRL222", "expected INT, found REAL", "2.5")],
    "VAR ARRAY [3..1] OF INT: a;": [("IRL508", "the range 3..1 is empty", "3..1")],
    "VAR ARRAY [1..5000, 1..5000] OF REAL: a;": [
        (
            "IRL507",
            "an array of 25000000 elements is too large; at most 10000000 are kept",
            "ARRAY [1..5000, 1..5000] OF REAL",
        )
    ],
    "VAR ARRAY [1..2000000] OF POSE: a;": [
        (
            "IRL507",
            "an array of 14000000 elements is too large; at most 10000000 are kept",
            "ARRAY [1..2000000] OF POSE",
        )
    ],
    "VAR ARRAY [1..2] OF ARRAY [1..20000000] OF REAL: a;": [
        (
            "IRL507",
            "an array of 20000000 elements is too large; at most 10000000 are kept",
            "ARRAY [1..20000000] OF REAL",
        )
    ],
    # records
    "TYPE RECORD INT: n; REAL: n; ENDRECORD = r;": [("IRL214", "the record has two fields 'n'", "n")],
    "TYPE RECORD REAL: max; ENDRECORD = inner; RECORD inner: a1; REAL: a1.max; ENDRECORD = both;": [
        ("IRL226", "'a1.max' could mean the field a1.max, or max of the field a1", "a1.max")
    ],
    "TYPE RECORD REAL: a; ENDRECORD = POSE;": [("IRL202", "'POSE' is declared twice", "POSE")],
    "TYPE INT = INTEGER;": [("IRL202", "'INTEGER' is declared twice", "INTEGER")],
    "TYPE REAL = length; VAR length: l := 3;": [],
    "TYPE POSE = place; VAR place: a; POSE: b := a;": [("IRL222", "expected POSE, found place", "a")],
    # joint types
    "TYPE RECORD REAL: a1, a2; ENDRECORD = MAIN_JOINT; VAR MAIN_JOINT: m := (1, 2);": [],
    "TYPE RECORD REAL: a1, a2; ENDRECORD = MAIN_JOINT; VAR MAIN_JOINT_MIN: m := (1, 2);": [],
    "TYPE RECORD REAL: a1, a2; ENDRECORD = MAIN_JOINT; VAR MAIN_JOINT: m := (1, 2, 3);": [
        ("IRL223", "MAIN_JOINT takes 2 values, found 3", "(1, 2, 3)")
    ],
    "TYPE RECORD REAL: a1, a2; ENDRECORD = MAIN_JOINT; RECORD REAL: a1.max; ENDRECORD = MAIN_JOINT_MAX;": [
        ("IRL246", "type MAIN_JOINT_MAX is defined with 1 field, but MAIN_JOINT with 2", "MAIN_JOINT_MAX")
    ],
    "TYPE RECORD REAL: a1; INT: a2; ENDRECORD = MAIN_JOINT;": [
        ("IRL222", "expected REAL for a field of MAIN_JOINT, found INT", "INT")
    ],
    "TYPE REAL = MAIN_JOINT;": [
        ("IRL222", "expected a RECORD with one REAL a joint for MAIN_JOINT, found REAL", "REAL")
    ],
    "TYPE RECORD REAL: a; ENDRECORD = MAIN_JOINT; VAR JOINT: j; REAL: x := j.m_joint.b;": [
        ("IRL225", "MAIN_JOINT has no field 'b'", ".b")
    ],
    # signals
    "VAR INPUT BOOL: a AT 1; OUTPUT INT: b AT 2; DIGITAL OUTPUT: c AT 3; ANALOG INPUT: d AT 4;": [],
    "VAR INPUT POSE: a AT 1;": [("IRL222", "expected BOOL, INT or REAL for a signal, found POSE", "POSE")],
    "VAR INPUT BOOL: a AT 1.5;": [("IRL222", "expected INT, found REAL", "1.5")],
    # modules and robots say nothing of types
    "FROM m IMPORT f, T9; VAR T9: a := f(1, TRUE); REAL: b := f;": [],
    "ROBOT r := arm;": [],
}


@pytest.mark.req("LANG-10")
@pytest.mark.req("LANG-20")
@pytest.mark.req("LANG-21")
@pytest.mark.req("LANG-22")
@pytest.mark.req("LANG-23")
@pytest.mark.req("LANG-06")
@pytest.mark.parametrize("declarations", ROWS)
def test_declarations(told_of, declarations):
    assert told_of(f"PROGRAM t; {declarations} BEGIN ENDPROGRAM") == ROWS[declarations]


def list_of(values):
    return lambda *_: source_text("points.dat", f"DATALIST points;\n{values}\nENDDATALIST")


@pytest.mark.req("LANG-13")
@pytest.mark.parametrize(
    ("values", "body", "wanted"),
    [
        ("POSE: p;", "MOVE LIN p; p.pos.x := 3;", []),
        ("POSE: p;", "p := 1;", [("IRL222", "expected POSE, found INT", "1")]),
        ("INT: n := 2.5;", "", [("IRL222", "expected INT, found REAL", "2.5")]),
        ("grip: g := (1); grip: h := (2.5);", "", [("IRL222", "expected INT, found REAL", "2.5")]),
        ("REAL: a := 1 / 0;", "", [("IRL502", "division by zero", "1 / 0")]),
        ("MAIN_JOINT: m := (1, 2, 3);", "m.a3 := 1; MOVE PTP m;", []),
    ],
)
def test_data_lists(told_of, values, body, wanted):
    text = f"PROGRAM t; IMPORT DATALIST points; TYPE RECORD INT: u; ENDRECORD = grip; BEGIN {body} ENDPROGRAM"
    assert told_of(text, data_lists=list_of(values)) == wanted


@pytest.mark.req("LANG-13")
def test_a_list_by_itself(told_of):
    assert told_of("DATALIST d; REAL: a := TRUE; own: b := (1, 2); ENDDATALIST") == [
        ("IRL222", "expected REAL, found BOOL", "TRUE")
    ]


def test_a_list_that_is_not_known_may_hold_anything(told_of):
    body = "x := q + 1; MOVE LIN q; q[1].a := q;"
    assert told_of(f"PROGRAM t; IMPORT DATALIST points; VAR REAL: x; BEGIN {body} ENDPROGRAM") == []


def test_constants_know_nothing_of_data_lists(told_of):
    text = "PROGRAM t; IMPORT DATALIST points; CONST REAL: c := lift; BEGIN ENDPROGRAM"
    ((code, message, marked),) = told_of(text, data_lists=list_of("REAL: lift := 1;"))
    assert (code, marked) == ("IRL201", "lift")
    assert message.endswith("of which constants know nothing")


@pytest.mark.req("LANG-05")
@pytest.mark.parametrize(
    ("body", "wanted"),
    [
        ("x := (1, 2;\ny := 3;", ["IRL120"]),
        ("x := ;\ny := 3;", ["IRL101"]),
        ("MOVE LIN (1, , 3);\ny := 3;", ["IRL101"]),
        ("x := 5 5;\n\n\ny := TRUE;", ["IRL101", "IRL222"]),
    ],
)
def test_mistakes_in_the_text_bring_no_mistakes_of_types(told_of, body, wanted):
    text = f"PROGRAM t; VAR REAL: x, y;\nBEGIN\n{body}\nENDPROGRAM"
    assert [code for code, _, _ in told_of(text, lints=True)] == wanted


def test_findings_come_in_the_order_of_the_text(told_of):
    text = """PROGRAM t; VAR INT: i := 2.5; PROCEDURE p; BEGIN i := TRUE; ENDPROC;
    BEGIN IF 1 THEN i := 'a'; ENDIF; i := 3.5; ENDPROGRAM"""
    assert [marked for _, _, marked in told_of(text)] == ["2.5", "TRUE", "1", "'a'", "3.5"]
