"""Types in statements at check time: control flow, calls, motion, switches, files."""

import pytest

from irlx.language.analysis import analyse
from irlx.language.source import source_text

DECLARATIONS = """TYPE RECORD INT: n; REAL: r; ENDRECORD = pair;
CONST INT: four := 4; POSE: home := ((600, 0, 400), ORIZYX(0, 180, 0));
VAR INT: i, j; REAL: x; BOOL: b; STRING: s; CHAR: k; FILE: f; SEMAPHORE: sema := 1; pair: d;
POSITION: v; ORIENTATION: o; POSE: p; MAIN_JOINT: m; JOINT: jt; ROBTARGET: rt; ADD_JOINT: aj;
MAIN_JOINT_MIN: lo; MAIN_JOINT_MAX: hi; MAIN_JOINT_SPEED_MIN: slo; MAIN_JOINT_SPEED_MAX: shi;
MAIN_JOINT_ACCEL_MIN: alo; MAIN_JOINT_ACCEL_MAX: ahi; ARRAY [1..4] OF POSE: way;
ARRAY [1..4] OF MAIN_JOINT: ms; ARRAY [1..i + 2] OF MAIN_JOINT: some; ARRAY [1..6] OF REAL: bands;
INPUT BOOL: part AT 1; OUTPUT BOOL: lamp AT 2; OUTPUT REAL: spindle AT four; ANALOG INPUT: gauge AT 3;
PROCEDURE pick(IN POSE: at; REAL: height; VAR INT: count); BEGIN count := count + 1; ENDPROC;
PROCEDURE rest; BEGIN RETURN; ENDPROC;
PROCEDURE grow(VAR REAL: r; VAR pair: whole); BEGIN r := r + 1; whole.n := 2; ENDPROC;
FUNCTION above(POSE: a; REAL: h): POSE; BEGIN RETURN a + POSITION(0, 0, h); ENDFCT;
"""


def program(statement, declarations=DECLARATIONS):
    return f"PROGRAM t;\n{declarations}BEGIN\n{statement}\nENDPROGRAM"


