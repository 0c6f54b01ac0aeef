"""MOVE and the switches: the blocks they become, as text lines, in the units of the joints."""

from math import radians

import pytest

from irlx.blocks import AskPosture, MoveBlock
from irlx.language.analysis import analyse
from irlx.language.source import source_text

LAW = "speed 250 mm/s acc 1000 mm/s2 speed_ori 90 deg/s acc_ori 180 deg/s2"
SHARE = "speed_ptp 100 % acc_ptp 100 %"


@pytest.mark.req("LANG-50")
@pytest.mark.req("LANG-69")
@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("MOVE LIN POSITION(1, 2, 3);", f"1 MOVE LIN to (1 2 3) kept in R_BASE {LAW} line 4"),
        ("MOVE LIN ((1, 2, 3), (1, 0, 0, 0));", f"1 MOVE LIN to (1 2 3) (0 0 0 1) in R_BASE {LAW} line 4"),
        ("MOVE PTP (1, 2, 3);", f"1 MOVE PTP to (1 2 3) kept in R_BASE {SHARE} line 4"),
        ("MOVE PTP (1, 2, 3, 4);", f"1 MOVE PTP to joints (1 2 3 4) {SHARE} line 4"),
        ("MOVE PTP R_JOINT_ACT;", f"1 MOVE PTP to joints (0 0 0 0) {SHARE} line 4"),
        ("MOVE LIN (1, 2, 3, 4);", f"1 MOVE LIN to joints (1 2 3 4) {LAW} line 4"),
        ("CYCLICSTART;", "1 CYCLICSTART line 4"),
        ("CYCLICEND;", "1 CYCLICEND line 4"),
        ("FREEZESTART 2, 1 + 2;", "1 FREEZESTART 2, 3 line 4"),
        ("FREEZEEND;", "1 FREEZEEND line 4"),
        ("JOINTLIMIT (0, -1, -2, -3), (4, 5, 6, 7);", "1 JOINTLIMIT (0 -1 -2 -3) (4 5 6 7) line 4"),
        ("JOINTLIMITEND;", "1 JOINTLIMITEND line 4"),
        ("JOINTSPEEDLIMIT (0, -1, -2, -3), (4, 5, 6, 7);", "1 JOINTSPEEDLIMIT (0 -1 -2 -3) (4 5 6 7) line 4"),
        ("JOINTSPEEDLIMITEND;", "1 JOINTSPEEDLIMITEND line 4"),
        ("JOINTACCELLIMIT (0, -1, -2, -3), (4, 5, 6, 7);", "1 JOINTACCELLIMIT (0 -1 -2 -3) (4 5 6 7) line 4"),
        ("JOINTACCELLIMITEND;", "1 JOINTACCELLIMITEND line 4"),
        ("HALT;", "1 HALT line 4"),
        (
            "RECONFIGURATION (1, 2, 3, 4);",
            "1 RECONFIGURATION to joints (1 2 3 4) speed 250 mm/s speed_ori 90 deg/s line 4",
        ),
        (
            "RECONFIGURATION R_JOINT_ACT;",
            "1 RECONFIGURATION to joints (0 0 0 0) speed 250 mm/s speed_ori 90 deg/s line 4",
        ),
        (
            "MOVE PTP POSITION(1, 2, 3) WITH RECONFIGURATION (1, 2, 3, 4);",
            f"1 MOVE PTP to (1 2 3) kept in R_BASE {SHARE} WITH RECONFIGURATION (1 2 3 4) line 4",
        ),
    ],
)
def test_blocks_of_statements(lines, statement, expected):
    assert lines("", statement, joints=4) == [expected]


