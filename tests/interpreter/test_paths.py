"""PATH, SPLINE and MOVE_INC: the blocks they become."""

from math import radians

import pytest

from irlx.blocks import JointIncrement, MoveKind, PoseIncrement

DECLARATIONS = """VAR POSITION: p := (1, 2, 3), q := (4, 5, 6), r := (7, 8, 9);
MAIN_JOINT: a := (1, 1), b := (2, 2); ARRAY [1..3] OF POSITION: way := (p, q, r);
ARRAY [0..1, 1..2] OF POSITION: grid := (p, q, r, p);
ARRAY [1..3] OF MAIN_JOINT: ks := (a, b, a); ARRAY [1..2] OF JOINT: js := (JOINT(a), JOINT(b));
POSE: d := ((0, 0, 10), ORIXYZ(0, 0, 90)); ROBTARGET: t := ROBTARGET(d);"""
LAW = "speed 250 mm/s acc 1000 mm/s2 speed_ori 90 deg/s acc_ori 180 deg/s2"


@pytest.fixture
def found(lines):
    """Lines without what all of them have."""

    def run(body, **machine):
        given = lines(DECLARATIONS, body, joints=2, **machine)
        return [line.replace(f" {LAW}", "").replace(" in R_BASE", "").replace(" kept", "") for line in given]

    return run


@pytest.mark.req("LANG-50")
@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("MOVE LIN PATH (p, q, r);", "1 MOVE LIN through (1 2 3) through (4 5 6) to (7 8 9)"),
        ("MOVE SPLINE PATH (p, q, r);", "1 MOVE SPLINE through (1 2 3) through (4 5 6) to (7 8 9)"),
        ("MOVE LIN PATH way;", "1 MOVE LIN through (1 2 3) through (4 5 6) to (7 8 9)"),
        ("MOVE LIN PATH (r, way);", "1 MOVE LIN through (7 8 9) through (1 2 3) through (4 5 6) to (7 8 9)"),
        ("MOVE LIN PATH grid;", "1 MOVE LIN through (1 2 3) through (4 5 6) through (7 8 9) to (1 2 3)"),
        ("MOVE SPLINE PATH ks;", "1 MOVE SPLINE through joints (1 1) through joints (2 2) to joints (1 1)"),
        ("MOVE LIN PATH (p, b);", "1 MOVE LIN through (1 2 3) to joints (2 2)"),
        ("MOVE LIN PATH (p);", "1 MOVE LIN to (1 2 3)"),
        ("MOVE SPLINE PATH (way[2]);", "1 MOVE LIN to (4 5 6)"),
        (
            "MOVE LIN PATH (p, q) WITH RECONFIGURATION (a, b);",
            "1 MOVE LIN through (1 2 3) to (4 5 6) WITH RECONFIGURATION (1 1) (2 2)",
        ),
        (
            "MOVE SPLINE PATH way WITH RECONFIGURATION ks;",
            "1 MOVE SPLINE through (1 2 3) through (4 5 6) to (7 8 9) WITH RECONFIGURATION (1 1) (2 2) (1 1)",
        ),
        (
            "MOVE SPLINE PATH way WITH RECONFIGURATION (b, js);",
            "1 MOVE SPLINE through (1 2 3) through (4 5 6) to (7 8 9) WITH RECONFIGURATION (2 2) (1 1) (2 2)",
        ),
        (
            "MOVE SPLINE PATH (p) WITH RECONFIGURATION (a);",
            "1 MOVE LIN to (1 2 3) WITH RECONFIGURATION (1 1)",
        ),
    ],
)
def test_paths(found, statement, expected):
    assert found(statement) == [f"{expected} line 8"]