GOOD = [
    # control flow
    "IF b THEN x := 1; ELSIF i > 3 THEN x := 2; ELSE x := 3; ENDIF;",
    "WHILE NOT part DO x := x + 1; ENDWHILE;",
    "REPEAT x := x + 1; UNTIL x > 3;",
    "FOR i := 1 TO 10 STEP 2 DO x := i; ENDFOR;",
    "FOR i := four DOWNTO -j DO x := i; ENDFOR;",
    "FOR d.n := 1 TO 3 DO x := d.n; ENDFOR;",
    "CASE i OF WHEN 1, 3..5: x := 1; WHEN -2: x := 2; DEFAULT: x := 3; ENDCASE;",
    "CASE k OF WHEN 'a'..'c', 'x': x := 1; WHEN 'd': x := 2; ENDCASE;",
    "CASE s OF WHEN 'on': x := 1; WHEN 'off': x := 2; ENDCASE;",
    "CASE b OF WHEN TRUE: x := 1; WHEN FALSE: x := 2; ENDCASE;",
    # calls
    "pick(p, 3, i);",
    "pick(above(p, 2), x, d.n);",
    "pick(((1, 2, 3), (1, 0, 0, 0)), 2.5, j);",
    "rest; rest();",
    "grow(x, d); grow(d.r, d);",
    "grow(R_SPEED, d);",
    # waiting, signals, files
    "WAIT 2 SEC; WAIT x SEC;",
    "WAIT FOR part AND NOT b TIMEOUT 5 SEC;",
    "lamp := part; spindle := 3; spindle := gauge;",
    "OPEN(f, 'log.txt', 'WRITE'); WRITE(f, 'x = ', x:8:3, i:4, b, k); WRITELN(f); CLOSE(f);",
    "OPEN(f, s, 'read'); READ(f, x, i, s, d.n, ms[1].a1); READ(x);",
    "WRITE('x'); WRITELN; WRITELN(x:8);",
    # motion
    "MOVE_INC PTP m, jt; MOVE_INC LIN (1, 2, 3, 4, 5, 6, 7); MOVE_INC CIRCLE v, p ANGLE := 90;",
    "MOVE LIN PATH (way, p) WITH RECONFIGURATION (ms, m); MOVE_INC SPLINE PATH (p, v);",
    "R_BASE := home; R_BASE.POS.X := 3; R_TOOL := INV(R_BASE); R_TOOL.POS := v; p := R_BASE @ R_TOOL;",
    "R_WEIGHTS := (1, 2, 3, 4, 5, 6, 7); R_WEIGHTS[2] := 0.5; x := R_WEIGHTS[i];",
    "lo := R_JBD.LOWER; hi := R_JBD.UPPER; JOINTLIMIT R_JBD.LOWER, hi; JOINTLIMITEND;",
    "x := R_JBD.UPPER.A2.MAX - R_JBD.LOWER.A2.MIN;",
    "x := R_MOVE_TIME + R_DISTANCE_FORW + R_DISTANCE_BACK; R_PROFILE := 's_curve'; R_C_PASS := b OR part;",
    "grow(R_OVERRIDE, d); R_C_CP := 5; R_C_PTP := 10; R_JERK := 100;",
    "MOVE LIN p C_CP := 0 C_PTP := 100 C_PASS := b JERK := 0 OVERRIDE := 100 PROFILE := 'trapezoid';",
    "MOVE LIN p, v, rt, m, jt;",
    "MOVE LIN (600, 0, 400);",
    "MOVE PTP ((600, 0, 400), ORIZYX(0, 180, 0));",
    "MOVE PTP (v, o);",
    "MOVE PTP (1, 2, 3, 4, 5, 6, 7);",
    "MOVE PTP (x, 2);",
    "MOVE LIN home @ POSE(v, o), above(p, 5), p + v, v * 2;",
    "MOVE LIN p SPEED := 200, ACC := i TIME := 2.5 SPEED_PTP := 100;",
    "MOVE LIN p C_PASS := TRUE PROFILE := 'S_CURVE' JERK := 5 C_CP := 0;",
    "MOVE CIRCLE v, p ANGLE := -360 CIRC_ORI := 'via';",
    "MOVE LIN PATH (p, v, m);",
    "MOVE LIN PATH way;",
    "MOVE LIN PATH way WITH RECONFIGURATION ms;",
    "MOVE SPLINE PATH (p, v) WITH RECONFIGURATION (m, jt);",
    "MOVE LIN PATH (p, v) WITH RECONFIGURATION some; MOVE LIN PATH way WITH RECONFIGURATION (m, some);",
    "MOVE_INC LIN (0, 0, 10); MOVE_INC PTP home;",
    "R_TOOL := home; R_BASE := ((0, 0, 0), (1, 0, 0, 0)); R_SPEED := 5; R_PROFILE := 'S_CURVE';",
    # redundancy
    "JOINTLIMIT lo, hi; JOINTLIMITEND;",
    "JOINTLIMIT (-1, -2, -3), (1, 2, 3); JOINTLIMITEND;",
    "JOINTSPEEDLIMIT slo, shi; JOINTSPEEDLIMITEND;",
    "JOINTACCELLIMIT alo, ahi; JOINTACCELLIMITEND;",
    "MOVE LIN p WITH JOINTLIMIT lo, hi WITH JOINTSPEEDLIMIT slo, shi WITH JOINTACCELLIMIT alo, ahi;",
    "MOVE LIN p, p WITH RECONFIGURATION m, jt;",
    "RECONFIGURATION m; RECONFIGURATION (1, 2, 3); RECONFIGURATION R_JOINT_ACT;",
    "FREEZESTART 1, four, i; FREEZEEND;",
    "MOVE LIN p WITH CRITERION manipulability WEIGHT := 2 GAIN := x;",
    "MOVE LIN p WITH TOLERANCE (0, 0, 0, 0, 0, 360);",
    "MOVE LIN p WITH TOLERANCE bands;",
    "CRITERION manipulability WEIGHT := i; CRITERIONEND manipulability;",
    # ports that are not declared
    "x := AIN_3 + 1; AOUT_4 := i; AOUT_5 := x; OUT_2 := IN_1;",
    "FOR x := 1 TO 3.5 STEP 0.5 DO b := TRUE; ENDFOR;",
    "FOR d.r := i DOWNTO j DO b := TRUE; ENDFOR;",
    "above(p, 3);",
]


