"""Data lists: their text and tree, the names that come in, and what is wrong with either."""

import re
from pathlib import Path

import pytest

from irlx.diagnostics import IrlxError, report
from irlx.language import tree as t
from irlx.language.analysis import analyse
from irlx.language.keywords import NAMES_TOO
from irlx.language.parser import parse
from irlx.language.source import source_text

pytestmark = pytest.mark.req("LANG-13")

POINTS = """DATALIST points;
  POSE: p0 := ((600, 0, 400), ORIZYX(0, 180, 0)), p1 := p0 @ INV(p0);
  REAL: lift := 120;
  ARRAY [1..2] OF POSITION: rack := ((1, 2, 3), (4, 5, 6));
  POSITION: later;
ENDDATALIST
"""


def supplied(lists):
    """A resolver of texts in memory."""

    def resolve(name, place):
        if name not in lists:
            raise IrlxError(report("IRL240", place, name=name, path=f"{name}.dat", near=""))
        return source_text(f"{name}.dat", lists[name])

    return resolve


def analysed(text, **lists):
    return analyse(source_text("t.irl", text), data_lists=supplied(lists))


def told(analysis):
    """Place, code and message of every finding, with the places that belong to it."""
    return [
        (f"{d.place} {d.code} {d.message}", *(str(r.place) for r in d.related)) for d in analysis.diagnostics
    ]


def program(body, declarations="IMPORT DATALIST points;"):
    return f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM"


# ---- the text


def test_tree():
    (found,) = analysed(program(""), points=POINTS).data_lists
    assert isinstance(found.tree, t.DataList)
    assert found.tree.name.name == "points"
    names = [[v.name.name for v in part.variables] for part in found.tree.declarations]
    assert names == [["p0", "p1"], ["lift"], ["rack"], ["later"]]
    assert [type(part.type) for part in found.tree.declarations][2] is t.ArrayType
    assert found.tree.declarations[3].variables[0].initial is None
    for node in t.walk(found.tree):
        assert 0 <= node.span.start < node.span.end <= len(found.source.text)


def test_a_list_by_itself():
    analysis = analyse(source_text("points.dat", POINTS))
    assert analysis.diagnostics == ()
    assert isinstance(analysis.tree, t.DataList)
    assert set(analysis.symbols) == {"p0", "p1", "lift", "rack", "later"}


@pytest.mark.parametrize("end", ["ENDDATALIST", "ENDDATALIST;", "enddatalist { comment } ;"])
def test_empty_lists_and_ends(end):
    assert analyse(source_text("points.dat", f"datalist points; {end}")).diagnostics == ()


@pytest.mark.req("LANG-04")
@pytest.mark.parametrize("word", sorted(NAMES_TOO))
def test_words_that_are_names_too(word):
    text = f"DATALIST {word};\n INT: {word} := 1, b := {word};\nENDDATALIST"
    assert analyse(source_text("points.dat", text)).diagnostics == ()
    body = f"{word} := {word} + b;"
    assert told(analysed(program(body, f"IMPORT DATALIST {word};"), **{word: text})) == []


SYNTAX = {
    "DATALIST points\nREAL: a := 1;\nENDDATALIST": ["1:16 IRL102 missing ';' after the DATALIST"],
    "DATALIST points;\nREAL a := 1;\nREAL: b := 2;\nENDDATALIST": [
        "2:5 IRL120 missing ':' before the name 'a'"
    ],
    "DATALIST points;\nREAL: a := 1\nENDDATALIST": ["2:13 IRL103 missing ';' after the declaration"],
    "DATALIST points;\nREAL: a := 1\nREAL: b := 2;\nENDDATALIST": [
        "2:13 IRL102 missing ';' after the declaration"
    ],
    "DATALIST points;\nREAL: a = 1;\nENDDATALIST": ["2:9 IRL105 '=' taken for ':='"],
    "DATALIST points;\nREAL: a := (1 + 2;\nREAL: b := c;\nENDDATALIST": [
        "2:18 IRL120 missing ')' before ';'",
        "3:12 IRL201 unknown name 'c'",
    ],
    "DATALIST points;\nVAR REAL: a := 1;\nENDDATALIST": [
        "2:1 IRL101 expected a type or ENDDATALIST, found the keyword VAR"
    ],
    "DATALIST points;\nREAL: a := 1;\n": [
        "3:1 IRL107 missing ENDDATALIST for the DATALIST of line 1, found the end of the file"
    ],
    "DATALIST points;\nREAL: a := 1;\nENDDATALIST\nREAL: b;": [
        "4:1 IRL109 nothing may follow the end of the data list, found the name 'REAL'"
    ],
    "DATALIST ; REAL: a := 1; ENDDATALIST": ["1:10 IRL101 expected a name, found ';'"],
}


