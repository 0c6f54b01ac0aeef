"""Which joints are drawn where none are named, and how joints are named."""

import numpy as np
import pytest

from drawn_streams import DrawnStream
from irlx.diagnostics import IrlxError
from irlx.report.plot.chosen_joints import busiest_joints, joints_named, told_numbers
from irlx.report.plot.make_curves import Subject, curves_of
from irlx.report.plot.quantity import Quantity
from irlx.robot.limits import JointLimits

pytestmark = pytest.mark.req("REP-03")

NAMES = ("still", "at_end", "half", "free", "fast", "3")


@pytest.fixture(scope="module")
def curves():
    """`at_end` stays at a limit, `fast` uses 90 % of its speed, `half` half its range, `free` and `3` have no
    limits and go 40 and 20 deg, `still` stands on a limit."""
    bound = np.array([0.0, 1.0, 1.0, np.inf, 100.0, np.inf])
    speed = np.array([np.inf, np.inf, np.inf, np.inf, 1.0, np.inf])
    limits = JointLimits.unlimited(6).with_pair("position", -bound - 1.0, bound)
    made = DrawnStream(NAMES, ("rad",) * 6, limits.with_pair("speed", -speed, speed), start=(0.0,) * 6)
    t = np.minimum(np.arange(1, 101) / 50.0, 1.0)
    turns = np.column_stack([0.0 * t, t, 0.0 * t, 0.7 * t, 0.45 * t, 0.35 * t])
    turns[:, 2] = 0.25 * np.sin(3.0 * t)
    made.move(turns)
    return curves_of(Subject(made.stream(), "a"), [Quantity.POSITION, Quantity.SPEED])[0]


@pytest.mark.parametrize(
    ("most", "chosen"),
    [
        (1, ["at_end"]),
        (2, ["at_end", "fast"]),
        (3, ["at_end", "half", "fast"]),
        (4, ["at_end", "half", "free", "fast"]),
        (5, ["at_end", "half", "free", "fast", "3"]),
        (9, list(NAMES)),
    ],
)
def test_the_busiest(curves, most, chosen):
    assert [NAMES[joint] for joint in busiest_joints([curves], most)] == chosen


def test_of_two_streams_either_counts(curves):
    made = DrawnStream(NAMES, ("rad",) * 6, JointLimits.unlimited(6), start=(0.0,) * 6)
    made.move(np.zeros((3, 6)))
    other = curves_of(Subject(made.stream(), "b"), [Quantity.POSITION, Quantity.SPEED])[0]
    assert busiest_joints([other, curves], 2) == busiest_joints([curves], 2)


def test_names_before_numbers():
    assert joints_named(["3", 2, "half", "6", " free "], NAMES) == [5, 1, 2, 3]
    for wrong in ("7", 0, "-1", "", "frei"):
        with pytest.raises(IrlxError, match="IRL006"):
            joints_named([wrong], NAMES)


def test_numbers_that_are_not_those_in_the_names_are_told():
    names = ("rail", "joint_1", "joint_2", "left_4", "arm7_5")
    assert told_numbers(["1", "joint_2", "4", 5], names) == []
    assert told_numbers(["3", 2, "03"], names) == ["3 is joint_2", "2 is joint_1", "3 is joint_2"]
