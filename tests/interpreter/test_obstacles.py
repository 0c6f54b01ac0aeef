"""OBSTACLE, CLEARANCE and POSTURE with an obstacle: blocks and questions with the names of the cell."""

from math import pi, radians

import pytest

from irlx.blocks import (
    AskAvoidingPosture,
    AskClearance,
    AskPosture,
    MoveBlock,
    ObstacleBlock,
    Question,
)
from irlx.language.analysis import analyse
from irlx.language.source import source_text

pytestmark = pytest.mark.req("LANG-64")

OBSTACLES = {"ściana_1": "Ściana_1", "window": "window", "cell_group": "cell_group"}
"""Obstacles of the cell by casefolded name, as it writes them."""

DECLARATIONS = """VAR POSITION: p := (1, 2, 3); MAIN_JOINT: j := (10, 20, 30), k; REAL: x; INT: n := 0;
BOOL: b; POSE: o := ((4, 5, 6), ORIZYX(0, 0, 180));
JOINT: both := JOINT((1, 2, 3)); FUNCTION next: INT; BEGIN n := n + 1; RETURN n; ENDFCT;"""

ANSWERS = {AskClearance: (0.125,), AskAvoidingPosture: (0.5, 0.6, 0.7), AskPosture: (0.1, pi, -pi)}


@pytest.fixture
def items(generator):
    """Questions and blocks of a body, in their order; the first joint slides."""

    def run(body, declarations=DECLARATIONS, obstacles=OBSTACLES):
        text = f"PROGRAM t; {declarations} BEGIN {body} ENDPROGRAM"
        source, found, reply = generator(text, joints=3, slides=(1,), obstacles=obstacles), [], None
        while True:
            try:
                found.append(source.send(reply))
            except StopIteration:
                return found
            reply = ANSWERS[type(found[-1])] if isinstance(found[-1], Question) else None

    return run


def told(items):
    return [(type(item).__name__, item.name, getattr(item, "active", None)) for item in items]


def test_switches_overlap_and_end_in_any_order(items):
    found = items("OBSTACLE window; OBSTACLE ŚCIANA_1; OBSTACLEEND Window; OBSTACLEEND ściana_1;")
    assert told(found) == [
        ("ObstacleBlock", "window", True),
        ("ObstacleBlock", "Ściana_1", True),
        ("ObstacleBlock", "window", False),
        ("ObstacleBlock", "Ściana_1", False),
    ]
    assert [block.id for block in found] == [1, 2, 3, 4]
    assert [block.origin.end - block.origin.start for block in found] == [15, 17, 18, 20]


def test_on_again_and_off_without_on_are_blocks_like_those_of_other_switches(items):
    found = items("OBSTACLEEND window; OBSTACLE window; OBSTACLE window;")
    assert [block.active for block in found] == [False, True, True]


def test_in_routines_and_loops(items):
    body = "FOR i := 1 TO 2 DO on; OBSTACLEEND window; ENDFOR;"
    found = items(body, "VAR INT: i; PROCEDURE on; BEGIN OBSTACLE window; ENDPROC;")
    assert [block.active for block in found] == [True, False, True, False]


def test_a_cell_that_nobody_knows_has_any_name(items):
    found = items("OBSTACLE Anything; x := CLEARANCE(j, Other);", obstacles=None)
    assert [item.name for item in found] == ["Anything", "Other"]


def test_clearance_asks_and_tells_mm(items):
    question, move = items("x := CLEARANCE(j, WINDOW) * 2; MOVE LIN POSITION(x, 0, 0);")
    assert isinstance(question, AskClearance)
    assert question.posture == (0.01, radians(20), radians(30))
    assert question.name == "window"
    assert move.target.position == pytest.approx((0.25, 0, 0), abs=1e-15)


def test_clearance_takes_joint_values_of_any_kind(items):
    found = items(
        "x := CLEARANCE(both, window); x := CLEARANCE((1, 2, 3), window);x := CLEARANCE(R_JOINT_ACT, window);"
    )
    assert [type(item) for item in found] == [AskClearance, AskClearance, AskPosture, AskClearance]
    assert found[0].posture == found[1].posture == (0.001, radians(2), radians(3))
    assert found[3].posture == pytest.approx(ANSWERS[AskPosture], abs=1e-15)


def test_questions_come_once_and_in_the_order_of_the_text(items):
    first, second, move = items(
        "x := next * 1000 + CLEARANCE(j, window) + next * CLEARANCE(j, cell_group);"
        "MOVE LIN POSITION(x, n, 0);"
    )
    assert [first.name, second.name] == ["window", "cell_group"]
    assert isinstance(move, MoveBlock)
    assert move.target.position == pytest.approx((1.375, 0.002, 0.0), abs=1e-15)


def test_what_is_not_needed_is_not_asked(items):
    assert items("b := FALSE AND CLEARANCE(j, window) > 0;") == []
    assert len(items("b := TRUE AND CLEARANCE(j, window) > 0;")) == 1