@pytest.mark.req("LANG-24")
@pytest.mark.req("LANG-40")
@pytest.mark.req("LANG-41")
@pytest.mark.req("LANG-42")
@pytest.mark.req("LANG-43")
@pytest.mark.req("LANG-50")
@pytest.mark.req("LANG-51")
@pytest.mark.parametrize("statement", GOOD)
def test_well_typed(told_of, statement):
    assert [found for found in told_of(program(statement)) if found[0] != "IRL205"] == []


TARGETS = "POSE or POSITION or ROBTARGET or MAIN_JOINT or JOINT"
NOT_A_PROCEDURE = "a function, not a procedure"
BAD = {
    # conditions
    "IF i THEN x := 1; ENDIF;": ("IRL222", "expected BOOL, found INT", "i"),
    "IF b THEN x := 1; ELSIF x THEN x := 2; ENDIF;": ("IRL222", "expected BOOL, found REAL", "x"),
    "WHILE 1 DO x := 1; ENDWHILE;": ("IRL222", "expected BOOL, found INT", "1"),
    "REPEAT x := 1; UNTIL s;": ("IRL222", "expected BOOL, found STRING", "s"),
    "IF b THEN IF b THEN WHILE b DO i := 2.5; ENDWHILE; ENDIF; ENDIF;": (
        "IRL222",
        "expected INT, found REAL",
        "2.5",
    ),
    # FOR
    "FOR b := 1 TO 3 DO x := 1; ENDFOR;": (
        "IRL222",
        "expected a variable of type INT or REAL, found BOOL",
        "b",
    ),
    "FOR x := b TO 3 DO b := TRUE; ENDFOR;": ("IRL222", "expected REAL, found BOOL", "b"),
    "FOR i := 1.5 TO 3 DO b := TRUE; ENDFOR;": ("IRL222", "expected INT, found REAL", "1.5"),
    "FOR i := 1 TO x DO b := TRUE; ENDFOR;": ("IRL222", "expected INT, found REAL", "x"),
    "FOR i := 1 TO 3 STEP 0.5 DO b := TRUE; ENDFOR;": ("IRL222", "expected INT, found REAL", "0.5"),
    "FOR i := 1 TO 3 STEP 0 DO b := TRUE; ENDFOR;": (
        "IRL505",
        "STEP must be greater than 0, found 0",
        "0",
    ),
    "FOR x := 3 DOWNTO 1 STEP -0.5 DO b := TRUE; ENDFOR;": (
        "IRL505",
        "STEP must be greater than 0, found -0.5",
        "-0.5",
    ),
    # CASE
    "CASE x OF WHEN 1: b := TRUE; ENDCASE;": (
        "IRL222",
        "expected INT, CHAR, STRING or BOOL, found REAL",
        "x",
    ),
    "CASE i OF WHEN 1, 'a': b := TRUE; ENDCASE;": ("IRL222", "expected INT, found STRING", "'a'"),
    "CASE k OF WHEN 'ab': b := TRUE; ENDCASE;": ("IRL222", "expected CHAR, found STRING", "'ab'"),
    "CASE s OF WHEN 'a'..'b': b := TRUE; ENDCASE;": (
        "IRL222",
        "expected INT or CHAR before a CASE with ranges, found STRING",
        "'a'..'b'",
    ),
    "CASE i OF WHEN 5..3: b := TRUE; ENDCASE;": ("IRL508", "the range 5..3 is empty", "5..3"),
    "CASE i OF WHEN 1: b := TRUE; WHEN 2, 1: b := FALSE; ENDCASE;": (
        "IRL252",
        "1 is chosen by an earlier label of this CASE",
        "1",
    ),
    "CASE i OF WHEN 1..5: b := TRUE; WHEN four: b := FALSE; ENDCASE;": (
        "IRL252",
        "four is chosen by an earlier label of this CASE",
        "four",
    ),
    "CASE i OF WHEN 7: b := TRUE; WHEN 1..9: b := FALSE; ENDCASE;": (
        "IRL252",
        "1..9 is chosen by an earlier label of this CASE",
        "1..9",
    ),
    "CASE b OF WHEN TRUE, TRUE: x := 1; ENDCASE;": (
        "IRL252",
        "TRUE is chosen by an earlier label of this CASE",
        "TRUE",
    ),
    # calls
    "pick(p, 3);": ("IRL228", "pick takes 3 values, found 2", "pick(p, 3)"),
    "pick;": ("IRL228", "pick takes 3 values, found 0", "pick"),
    "rest(1);": ("IRL228", "rest takes 0 values, found 1", "rest(1)"),
    "pick(v, 3, i);": ("IRL222", "expected POSE, found POSITION", "v"),
    "pick((1, 2, 3), 3, i);": ("IRL223", "POSE takes 2 values, found 3", "(1, 2, 3)"),
    "pick(p, b, i);": ("IRL222", "expected REAL, found BOOL", "b"),
    "pick(p, 3, 4);": (
        "IRL249",
        "the VAR parameter 'count' of pick needs a variable, found a number",
        "4",
    ),
    "pick(p, 3, i + 1);": (
        "IRL249",
        "the VAR parameter 'count' of pick needs a variable, found an expression",
        "i + 1",
    ),
    "pick(p, 3, (i));": (
        "IRL249",
        "the VAR parameter 'count' of pick needs a variable, found a value in parentheses",
        "(i)",
    ),
    "pick(p, 3, four);": (
        "IRL249",
        "the VAR parameter 'count' of pick needs a variable, found a constant",
        "four",
    ),
    "pick(p, 3, x);": ("IRL222", "expected a variable of INT, found REAL", "x"),
    "grow(i, d);": ("IRL222", "expected a variable of REAL, found INT", "i"),
    "grow(x, p);": ("IRL222", "expected a variable of pair, found POSE", "p"),
    "above(p, b);": ("IRL222", "expected REAL, found BOOL", "b"),
    "pick(p, 3, spindle);": (
        "IRL249",
        "the VAR parameter 'count' of pick needs a variable, found an output",
        "spindle",
    ),
    "i;": ("IRL250", "'i' is a variable, not a procedure", "i"),
    "four(1);": ("IRL250", "'four' is a constant, not a procedure", "four"),
    "pick(p:3, 3, i);": ("IRL222", "expected a value without a layout, found one with :width", "p:3"),
    # RETURN
    "RETURN 1;": ("IRL248", "RETURN gives a value, but the program has no result", "1"),
    # waiting, signals, files
    "WAIT b SEC;": ("IRL222", "expected REAL, found BOOL", "b"),
    "WAIT -1 SEC;": ("IRL505", "WAIT must be 0 or more, found -1", "-1"),
    "WAIT FOR x TIMEOUT 5 SEC;": ("IRL222", "expected BOOL, found REAL", "x"),
    "WAIT FOR b TIMEOUT s SEC;": ("IRL222", "expected REAL, found STRING", "s"),
    "WAIT FOR b TIMEOUT -5 SEC;": ("IRL505", "TIMEOUT must be 0 or more, found -5", "-5"),
    "lamp := 1;": ("IRL222", "expected BOOL, found INT", "1"),
    "spindle := b;": ("IRL222", "expected REAL, found BOOL", "b"),
    "i := gauge;": ("IRL222", "expected INT, found REAL", "gauge"),
    "OPEN(f, 'a');": ("IRL228", "OPEN takes 3 values, found 2", "OPEN(f, 'a')"),
    "OPEN(s, 'a', 'READ');": ("IRL222", "expected a variable of FILE, found STRING", "s"),
    "OPEN(f, 1, 'READ');": ("IRL222", "expected STRING, found INT", "1"),
    "OPEN(f, 'a', 'RAED');": (
        "IRL505",
        "the mode of OPEN must be 'READ', 'WRITE' or 'APPEND', found 'RAED'",
        "'RAED'",
    ),
    "CLOSE(i);": ("IRL222", "expected a variable of FILE, found INT", "i"),
    "READ(f);": ("IRL228", "READ takes a variable, found none", "READ(f)"),
    "READ(f, 3);": ("IRL249", "READ needs a variable, found a number", "3"),
    "READ(f, four);": ("IRL249", "READ needs a variable, found a constant", "four"),
    "READ(p);": ("IRL222", "expected INT, REAL, CHAR, STRING or BOOL, found POSE", "p"),
    "WRITE(p);": ("IRL222", "expected INT, REAL, CHAR, STRING or BOOL, found POSE", "p"),
    "WRITE(x:2.5);": ("IRL222", "expected INT, found REAL", "2.5"),
    "WRITE(s:8:2);": ("IRL222", "expected a number before :width:precision, found STRING", "s"),
    # targets
    "MOVE LIN x;": ("IRL222", f"expected {TARGETS}, found REAL", "x"),
    "MOVE LIN p, o;": ("IRL222", f"expected {TARGETS}, found ORIENTATION", "o"),
    "MOVE LIN way;": ("IRL222", f"expected {TARGETS}, found ARRAY [1..4] OF POSE", "way"),
    "MOVE LIN (600, 0, TRUE);": ("IRL222", "expected REAL, found BOOL", "TRUE"),
    "MOVE LIN ((600, 0), o);": ("IRL223", "POSITION takes 3 values, found 2", "(600, 0)"),
    "MOVE LIN (p, o);": ("IRL222", "expected POSITION, found POSE", "p"),
    "MOVE LIN (v, o, v, o);": (
        "IRL222",
        "expected POSE or POSITION or MAIN_JOINT, found 4 values",
        "(v, o, v, o)",
    ),
    "MOVE LIN lo;": ("IRL222", f"expected {TARGETS}, found MAIN_JOINT_MIN", "lo"),
    "MOVE LIN PATH (p, x);": ("IRL222", f"expected {TARGETS}, found REAL", "x"),
    "MOVE LIN PATH bands;": ("IRL222", f"expected {TARGETS}, found ARRAY [1..6] OF REAL", "bands"),
    "MOVE_INC LIN rt;": ("IRL222", "expected POSE or POSITION or MAIN_JOINT or JOINT, found ROBTARGET", "rt"),
    "MOVE_INC LIN PATH (p, m);": ("IRL222", "expected POSE or POSITION, found MAIN_JOINT", "m"),
    "MOVE LIN p C_CP := -1;": ("IRL505", "C_CP must be 0 or more, found -1", "-1"),
    "MOVE PTP p C_PTP := 101;": ("IRL505", "C_PTP must be at most 100 %, found 101", "101"),
    "MOVE PTP p C_PASS := 1;": ("IRL222", "expected BOOL, found INT", "1"),
    "MOVE LIN p OVERRIDE := 0;": ("IRL505", "OVERRIDE must be greater than 0, found 0", "0"),
    "MOVE LIN p OVERRIDE := 100.5;": ("IRL505", "OVERRIDE must be at most 100 %, found 100.5", "100.5"),
    "MOVE LIN p JERK := -1.0;": ("IRL505", "JERK must be 0 or more, found -1", "-1.0"),
    "R_C_PASS := 1;": ("IRL222", "expected BOOL, found INT", "1"),
    "R_PROFILE := TRUE;": ("IRL222", "expected STRING, found BOOL", "TRUE"),
    "R_JBD.LOWER.A1.MIN := 1;": (
        "IRL211",
        "'R_JBD' is a system variable that only the robot sets and cannot be set",
        "R_JBD",
    ),
    "R_MOVE_TIME := 1;": (
        "IRL211",
        "'R_MOVE_TIME' is a system variable that only the robot sets and cannot be set",
        "R_MOVE_TIME",
    ),
    "grow(R_TOOL.POS.X, d);": (
        "IRL249",
        "the VAR parameter 'r' of grow needs a variable, found a system variable that the robot follows",
        "R_TOOL.POS.X",
    ),
    "FOR R_WEIGHTS[1] := 1 TO 3 DO x := 1; ENDFOR;": (
        "IRL249",
        "this statement needs a variable, found a system variable that the robot follows",
        "R_WEIGHTS[1]",
    ),
    "MOVE LIN PATH (p, v) WITH RECONFIGURATION ms;": (
        "IRL405",
        "2 target(s), but 4 posture(s) after RECONFIGURATION",
        "WITH RECONFIGURATION ms",
    ),
    "MOVE LIN PATH way WITH RECONFIGURATION m;": (
        "IRL405",
        "4 target(s), but 1 posture(s) after RECONFIGURATION",
        "WITH RECONFIGURATION m",
    ),
    # parameters
    "MOVE LIN p SPEED := b;": ("IRL222", "expected REAL, found BOOL", "b"),
    "MOVE LIN p SPEED := 0;": ("IRL505", "SPEED must be greater than 0, found 0", "0"),
    "MOVE LIN p ACC := -5;": ("IRL505", "ACC must be greater than 0, found -5", "-5"),
    "MOVE PTP p SPEED_PTP := 120;": ("IRL505", "SPEED_PTP must be at most 100 %, found 120", "120"),
    "MOVE LIN p C_PASS := 1;": ("IRL222", "expected BOOL, found INT", "1"),
    "MOVE LIN p PROFILE := 1;": ("IRL222", "expected STRING, found INT", "1"),
    "MOVE LIN p PROFILE := 'S';": (
        "IRL505",
        "PROFILE must be 'TRAPEZOID' or 'S_CURVE', found 'S'",
        "'S'",
    ),
    "MOVE CIRCLE v, p ANGLE := 0;": ("IRL505", "ANGLE must be other than 0, found 0", "0"),
    "MOVE CIRCLE v, p CIRC_ORI := 'MID';": (
        "IRL505",
        "CIRC_ORI must be 'VIA' or 'END', found 'MID'",
        "'MID'",
    ),
    # redundancy
    "JOINTLIMIT hi, lo; JOINTLIMITEND;": (
        ("IRL222", "expected MAIN_JOINT_MIN, found MAIN_JOINT_MAX", "hi"),
        ("IRL222", "expected MAIN_JOINT_MAX, found MAIN_JOINT_MIN", "lo"),
    ),
    "JOINTSPEEDLIMIT lo, shi; JOINTSPEEDLIMITEND;": (
        "IRL222",
        "expected MAIN_JOINT_SPEED_MIN, found MAIN_JOINT_MIN",
        "lo",
    ),
    "MOVE LIN p WITH JOINTACCELLIMIT alo, shi;": (
        "IRL222",
        "expected MAIN_JOINT_ACCEL_MAX, found MAIN_JOINT_SPEED_MAX",
        "shi",
    ),
    "MOVE LIN p WITH RECONFIGURATION p;": ("IRL222", "expected MAIN_JOINT or JOINT, found POSE", "p"),
    "RECONFIGURATION v;": ("IRL222", "expected MAIN_JOINT or JOINT, found POSITION", "v"),
    "RECONFIGURATION (1, 2, v);": ("IRL222", "expected MAIN_JOINT or JOINT, found 3 values", "(1, 2, v)"),
    "FREEZESTART x; FREEZEEND;": ("IRL222", "expected INT, found REAL", "x"),
    "FREEZESTART 1, 2.5; FREEZEEND;": ("IRL222", "expected INT, found REAL", "2.5"),
    "CRITERION c WEIGHT := b; CRITERIONEND c;": ("IRL222", "expected REAL, found BOOL", "b"),
    "MOVE LIN p WITH CRITERION c WEIGHT := 0;": ("IRL505", "WEIGHT must be greater than 0, found 0", "0"),
    "MOVE LIN p WITH TOLERANCE (1, 2, 3);": ("IRL223", "TOLERANCE takes 6 values, found 3", "(1, 2, 3)"),
    "MOVE LIN p WITH TOLERANCE (0, 0, 0, 0, 0, b);": ("IRL222", "expected REAL, found BOOL", "b"),
    "MOVE LIN p WITH TOLERANCE way;": (
        "IRL222",
        "expected 6 values for TOLERANCE, found ARRAY [1..4] OF POSE",
        "way",
    ),
    # system variables
    "R_SPEED := b;": ("IRL222", "expected REAL, found BOOL", "b"),
    "R_TOOL := v;": ("IRL222", "expected POSE, found POSITION", "v"),
    "R_JOINT_ACT := jt;": (
        "IRL211",
        "'R_JOINT_ACT' is a system variable that only the robot sets and cannot be set",
        "R_JOINT_ACT",
    ),
}


