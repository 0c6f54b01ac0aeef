"""System variables about the robot: weights, bounds, and what the last move was like."""

from math import inf, radians

import pytest

from irlx.blocks import AskJointBounds, AskLastMove, Question, WeightsBlock
from irlx.interpreter.setting import Setting
from irlx.language.analysis import analyse
from irlx.language.source import source_text


@pytest.mark.req("LANG-52")
def test_weights(blocks):
    body = """R_WEIGHTS := (1, 2.5, 3); R_WEIGHTS[2] := R_WEIGHTS[2] * 2; R_WEIGHTS[3] := 3; MOVE LIN p;
    w := R_WEIGHTS; w[1] := 7; R_WEIGHTS := w; w[1] := 8;"""
    found = blocks("VAR ARRAY [1..3] OF REAL: w; POSITION: p := (1, 2, 3);", body, joints=3)
    assert [block.weights for block in found if isinstance(block, WeightsBlock)] == [
        (1.0, 2.5, 3.0),
        (1.0, 5.0, 3.0),
        (7.0, 5.0, 3.0),
    ]
    assert [block.id for block in found] == [1, 2, 3, 4]


@pytest.mark.req("LANG-52")
@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("R_WEIGHTS[2] := 0;", ("IRL505", "R_WEIGHTS[2] must be greater than 0, found 0", "0")),
        (
            "R_WEIGHTS := (1, 2, -3);",
            ("IRL505", "R_WEIGHTS[3] must be greater than 0, found -3", "(1, 2, -3)"),
        ),
        ("R_WEIGHTS := (1, 2);", ("IRL223", "ARRAY [1..3] OF REAL takes 3 values, found 2", "(1, 2)")),
        ("R_WEIGHTS[4] := 1;", ("IRL504", "index 4 of 'R_WEIGHTS' is outside 1..3", "4")),
        (
            "R_JBD.LOWER.A1.MIN := 1;",
            ("IRL211", "'R_JBD' is a constant and cannot be set", "R_JBD.LOWER.A1.MIN"),
        ),
        ("R_MOVE_TIME := 1;", ("IRL211", "'R_MOVE_TIME' is a constant and cannot be set", "R_MOVE_TIME")),
        ("x := R_JBD.MIDDLE.A1;", ("IRL225", "JOINT_BOUNDS has no field 'MIDDLE.A1'", ".MIDDLE")),
    ],
)
def test_what_does_not_fit(run_error, body, expected):
    code, message, marked = run_error("VAR REAL: x;", body, joints=3)
    assert (code, message.split(";")[0], marked) == expected


@pytest.mark.req("LANG-52")
def test_the_first_weights_are_those_of_the_cell():
    from irlx.interpreter.interpret import Interpretation

    text = "PROGRAM t; VAR REAL: x; BEGIN x := R_WEIGHTS[2]; ENDPROGRAM"
    analysis = analyse(source_text("t.irl", text))
    defaults = dict.fromkeys(
        ("R_SPEED", "R_ACC", "R_SPEED_ORI", "R_ACC_ORI", "R_SPEED_PTP", "R_ACC_PTP"), 1.0
    )
    setting = Setting(("a", "b"), (False, False), defaults, weights=(4.0, 9.0))
    ready = Interpretation(analysis.tree, analysis.source, setting)
    assert list(ready.run()) == []
    assert ready.scope.variables["x"].value == 9.0


def asked(generator, body, answers, **machine):
    """Kinds of the questions of a program, and its blocks."""
    source = generator(f"PROGRAM t; VAR REAL: x, y; MAIN_JOINT_MIN: lo; BEGIN {body} ENDPROGRAM", **machine)
    kinds, found, reply = [], [], None
    while True:
        try:
            item = source.send(reply)
        except StopIteration:
            return kinds, found
        reply = None
        if isinstance(item, Question):
            kinds.append(type(item))
            reply = answers[type(item)]
        else:
            found.append(item)


@pytest.mark.req("LANG-52")
def test_the_last_move(generator):
    body = """MOVE LIN POSITION(1, 2, 3); x := R_MOVE_TIME; y := R_DISTANCE_BACK - R_DISTANCE_FORW;
    MOVE LIN POSITION(x, y, R_DISTANCE_FORW);"""
    kinds, (_, move) = asked(generator, body, {AskLastMove: (1.25, 0.5, 0.125)})
    assert kinds == [AskLastMove] * 4
    assert move.target.position == (0.00125, 0.375, 0.125)


@pytest.mark.req("LANG-52")
def test_bounds_in_the_units_of_the_program(generator):
    answer = (radians(-90), -0.5, -inf, radians(45), 0.25, inf)
    body = """lo := R_JBD.LOWER; JOINTLIMIT lo, R_JBD.UPPER; MOVE LIN
    POSITION(lo.A2.MIN, R_JBD.UPPER.A2.MAX, 0);
    x := R_JBD.UPPER.A3.MAX; IF x = 1E30 THEN HALT; ENDIF;"""
    kinds, found = asked(generator, body, {AskJointBounds: answer}, joints=3, slides=(2,))
    assert kinds == [AskJointBounds] * 4
    limit, move, halt = found
    assert limit.range.lower[:2] == pytest.approx(answer[:2], abs=1e-15)
    assert limit.range.upper[:2] == pytest.approx(answer[3:5], abs=1e-15)
    assert move.target.position == (-0.5, 0.25, 0.0)
    assert type(halt).__name__ == "HaltBlock"


@pytest.mark.req("LANG-52")
def test_bounds_have_the_types_of_the_program(generator):
    text = """PROGRAM t; TYPE RECORD REAL: q1.low, q2.low; ENDRECORD = MAIN_JOINT_MIN; VAR REAL: x;
    BEGIN x := R_JBD.LOWER.q2.low; MOVE LIN POSITION(x, 0, 0); ENDPROGRAM"""
    analysis = analyse(source_text("t.irl", text))
    assert not analysis.has_errors, analysis.diagnostics
    source = generator(text, joints=2)
    assert isinstance(next(source), AskJointBounds)
    assert source.send((0.0, radians(30), 1.0, 1.0)).target.position[0] == pytest.approx(0.03)


@pytest.mark.req("LANG-52")
def test_constants_cannot_ask(run_error):
    code, message, _ = run_error("CONST REAL: x := R_MOVE_TIME;", "")
    assert (code, "the system variable R_MOVE_TIME in a constant" in message) == ("IRL590", True)