@pytest.mark.req("LANG-05")
@pytest.mark.parametrize("text", SYNTAX)
def test_mistakes_in_the_text(text):
    """The same alone and imported, where no name of the program is called unknown for them."""
    wanted = [f"points.dat:{line}" for line in SYNTAX[text]]
    alone = analyse(source_text("points.dat", text))
    assert [f"{d.place} {d.code} {d.message}" for d in alone.diagnostics] == wanted
    found = analysed(program("q := a + b;", "IMPORT DATALIST points; VAR REAL: q;"), points=text)
    lines = [f"{d.place} {d.code} {d.message}" for d in found.diagnostics]
    if "REAL: b" in text or not parse(source_text("points.dat", text)).complete:
        assert lines == wanted
    else:
        assert lines == ["t.irl:4:10 IRL201 unknown name 'b'", *wanted]


def test_a_variable_called_datalist_begins_statements_like_any_other():
    """A mistake in such a statement costs at most that statement."""
    text = "PROGRAM t; VAR INT: datalist, x;\nBEGIN\n  datalist := 5 5;\n  x := := 1;\n  x := 2;\nENDPROGRAM"
    found = analyse(source_text("t.irl", text))
    assert [(d.code, d.place.line) for d in found.diagnostics] == [("IRL101", 3), ("IRL101", 4)]
    assert {type(statement) for statement in found.tree.body} == {t.Assignment}


@pytest.mark.parametrize("use", ["IMPORT DATALIST points;", "VAR INT: datalist;"])
def test_elsewhere_datalist_opens_nothing(use):
    (found,) = analyse(source_text("t.irl", f"PROGRAM t;\n{use}\nBEGIN\n  HALT;\n")).diagnostics
    assert found.message == "missing ENDPROGRAM for the PROGRAM of line 1, found the end of the file"


def test_the_list_of_the_reference():
    reference = Path(__file__).parents[2] / "docs" / "reference" / "language.md"
    shown = re.search(r"^DATALIST.*?^ENDDATALIST$", reference.read_text(encoding="utf-8"), re.M | re.S)
    assert told(analysed(program("MOVE LIN p1; lift := 2;"), points=shown[0])) == []


# ---- names


def test_names_are_known_and_can_be_set():
    body = "p0 := p1; p0.pos.x := lift; MOVE LIN rack[1], later; lift := 3;"
    analysis = analysed(program(body), points=POINTS)
    assert told(analysis) == []
    assert {key: symbol.kind for key, symbol in analysis.symbols.items()}["lift"] == "variable"


def test_unknown_names_get_those_of_the_list_to_choose_from():
    assert told(analysed(program("MOVE LIN rak;"), points=POINTS)) == [
        ("t.irl:4:10 IRL201 unknown name 'rak'; did you mean 'rack'?",)
    ]


def test_a_list_that_is_not_given_may_hold_any_name():
    found = analysed(program("MOVE LIN nowhere;"))
    assert told(found) == [("t.irl:2:17 IRL240 no data list 'points': there is no file points.dat",)]
    assert found.data_lists == ()


