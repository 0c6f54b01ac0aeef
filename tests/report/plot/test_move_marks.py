"""Which marks of moves are drawn, and which are told their line."""

import pytest

from irlx.report.plot.curves import MoveMark
from irlx.report.plot.move_marks import spaced_marks, told_marks

pytestmark = pytest.mark.req("REP-03")


def marks(*found):
    return [MoveMark(float(time), line) for time, line in found]


def test_marks_with_room_are_all_drawn():
    wide = marks((0, 5), (1, 5), (2, 5), (9, 7))
    assert spaced_marks(wide, 0.5) == wide
    assert spaced_marks([], 0.5) == []


def test_of_a_few_dense_ones_some_are_left_out():
    dense = marks((0, 5), (0.2, 6), (0.6, 7), (5, 8))
    assert spaced_marks(dense, 0.5) == marks((0, 5), (0.6, 7), (5, 8))


def test_of_many_dense_ones_those_that_first_reach_a_line_and_the_last():
    two, one = [(1 + 0.1 * k, 5 + k % 2) for k in range(100)], [(11 + 0.1 * k, 9) for k in range(50)]
    assert spaced_marks(marks((0, 3), *two, *one), 0.3) == marks((0, 3), (1, 5), (11, 9), one[-1])
    # All on lines of their own: the first and the last.
    assert spaced_marks(marks(*((0.1 * k, k + 1) for k in range(101))), 0.3) == marks((0, 1), (10, 101))


def test_a_line_is_told_once_in_a_row_and_where_there_is_room():
    found = marks((0, 5), (1, 5), (2, 5), (2.3, 6), (4, 7), (5, 5))
    assert told_marks(found, 1.0) == marks((0, 5), (2.3, 6), (4, 7), (5, 5))
    assert told_marks(found, 3.0) == marks((0, 5), (4, 7))
