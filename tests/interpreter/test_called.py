"""Errors of moves of a routine name from where it was called, where that is known for sure."""

from __future__ import annotations

from irlx.blocks import MotionLaw, MoveBlock, MoveKind, Origin, PoseTarget
from irlx.diagnostics import IrlxError, Place, SourceText, Span, report
from irlx.interpreter.called import _KEPT, Called

TEXT = SourceText("p.irl", "x" * 100)


def place(start: int) -> Place:
    return Place.in_text(TEXT, Span(start, start + 5))


def locate(origin: Origin) -> Place:
    return place(origin.start)


def move(number: int, start: int = 0) -> MoveBlock:
    law, target = MotionLaw(0.25, 1.0, 1.5, 3.0), PoseTarget((0.0, 0.0, 0.0), None)
    return MoveBlock(
        id=number, origin=Origin("p.irl", start, start + 5, 1), kind=MoveKind.LIN, target=target, law=law
    )


def told(called: Called, *blocks: MoveBlock) -> list[Place]:
    """Where the routine was called of an error at the first of some blocks."""
    error = IrlxError(report("IRL512", locate(blocks[0].origin), length=1, most=0))
    called.tell(error, blocks, locate)
    return [related.place for related in error.reason.related]


def test_calls_from_the_innermost_on() -> None:
    called = Called()
    called.take(move(1), (place(20), place(40)))
    called.take(move(2, start=60), ())
    assert told(called, move(1), move(2, start=60)) == [place(20), place(40)]
    assert told(called, move(2, start=60)) == []


def test_nothing_is_told_where_it_may_be_one_of_several() -> None:
    """Joined moves of one line of a routine: an error of the line does not say which of them it is."""
    called = Called()
    called.take(move(1), (place(20),))
    called.take(move(2), (place(20),))
    called.take(move(3), (place(40),))
    assert told(called, move(1), move(2)) == [place(20)]
    assert told(called, move(1), move(2), move(3)) == []


def test_old_moves_are_forgotten() -> None:
    called = Called()
    for number in range(_KEPT + 1):
        called.take(move(number), (place(20),))
    assert told(called, move(0)) == []
    assert told(called, move(1)) == [place(20)]