def test_other_texts_are_no_data_lists():
    for text, where, what in (
        ("PROGRAM other; BEGIN ENDPROGRAM", "1:1", "PROGRAM other"),
        ("{ x }\nMODULE m; ENDMODULE", "2:1", "MODULE m"),
        ("x := 1;", "1:1", "the name 'x'"),
        ("", "1:1", "an empty text"),
        ("{ nothing }\n", "1:1", "an empty text"),
    ):
        found = told(analysed(program("MOVE LIN p;"), points=text))
        assert found == [(f"points.dat:{where} IRL242 expected a data list, found {what}", "t.irl:2:17")]


def test_another_name_in_the_header_is_a_warning():
    analysis = analysed(program(""), points="DATALIST Poinst; REAL: a := 1; ENDDATALIST")
    assert told(analysis) == [
        (
            "points.dat:1:10 IRL243 the data list is called 'Poinst' here and 'points' where it is imported",
            "t.irl:2:17",
        )
    ]
    assert not analysis.has_errors
    assert told(analysed(program(""), points="DATALIST POINTS; ENDDATALIST")) == []


def test_a_list_imported_twice():
    text = program("lift := 1;", "IMPORT DATALIST points;\nIMPORT DATALIST Points;")
    analysis = analysed(text, points=POINTS)
    assert told(analysis) == [("t.irl:3:17 IRL244 the data list 'Points' is imported twice", "t.irl:2:17")]
    assert len(analysis.data_lists) == 1


TWICE = {
    "within a list": (
        program(""),
        {"points": "DATALIST points;\nREAL: a := 1;\nINT: b := 1, A := 2;\nENDDATALIST"},
        ("points.dat:3:14 IRL202 'A' is declared twice", "points.dat:2:7"),
    ),
    "in the program": (
        program("", "VAR REAL: a;\nIMPORT DATALIST points;"),
        {"points": "DATALIST points;\nREAL: a := 1;\nENDDATALIST"},
        ("t.irl:2:11 IRL202 'a' is declared twice", "points.dat:2:7"),
    ),
    "in two lists": (
        program("", "IMPORT DATALIST points; IMPORT DATALIST more;"),
        {
            "points": "DATALIST points;\nREAL: a := 1;\nENDDATALIST",
            "more": "DATALIST more; REAL: a := 1; ENDDATALIST",
        },
        ("more.dat:1:22 IRL202 'a' is declared twice", "points.dat:2:7"),
    ),
}


@pytest.mark.parametrize("case", TWICE)
def test_names_declared_twice(case):
    text, lists, wanted = TWICE[case]
    assert told(analysed(text, **lists)) == [wanted]


def test_routines_may_hide_names_of_a_list():
    routine = "PROCEDURE p; VAR REAL: lift; BEGIN lift := 1; ENDPROC; IMPORT DATALIST points;"
    assert told(analysed(program("", routine), points=POINTS)) == [
        ("t.irl:2:24 IRL213 'lift' hides a name of the program", "points.dat:3:9")
    ]


# ---- values are constant

NOT_CONSTANT = {
    "REAL: a := b, b := 1;": "2:12 IRL245 .. use 'b', which does not stand further up in it",
    "REAL: a := a;": "2:12 IRL245 .. use 'a', which does not stand further up in it",
    "REAL: a := x;": "2:12 IRL245 .. use 'x', a variable of the program",
    "REAL: a := 2 * k;": "2:16 IRL245 .. use 'k', a constant of the program",
    "REAL: a := twice(1);": "2:12 IRL245 .. use 'twice', a function of the program",
    "REAL: a := R_SPEED;": "2:12 IRL245 .. use 'R_SPEED', a system variable",
    "JOINT: a := R_JOINT_ACT;": "2:13 IRL245 .. use 'R_JOINT_ACT', a system variable",
    "BOOL: a := IN_3;": "2:12 IRL245 .. use 'IN_3', a port",
    "POSE: a := part;": "2:12 IRL245 .. use 'part', a frame of the cell",
    "MAIN_JOINT: a := POSTURE((1, 2, 3));": "2:18 IRL245 .. use 'POSTURE', which asks the robot",
    "REAL: a := CLEARANCE((1, 2, 3), wall);": "2:12 IRL245 .. use 'CLEARANCE', which asks the robot",
    "ARRAY [1..k] OF INT: a;": "2:11 IRL245 .. use 'k', a constant of the program",
    "REAL: first := 1, a := frist;": "2:24 IRL201 unknown name 'frist'; did you mean 'first'?",
    "REAL: a := SQR(1);": "2:12 IRL206 unknown function 'SQR'; did you mean 'SQRT'?",
    "REAL: a := 1, b := a(1);": "2:20 IRL209 'a' is no function",
    "PSE: a;": "2:1 IRL204 unknown type 'PSE'; did you mean 'POSE'?",
    "gripp: a;": "2:1 IRL204 unknown type 'gripp'; did you mean 'grip'?",
    "RECORD INT: u; REAL: U; ENDRECORD: a;": "2:22 IRL214 the record has two fields 'U'",
    "REAL: r_speed := 1;": "2:7 IRL216 'r_speed' is a system variable: assign to it instead of declaring it",
}
DECLARATIONS = """IMPORT DATALIST points; VAR REAL: x; CONST INT: k := 3;
TYPE RECORD INT: u; ENDRECORD = grip;
FUNCTION twice(REAL: v): REAL; BEGIN RETURN 2 * v; ENDFCT;"""