@pytest.mark.req("LANG-51")
def test_parameters_and_their_defaults(lines):
    statements = """R_SPEED := 100; R_ACC := R_SPEED * 2; R_SPEED_ORI := 45; R_ACC_ORI := 30;
    R_SPEED_PTP := 80; R_ACC_PTP := 20;
    MOVE LIN POSITION(1, 2, 3);
    MOVE LIN POSITION(1, 2, 3) SPEED := 50, ACC := 7 SPEED_ORI := 10 acc_ori := 20 TIME := 3;
    MOVE PTP POSITION(1, 2, 3);
    MOVE PTP POSITION(1, 2, 3) SPEED_PTP := 50 ACC_PTP := 100 TIME := 0.5;"""
    assert lines("", statements) == [
        "1 MOVE LIN to (1 2 3) kept in R_BASE speed 100 mm/s acc 200 mm/s2"
        " speed_ori 45 deg/s acc_ori 30 deg/s2 line 6",
        "2 MOVE LIN to (1 2 3) kept in R_BASE speed 50 mm/s acc 7 mm/s2"
        " speed_ori 10 deg/s acc_ori 20 deg/s2 time 3 s line 7",
        "3 MOVE PTP to (1 2 3) kept in R_BASE speed_ptp 80 % acc_ptp 20 % line 8",
        "4 MOVE PTP to (1 2 3) kept in R_BASE speed_ptp 50 % acc_ptp 100 % time 0.5 s line 9",
    ]


@pytest.mark.req("LANG-51")
def test_values_are_latched_when_the_statement_runs(lines):
    statements = (
        "x := 1; MOVE LIN POSITION(x, 0, 0) SPEED := x; x := 2; MOVE LIN POSITION(x, 0, 0) SPEED := x;"
    )
    first, second = lines("VAR REAL: x;", statements)
    assert "(1 0 0)" in first
    assert "speed 1 mm/s" in first
    assert "(2 0 0)" in second
    assert "speed 2 mm/s" in second


@pytest.mark.req("LANG-50")
def test_several_targets_are_several_moves(blocks):
    first, second = blocks("VAR POSITION: a := (1, 2, 3), b := (4, 5, 6);", "MOVE LIN a, b SPEED := 7;")
    assert (first.id, second.id) == (1, 2)
    assert first.target.position == (0.001, 0.002, 0.003)
    assert second.target.position == (0.004, 0.005, 0.006)
    assert first.law == second.law
    assert first.origin.end - first.origin.start == 1
    assert first.origin.start < second.origin.start


@pytest.mark.req("LANG-60")
def test_clauses_hold_for_every_target_of_the_move(blocks):
    statement = """MOVE LIN POSITION(1, 2, 3), POSITION(4, 5, 6)
    WITH JOINTLIMIT (-90, -1000), (90, 1000) WITH JOINTSPEEDLIMIT (-1, -1), (1, 1)
    WITH JOINTACCELLIMIT (-2, -2), (2, 2);"""
    found = blocks("", statement, joints=2, slides=(2,))
    for block in found:
        position, speed, acceleration = block.limits
        assert [clause.kind.value for clause in block.limits] == ["POSITION", "SPEED", "ACCELERATION"]
        assert position.range.lower == (radians(-90), -1.0)
        assert position.range.upper == (radians(90), 1.0)
        assert speed.range.upper == (radians(1), 0.001)
        assert acceleration.range.lower == (radians(-2), -0.002)
        assert (position.origin.line, acceleration.origin.line) == (5, 6)
    assert len(found) == 2


@pytest.mark.req("LANG-25")
def test_units(blocks):
    (move,) = blocks("", "MOVE PTP (180, 1500, -90, 0);", joints=4, slides=(2,))
    assert move.target.values == (radians(180), 1.5, radians(-90), 0.0)
    (move,) = blocks(
        "", "MOVE LIN ((1500, 0, 0), ORIXYZ(180, 0, 0)) SPEED := 250 ACC := 500 SPEED_ORI := 180;"
    )
    assert move.target.position == (1.5, 0.0, 0.0)
    assert move.target.orientation == pytest.approx((1.0, 0.0, 0.0, 0.0), abs=1e-15)
    assert (move.law.speed, move.law.acc, move.law.speed_ori) == (0.25, 0.5, radians(180))
    assert (move.law.speed_ptp, move.law.acc_ptp, move.law.duration) == (1.0, 1.0, None)


