"""MOVE CIRCLE: pairs of targets become arcs, with ANGLE and CIRC_ORI."""

from math import pi, radians

import pytest

from irlx.blocks import ArcCourse, JointTarget, MoveKind, PoseTarget
from irlx.language.analysis import analyse
from irlx.language.source import source_text

pytestmark = [pytest.mark.req("LANG-50"), pytest.mark.req("LANG-51")]

POINTS = """VAR POSITION: a := (1, 2, 3), b := (4, 5, 6), c := (7, 8, 9);
POSE: p := ((10, 20, 30), ORIZYX(0, 0, 180));"""


def test_a_pair_is_one_move(blocks):
    (move,) = blocks(POINTS, "MOVE CIRCLE a, p SPEED := 50;")
    assert move.kind is MoveKind.CIRCLE
    assert move.course == ArcCourse(PoseTarget((0.001, 0.002, 0.003), None))
    assert move.target.position == (0.01, 0.02, 0.03)
    assert move.target.orientation == pytest.approx((1.0, 0.0, 0.0, 0.0), abs=1e-15)
    assert move.law.speed == 0.05


def test_several_pairs_are_several_moves(blocks):
    body = "MOVE CIRCLE a, b, c, p ANGLE := 90;"
    first, second = blocks(POINTS, body)
    assert (first.id, second.id) == (1, 2)
    assert [m.course.via.position[0] for m in (first, second)] == [0.001, 0.007]
    assert [m.target.position[0] for m in (first, second)] == [0.004, 0.01]
    assert {m.course.angle for m in (first, second)} == {pi / 2}
    # Each is placed on its own pair.
    assert first.origin.end - first.origin.start == len("a, b")
    assert second.origin.start - first.origin.start == len("a, b, ")


@pytest.mark.parametrize(
    ("params", "angle", "through"),
    [
        ("", None, False),
        ("ANGLE := 360", 2 * pi, False),
        ("ANGLE := 1080.", 6 * pi, False),
        ("ANGLE := -45", -pi / 4, False),
        ("CIRC_ORI := 'VIA'", None, True),
        ("circ_ori := 'via', ANGLE := 400", radians(400), True),
        ("CIRC_ORI := 'END'", None, False),
    ],
)
def test_parameters(blocks, params, angle, through):
    (move,) = blocks(POINTS, f"MOVE CIRCLE a, b {params};")
    assert (move.course.angle, move.course.turns_through_via) == (angle, through)


@pytest.mark.req("LANG-69")
def test_joint_values_as_via_and_end(blocks):
    (move,) = blocks(
        "", "MOVE CIRCLE (90, 1500, 0, 0), R_JOINT_ACT;", joints=4, slides=(2,), posture=(1, 2, 3, 4)
    )
    assert move.course.via == JointTarget((radians(90), 1.5, 0.0, 0.0))
    assert move.target.values == pytest.approx((1.0, 2.0, 3.0, 4.0), abs=1e-15)


@pytest.mark.parametrize(
    ("params", "expected"),
    [
        ("ANGLE := 0", ("IRL505", "ANGLE must be other than 0, found 0", "0")),
        ("ANGLE := TRUE", ("IRL222", "expected REAL, found BOOL", "TRUE")),
        ("CIRC_ORI := 'BOTH'", ("IRL505", "CIRC_ORI must be 'VIA' or 'END', found 'BOTH'", "'BOTH'")),
        ("CIRC_ORI := 1", ("IRL222", "expected STRING, found INT", "1")),
    ],
)
def test_parameters_out_of_range(run_error, params, expected):
    assert run_error(POINTS, f"MOVE CIRCLE a, b {params};") == expected


def test_what_the_text_line_says(lines):
    (line,) = lines(POINTS, "MOVE CIRCLE a, b ANGLE := 360 CIRC_ORI := 'VIA';")
    assert line.startswith(
        "1 MOVE CIRCLE via (1 2 3) kept in R_BASE to (4 5 6) kept in R_BASE "
        "turning through via angle 360 deg speed"
    )


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize(("param", "value"), [("ANGLE", "90"), ("CIRC_ORI", "'VIA'")])
@pytest.mark.parametrize("kind", ["LIN", "PTP"])
def test_parameters_of_a_circle_belong_to_circles(kind, param, value):
    text = (
        f"PROGRAM t;\nVAR POSITION: a := (1, 2, 3);\nBEGIN\n  MOVE {kind} a {param} := {value};\nENDPROGRAM"
    )
    found = [d for d in analyse(source_text("t.irl", text)).diagnostics if d.is_error]
    assert [(d.code, d.message) for d in found] == [("IRL404", f"{param} does not go with {kind}")]