@pytest.mark.req("LANG-68")
@pytest.mark.parametrize(
    ("statement", "targets", "postures"),
    [
        ("MOVE LIN PATH way WITH RECONFIGURATION js;", 3, 2),
        ("MOVE LIN PATH (p, q) WITH RECONFIGURATION ks;", 2, 3),
        ("MOVE SPLINE PATH way WITH RECONFIGURATION a;", 3, 1),
    ],
)
def test_a_posture_for_each_point(run_error, statement, targets, postures):
    code, message, marked = run_error(DECLARATIONS, statement, joints=2)
    assert code == "IRL405"
    assert message == f"{targets} target(s), but {postures} posture(s) after RECONFIGURATION"
    assert marked.startswith("WITH RECONFIGURATION")


@pytest.mark.req("LANG-50")
def test_an_array_that_is_not_taught(run_error):
    code, message, marked = run_error("VAR ARRAY [1..2] OF POSE: w;", "MOVE LIN PATH w;")
    assert (code, message, marked) == ("IRL501", "'w' has no value yet", "w")


@pytest.mark.req("LANG-50")
@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("MOVE_INC LIN p;", ["1 MOVE LIN to on by (1 2 3)"]),
        ("MOVE_INC LIN p, q;", ["1 MOVE LIN to on by (1 2 3)", "2 MOVE LIN to on by (4 5 6)"]),
        ("MOVE_INC LIN (0, 0, 5);", ["1 MOVE LIN to on by (0 0 5)"]),
        ("MOVE_INC LIN a;", ["1 MOVE LIN to on by joints (1 1)"]),
        ("MOVE_INC LIN js[2];", ["1 MOVE LIN to on by joints (2 2)"]),
        ("MOVE_INC CIRCLE p, q;", ["1 MOVE CIRCLE via on by (1 2 3) to on by (4 5 6)"]),
        (
            "MOVE_INC CIRCLE p, q ANGLE := 90;",
            ["1 MOVE CIRCLE via on by (1 2 3) to on by (4 5 6) angle 90 deg"],
        ),
        ("MOVE_INC LIN PATH (p, q);", ["1 MOVE LIN through on by (1 2 3) to on by (4 5 6)"]),
        (
            "MOVE_INC SPLINE PATH way;",
            ["1 MOVE SPLINE through on by (1 2 3) through on by (4 5 6) to on by (7 8 9)"],
        ),
        (
            "MOVE_INC LIN d;",
            ["1 MOVE LIN to on by (0 0 10) (0 0 0.7071067812 0.7071067812) in the tool"],
        ),
        (
            "MOVE_INC LIN p WITH RECONFIGURATION a;",
            ["1 MOVE LIN to on by (1 2 3) WITH RECONFIGURATION (1 1)"],
        ),
    ],
)
def test_increments(found, statement, expected):
    assert found(statement) == [f"{line} line 8" for line in expected]


@pytest.mark.req("LANG-25")
def test_units_of_increments(blocks):
    (first, second) = blocks(
        "", "MOVE_INC PTP POSITION(1500, 0, 0); MOVE_INC PTP (180, 500);", joints=2, slides=(2,)
    )
    assert first.kind is MoveKind.PTP
    assert first.target == PoseIncrement((1.5, 0.0, 0.0), None)
    assert second.target == JointIncrement((radians(180), 0.5))


@pytest.mark.req("LANG-50")
@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        (
            "MOVE_INC LIN t;",
            ("IRL222", "expected POSE or POSITION or MAIN_JOINT or JOINT, found ROBTARGET", "t"),
        ),
        ("MOVE_INC LIN PATH (p, a);", ("IRL222", "expected POSE or POSITION, found MAIN_JOINT", "a")),
        ("MOVE_INC LIN 5;", ("IRL222", "expected POSE or POSITION or MAIN_JOINT or JOINT, found INT", "5")),
        (
            "MOVE_INC LIN PATH ks;",
            ("IRL222", "expected POSE or POSITION, found ARRAY [1..3] OF MAIN_JOINT", "ks"),
        ),
    ],
)
def test_what_is_no_increment(run_error, statement, expected):
    assert run_error(DECLARATIONS, statement, joints=2) == expected