@pytest.mark.parametrize("values", NOT_CONSTANT)
def test_values_that_are_not_constant(values):
    found = analyse(
        source_text("t.irl", program("", DECLARATIONS)),
        cell_names=lambda _: ("part",),
        data_lists=supplied({"points": f"DATALIST points;\n{values}\nENDDATALIST"}),
    )
    wanted = NOT_CONSTANT[values].replace("IRL245 ..", "IRL245 a value of a data list cannot", 1)
    assert [f"{d.place} {d.code} {d.message}" for d in found.diagnostics] == [f"points.dat:{wanted}"]


def test_values_that_are():
    values = """INT: n := 2; ARRAY [1..n] OF INT: a := (n, n + 1); grip: g := (1);
    POSE: pose := POSE(POSITION(1, 2, 3), ORIZYX(0, 180, 0));
    POSE: b := INV(pose) @ pose + POSITION(a[1], 0, -SQRT(2.));
    RECORD REAL: u, v; ENDRECORD: r := (1, 2); REAL: part := r.u; BOOL: ok := NOT (n > 1 AND TRUE);"""
    found = analyse(
        source_text("t.irl", program("", DECLARATIONS)),
        cell_names=lambda _: ("part",),
        data_lists=supplied({"points": f"DATALIST points;\n{values}\nENDDATALIST"}),
    )
    assert told(found) == []


def test_each_name_is_told_once_and_in_the_order_of_the_files():
    text = program("MOVE LIN nowhere;", "IMPORT DATALIST b; IMPORT DATALIST a;")
    lists = {"a": "DATALIST a; REAL: v := u + u; ENDDATALIST", "b": "DATALIST b; REAL: w := u; ENDDATALIST"}
    places = [str(d.place) for d in analysed(text, **lists).diagnostics]
    assert places == ["t.irl:4:10", "b.dat:1:24", "a.dat:1:24"]


def test_types_of_an_unknown_program_are_not_called_unknown():
    text = "DATALIST points;\n grip: g := (1);\n REAL: a := u;\nENDDATALIST"
    assert told(analyse(source_text("points.dat", text))) == [("points.dat:3:13 IRL201 unknown name 'u'",)]


@pytest.mark.parametrize(
    ("joints", "expected"), [(0, []), (7, []), (6, ["MAIN_JOINT takes 6 values, found 7"])]
)
def test_a_list_by_itself_is_held_against_the_robot(joints, expected):
    """Where the cell is known; without one any number of joints will do."""
    text = "DATALIST postures;\n  MAIN_JOINT: home := (1, 2, 3, 4, 5, 6, 7);\nENDDATALIST\n"
    names = tuple(f"a{number}" for number in range(joints))
    found = analyse(source_text("postures.dat", text), joints=names, lints=False).diagnostics
    assert [one.message for one in found] == expected
