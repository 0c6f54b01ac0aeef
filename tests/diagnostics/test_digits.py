"""Numbers that a message compares never read alike, and are the numbers."""

from __future__ import annotations

import math

import pytest

from irlx.diagnostics import told_apart

pytestmark = pytest.mark.req("REP-02")


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ((100.0, 99.5), ["100", "99.5"]),
        ((math.nextafter(100.0, 200.0), 100.0), ["100.00000000000001", "100"]),
        ((30.00762003, 30.00762002, -107.67), ["30.00762003", "30.00762002", "-107.67"]),
        ((2.0, 2.0), ["2", "2"]),
        ((-1e-300, 0.0), ["-1e-300", "0"]),
        ((1, 2.5), ["1", "2.5"]),
    ],
)
def test_as_many_digits_as_tell_numbers_apart(values, told) -> None:
    assert told_apart(*values) == told


def test_fewer_digits_where_these_do() -> None:
    assert told_apart(1.23456, 2.0, digits=3) == ["1.23", "2"]
    assert told_apart(1.2346, 1.2345, digits=3) == ["1.235", "1.234"]


@pytest.mark.parametrize("value", [1.0, 1e-9, 5e17, 0.1, math.pi])
def test_neighbours_are_told_apart(value: float) -> None:
    beside = math.nextafter(value, math.inf)
    told = [float(text) for text in told_apart(value, beside)]
    assert told[0] < told[1]
    assert told == pytest.approx([value, beside], rel=1e-15)
