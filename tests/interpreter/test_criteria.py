"""CRITERION, CRITERIONEND, WITH CRITERION: their blocks, the range of WEIGHT, names outside the library."""

import re
from pathlib import Path

import pytest

from irlx.blocks import CriterionBlock, CriterionChoice, CriterionParam
from irlx.blocks.criterion import LIBRARY
from irlx.interpreter.support import unsupported
from irlx.language.analysis import analyse
from irlx.language.source import source_text

PAGE = Path(__file__).parents[2] / "docs" / "diagnostics" / "IRL363.md"

LIN = (
    "1 MOVE LIN to (1 2 3) kept in R_BASE speed 250 mm/s acc 1000 mm/s2 speed_ori 90 deg/s acc_ori 180 deg/s2"
)
P = "VAR POSITION: p := (1, 2, 3), q := (4, 5, 6);"


def covered(text, origin):
    return text[origin.start : origin.end]


@pytest.mark.req("LANG-66")
@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("CRITERION manipulability;", "CRITERION MANIPULABILITY weight 1"),
        ("CRITERION manipulability WEIGHT := 2 GAIN := 0.5;", "CRITERION MANIPULABILITY weight 2 gain 0.5"),
        ("CRITERION manipulability WEIGHT := 2, GAIN := 0.5;", "CRITERION MANIPULABILITY weight 2 gain 0.5"),
        ("CRITERION manipulability, WEIGHT := 2;", "CRITERION MANIPULABILITY weight 2"),
        ("criterion Manipulability Gain := 0.5, weight := 2;", "CRITERION MANIPULABILITY weight 2 gain 0.5"),
        ("CRITERION mine b := 1, a := -2;", "CRITERION MINE weight 1 b 1 a -2"),
        ("CRITERION ściana próg := x * 2 WEIGHT := x / 2;", "CRITERION ŚCIANA weight 2 próg 8"),
        ("CRITERIONEND Manipulability;", "CRITERIONEND MANIPULABILITY"),
        ("CRITERIONEND mine;", "CRITERIONEND MINE"),
    ],
)
def test_switches(lines, statement, expected):
    assert lines("VAR REAL: x := 4;", statement) == [f"1 {expected} line 4"]


@pytest.mark.req("LANG-66")
def test_a_switch_as_a_block(blocks):
    statements = "CRITERION mine b := 1, WEIGHT := 3, a := 2; CRITERIONEND Mine;"
    start, end = blocks("", statements)
    assert isinstance(start, CriterionBlock)
    params = (CriterionParam("B", 1.0), CriterionParam("A", 2.0))
    assert (start.name, start.choice) == ("MINE", CriterionChoice("MINE", 3.0, params))
    assert (end.id, end.name, end.choice) == (2, "MINE", None)
    text = f"PROGRAM t;\n\nBEGIN\n{statements}\nENDPROGRAM"
    assert covered(text, start.origin) == "CRITERION mine b := 1, WEIGHT := 3, a := 2"
    assert covered(text, end.origin) == "CRITERIONEND Mine"


@pytest.mark.req("LANG-66")
def test_every_spelling_of_a_name_is_one_name(blocks):
    body = "CRITERION straße; CRITERION STRASSE; CRITERIONEND Straße;"
    assert {block.name for block in blocks("", body)} == {"STRASSE"}


@pytest.mark.req("LANG-66")
def test_parameters_are_latched_when_the_statement_runs(lines):
    body = "x := 2; CRITERION a WEIGHT := x; x := 3; CRITERION a WEIGHT := x;"
    assert lines("VAR REAL: x;", body) == ["1 CRITERION A weight 2 line 4", "2 CRITERION A weight 3 line 4"]


@pytest.mark.req("LANG-66")
@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        ("WITH CRITERION joint_centring", "WITH CRITERION JOINT_CENTRING weight 1"),
        (
            "WITH CRITERION joint_centring WEIGHT := 3, GAIN := 2",
            "WITH CRITERION JOINT_CENTRING weight 3 gain 2",
        ),
        (
            "WITH CRITERION a GAIN := 2 WITH CRITERION b WEIGHT := 2",
            "WITH CRITERION A weight 1 gain 2 WITH CRITERION B weight 2",
        ),
        (
            "WITH CRITERION a WEIGHT := 2 GAIN := 1 WITH JOINTLIMIT (0, 0), (1, 1)",
            "WITH JOINTLIMIT (0 0) (1 1) WITH CRITERION A weight 2 gain 1",
        ),
        (
            "WITH CRITERION a, WEIGHT := 2 WITH RECONFIGURATION (5, 6) WITH CRITERION b",
            "WITH RECONFIGURATION (5 6) WITH CRITERION A weight 2 WITH CRITERION B weight 1",
        ),
    ],
)
def test_clauses(lines, clauses, expected):
    assert lines(P, f"MOVE LIN p {clauses};", joints=2) == [f"{LIN} {expected} line 4"]


