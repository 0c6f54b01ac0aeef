"""POSTURE(pose): what is asked of the machine and when, and what becomes of the answer of a fake one."""

from math import radians, sqrt

import pytest

from irlx.blocks import AskPosture, AskPostureOf, Question
from irlx.interpreter.support import unsupported
from irlx.language.analysis import analyse
from irlx.language.source import source_text

DECLARATIONS = "VAR POSITION: p := (1, 2, 3), q := (4, 5, 6); MAIN_JOINT: j, k; BOOL: b;"


class Machine:
    """Joint 1 slides and tells x of the pose; joint 2 tells how many blocks were executed, joint 3 how many
    questions came, in degrees."""

    def __init__(self, source):
        self.source = source
        self.blocks = []
        self.asked = []

    def answer(self, question):
        self.asked.append(question)
        if isinstance(question, AskPosture):
            return (0.0, 0.0, 0.0)
        return (question.position[0], radians(len(self.blocks)), radians(len(self.asked)))

    def run(self):
        reply = None
        while True:
            try:
                item = self.source.send(reply)
            except StopIteration:
                return self
            reply = self.answer(item) if isinstance(item, Question) else None
            if reply is None:
                self.blocks.append(item)


@pytest.fixture
def machine(generator):
    def run(body, declarations=DECLARATIONS):
        text = f"PROGRAM t; {declarations} BEGIN {body} ENDPROGRAM"
        return text, Machine(generator(text, joints=3, slides=(1,))).run()

    return run


def marked(text, question):
    return text[question.origin.start : question.origin.end]


@pytest.mark.req("LANG-34")
def test_the_question_and_its_answer(machine):
    text, ran = machine("MOVE PTP POSTURE(POSITION(600, -20, 3));")
    (question,) = ran.asked
    assert question == AskPostureOf(question.origin, (0.6, -0.02, 0.003), None)
    assert marked(text, question) == "POSTURE(POSITION(600, -20, 3))"
    (move,) = ran.blocks
    assert move.id == 1
    assert move.target.values == pytest.approx((0.6, 0.0, radians(1)), abs=1e-15)


@pytest.mark.req("LANG-34")
@pytest.mark.parametrize(
    ("pose", "orientation"),
    [
        ("((600, 0, 0), (1, 0, 0, 0))", (0.0, 0.0, 0.0, 1.0)),
        ("POSE(POSITION(600, 0, 0), ORIXYZ(90, 0, 0))", (sqrt(0.5), 0.0, 0.0, sqrt(0.5))),
        ("POSE(POSITION(500, 0, 0), ORIXYZ(0, 0, 180)) + POSITION(100, 0, 0)", (0.0, 0.0, 1.0, 0.0)),
        ("(600, 0, 0)", None),
    ],
)
def test_poses_as_a_ptp_would_take_them(machine, pose, orientation):
    _, ran = machine(f"j := POSTURE({pose});")
    (question,) = ran.asked
    assert question.position == pytest.approx((0.6, 0.0, 0.0))
    if orientation is None:
        assert question.orientation is None
    else:
        assert question.orientation == pytest.approx(orientation, abs=1e-15)


@pytest.mark.req("LANG-34")
def test_a_pose_is_asked_with_the_bits_of_its_target(machine):
    pose = "POSE(POSITION(1 / 3, 0.1, 7), ORIZYX(10, 20, 30))"
    _, ran = machine(f"MOVE PTP {pose}; j := POSTURE({pose});")
    (question,), (move,) = ran.asked, ran.blocks
    assert (question.position, question.orientation) == (move.target.position, move.target.orientation)


@pytest.mark.req("LANG-34")
def test_all_blocks_before_it_are_executed_first(machine):
    _, ran = machine(
        "MOVE LIN p, q; CYCLICSTART; j := POSTURE(p); CYCLICEND; MOVE PTP POSTURE(q); MOVE PTP j;"
    )
    executed = [block.target.values[1] for block in ran.blocks[4:]]
    assert executed == pytest.approx([radians(4), radians(3)], abs=1e-15)
    assert [block.id for block in ran.blocks] == [1, 2, 3, 4, 5, 6]


@pytest.mark.req("LANG-34")
def test_a_statement_asks_each_of_its_calls_once(machine):
    text, ran = machine(
        "MOVE LIN POSTURE(p), q, POSTURE(p) WITH RECONFIGURATION POSTURE(q), j, POSTURE(p);",
        DECLARATIONS.replace("j,", "j := (0, 0, 0),"),
    )
    assert sorted(question.origin.start for question in ran.asked) == [
        at for at in range(len(text)) if text.startswith("POSTURE(", at)
    ]
    # All of them before the first move: the present posture is that of the statement's start.
    values = [block.target.values[1] for block in ran.blocks if hasattr(block.target, "values")]
    values += [block.reconfiguration.values[1] for block in ran.blocks]
    assert values == [0.0] * 5
    assert [block.id for block in ran.blocks] == [1, 2, 3]


