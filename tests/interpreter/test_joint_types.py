"""MAIN_JOINT and its kin: predefined for the robot, or defined by the program."""

import pytest

OWN = "TYPE RECORD REAL: left, mid, right; ENDRECORD = MAIN_JOINT;"


@pytest.mark.req("LANG-22")
def test_predefined_types_have_one_field_a_joint(lines):
    declarations = "VAR MAIN_JOINT: j := (10, 20, 30, 40); MAIN_JOINT_SPEED_MAX: s;"
    statements = "j.A4 := j.a1 + 1; MOVE PTP j; s.a1.s.max := 1;"
    (line,) = lines(declarations, statements, joints=4)
    assert line == "1 MOVE PTP to joints (10 20 30 11) speed_ptp 100 % acc_ptp 100 % line 4"


@pytest.mark.req("LANG-23")
def test_a_program_names_the_joints(lines):
    declarations = OWN + "VAR MAIN_JOINT: j := (1, 2, 3);"
    (line,) = lines(declarations, "j.mid := 5; MOVE PTP j;", joints=3)
    assert line == "1 MOVE PTP to joints (1 5 3) speed_ptp 100 % acc_ptp 100 % line 4"


@pytest.mark.req("LANG-23")
@pytest.mark.parametrize(
    "suffix", ["", "_MIN", "_MAX", "_SPEED_MIN", "_SPEED_MAX", "_ACCEL_MIN", "_ACCEL_MAX"]
)
@pytest.mark.parametrize(("form", "found"), [("RECORD REAL: a, b; ENDRECORD", 2), ("REAL", 1)])
def test_a_joint_type_with_a_wrong_number_of_fields(run_error, suffix, form, found):
    name = f"MAIN_JOINT{suffix}"
    code, message, text = run_error(f"TYPE {form} = {name};", "", joints=3)
    assert (code, text) == ("IRL221", name)
    assert message == f"type {name} is defined with {found} fields, but the robot has 3 joints"


@pytest.mark.req("LANG-23")
@pytest.mark.req("LANG-68")
def test_limit_types_with_dotted_fields(lines):
    declarations = """TYPE
    RECORD REAL: a1.min, a2.min, a3.min; ENDRECORD = MAIN_JOINT_MIN;
    RECORD REAL: a1.max, a2.max, a3.max; ENDRECORD = MAIN_JOINT_MAX;
    VAR MAIN_JOINT_MIN: lo := (-1, -2, -3); MAIN_JOINT_MAX: hi := (1., 2, 3);"""
    found = lines(declarations, "hi.a1.max := 9; JOINTLIMIT lo, hi; JOINTLIMITEND;", joints=3)
    assert found == ["1 JOINTLIMIT (-1 -2 -3) (9 2 3) line 7", "2 JOINTLIMITEND line 7"]


@pytest.mark.req("LANG-23")
@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("JOINTLIMIT hi, lo;", ("IRL222", "expected MAIN_JOINT_MIN, found MAIN_JOINT_MAX", "hi")),
        (
            "JOINTSPEEDLIMIT lo, (1, 1, 1);",
            ("IRL222", "expected MAIN_JOINT_SPEED_MIN, found MAIN_JOINT_MIN", "lo"),
        ),
        ("JOINTLIMIT (1, 2), hi;", ("IRL223", "MAIN_JOINT_MIN takes 3 values, found 2", "(1, 2)")),
        ("lo := j;", ("IRL222", "expected MAIN_JOINT_MIN, found MAIN_JOINT", "j")),
    ],
)
def test_joint_types_are_not_interchangeable(run_error, statement, expected):
    declarations = (
        "VAR MAIN_JOINT: j := (1, 2, 3); MAIN_JOINT_MIN: lo := (0, 0, 0); MAIN_JOINT_MAX: hi := (1, 1, 1);"
    )
    assert run_error(declarations, statement, joints=3) == expected


@pytest.mark.req("LANG-23")
@pytest.mark.parametrize(
    "statements",
    [
        "c.m_joint := j; MOVE PTP c;",
        "j := R_JOINT_ACT.M_JOINT; MOVE PTP j;",
        "MOVE PTP R_JOINT_ACT;j := R_JOINT_ACT.M_JOINT;",
    ],
)
def test_joint_follows_the_programs_own_main_joint(lines, statements):
    assert len(lines(OWN + "VAR JOINT: c; MAIN_JOINT: j := (1, 2, 3);", statements, joints=3)) == 1


@pytest.mark.req("LANG-23")
@pytest.mark.parametrize(("field", "value"), [("POSITION", "(1, 2, 3)"), ("BOOL", "TRUE"), ("STRING", "'a'")])
def test_fields_of_a_joint_type_are_numbers(run_error, field, value):
    declarations = f"TYPE RECORD {field}: a, b, c; ENDRECORD = MAIN_JOINT;"
    declarations += f" VAR MAIN_JOINT: j := ({value}, {value}, {value});"
    message = f"expected REAL for a field of MAIN_JOINT, found {field}"
    assert run_error(declarations, "MOVE PTP j;", joints=3) == ("IRL222", message, field)
