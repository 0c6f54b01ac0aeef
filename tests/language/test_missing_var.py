"""A VAR that is missing below CONST is one mistake, not one for each variable and each place that sets it."""

import pytest

from irlx.language.analysis import analyse
from irlx.language.source import source_text

pytestmark = pytest.mark.req("LANG-05")

BODY = """BEGIN
  a := 1;
  b := a + 1;
  go(c);
  q := ((1, 2, 3), (1, 0, 0, 0));
  FOR a := 1 TO 3 DO b := b + 1; ENDFOR;
ENDPROGRAM"""
ROUTINE = "PROCEDURE go(VAR INT: n); BEGIN n := n + 1; ENDPROC;"


def told(constants, body=BODY):
    text = f"PROGRAM p;\nCONST\n  REAL: pi := 3.14;\n{constants}\n{ROUTINE}\n{body}"
    found = analyse(source_text("p.irl", text)).diagnostics
    return [(one.code, one.place.text.text[one.place.span.start : one.place.span.end]) for one in found]


def test_variables_without_values():
    assert told("INT: a, b := 3, c;\nPOSE: q;") == [("IRL251", "a")]


def test_variables_with_values():
    assert told("INT: a := 1, b := 2, c := 3;\nPOSE: q := ((0, 0, 0), (1, 0, 0, 0));") == [("IRL211", "a")]
    text = "PROGRAM p; CONST INT: a := 1, b := 2, c := 3; BEGIN c := 1; a := 1; b := 2; ENDPROGRAM"
    (found,) = analyse(source_text("p.irl", text)).diagnostics
    assert "VAR" in found.help


def test_beside_another_mistake():
    """INPUT belongs below VAR: that is told, and nothing of the variables that follow."""
    assert told("INPUT BOOL: seen AT 3;\nINT: a, b := 3, c := 4;\nPOSE: q;") == [("IRL101", "INPUT")]


def test_those_above_the_first_without_a_value_are_constants():
    body = "BEGIN pi := 4; a := 1; c := a; ENDPROGRAM"
    assert told("INT: a, b := 3, c;", body) == [("IRL251", "a"), ("IRL211", "pi")]


def test_single_mistakes_are_told_where_they_are():
    constants = "INT: a := 1, b := 2, c := 3;"
    assert told(constants, "BEGIN a := 1; b := 2; a := 3; ENDPROGRAM") == [("IRL211", "a"), ("IRL211", "b")]
    assert told(constants, "BEGIN go(a); go(b); ENDPROGRAM") == [("IRL249", "a"), ("IRL249", "b")]
    assert told("INT: a; REAL: b := 2;", "BEGIN a := 1; ENDPROGRAM") == [("IRL251", "a")]


def test_each_list_for_itself():
    routine = "PROCEDURE other; CONST INT: k, m := 2; BEGIN k := 1; m := 2; ENDPROC;"
    body = f"{routine} BEGIN a := 1; other; ENDPROGRAM"
    assert told("INT: a;", body) == [("IRL251", "a"), ("IRL251", "k")]
