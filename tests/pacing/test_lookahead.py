"""Which blocks are carried out together (LANG-54)."""

from __future__ import annotations

from dataclasses import replace

import pytest

from irlx.blocks import (
    AskAvoidingPosture,
    AskClearance,
    AskInput,
    AskInputChange,
    AskPause,
    AskPose,
    AskPosture,
    AskStandstill,
    Blend,
    Block,
    JointIncrement,
    JointRange,
    JointTarget,
    LimitClause,
    LimitKind,
    MotionLaw,
    MoveBlock,
    MoveKind,
    Origin,
    PauseBlock,
    Port,
    PoseTarget,
    Question,
    SignalBlock,
    SignalKind,
    WaitBlock,
)
from irlx.diagnostics import Diagnostic, Place, Span
from irlx.diagnostics.place import SourceText
from irlx.pacing.lookahead import WINDOW, Lookahead
from irlx.pacing.notes import Notes

pytestmark = pytest.mark.req("LANG-54")

TEXT = SourceText("p.irl", "x" * 10_000)
LAW = MotionLaw(0.25, 1.0, 1.5, 3.0)
PASS = Blend(0.01)


def origin(number: int) -> Origin:
    return Origin("p.irl", 10 * number, 10 * number + 5, 1)


def move(number: int, blend: Blend | None = PASS, kind: MoveKind = MoveKind.LIN) -> MoveBlock:
    target = PoseTarget((0.1 * number, 0.0, 0.0), None)
    return MoveBlock(id=number, origin=origin(number), kind=kind, target=target, law=LAW, blend=blend)


def signal(number: int) -> SignalBlock:
    port = Port(f"OUT_{number}", SignalKind.BOOL)
    return SignalBlock(id=number, origin=origin(number), port=port, value=1.0)


def gathered(*blocks: Block) -> tuple[list[list[int]], list[Diagnostic]]:
    notes: list[Diagnostic] = []
    ahead = Lookahead(lambda o: Place.in_text(TEXT, Span(o.start, o.end)), Notes(notes))
    groups = [group for block in blocks for group in ahead.take(block)]
    groups += ahead.stop(None, "the program ends")
    return [[block.id for block in group] for group in groups], notes


def test_moves_that_pass_are_carried_out_with_the_one_behind() -> None:
    groups, notes = gathered(move(1), move(2), move(3, None), move(4, None))
    assert groups == [[1, 2, 3], [4]]
    assert notes == []


def test_a_ptp_belongs_to_the_moves_beside_it() -> None:
    groups, notes = gathered(move(1), move(2, kind=MoveKind.PTP), signal(3), move(4, None))
    assert groups == [[1, 2, 3, 4]]
    assert notes == []


def test_signals_between_them_belong_to_the_group() -> None:
    groups, notes = gathered(signal(1), move(2), signal(3), signal(4), move(5, None), signal(6))
    assert groups == [[1], [2, 3, 4, 5], [6]]
    assert notes == []


@pytest.mark.parametrize(
    "stopping",
    [
        WaitBlock(id=3, origin=origin(3), duration=1.0),
        PauseBlock(id=3, origin=origin(3)),
        replace(move(3), kind=MoveKind.PTP, law=replace(LAW, duration=1.0)),
        replace(move(3), kind=MoveKind.PTP, target=JointIncrement((0.0,))),
        replace(move(3), target=JointTarget((0.0,))),
        replace(move(3), reconfiguration=JointTarget((0.0,))),
        replace(
            move(3),
            limits=(LimitClause(LimitKind.SPEED, JointRange((-1.0,), (1.0,)), origin(3)),),
        ),
    ],
    ids=["wait", "pause", "time of a ptp", "increments of a ptp", "posture", "reconfiguration", "clause"],
)
def test_what_needs_a_stop_ends_the_group_and_is_named(stopping: Block) -> None:
    groups, notes = gathered(move(1), move(2), stopping)
    assert groups == [[1, 2], [3]]
    lost = [note for note in notes if note.place is not None and note.place.span.start == 20]
    (note,) = lost
    assert note.code == "IRL432"
    assert note.related[0].place.span.start == 30


