"""Numbers with a decimal comma: told as such wherever a comma cannot part values, else by what helps."""

import pytest

from irlx.language.analysis import analyse
from irlx.language.source import source_text

POINT = "numbers are written with a decimal point: "
SEVEN = tuple(f"joint_{number}" for number in range(1, 8))


def told(text, joints=()):
    found = analyse(source_text("t.irl", text), joints=joints).diagnostics
    return [(one.code, one.help.removeprefix(POINT)) for one in found]


def in_program(declaration, statement="HALT;"):
    return f"PROGRAM t;\n{declaration}\nBEGIN\n{statement}\nENDPROGRAM\n"


DECLARATIONS = {
    "VAR REAL: v := 12,5;": ["12.5"],
    "CONST REAL: half := 0,5, third := -0,33, one := 1;": ["0.5", "0.33"],
    "VAR REAL: v, w := 1.000,5; INT: i := 1;": ["1000.5"],
    "VAR REAL: v := 2 * 2,5, w := 7;": ["2.5"],
}
STATEMENTS = {
    "MOVE LIN p SPEED := 1.000,0;": ["1000.0"],
    "MOVE LIN p SPEED := 2 * 2,5, ACC := 10,5;": ["2.5", "10.5"],
    "MOVE LIN p WITH CRITERION VELOCITY_RATIO WEIGHT := 0,5;": ["0.5"],
    "x := 1.000,5 + 2;": ["1000.5"],
    "WAIT 0,5 SEC;": ["0.5"],
}


@pytest.mark.parametrize("declaration", DECLARATIONS)
def test_in_declarations(declaration):
    expected = [("IRL124", number) for number in DECLARATIONS[declaration]]
    assert told(in_program(declaration)) == expected
    if declaration.startswith("VAR"):
        assert told(f"DATALIST t; {declaration.removeprefix('VAR ')} ENDDATALIST") == expected


@pytest.mark.parametrize("statement", STATEMENTS)
def test_in_statements(statement):
    text = in_program("VAR POSITION: p := (1, 2, 3); REAL: x;", statement)
    assert told(text) == [("IRL124", number) for number in STATEMENTS[statement]]


LISTS = {
    ("VAR POSITION: p := (500,5, 0, 400);", "HALT;"): ("IRL223", "500.5"),
    ("VAR POSE: p := ((480,5, -0,5, 400), ORIZYX(0, 180, 0));", "HALT;"): ("IRL223", "480.5, -0.5"),
    ("VAR ARRAY [1..2] OF REAL: r := (1,5, 2,5);", "HALT;"): ("IRL223", "1.5, 2.5"),
    ("VAR MAIN_JOINT: h := (0, -30,5, 0, 90, 0, 60, 0);", "HALT;"): ("IRL223", "-30.5"),
    ("", "MOVE LIN (500,5, 0, 400);"): ("IRL222", "500.5"),
    ("", "MOVE LIN POSITION(500, 0, 400,25);"): ("IRL228", "400.25"),
    ("VAR REAL: x;", "x := SQRT(2,5);"): ("IRL228", "2.5"),
    # Values too many, or in doubt.
    ("VAR POSITION: p := (500, 5, 0, 400);", "HALT;"): ("IRL223", ""),
    ("VAR POSITION: p := (500,5,0,400);", "HALT;"): ("IRL223", ""),
    ("VAR POSITION: p := (500,5, 0);", "HALT;"): None,
    ("", "FREEZESTART 1,2; FREEZEEND;"): None,
    ("VAR INT: n := 2;", "CASE n OF WHEN 1,2: n := 3; ENDCASE;"): None,
}


@pytest.mark.parametrize(("declaration", "statement"), LISTS)
def test_in_lists(declaration, statement):
    expected = LISTS[declaration, statement]
    assert told(in_program(declaration, statement), SEVEN) == ([] if expected is None else [expected])