@pytest.mark.req("LANG-51")
@pytest.mark.parametrize(
    ("param", "value", "expected"),
    [
        ("SPEED", "0", "SPEED must be greater than 0, found 0"),
        ("SPEED", "-5", "SPEED must be greater than 0, found -5"),
        ("ACC", "0.0", "ACC must be greater than 0, found 0"),
        ("SPEED_ORI", "-1", "SPEED_ORI must be greater than 0, found -1"),
        ("ACC_ORI", "0", "ACC_ORI must be greater than 0, found 0"),
        ("TIME", "-2.5", "TIME must be greater than 0, found -2.5"),
        ("SPEED_PTP", "0", "SPEED_PTP must be greater than 0, found 0"),
        ("SPEED_PTP", "100.5", "SPEED_PTP must be at most 100 %, found 100.5"),
        ("ACC_PTP", "200", "ACC_PTP must be at most 100 %, found 200"),
    ],
)
def test_parameters_out_of_range(run_error, param, value, expected):
    assert run_error("", f"MOVE LIN POSITION(1, 2, 3) {param} := {value};") == ("IRL505", expected, value)


@pytest.mark.req("LANG-51")
def test_a_default_out_of_range_is_reported_at_the_move(run_error):
    expected = ("IRL505", "R_SPEED must be greater than 0, found 0", "MOVE LIN POSITION(1, 2, 3)")
    assert run_error("", "R_SPEED := 0; MOVE LIN POSITION(1, 2, 3);") == expected


@pytest.mark.req("LANG-24")
@pytest.mark.parametrize(
    ("statement", "joints", "expected"),
    [
        ("MOVE LIN (1, 2, 3);", 3, ("IRL229", "these values could be POSITION or MAIN_JOINT", "(1, 2, 3)")),
        (
            "MOVE LIN (1, 2);",
            3,
            ("IRL222", "expected POSE or POSITION or MAIN_JOINT or JOINT, found 2 values", "(1, 2)"),
        ),
        ("MOVE LIN 5;", 3, ("IRL222", "expected POSE or POSITION or MAIN_JOINT or JOINT, found INT", "5")),
        (
            "MOVE LIN ((1, 2, 3), (0, 0, 0, 2));",
            3,
            ("IRL230", "an orientation needs a quaternion of length 1, found length 2", "(0, 0, 0, 2)"),
        ),
        ("MOVE LIN POSITION(1, 2, 3) SPEED := TRUE;", 3, ("IRL222", "expected REAL, found BOOL", "TRUE")),
        ("FREEZESTART 2.5;", 3, ("IRL222", "expected INT, found REAL", "2.5")),
    ],
)
def test_targets_that_do_not_fit(run_error, statement, joints, expected):
    assert run_error("", statement, joints=joints) == expected


@pytest.mark.req("LANG-52")
def test_question_and_answer(generator):
    source = generator(
        """PROGRAM t; VAR MAIN_JOINT: j; BEGIN
    MOVE LIN POSITION(1, 2, 3);
    j := R_JOINT_ACT.M_JOINT;
    j.A2 := j.A2 + 10;
    MOVE PTP j;
    MOVE PTP R_JOINT_ACT;
    ENDPROGRAM""",
        joints=3,
        slides=(2,),
    )
    assert isinstance(next(source), MoveBlock)
    question = next(source)
    assert isinstance(question, AskPosture)
    assert question.origin.line == 3
    move = source.send((radians(30), 0.25, radians(-45)))
    assert move.target.values == pytest.approx((radians(30), 0.26, radians(-45)), abs=1e-15)
    assert isinstance(next(source), AskPosture)
    move = source.send((1.0, 2.0, 3.0))
    assert move.target.values == pytest.approx((1.0, 2.0, 3.0), abs=1e-15)
    with pytest.raises(StopIteration):
        next(source)


@pytest.mark.req("LANG-52")
def test_only_reading_the_posture_asks(generator):
    source = generator("PROGRAM t; BEGIN MOVE LIN POSITION(1, 2, 3); HALT; ENDPROGRAM")
    assert not any(isinstance(item, AskPosture) for item in source)


def test_nothing_follows_halt(lines):
    assert lines("", "CYCLICSTART; HALT; CYCLICEND;") == ["1 CYCLICSTART line 4", "2 HALT line 4"]


def test_blocks_before_an_error_stay_valid(generator):
    source = generator("PROGRAM t; VAR REAL: x; BEGIN CYCLICSTART; x := 1 / 0; ENDPROGRAM")
    assert next(source).active
    with pytest.raises(Exception, match="IRL502"):
        next(source)