@pytest.mark.req("LANG-34")
def test_the_same_call_is_asked_again_in_the_next_statement(machine):
    _, ran = machine("j := POSTURE(p); j := POSTURE(p); MOVE PTP j;")
    assert len(ran.asked) == 2
    assert ran.blocks[0].target.values[2] == pytest.approx(radians(2), abs=1e-15)


@pytest.mark.req("LANG-34")
def test_it_stands_with_the_actual_posture_in_one_statement(machine):
    declarations = DECLARATIONS + " ARRAY [1..2] OF MAIN_JOINT: both;"
    _, ran = machine("both := (R_JOINT_ACT.M_JOINT, POSTURE(p)); MOVE PTP both[1], both[2];", declarations)
    assert [type(question) for question in ran.asked] == [AskPosture, AskPostureOf]
    assert ran.blocks[0].target.values == (0.0, 0.0, 0.0)
    assert ran.blocks[1].target.values == pytest.approx((0.001, 0.0, radians(2)), abs=1e-15)


@pytest.mark.req("LANG-34")
def test_an_assignment_happens_once_it_has_its_value(machine):
    declarations = DECLARATIONS + " ARRAY [1..2] OF MAIN_JOINT: list; INT: i := 1;"
    _, ran = machine(
        "list[i] := POSTURE(p); i := i + 1; list[i] := POSTURE(q); MOVE PTP list[1], list[2];", declarations
    )
    assert [block.target.values[0] for block in ran.blocks] == pytest.approx([0.001, 0.004], abs=1e-15)


@pytest.mark.req("LANG-34")
def test_other_statements_take_it_too(machine):
    _, ran = machine("RECONFIGURATION posture(p); MOVE CIRCLE POSTURE(p), POSTURE(q);")
    reconfiguration, arc = ran.blocks
    assert reconfiguration.target.values[0] == pytest.approx(0.001)
    assert (arc.course.via.values[0], arc.target.values[0]) == pytest.approx((0.001, 0.004))
    assert (reconfiguration.id, arc.id) == (1, 2)


@pytest.mark.req("LANG-34")
def test_what_is_not_evaluated_is_not_asked(machine):
    with pytest.raises(Exception, match="IRL227"):
        machine("b := TRUE AND (POSTURE(p) = POSTURE(q));")
    _, ran = machine("b := FALSE AND (POSTURE(p) = POSTURE(q));")
    assert ran.asked == []


@pytest.mark.req("LANG-34")
@pytest.mark.parametrize(
    ("statement", "expected"),
    [
        ("j := POSTURE();", ("IRL228", "POSTURE takes 1 or 2 values, found 0", "POSTURE()")),
        ("j := POSTURE(1);", ("IRL222", "expected POSE or POSITION, found INT", "1")),
        ("j := POSTURE(p, p, p);", ("IRL228", "POSTURE takes 1 or 2 values, found 3", "POSTURE(p, p, p)")),
        ("x := POSTURE(p);", ("IRL222", "expected REAL, found MAIN_JOINT", "POSTURE(p)")),
        ("MOVE LIN POSTURE(p), 1 / 0;", ("IRL502", "division by zero", "1 / 0")),
    ],
)
def test_wrong_uses(run_error, statement, expected):
    assert run_error(DECLARATIONS + " REAL: x;", statement) == expected


def warned(declarations, body):
    text = f"PROGRAM t; {declarations} BEGIN {body} ENDPROGRAM"
    analysis = analyse(source_text("t.irl", text))
    return [
        (d.code, d.data["what"], text[d.place.span.start : d.place.span.end])
        for d in unsupported(analysis.tree, analysis.source)
    ]


@pytest.mark.req("LANG-34")
def test_an_initial_value_asks_before_the_first_statement(machine):
    _, ran = machine("MOVE PTP j;", "VAR MAIN_JOINT: j := POSTURE(POSITION(1, 2, 3));")
    assert (len(ran.asked), ran.blocks[0].target.values[0]) == (1, pytest.approx(0.001))


@pytest.mark.req("LANG-34")
def test_constants_come_before_there_is_a_machine_to_ask(run_error):
    message = "this version of irlx reads the function POSTURE in a constant but does not execute it yet"
    declarations = "CONST MAIN_JOINT: j := POSTURE(POSITION(1, 2, 3));"
    assert run_error(declarations, "") == ("IRL590", message, "POSTURE")


@pytest.mark.req("LANG-34")
def test_a_check_has_nothing_to_say_of_it():
    assert warned(DECLARATIONS, "j := POSTURE(p); MOVE LIN p WITH RECONFIGURATION POSTURE(p);") == []