@pytest.mark.req("LANG-24")
@pytest.mark.req("LANG-40")
@pytest.mark.req("LANG-41")
@pytest.mark.req("LANG-42")
@pytest.mark.req("LANG-43")
@pytest.mark.req("LANG-50")
@pytest.mark.req("LANG-51")
@pytest.mark.req("LANG-60")
@pytest.mark.parametrize("statement", BAD)
def test_wrongly_typed(told_of, statement):
    wanted = BAD[statement]
    assert told_of(program(statement)) == ([wanted] if isinstance(wanted[0], str) else list(wanted))


@pytest.mark.req("LANG-24")
@pytest.mark.parametrize(
    ("joints", "statement", "wanted"),
    [
        (3, "MOVE LIN (100, 200, 300);", [("IRL229", "these values could be POSITION or MAIN_JOINT")]),
        (3, "MOVE LIN POSITION(100, 200, 300);", []),
        (4, "MOVE LIN (100, 200, 300);", []),
        (4, "MOVE PTP (1, 2, 3, 4);", []),
        (
            4,
            "MOVE PTP (1, 2, 3, 4, 5);",
            [("IRL222", "expected POSE or POSITION or MAIN_JOINT, found 5 values")],
        ),
        (4, "MOVE PTP (1, 2);", [("IRL222", "expected POSE or POSITION or MAIN_JOINT, found 2 values")]),
        (4, "FREEZESTART 4; FREEZEEND;", []),
        (4, "FREEZESTART 5; FREEZEEND;", [("IRL346", "FREEZESTART names joint 5")]),
        (4, "RECONFIGURATION (1, 2, 3);", [("IRL222", "expected MAIN_JOINT or JOINT, found 3 values")]),
        (4, "m := (1, 2, 3);", [("IRL223", "MAIN_JOINT takes 4 values, found 3")]),
        (4, "lo := (1, 2, 3, 4);", []),
        (4, "m.A5 := 1;", [("IRL225", "MAIN_JOINT has no field 'A5'")]),
    ],
)
@pytest.mark.parametrize("by", ["cell", "program"])
def test_joints_are_counted_where_their_number_is_known(joints, statement, wanted, by):
    """The cell tells it, or the program that defines MAIN_JOINT."""
    names = tuple(f"j{number}" for number in range(joints))
    fields = ", ".join(f"A{number}" for number in range(1, joints + 1))
    define = f"TYPE RECORD REAL: {fields}; ENDRECORD = MAIN_JOINT;" if by == "program" else ""
    text = f"PROGRAM t; {define} VAR MAIN_JOINT: m; MAIN_JOINT_MIN: lo; BEGIN {statement} ENDPROGRAM"
    found = analyse(source_text("t.irl", text), joints=names if by == "cell" else ())
    assert [(d.code, d.message.split(";")[0]) for d in found.diagnostics] == wanted