@pytest.mark.req("LANG-52")
def test_poses_of_the_cell_are_constants(lines, run_error):
    poses = {"Fixture": ((600.0, 0.0, 0.0), (0.5, 0.5, 0.5, 0.5))}
    (line,) = lines("", "MOVE LIN fixture @ POSITION(0, 10, 0);", poses=poses)
    assert line.startswith("1 MOVE LIN to (600 0 10) kept")
    code, message, _ = run_error("", "fixture.pos.x := 3;", poses=poses)
    assert (code, message) == ("IRL211", "'Fixture' is a constant and cannot be set")


@pytest.mark.parametrize("declaration", ["VAR REAL: r_speed;", "VAR BOOL: R_SPEED := TRUE;"])
def test_declaring_a_system_variable(run_error, declaration):
    code, _, _ = run_error(declaration, "MOVE LIN POSITION(1, 2, 3);")
    assert code.startswith("IRL2")


@pytest.mark.req("LANG-68")
def test_one_posture_for_each_target(lines):
    variables = "VAR MAIN_JOINT: a := (1, 1, 1, 1), b := (2, 2, 2, 2); POSITION: p := (1, 2, 3);"
    first, second = lines(variables, "MOVE LIN p, p WITH RECONFIGURATION a, b;", joints=4)
    assert first.endswith("WITH RECONFIGURATION (1 1 1 1) line 4")
    assert second.endswith("WITH RECONFIGURATION (2 2 2 2) line 4")
    (arc,) = lines(variables, "MOVE CIRCLE p, p WITH RECONFIGURATION b;", joints=4)
    assert arc.endswith("WITH RECONFIGURATION (2 2 2 2) line 4")


@pytest.mark.req("LANG-62")
@pytest.mark.req("LANG-68")
def test_a_posture_for_each_target_of_a_circle_or_for_each_end(lines):
    variables = "VAR MAIN_JOINT: a := (1, 1, 1, 1), b := (2, 2, 2, 2); POSITION: p := (1, 2, 3);"
    (arc,) = lines(variables, "MOVE CIRCLE p, p WITH RECONFIGURATION a, b;", joints=4)
    assert arc.endswith("WITH RECONFIGURATION via (1 1 1 1) to (2 2 2 2) line 4")
    body = "MOVE CIRCLE p, p, p, p WITH RECONFIGURATION "
    found = lines(variables, f"{body}a, b; {body}a, b, b, a;", joints=4)
    assert [line.partition("RECONFIGURATION ")[2] for line in found] == [
        "(1 1 1 1) line 4",
        "(2 2 2 2) line 4",
        "via (1 1 1 1) to (2 2 2 2) line 4",
        "via (2 2 2 2) to (1 1 1 1) line 4",
    ]


@pytest.mark.req("LANG-62")
@pytest.mark.parametrize("count", [1, 3, 5])
def test_any_other_number_of_postures_is_told(count):
    postures = ", ".join(["j"] * count)
    text = "PROGRAM t; VAR MAIN_JOINT: j; POSE: p; BEGIN MOVE CIRCLE p, p, p, p WITH RECONFIGURATION "
    (found,) = analyse(source_text("t.irl", f"{text}{postures}; ENDPROGRAM")).diagnostics
    assert found.code == "IRL405"
    assert found.message == f"4 target(s), but {count} posture(s) after RECONFIGURATION"
    assert "for each via and end point or for each end point" in found.help


@pytest.mark.req("LANG-65")
def test_the_speeds_of_a_reconfiguration_are_latched(lines):
    (line,) = lines("", "R_SPEED := 10; R_SPEED_ORI := 5; RECONFIGURATION (1, 2, 3, 4);", joints=4)
    assert "speed 10 mm/s speed_ori 5 deg/s" in line


@pytest.mark.req("LANG-65")
@pytest.mark.parametrize("wrong", ["POSITION(1, 2, 3)", "(1, 2, 3)", "5"])
def test_a_reconfiguration_wants_a_posture(run_error, wrong):
    assert run_error("", f"RECONFIGURATION {wrong};", joints=4)[0] == "IRL222"
