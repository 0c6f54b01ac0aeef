"""What is drawn of a stream as plain data: units, spans, marks, windows."""

import numpy as np
import pytest

from drawn_streams import DT, square_and_slow
from irlx.report.plot.limit_spans import AT_RATE
from irlx.report.plot.make_curves import Subject, curves_of
from irlx.report.plot.quantity import JOINT_QUANTITIES, QUANTITIES, Quantity

pytestmark = pytest.mark.req("REP-03")


@pytest.fixture(scope="module")
def stream():
    return square_and_slow()


@pytest.fixture(scope="module")
def curves(stream):
    return curves_of(Subject(stream, "drawn.irdata"), QUANTITIES)[0]


def test_values_are_differences_in_deg_and_mm(stream, curves):
    assert curves.units == ("deg", "mm")
    q = np.column_stack([np.rad2deg(stream.q[:, 0]), 1e3 * stream.q[:, 1]])
    qd = np.vstack([[0.0, 0.0], np.diff(q, axis=0) / DT])
    qdd = np.vstack([[0.0, 0.0], np.diff(qd, axis=0) / DT])
    for quantity, due in zip(JOINT_QUANTITIES, (q, qd, qdd), strict=True):
        np.testing.assert_allclose(curves.values[quantity], due, atol=1e-6)


def test_limits_in_force_step_where_the_program_changes_them(stream, curves):
    # The first move ends at row 121, where the switch stands: it holds from there on.
    times, lower, upper = curves.bounds[Quantity.SPEED].steps(1)
    end = stream.t[-1]
    np.testing.assert_allclose(times, [0.0, 1.21, 1.21, end])
    np.testing.assert_allclose(upper, [400.0, 400.0, 100.0, 100.0])
    np.testing.assert_allclose(lower, [-400.0, -400.0, -100.0, -100.0])
    _, lower, upper = curves.bounds[Quantity.POSITION].steps(1)
    assert np.isnan(lower).all()
    np.testing.assert_allclose(upper, 500.0)


def test_where_joints_are_at_limits(stream, curves):
    # The turn reaches 1 rad in row 60 and stays; the slide runs at 0.4 m/s in rows 1 to 50, back at 0.1 m/s
    # in 100 rows from 122 on. What a row tells holds in the tick before it.
    end = float(stream.t[-1])
    assert curves.spans(Quantity.POSITION, 0) == [pytest.approx((0.59, end))]
    assert curves.spans(Quantity.POSITION, 1) == []
    assert curves.spans(Quantity.SPEED, 0) == []
    assert curves.spans(Quantity.SPEED, 1) == [pytest.approx((0.0, 0.5)), pytest.approx((1.21, 2.21))]
    assert curves.spans(Quantity.ACCELERATION, 0) == []


def test_just_below_a_limit_is_not_at_it(stream):
    slower = stream.q * (AT_RATE - 1e-3)
    still = np.tile(stream.tool[0], (len(slower), 1))
    other = type(stream)(stream.header, stream.records, stream.ticks, slower, stream.block, still, True)
    curves, _ = curves_of(Subject(other, "x"), JOINT_QUANTITIES)
    assert curves.limit_spans == ()


def test_what_slows_the_tool_is_at_its_limit_below_it_too(stream):
    # A plan keeps a reserve: 93 % of the limit count in the rows from 142 on that are slower than programmed.
    q = stream.q.copy()
    q[121:, 1] = q[121, 1] - np.minimum(0.00093 * np.arange(len(q) - 121), 0.15)
    other = type(stream)(stream.header, stream.records, stream.ticks, q, stream.block, stream.tool, True)
    curves, _ = curves_of(Subject(other, "x"), JOINT_QUANTITIES)
    assert curves.spans(Quantity.SPEED, 1)[1] == pytest.approx((1.41, 121 * DT + 1.61))


@pytest.mark.parametrize(("part", "joints"), [(0.91, [1]), (0.985, [0])])
def test_of_joints_near_their_limits_while_slowed_the_one_that_decides(stream, part, joints):
    # The slide uses 93 % of its limit, the turn more or less than that.
    q = stream.q.copy()
    ticks = np.arange(len(q) - 121)
    q[121:] = np.column_stack([1.0 - 0.03 * part * ticks, q[121, 1] - 0.00093 * ticks])
    other = type(stream)(stream.header, stream.records, stream.ticks, q, stream.block, stream.tool, True)
    curves, _ = curves_of(Subject(other, "x"), JOINT_QUANTITIES)
    found = {joint for joint in (0, 1) for begin, _ in curves.spans(Quantity.SPEED, joint) if begin > 1.2}
    assert sorted(found) == joints


def test_moves_and_slowed_spans(curves):
    assert [(mark.time, mark.line) for mark in curves.moves] == [(0.0, 10), (1.21, 30)]
    assert curves.slowed == (pytest.approx((1.41, 3.01)),)
    (speed,) = curves.tracks[Quantity.PATH_SPEED]
    assert (speed.title, speed.unit) == ("tool speed", "mm/s")
    assert np.max(speed.values) == pytest.approx(200.0)
    # The programmed speed is drawn where it is another one.
    apart = np.isfinite(speed.apart)
    assert apart.sum() == 162
    np.testing.assert_allclose(speed.apart[142:302], 200.0)


def test_without_a_robot_the_rest_is_drawn(stream):
    curves, notes = curves_of(Subject(stream, "drawn.irdata"), QUANTITIES)
    assert set(curves.tracks) == {Quantity.PATH_SPEED}
    assert [note.code for note in notes] == ["IRL019", "IRL019"]
    words = "its robot is not known; --cell names its cell"
    assert str(notes[0]) == f"drawn.irdata: warning IRL019: singular is left out: {words}"


def test_a_window_changes_no_value(stream, curves):
    part, _ = curves_of(Subject(stream, "x"), QUANTITIES, (1.0, 2.0))
    assert (part.t[0], part.t[-1]) == (1.0, 2.0)
    inside = (curves.t >= 1.0) & (curves.t <= 2.0)
    for quantity in JOINT_QUANTITIES:
        assert np.array_equal(part.values[quantity], curves.values[quantity][inside])
    np.testing.assert_allclose(part.bounds[Quantity.SPEED].steps(1)[0], [1.0, 1.21, 1.21, 2.0])
    assert part.slowed == (pytest.approx((1.41, 2.0)),)
    assert [mark.line for mark in part.moves] == [30]
    assert part.spans(Quantity.SPEED, 1) == [pytest.approx((1.21, 2.0))]
