"""What only the machine can tell: FK, IK, MANIPULABILITY, where the robot is; asked once, in order."""

from math import pi, radians

import pytest

from irlx.blocks import (
    AskManipulability,
    AskNearestPosture,
    AskPose,
    AskPosture,
    AskPostureOf,
    MoveBlock,
    Question,
)

pytestmark = [pytest.mark.req("LANG-34"), pytest.mark.req("LANG-52")]

DECLARATIONS = """VAR POSITION: p := (1, 2, 3); MAIN_JOINT: j := (10, 20, 30), k; POSE: o; REAL: x;
INT: n := 0; ROBTARGET: t; JOINT: both := JOINT((1, 2, 3));
FUNCTION f(MAIN_JOINT: m): REAL; BEGIN n := n + 1; RETURN MANIPULABILITY(m) + n; ENDFCT;"""

ANSWERS = {
    AskPosture: (0.1, 1.5 * pi, -3.5 * pi),
    AskPose: (1.0, 2.0, 3.0, 0.0, 0.0, 1.0, 0.0),
    AskManipulability: (0.25,),
    AskPostureOf: (0.5, 0.6, 0.7),
    AskNearestPosture: (0.8, 0.9, 1.0),
}


@pytest.fixture
def asked(generator):
    """Questions and blocks of a body, in their order."""

    def run(body, declarations=DECLARATIONS):
        source = generator(f"PROGRAM t; {declarations} BEGIN {body} ENDPROGRAM", joints=3, slides=(1,))
        found, reply = [], None
        while True:
            try:
                found.append(source.send(reply))
            except StopIteration:
                return found
            reply = ANSWERS[type(found[-1])] if isinstance(found[-1], Question) else None

    return run


def test_fk(asked):
    question, move = asked("o := FK(j); MOVE LIN o;")
    assert question.posture == (0.01, radians(20), radians(30))
    assert move.target.position == (1.0, 2.0, 3.0)
    assert move.target.orientation == (0.0, 0.0, 1.0, 0.0)


def test_fk_takes_joint_values_of_either_kind(asked):
    first, second = asked(
        "o := FK(both); x := FK((1, 2, 3)).pos.x;".replace(".pos.x", "").replace("x :=", "o :=")
    )
    assert first.posture == second.posture == (0.001, radians(2), radians(3))


def test_ik(asked):
    question, move = asked("k := IK(p, j); MOVE PTP k;")
    assert isinstance(question, AskNearestPosture)
    assert (question.position, question.orientation) == ((0.001, 0.002, 0.003), None)
    assert question.near == (0.01, radians(20), radians(30))
    assert move.target.values == pytest.approx((0.8, 0.9, 1.0))


def test_manipulability(asked):
    question, move = asked("x := MANIPULABILITY(j) * 4; MOVE LIN POSITION(x, 0, 0);")
    assert isinstance(question, AskManipulability)
    assert move.target.position[0] == 0.001


def test_where_the_robot_is(asked):
    posture, pose, move = asked(
        "t := R_ROBTARGET_ACT; MOVE LIN t.pse + POSITION(t.turns[2], t.turns[3], t.status);"
    )
    assert isinstance(posture, AskPosture)
    assert pose.posture == ANSWERS[AskPosture]
    assert move.target.position == pytest.approx((1.001, 1.998, 3.0), abs=1e-12)


@pytest.mark.parametrize(
    ("degrees", "turns"),
    [(0, 0), (180, 0), (-180, 0), (180.001, 1), (540, 1), (-540, -1), (540.001, 2), (-900.001, -3)],
)
def test_turns_are_counted_beyond_half_a_turn(asked, monkeypatch, degrees, turns):
    monkeypatch.setitem(ANSWERS, AskPosture, (0.1, radians(degrees), 0.0))
    *_, move = asked("t := R_ROBTARGET_ACT; MOVE LIN POSITION(t.turns[2], 0, 0);")
    assert move.target.position[0] == pytest.approx(turns / 1000, abs=1e-12)


def test_loops_ask_again_in_every_round(asked):
    found = asked("WHILE R_JOINT_ACT.M_JOINT.A1 < 1 OR n < 2 DO n := n + 1; MOVE LIN p; ENDWHILE;")
    assert [type(item) for item in found] == [AskPosture, MoveBlock, AskPosture, MoveBlock, AskPosture]


def test_functions_that_ask_are_called_once(asked):
    found = asked("x := f(j) + f(k) * f(IK(p, j)); MOVE LIN POSITION(x, n, 0);".replace("f(k)", "f(j)"))
    kinds = [AskManipulability, AskManipulability, AskNearestPosture, AskManipulability, MoveBlock]
    assert [type(item) for item in found] == kinds
    assert found[-1].target.position == pytest.approx(((1.25 + 2.25 * 3.25) / 1000, 0.003, 0.0))


def test_what_is_not_needed_is_not_asked(asked):
    (move,) = asked("IF n = 1 AND MANIPULABILITY(j) > 0.1 THEN n := 5; ENDIF; MOVE LIN POSITION(n, 0, 0);")
    assert move.target.position[0] == 0.0


WRONG = [
    ("o := FK(p);", ("IRL222", "expected MAIN_JOINT or JOINT, found POSITION", "p")),
    ("k := IK(p);", ("IRL228", "IK takes 2 values, found 1", "IK(p)")),
    ("x := MANIPULABILITY();", ("IRL228", "MANIPULABILITY takes 1 value, found 0", "MANIPULABILITY()")),
    (
        "R_ROBTARGET_ACT.status := 1;",
        ("IRL211", "'R_ROBTARGET_ACT' is a constant and cannot be set", "R_ROBTARGET_ACT.status"),
    ),
]


@pytest.mark.parametrize(("body", "expected"), WRONG)
def test_wrong_uses(run_error, body, expected):
    assert run_error(DECLARATIONS, body, joints=3) == expected
