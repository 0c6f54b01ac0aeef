"""What inputs say at a time, when they change, and how long a wait is."""

from __future__ import annotations

from math import inf, nan

import numpy as np
import pytest

from irlx.blocks import AskInput, AskInputChange, Origin, Port, SignalKind, WaitBlock
from irlx.diagnostics import Place
from irlx.motion.whole_ticks import MOST_TICKS
from irlx.pacing.errors import PacingError
from irlx.pacing.inputs import Inputs, answer_of_inputs
from irlx.pacing.waiting import ticks_of_wait, waited
from irlx.robot.kinematics import Kinematics

TRACES = {"in_3": [(0.5, 1.0), (1.25, 0.0)], "level": [(0.0, 2.5)]}
ORIGIN, PLACE = Origin("t.irl", 0, 4, 1), Place("t.irl")


@pytest.mark.parametrize(
    ("time", "slack", "value"),
    [
        (0.0, 0.0, 0.0),
        (0.4999, 0.0, 0.0),
        (0.4999, 2e-4, 1.0),
        (0.5, 0.0, 1.0),
        (1.2, 0.0, 1.0),
        (9.0, 0.0, 0.0),
    ],
)
def test_a_trace_holds_until_its_next_time(time: float, slack: float, value: float) -> None:
    assert Inputs(TRACES).value(("IN_3",), time, slack) == value


def test_the_first_name_that_is_known_counts_and_a_function_before_all() -> None:
    inputs = Inputs(TRACES)
    assert inputs.value(("nobody", "Level", "in_3"), 0.6) == 2.5
    assert inputs.value(("nobody",), 0.6) is None
    asked: list[tuple[str, float]] = []

    def told(name: str, time: float) -> float | None:
        asked.append((name, time))
        return 7 if name == "level" else None

    own = Inputs(TRACES, told)
    assert own.value(("in_3", "level"), 0.6) == 7.0
    assert asked == [("in_3", 0.6), ("level", 0.6)]
    assert own.value(("in_3",), 0.6) == 1.0
    assert own.knows(("nobody",))
    assert not inputs.knows(("nobody",))
    assert inputs.knows(("nobody", "LEVEL"))


@pytest.mark.parametrize(
    ("time", "slack", "after"), [(0.0, 0.0, 0.5), (0.5, 0.0, 0.75), (0.4999, 1e-3, 0.7501), (1.25, 0.0, inf)]
)
def test_the_next_change(time: float, slack: float, after: float) -> None:
    found = Inputs(TRACES).until_change((("in_3",), ("nobody",), ("level",)), time, 0.01, slack)
    assert found == pytest.approx(after)
    assert Inputs(TRACES, lambda name, at: None).until_change((("in_3",),), time, 0.01) == 0.01


def asked(kind: SignalKind, name: str = "x") -> AskInput:
    return AskInput(origin=ORIGIN, port=Port(name, kind), names=(name,))


@pytest.mark.parametrize(
    ("kind", "value", "fits"),
    [
        (SignalKind.BOOL, 0.0, True),
        (SignalKind.BOOL, 1.0, True),
        (SignalKind.BOOL, 2.0, False),
        (SignalKind.INT, -3.0, True),
        (SignalKind.INT, 0.5, False),
        (SignalKind.INT, inf, False),
        (SignalKind.REAL, 0.5, True),
        (SignalKind.REAL, nan, False),
    ],
)
def test_values_that_an_input_can_have(kind: SignalKind, value: float, fits: bool) -> None:
    inputs = Inputs({"x": [(0.0, value)]})
    if fits:
        assert answer_of_inputs(asked(kind), inputs, 1.0, 0.01, lambda origin: PLACE) == (value,)
        return
    with pytest.raises(PacingError) as caught:
        answer_of_inputs(asked(kind), inputs, 1.0, 0.01, lambda origin: PLACE)
    assert caught.value.reason.code == "IRL531"


def test_an_input_that_nobody_knows() -> None:
    with pytest.raises(PacingError) as caught:
        answer_of_inputs(asked(SignalKind.REAL, "lever"), Inputs(TRACES), 1.0, 0.01, lambda origin: PLACE)
    told = caught.value.reason
    assert (told.code, told.data["name"], told.data["known"]) == ("IRL530", "lever", "in_3, level")


def test_changes_that_come_and_that_do_not() -> None:
    """A change within a millionth of a tick is one of this tick already."""
    question = AskInputChange(ORIGIN, (("in_3",),))
    for time, answer in ((0.25, (0.25,)), (0.5 - 1e-10, (0.75 + 1e-10,)), (2.0, ())):
        found = answer_of_inputs(question, Inputs(TRACES), time, 0.01, lambda origin: PLACE)
        assert found == pytest.approx(answer)


@pytest.mark.parametrize(
    ("duration", "ticks"),
    [(0.0, 0), (1e-9, 0), (1e-3, 1), (0.02, 2), (0.02 + 1e-9, 2), (0.0201, 3)],
)
def test_a_wait_takes_whole_ticks(kit, duration: float, ticks: int) -> None:
    assert ticks_of_wait(duration, 0.01) == ticks
    block = WaitBlock(id=1, origin=ORIGIN, duration=duration)
    rows = waited(block, kit.start, 0.01, 5, Kinematics(kit.gantry()), PLACE)
    assert (0 if rows is None else len(rows)) == ticks
    if rows is not None:
        np.testing.assert_array_equal(rows.q, np.tile(kit.start, (ticks, 1)))
        np.testing.assert_allclose(
            rows.tool_position, np.tile(kit.position(kit.start), (ticks, 1)), atol=1e-15
        )
        np.testing.assert_allclose(rows.tool_rotation[-1], kit.rotation(kit.start).as_matrix(), atol=1e-15)
        assert not np.any(rows.active)
        assert (rows.first_tick, rows.ticks) == (5, ticks)


def test_a_wait_of_more_ticks_than_there_may_be(kit) -> None:
    block = WaitBlock(id=1, origin=ORIGIN, duration=0.01 * (MOST_TICKS + 1))
    with pytest.raises(PacingError) as caught:
        waited(block, kit.start, 0.01, 5, Kinematics(kit.gantry()), PLACE)
    assert caught.value.reason.code == "IRL425"