def test_the_end_of_the_program_stops_the_last_move() -> None:
    groups, notes = gathered(move(1), move(2), signal(3))
    assert groups == [[1, 2, 3]]
    assert [(note.code, note.place.span.start, note.related) for note in notes if note.place] == [
        ("IRL432", 20, ())
    ]


def test_a_pair_of_places_is_noted_once() -> None:
    wait = WaitBlock(id=2, origin=origin(2), duration=1.0)
    _, notes = gathered(*[block for _ in range(5) for block in (move(1), wait)])
    assert len(notes) == 1


def test_the_window_is_bounded() -> None:
    groups, notes = gathered(*[move(number) for number in range(1, 2 * WINDOW + 6)])
    assert [len(group) for group in groups] == [WINDOW, WINDOW, 5]
    assert [note.place.span.start for note in notes if note.place] == [
        10 * WINDOW,
        20 * WINDOW,
        20 * WINDOW + 50,
    ]


def test_questions_that_do_not_ask_where_the_robot_is_stop_nothing() -> None:
    notes: list[Diagnostic] = []
    ahead = Lookahead(lambda o: Place.in_text(TEXT, Span(o.start, o.end)), Notes(notes))
    assert ahead.take(move(1)) == []
    assert ahead.before(AskPose(origin(2), (0.0,))) == []
    assert notes == []
    assert [len(group) for group in ahead.before(AskPosture(origin(3)))] == [1]
    assert [note.code for note in notes] == ["IRL432"]
    assert "the answer depends on where the robot stands" in notes[0].message
    assert ahead.before(AskPosture(origin(3))) == []


@pytest.mark.parametrize(
    ("question", "why"),
    [
        (AskInput(origin(2), Port("IN_1", SignalKind.BOOL), ("a", "IN_1")), "an input is read at its moment"),
        (AskInputChange(origin(2), (("a", "IN_1"),)), "an input is read at its moment"),
        (AskPause(origin(2)), "the robot has to stand there"),
    ],
    ids=["read", "waited for", "pause"],
)
def test_what_belongs_to_a_moment_does_not_ask_where_the_robot_is(question: Question, why: str) -> None:
    notes: list[Diagnostic] = []
    ahead = Lookahead(lambda o: Place.in_text(TEXT, Span(o.start, o.end)), Notes(notes))
    assert ahead.take(move(1)) == []
    assert [len(group) for group in ahead.before(question)] == [1]
    assert [note.code for note in notes] == ["IRL432"]
    assert why in notes[0].message


def test_what_is_written_is_no_question() -> None:
    notes: list[Diagnostic] = []
    ahead = Lookahead(lambda o: Place.in_text(TEXT, Span(o.start, o.end)), Notes(notes))
    assert ahead.take(move(1)) == []
    assert [len(group) for group in ahead.before(AskStandstill(origin(2)))] == [1]
    assert [note.code for note in notes] == ["IRL432"]
    assert "what comes next waits until the moves are done" in notes[0].message


@pytest.mark.req("LANG-54")
@pytest.mark.parametrize("moving", [False, True])
def test_a_distance_stops_only_where_obstacles_move(moving: bool) -> None:
    notes: list[Diagnostic] = []
    locate = lambda o: Place.in_text(TEXT, Span(o.start, o.end))  # noqa: E731
    ahead = Lookahead(locate, Notes(notes), obstacles_move=moving)
    assert ahead.take(move(1)) == []
    assert [len(group) for group in ahead.before(AskClearance(origin(2), (0.0,), "wall"))] == [1] * moving
    assert [note.code for note in notes] == ["IRL432"] * moving


@pytest.mark.req("LANG-54")
def test_an_avoiding_posture_stops() -> None:
    ahead = Lookahead(lambda o: Place.in_text(TEXT, Span(o.start, o.end)), Notes([]))
    assert ahead.take(move(1)) == []
    asked = AskAvoidingPosture(origin(2), (0.0, 0.0, 0.0), None, "wall")
    assert [len(group) for group in ahead.before(asked)] == [1]


def test_two_hundred_moves_are_joined_and_the_next_ones_again() -> None:
    """The number that docs/reference/motion.md tells."""
    groups, _ = gathered(*(move(number) for number in range(401)))
    assert [len(group) for group in groups] == [200, 200, 1]
