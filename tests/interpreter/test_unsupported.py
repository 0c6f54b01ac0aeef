"""What is read but not executed: an error where a run meets it, a warning in a check, both with its name."""

import pytest

from irlx.interpreter.rotations import FUNCTIONS
from irlx.interpreter.support import unsupported
from irlx.language import builtins
from irlx.language.analysis import analyse
from irlx.language.builtins import ASKING_FUNCTIONS
from irlx.language.source import source_text

START = "VAR POSITION: p := (1, 2, 3); MAIN_JOINT: j; BOOL: b; INT: i := 1; REAL: x;"


def warnings_of(text):
    analysis = analyse(source_text("t.irl", text))
    found = unsupported(analysis.tree, analysis.source)
    return [(d.code, d.data["what"], text[d.place.span.start : d.place.span.end]) for d in found]


def program(declarations, body):
    return f"PROGRAM t;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM"


@pytest.mark.req("LANG-34")
def test_every_function_is_executed():
    assert {*builtins.FUNCTIONS} - {"eof"} <= {*FUNCTIONS, *ASKING_FUNCTIONS, *builtins.TYPES}


@pytest.mark.parametrize("type", ["SEMAPHORE", "SIGNAL"])
def test_types(run_error, type):
    code, message, text = run_error(f"VAR {type}: v;", "")
    assert (code, text) == ("IRL590", type)
    assert message == f"this version of irlx reads the type {type} but does not execute it yet"


def test_what_is_executed_is_not_warned_about():
    declarations = START + "CONST ORIENTATION: o := ORIZYX(1, 2, 3); TYPE RECORD REAL: a; ENDRECORD = one;"
    declarations += (
        "PROCEDURE pick(VAR INT: n); VAR CHAR: c; ROBTARGET: t; BEGIN n := 3; ENDPROC; EXPORT pick;"
    )
    declarations += "STANDARD_OUT = log; VAR FILE: log; ARRAY [1..2] OF FILE: logs; STANDARD_IN = keyboard;"
    declarations += "FROM grippers IMPORT close; VAR OUTPUT BOOL: part AT 3; DIGITAL OUTPUT: lamp AT 4;"
    body = """i := 2; MOVE LIN p SPEED := 3 WITH JOINTLIMIT j, j; MOVE PTP R_JOINT_ACT; FREEZESTART 1;
    MOVE CIRCLE p, p ANGLE := 90 CIRC_ORI := 'VIA'; MOVE CIRCLE p, p WITH RECONFIGURATION j, j;
    IF b THEN FOR i := 1 TO 3 DO WHILE b DO EXIT; ENDWHILE; ENDFOR; ELSE pick(i); RETURN; ENDIF;
    CASE i OF WHEN 1: PAUSE; ENDCASE; REPEAT GOTO end; UNTIL b; end: x := ROUND(1.5) + LEN('a');
    x := MANIPULABILITY(j) + FK(R_JOINT_ACT).pos.x + R_ROBTARGET_ACT.pse.pos.x; j := IK(p, j);
    CRITERION joint_barrier GAIN := i; MOVE LIN p WITH CRITERION gravity_torque; CRITERIONEND joint_barrier;
    MOVE_INC LIN p C_CP := 10, C_PASS := TRUE, JERK := 1, PROFILE := 's_curve', OVERRIDE := 50;
    MOVE_INC PTP j C_PTP := 10; MOVE LIN PATH (p, p); MOVE SPLINE PATH (p, p); R_BASE := R_TOOL;
    R_TOOL := R_BASE; x := R_MOVE_TIME + R_DISTANCE_BACK + R_JBD.LOWER.A1.MIN + R_OVERRIDE; R_C_PASS := FALSE;
    R_WEIGHTS[1] := 2; WAIT 2 SEC; WAIT FOR b TIMEOUT 3 SEC; part := IN_3; OUT_3 := lamp; lamp := part;
    OPEN(log, 'a', 'WRITE'); WRITE(log, i:4, x:8:2); WRITELN(b); READ(i, p.x); b := EOF(log);
    CLOSE(log); b := EOF();
    OBSTACLE wall; x := CLEARANCE(j, wall); j := POSTURE(p, wall); OBSTACLEEND wall;
    MOVE LIN p WITH TOLERANCE (0, 0, 0, 0, 0, 9);
    MOVE PTP POSTURE(p); FREEZEEND; CYCLICSTART; CYCLICEND; JOINTLIMITEND; HALT;"""
    assert warnings_of(program(declarations, body)) == []


def test_every_finding_is_reported_in_order():
    found = warnings_of(program("ROBOT r := left; VAR SEMAPHORE: s; SIGNAL: t;", ""))
    assert [what for _, what, _ in found] == ["the type SEMAPHORE", "the type SIGNAL"]


SILENT = [
    ("VAR ARRAY [1..2] OF SEMAPHORE: t;", "", "SEMAPHORE"),
    ("PROCEDURE p; VAR SEMAPHORE: s; BEGIN ENDPROC;", "", "SEMAPHORE"),
]


@pytest.mark.req("LANG-64")
@pytest.mark.parametrize(("declarations", "body", "marked"), SILENT)
def test_warned_about_as_well(declarations, body, marked):
    assert marked in [text for _, _, text in warnings_of(program(declarations, body))]


def test_an_unknown_parameter_is_not_one_of_later():
    """That no MOVE has it is said already (IRL203)."""
    assert warnings_of(program(START, "MOVE LIN p SPED := 5;")) == []
