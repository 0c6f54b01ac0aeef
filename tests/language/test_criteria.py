"""CRITERION and WITH CRITERION: forms of their parameters, and what the text tells of them."""

import re
from pathlib import Path

import pytest

from irlx.language import tree

PAGES = Path(__file__).parents[2] / "docs" / "diagnostics"


def shown(params):
    return [(param.name.key, param.value.value) for param in params]


@pytest.fixture
def codes_of(analysed):
    """Codes of a body with the text that each marks."""

    def run(body):
        text = f"PROGRAM t; VAR POSITION: p, q; MAIN_JOINT: a, b; BEGIN {body} ENDPROGRAM"
        found = analysed(text).diagnostics
        return [(d.code, text[d.place.span.start : d.place.span.end]) for d in found]

    return run


@pytest.mark.req("LANG-66")
@pytest.mark.parametrize(
    "params",
    [
        "WEIGHT := 2 GAIN := 0.5",
        "WEIGHT := 2, GAIN := 0.5",
        ", WEIGHT := 2, GAIN := 0.5",
        "weight := 2\n  , gain := 0.5",
        "\n  WEIGHT := 2\n  GAIN := 0.5",
    ],
)
def test_parameters_with_and_without_commas(statement_of, params):
    start = statement_of(f"CRITERION manipulability {params};")
    assert isinstance(start, tree.CriterionStart)
    assert (start.name.key, shown(start.params)) == ("manipulability", [("weight", 2), ("gain", 0.5)])
    move = statement_of(f"MOVE LIN p SPEED := 9 WITH CRITERION manipulability {params};")
    (clause,) = move.clauses
    assert isinstance(clause, tree.WithCriterion)
    assert (clause.name.key, shown(clause.params)) == ("manipulability", [("weight", 2), ("gain", 0.5)])
    assert shown(move.params) == [("speed", 9)]


@pytest.mark.req("LANG-66")
@pytest.mark.parametrize("comma", ["", ","])
def test_other_clauses_follow(statement_of, comma):
    move = statement_of(
        f"MOVE LIN p WITH CRITERION c WEIGHT := 2{comma} GAIN := 1 WITH JOINTLIMIT a, b WITH CRITERION d"
        f" WITH RECONFIGURATION a WITH CRITERION e{comma} GAIN := 3;"
    )
    kinds = [type(clause).__name__ for clause in move.clauses]
    assert kinds == ["WithCriterion", "WithLimit", "WithCriterion", "WithReconfiguration", "WithCriterion"]
    params = [shown(clause.params) for clause in move.clauses if isinstance(clause, tree.WithCriterion)]
    assert params == [[("weight", 2), ("gain", 1)], [], [("gain", 3)]]


@pytest.mark.req("LANG-66")
@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("CRITERION c GAIN := 1 WEIGHT := 1; CRITERIONEND c;", []),
        ("CRITERION c GAIN := 1, gain := 2; CRITERIONEND c;", [("IRL306", "gain")]),
        (
            "CRITERION c WEIGHT := 1 WEIGHT := 1 Weight := 1; CRITERIONEND c;",
            [("IRL306", "WEIGHT"), ("IRL306", "Weight")],
        ),
        ("MOVE LIN p WITH CRITERION c GAIN := 1 GAIN := 1;", [("IRL306", "GAIN")]),
        ("MOVE LIN p WITH CRITERION c GAIN := 1 WITH CRITERION d GAIN := 1;", []),
        (
            "MOVE LIN p WITH CRITERION c WITH CRITERION C GAIN := 2;",
            [("IRL406", "WITH CRITERION C GAIN := 2")],
        ),
        ("MOVE PTP p WITH CRITERION c;", [("IRL407", "WITH CRITERION c")]),
        (
            "MOVE PTP p WITH CRITERION c WITH CRITERION c;",
            [("IRL407", "WITH CRITERION c"), ("IRL406", "WITH CRITERION c")],
        ),
        ("MOVE CIRCLE p, q WITH CRITERION c;", []),
    ],
)
def test_parameters_and_clauses(codes_of, body, found):
    assert codes_of(body) == found


@pytest.mark.req("LANG-66")
@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("CRITERION c; CRITERION d; CRITERIONEND C; CRITERIONEND d;", []),
        ("CRITERION c; CRITERION C GAIN := 2; CRITERIONEND c;", [("IRL303", "CRITERION C GAIN := 2")]),
        ("CRITERION c; CRITERION d; CRITERIONEND c;", [("IRL301", "CRITERION d")]),
        ("CRITERION c; CRITERIONEND c; CRITERIONEND c;", [("IRL302", "CRITERIONEND c")]),
        ("CRITERIONEND never;", [("IRL302", "CRITERIONEND never")]),
        ("CRITERION c; MOVE LIN p WITH CRITERION c WEIGHT := 2; CRITERIONEND c;", []),
    ],
)
def test_switches_are_told_apart_by_name(codes_of, body, found):
    assert codes_of(body) == found


@pytest.mark.req("LANG-66")
def test_findings_as_text(analysed):
    def told(statement):
        (found,) = analysed(f"PROGRAM t; VAR POSITION: p; BEGIN {statement} ENDPROGRAM").diagnostics
        return found.is_error, found.message

    assert told("MOVE LIN p WITH CRITERION c GAIN := 1 Gain := 1;") == (
        True,
        "parameter 'Gain' of the criterion c is given twice",
    )
    assert told("MOVE PTP p WITH CRITERION c;") == (
        False,
        "WITH CRITERION c does nothing on a PTP, which goes straight in joint space",
    )
    assert told("MOVE LIN p WITH CRITERION c WITH CRITERION C;") == (True, "WITH CRITERION C is given twice")


def section(code, title):
    page = (PAGES / f"{code}.md").read_text(encoding="utf-8")
    return re.search(rf"^## {title}\n+```irl\n(.*?)```", page, re.MULTILINE | re.DOTALL)[1]


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize(
    ("code", "place"), [("IRL306", (4, 69)), ("IRL407", (4, 15))], ids=["IRL306", "IRL407"]
)
def test_pages_show_what_they_say(analysed, code, place):
    (found,) = analysed(section(code, "Bad")).diagnostics
    assert (found.code, found.place.line_and_column) == (code, place)
    assert analysed(section(code, "Repaired")).diagnostics == ()
