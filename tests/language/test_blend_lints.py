"""Lints on blends (LANG-54, LANG-73): what cannot be honoured, and outputs that are set at a corner."""

import pytest

from irlx.diagnostics import CATALOGUE

DECLARATIONS = """VAR POSITION: p := (1, 2, 3), q := (4, 5, 6); REAL: x := 1; BOOL: b := TRUE; MAIN_JOINT: j;
POSE: f; INPUT BOOL: part AT 3; INPUT REAL: gauge AT 4; OUTPUT BOOL: gun AT 3;
OUTPUT REAL: speed AT 4;
PROCEDURE pick; BEGIN x := 2; ENDPROC; FUNCTION twice(REAL: y): REAL; BEGIN RETURN 2 * y; ENDFCT;"""
OURS = {"IRL288", "IRL289"}


@pytest.fixture
def blends(told_of):
    """Codes, messages and marked texts of the findings on blends in a program."""

    def run(body, declarations=DECLARATIONS):
        found = told_of(f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM", lints=True)
        return [one for one in found if one[0] in OURS]

    return run


LOST = {
    "WAIT 1 SEC;": "WAIT",
    "WAIT FOR b TIMEOUT 1 SEC;": "WAIT FOR",
    "PAUSE;": "PAUSE",
    "HALT;": "HALT",
    "CYCLICSTART;": "CYCLICSTART",
    "FREEZESTART 1;": "FREEZESTART",
    "OBSTACLE wall;": "OBSTACLE",
    "OBSTACLEEND wall;": "OBSTACLEEND",
    "j := POSTURE(p, wall);": "POSTURE",
    "x := CLEARANCE(R_JOINT_ACT, wall);": "reading R_JOINT_ACT",
    "JOINTLIMIT (1), (2);": "the limit",
    "CRITERION joint_centring;": "CRITERION",
    "RECONFIGURATION j;": "RECONFIGURATION",
    "R_TOOL := f;": "setting R_TOOL",
    "R_TOOL.POS.X := x;": "setting R_TOOL",
    "R_WEIGHTS[1] := x;": "setting R_WEIGHTS",
    "b := part;": "reading part",
    "x := gauge * 2;": "reading gauge",
    "b := IN_7 OR b;": "reading IN_7",
    "x := AIN_1;": "reading AIN_1",
    "IF part THEN x := 2; ENDIF;": "reading part",
    "WHILE NOT part DO x := 2; ENDWHILE;": "reading part",
    "CASE part OF WHEN TRUE: x := 3; ENDCASE;": "reading part",
    "j := R_JOINT_ACT.M_JOINT;": "reading R_JOINT_ACT",
    "x := R_MOVE_TIME;": "reading R_MOVE_TIME",
    "MOVE LIN R_ROBTARGET_ACT;": "reading R_ROBTARGET_ACT",
    "MOVE PTP POSTURE(p);": "POSTURE",
    "j := IK(p, j);": "IK",
    "WRITELN('a');": "WRITELN",
    "x := 2; b := FALSE; again: PAUSE;": "PAUSE",
    "x := 2; gun := TRUE; WAIT 1 SEC;": "WAIT",
}


@pytest.mark.req("LANG-54")
@pytest.mark.req("LANG-73")
@pytest.mark.parametrize("statements", LOST)
@pytest.mark.parametrize("param", ["C_CP := 10", "C_PASS := TRUE"])
def test_a_blend_that_is_lost(blends, statements, param):
    found = blends(f"MOVE LIN p {param};\n{statements}\nMOVE LIN q;")
    message = f"the blend of this move is lost: {LOST[statements]} in line 8 needs the robot at rest"
    assert found == [("IRL288", message, param)]


@pytest.mark.req("LANG-73")
def test_the_end_of_the_program(blends):
    message = "the blend of this move is lost: the end of the program needs the robot at rest"
    assert blends("MOVE PTP p C_PTP := 50; x := 3;") == [("IRL288", message, "C_PTP := 50")]


HONOURED = [
    "MOVE LIN p C_CP := 10; MOVE LIN q;",
    "MOVE LIN p C_CP := 10; x := twice(3) + 1; R_BASE := f; R_SPEED := 100; MOVE LIN q;",
    "MOVE LIN p C_CP := 10; MOVE LIN q C_CP := 5; x := FK(j).POS.X; MOVE LIN p;",
    "MOVE LIN p C_CP := 10; x := CLEARANCE(j, wall); MOVE LIN q;",
    # An obstacle may be called like an input: it is none.
    "MOVE LIN p C_CP := 10; x := CLEARANCE(j, part); MOVE LIN q;",
    "MOVE LIN p C_CP := 0; WAIT 1 SEC;",
    "MOVE LIN p C_CP := x; WAIT 1 SEC;",
    "MOVE LIN p C_CP := 10 C_PASS := FALSE; WAIT 1 SEC;",
    "MOVE LIN p C_PTP := 10; WAIT 1 SEC;",
    "MOVE PTP p C_CP := 10; WAIT 1 SEC;",
    "MOVE LIN p; WAIT 1 SEC;",
    # What a routine or a loop does next, nobody says here.
    "MOVE LIN p C_CP := 10; pick; WAIT 1 SEC;",
    "MOVE LIN p C_CP := 10; x := twice(x); pick;",
    "MOVE LIN p C_CP := 10; IF b THEN WAIT 1 SEC; ENDIF; MOVE LIN q;",
    "FOR i := 1 TO 3 DO MOVE LIN p C_CP := 10; ENDFOR;",
    "IF b THEN MOVE LIN p C_CP := 10; ENDIF; MOVE LIN q;",
    "IF b THEN MOVE LIN p C_CP := 10; RETURN; ENDIF; MOVE LIN q;",
    # At their other targets and points these pass.
    "MOVE LIN p, q C_CP := 10; WAIT 1 SEC;",
    "MOVE LIN PATH (p, q) C_CP := 10; WAIT 1 SEC;",
]


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize("body", HONOURED)
def test_what_is_honoured_or_cannot_be_known(blends, body):
    assert blends(body, DECLARATIONS.replace("REAL: x", "INT: i; REAL: x")) == []


@pytest.mark.req("LANG-73")
def test_inside_branches_and_routines(blends):
    inner = "IF b THEN MOVE LIN p C_CP := 10; WAIT 1 SEC; ENDIF;"
    assert [code for code, _, _ in blends(inner)] == ["IRL288"]
    assert [code for code, _, _ in blends("", DECLARATIONS + f"PROCEDURE go; BEGIN {inner} ENDPROC;")] == [
        "IRL288"
    ]
    # The end of a routine is not that of the program, and a local name hides an input.
    declared = "PROCEDURE go; VAR BOOL: part := TRUE; BEGIN MOVE LIN p C_CP := 10; b := part; ENDPROC;"
    assert blends("", DECLARATIONS + declared) == []


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize(
    ("body", "output"),
    [
        ("MOVE LIN p C_CP := 10; gun := TRUE; MOVE LIN q;", "gun"),
        ("MOVE LIN p C_PASS := TRUE; x := 3; speed := 2 * x; gun := FALSE; MOVE LIN q;", "speed"),
        ("MOVE PTP p C_PTP := 10; OUT_4 := TRUE; MOVE LIN q;", "OUT_4"),
        ("MOVE LIN p, q C_CP := 10; AOUT_4 := 1; MOVE LIN q;", "AOUT_4"),
        ("MOVE LIN p C_CP := 10; gun := TRUE; pick;", "gun"),
    ],
)
def test_an_output_at_a_corner(blends, body, output):
    ((code, message, marked),) = blends(body)
    assert code == "IRL289"
    assert message == f"{output} is set while the robot passes the corner, not once it has stopped there"
    assert marked.startswith(f"{output} := ")


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize(
    "body",
    [
        "MOVE LIN p; gun := TRUE; MOVE LIN q;",
        "MOVE LIN p C_CP := 10; MOVE LIN q; gun := TRUE;",
        "MOVE LIN p C_CP := 10; MOVE LIN q; gun := TRUE; MOVE LIN p;",
        "MOVE LIN p C_PASS := FALSE; gun := TRUE; MOVE LIN q;",
    ],
)
def test_an_output_at_a_stop(blends, body):
    assert blends(body) == []


def test_how_much_they_matter():
    assert CATALOGUE["IRL288"].severity.value == "warning"
    assert CATALOGUE["IRL289"].severity.value == "info"