def test_posture_of_a_pose_that_avoids(items):
    first, second, move = items(
        "k := POSTURE(p, cell_group); k := POSTURE(o, ściana_1); MOVE PTP k WITH RECONFIGURATION k;"
    )
    assert isinstance(first, AskAvoidingPosture)
    assert (first.position, first.orientation, first.name) == ((0.001, 0.002, 0.003), None, "cell_group")
    assert second.position == pytest.approx((0.004, 0.005, 0.006), abs=1e-15)
    assert second.orientation == pytest.approx((1.0, 0.0, 0.0, 0.0), abs=1e-15)
    assert second.name == "Ściana_1"
    assert move.target.values == pytest.approx((0.5, 0.6, 0.7), abs=1e-15)


def test_poses_count_in_the_base_frame(items):
    (question,) = items("R_BASE := POSE(POSITION(100, 0, 0), ORIZYX(0, 0, 0)); k := POSTURE(p, window);")
    assert question.position == pytest.approx((0.101, 0.002, 0.003), abs=1e-15)


def test_a_variable_of_the_same_name_is_not_meant(items):
    declarations = DECLARATIONS + "VAR REAL: window := 5;"
    (question,) = items("x := CLEARANCE(j, window);", declarations)
    assert question.name == "window"


def test_a_function_of_the_program_hides_the_built_in_one(items):
    declarations = (
        DECLARATIONS
        + "VAR REAL: wall := 5; FUNCTION clearance(MAIN_JOINT: m; REAL: r): REAL; BEGIN RETURN r; ENDFCT;"
    )
    (move,) = items("MOVE LIN POSITION(clearance(j, wall), 0, 0);", declarations)
    assert move.target.position[0] == pytest.approx(0.005, abs=1e-15)


UNKNOWN = "the cell has no obstacle or group '{}'{}"
EXPRESSION = "expected the name of an obstacle or group of the cell, found an expression"
WRONG = [
    ("OBSTACLE windw;", ("IRL573", UNKNOWN.format("windw", "; did you mean 'window'?"), "windw")),
    ("OBSTACLEEND roof;", ("IRL573", UNKNOWN.format("roof", ""), "roof")),
    (
        "x := CLEARANCE(j, sciana_1);",
        ("IRL573", UNKNOWN.format("sciana_1", "; did you mean 'Ściana_1'?"), "sciana_1"),
    ),
    ("k := POSTURE(p, j);", ("IRL573", UNKNOWN.format("j", ""), "j")),
    ("k := POSTURE(p, p + p);", ("IRL222", EXPRESSION, "p + p")),
    ("x := CLEARANCE(j, 'window');", ("IRL222", EXPRESSION, "'window'")),
    ("x := CLEARANCE(j, both.M_JOINT);", ("IRL222", EXPRESSION, "both.M_JOINT")),
    ("x := CLEARANCE(j);", ("IRL228", "CLEARANCE takes 2 values, found 1", "CLEARANCE(j)")),
    ("x := CLEARANCE();", ("IRL228", "CLEARANCE takes 2 values, found 0", "CLEARANCE()")),
    (
        "k := POSTURE(p, p, j);",
        ("IRL228", "POSTURE takes 1 or 2 values, found 3", "POSTURE(p, p, j)"),
    ),
    ("x := CLEARANCE(p, window);", ("IRL222", "expected MAIN_JOINT or JOINT, found POSITION", "p")),
    ("k := POSTURE(j, window);", ("IRL222", "expected POSE or POSITION, found MAIN_JOINT", "j")),
    ("p := CLEARANCE(j, window);", ("IRL222", "expected POSITION, found REAL", "CLEARANCE(j, window)")),
]


@pytest.mark.parametrize(("body", "expected"), WRONG)
def test_wrong_uses_are_told_alike_by_check_and_run(run_error, told_by_check, body, expected):
    assert run_error(DECLARATIONS, body, joints=3, slides=(1,), obstacles=OBSTACLES) == expected
    assert told_by_check(body) == [expected]


@pytest.fixture
def told_by_check():
    """Errors of the analysis in a cell of three joints that has these obstacles."""

    def run(body):
        text = f"PROGRAM t;\n{DECLARATIONS}\nBEGIN\n{body}\nENDPROGRAM"
        found = analyse(
            source_text("t.irl", text), joints=("a", "b", "c"), obstacles=lambda _: OBSTACLES.values()
        )
        errors = [one for one in found.diagnostics if one.is_error]
        return [(e.code, e.message, text[e.place.span.start : e.place.span.end]) for e in errors]

    return run


def test_the_names_that_the_cell_has_are_told(blocks):
    with pytest.raises(Exception, match="IRL573") as caught:
        blocks("", "OBSTACLE roof;", obstacles=OBSTACLES)
    assert caught.value.reason.help.startswith("names that it has: cell_group, window, Ściana_1;")
    with pytest.raises(Exception, match="IRL573") as caught:
        blocks("", "OBSTACLE roof;", obstacles={})
    assert caught.value.reason.help.startswith("names that it has: none;")


def test_a_wrong_name_counts_only_where_the_program_comes_to_it(items):
    assert told(items("IF FALSE THEN OBSTACLE roof; x := CLEARANCE(j, roof); ENDIF; OBSTACLE window;")) == [
        (ObstacleBlock.__name__, "window", True)
    ]


def test_constants_do_not_ask(run_error):
    code, message, marked = run_error("CONST REAL: c := CLEARANCE((1, 2, 3, 4, 5, 6, 7), wall);", "")
    assert (code, marked) == ("IRL590", "CLEARANCE")
    assert message.startswith("this version of irlx reads the function CLEARANCE in a constant")