def test_a_wrong_call_shows_the_declaration():
    text = program("pick(p);")
    (found,) = analyse(source_text("t.irl", text)).diagnostics
    (related,) = found.related
    assert (found.code, related.message) == ("IRL228", "declared here")
    assert text[related.place.span.start :].startswith("pick(IN POSE: at")


def test_help_where_a_whole_number_is_expected():
    (found,) = analyse(source_text("t.irl", program("i := x / 2;"))).diagnostics
    assert found.help == "ROUND and TRUNC make whole numbers, DIV divides them"


# ---- inside routines

ROUTINES = {
    "PROCEDURE q; BEGIN RETURN 1; ENDPROC;": [
        ("IRL248", "RETURN gives a value, but the procedure q has no result", "1")
    ],
    "FUNCTION q: REAL; BEGIN RETURN; ENDFCT;": [
        ("IRL247", "RETURN of the function q needs a value of type REAL", "RETURN")
    ],
    "FUNCTION q: INT; BEGIN RETURN 2.5; ENDFCT;": [("IRL222", "expected INT, found REAL", "2.5")],
    "FUNCTION q: REAL; BEGIN RETURN 2; ENDFCT;": [],
    "FUNCTION q: POSITION; BEGIN RETURN (1, 2, 3); ENDFCT;": [],
    "FUNCTION q: POSITION; BEGIN RETURN (1, 2); ENDFCT;": [
        ("IRL223", "POSITION takes 3 values, found 2", "(1, 2)")
    ],
    "FUNCTION q(INT: n): INT; BEGIN RETURN n * q(n - 1); ENDFCT;": [],
    "FUNCTION q(INT: n): INT; BEGIN RETURN q(TRUE); ENDFCT;": [
        ("IRL222", "expected INT, found BOOL", "TRUE")
    ],
    "PROCEDURE q(REAL: r); BEGIN r := 3; later(r); ENDPROC; PROCEDURE later(REAL: r); BEGIN ENDPROC;": [],
    "PROCEDURE q(REAL: r); BEGIN later(TRUE); ENDPROC; PROCEDURE later(REAL: r); BEGIN ENDPROC;": [
        ("IRL222", "expected REAL, found BOOL", "TRUE")
    ],
    "PROCEDURE q; VAR INT: n := 2.5; BEGIN n := 1; ENDPROC;": [("IRL222", "expected INT, found REAL", "2.5")],
    "PROCEDURE q; CONST INT: n := 3; VAR ARRAY [1..n] OF INT: a; BEGIN a[4] := 1; ENDPROC;": [
        ("IRL504", "index 4 of 'a' is outside 1..3", "4")
    ],
    "PROCEDURE q; TYPE RECORD INT: n; ENDRECORD = own; VAR own: a; BEGIN a.m := 1; ENDPROC;": [
        ("IRL225", "own has no field 'm'", ".m")
    ],
    "PROCEDURE q; VAR BOOL: x; BEGIN x := TRUE; ENDPROC;": [
        ("IRL213", "'x' hides a name of the program", "x")
    ],
    "PROCEDURE q(VAR BOOL: x); BEGIN x := 1; ENDPROC;": [
        ("IRL213", "'x' hides a name of the program", "x"),
        ("IRL222", "expected BOOL, found INT", "1"),
    ],
    "PROCEDURE q(SIGNALS: x); BEGIN ENDPROC;": [
        ("IRL204", "unknown type 'SIGNALS'; did you mean 'SIGNAL'?", "SIGNALS"),
        ("IRL213", "'x' hides a name of the program", "x"),
    ],
}


@pytest.mark.req("LANG-11")
@pytest.mark.parametrize("routine", ROUTINES)
def test_routines(told_of, routine):
    text = f"PROGRAM t; VAR REAL: x; {routine} BEGIN x := 1; ENDPROGRAM"
    assert sorted(told_of(text)) == sorted(ROUTINES[routine])


def test_deeply_nested_statements(told_of):
    depth = 60
    text = "IF b THEN " * depth + "i := 2.5;" + " ENDIF;" * depth
    assert told_of(program(text)) == [("IRL222", "expected INT, found REAL", "2.5")]