@pytest.mark.req("LANG-66")
def test_a_clause_has_its_own_place_and_holds_for_every_target(blocks):
    body = "MOVE LIN p, q SPEED := 5\n WITH CRITERION a GAIN := 2 WEIGHT := 4;"
    first, second = blocks(P, body)
    (clause,) = first.criteria
    assert clause.choice == CriterionChoice("A", 4.0, (CriterionParam("GAIN", 2.0),))
    text = f"PROGRAM t;\n{P}\nBEGIN\n{body}\nENDPROGRAM"
    assert covered(text, clause.origin) == "WITH CRITERION a GAIN := 2 WEIGHT := 4"
    assert clause.origin.line == 5
    assert second.criteria == first.criteria
    assert first.law.speed == 0.005


@pytest.mark.req("LANG-66")
@pytest.mark.parametrize("motion", ["CIRCLE p, q", "PTP p"])
def test_other_moves_carry_their_clause_too(blocks, motion):
    (move,) = blocks(P, f"MOVE {motion} WITH CRITERION a;")
    assert [clause.choice.name for clause in move.criteria] == ["A"]


@pytest.mark.req("LANG-66")
@pytest.mark.parametrize(
    "statement", ["CRITERION a WEIGHT := {};", "MOVE LIN p WITH CRITERION a WEIGHT := {};"]
)
@pytest.mark.parametrize(
    ("weight", "expected"),
    [
        ("0", ("IRL505", "WEIGHT must be greater than 0, found 0", "0")),
        ("-2.5", ("IRL505", "WEIGHT must be greater than 0, found -2.5", "-2.5")),
        ("TRUE", ("IRL222", "expected REAL, found BOOL", "TRUE")),
        ("1 / 0", ("IRL502", "division by zero", "1 / 0")),
    ],
)
def test_weights_out_of_range(run_error, statement, weight, expected):
    assert run_error(P, statement.format(weight)) == expected


@pytest.mark.req("LANG-66")
def test_other_parameters_may_be_any_number_but_no_text(lines, run_error):
    assert lines("", "CRITERION a gain := 0, w := -1;") == ["1 CRITERION A weight 1 gain 0 w -1 line 4"]
    assert run_error("", "CRITERION a GAIN := 'much';") == ("IRL222", "expected REAL, found STRING", "'much'")


# ---- what a check says


def warnings_of(body, declarations=P):
    text = f"PROGRAM t; {declarations} BEGIN {body} ENDPROGRAM"
    analysis = analyse(source_text("t.irl", text))
    return [
        (d.code, d.message, text[d.place.span.start : d.place.span.end])
        for d in unsupported(analysis.tree, analysis.source)
    ]


@pytest.mark.req("LANG-66")
@pytest.mark.parametrize("name", LIBRARY)
def test_the_library_is_known(name):
    body = f"CRITERION {name.lower()}; CRITERIONEND {name}; MOVE LIN p WITH CRITERION {name};"
    assert warnings_of(body) == []


@pytest.mark.req("LANG-66")
def test_a_name_outside_the_library_is_warned_about_once():
    body = "CRITERION manipulabilty; CRITERIONEND manipulabilty; MOVE LIN p WITH CRITERION Manipulabilty;"
    (found,) = warnings_of(body)
    code, message, marked = found
    assert (code, marked) == ("IRL363", "manipulabilty")
    assert message.startswith(
        "no criterion of the library is called MANIPULABILTY; did you mean 'MANIPULABILITY'"
    )


@pytest.mark.req("LANG-66")
def test_nothing_like_it_is_known():
    message = "no criterion of the library is called XYZ"
    assert warnings_of("MOVE LIN p WITH CRITERION xyz;") == [("IRL363", message, "xyz")]


@pytest.mark.req("LANG-66")
def test_names_in_routines_and_branches_count_too():
    found = warnings_of(
        "IF TRUE THEN CRITERION abc; ENDIF;", P + "PROCEDURE r; BEGIN CRITERION xyz; ENDPROC;"
    )
    assert [marked for code, _, marked in found if code == "IRL363"] == ["xyz", "abc"]
    assert [code for code, _, _ in found] == ["IRL363", "IRL363"]


@pytest.mark.req("LANG-70")
def test_the_page_shows_what_it_says():
    bad, repaired = re.findall(
        r"^```irl\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )
    found = {}
    for text in (bad, repaired):
        analysis = analyse(source_text("p.irl", text))
        assert analysis.diagnostics == ()
        found[text] = [(d.code, d.place.line_and_column) for d in unsupported(analysis.tree, analysis.source)]
    assert found == {bad: [("IRL363", (3, 55))], repaired: []}
