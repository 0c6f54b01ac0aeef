"""What a check knows of values: constants worked out beforehand, and variables that are set once."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from math import trunc

import pytest

from irlx.language.checking.names import Entry
from irlx.language.checking.operators import binary_value, unary_value
from irlx.language.types import BOOL, INT, REAL

WHOLE = (-7, -3, -1, 0, 1, 2, 3, 7)
EXACT = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b,
    "DIV": lambda a, b: Fraction(trunc(a / b)),
    "MOD": lambda a, b: a - b * trunc(a / b),
}


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize("op", EXACT)
def test_arithmetic_of_constants_is_that_of_rational_numbers(op: str) -> None:
    result = REAL if op == "/" else INT
    for left, right in product(WHOLE, WHOLE):
        if right or op in "+-*":
            wanted = EXACT[op](Fraction(left), Fraction(right))
            assert binary_value(op, left, right, result) == pytest.approx(float(wanted), rel=1e-15), (
                left,
                right,
            )


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize("op", ["+", "-", "*", "/"])
def test_of_reals_too(op: str) -> None:
    found = binary_value(op, 1.5, -0.25, REAL)
    assert isinstance(found, float)
    assert found == EXACT[op](1.5, -0.25)


@pytest.mark.req("LANG-73")
def test_what_has_no_value_beforehand() -> None:
    assert binary_value("+", None, 1, INT) is None
    assert binary_value("+", 1, None, INT) is None
    assert binary_value("+", True, 1, INT) is None
    assert binary_value("+", 1, True, INT) is None
    assert binary_value("+", "a", "b", INT) is None
    assert binary_value("<", 1, 2, BOOL) is None
    assert binary_value("*", 10.0, 10**400, REAL) is None


@pytest.mark.req("LANG-73")
@pytest.mark.parametrize(
    ("op", "value", "wanted"),
    [
        ("-", 3, -3),
        ("+", 3, 3),
        ("-", -0.5, 0.5),
        ("NOT", True, False),
        ("NOT", False, True),
        ("-", None, None),
    ],
)
def test_signs(op: str, value: object, wanted: object) -> None:
    assert unary_value(op, value) is wanted or unary_value(op, value) == wanted
    assert type(unary_value(op, value)) is type(wanted)


@pytest.mark.req("LANG-73")
def test_a_variable_has_a_value_that_is_set_once_and_as_a_whole() -> None:
    once, twice, partly, both = (Entry("variable", REAL) for _ in range(4))
    once.set(2.5)
    twice.set(2.5)
    twice.set(2.5)
    partly.set(2.5, whole=False)
    both.set(2.5, whole=False)
    both.set(2.5)
    assert [entry.settled for entry in (once, twice, partly, both)] == [2.5, None, None, None]
    assert [entry.settings for entry in (once, twice, partly, both)] == [1, 2, 1, 2]


@pytest.mark.req("LANG-62")
@pytest.mark.parametrize(
    ("statement", "codes"),
    [
        ("go(1 + TRUE, 2);", {"IRL228", "IRL227"}),
        ("x := twice(1, nosuch);", {"IRL228", "IRL201"}),
        ("x := go[1 + TRUE];", {"IRL250", "IRL227"}),
        ("x := FILE(1 + TRUE);", {"IRL227", "IRL222"}),
        ("o := ORIENTATION(1, 1, 0, 0);", {"IRL230"}),
        ("o := ORIENTATION(0.6, 0, 0.8, 0);", set()),
        ("o := (1, 1, 0, 0);", {"IRL230"}),
        ("q := four(1, 1, 0, 0);", set()),
    ],
)
def test_all_that_is_wrong_with_a_call_is_told(told_of, statement: str, codes: set[str]) -> None:
    """A wrong number of values hides nothing that is wrong inside of them."""
    text = f"""PROGRAM t; TYPE RECORD REAL: a, b, c, d; ENDRECORD = four; VAR REAL: x;
    ORIENTATION: o; four: q;
    PROCEDURE go(REAL: r); BEGIN ENDPROC; FUNCTION twice(REAL: r): REAL; BEGIN RETURN r * 2; ENDFCT;
    BEGIN {statement} ENDPROGRAM"""
    assert {code for code, _, _ in told_of(text)} == codes


@pytest.mark.req("LANG-62")
@pytest.mark.parametrize(
    ("excess", "told"), [(0.9e-6, False), (1.2e-6, True), (-0.9e-6, False), (-1.2e-6, True)]
)
def test_how_far_from_one_the_length_of_a_quaternion_may_be(told_of, excess: float, told: bool) -> None:
    text = f"PROGRAM t; VAR ORIENTATION: o; BEGIN o := ORIENTATION({1.0 + excess:.9f}, 0, 0, 0); ENDPROGRAM"
    assert [code for code, _, _ in told_of(text)] == ["IRL230"] * told


@pytest.mark.req("LANG-62")
@pytest.mark.parametrize(
    ("bands", "marked"), [("0, 0, 0, 0, 0, 0", []), ("0, -1, 0, 2, 0, -0.5", ["-1", "-0.5"])]
)
def test_bands_of_less_than_nothing(told_of, bands: str, marked: list[str]) -> None:
    found = told_of(f"PROGRAM t; VAR POSE: p; BEGIN MOVE LIN p WITH TOLERANCE ({bands}); ENDPROGRAM")
    assert [(code, text) for code, _, text in found] == [("IRL505", value) for value in marked]


def test_uses_of_names_come_in_the_order_of_the_text(analysed) -> None:
    """Whatever has to be looked at last, as files that are read from."""
    text = """PROGRAM t; VAR FILE: points; REAL: x, sum := 0; INT: n := 0;
    BEGIN OPEN(points, 'points.txt', 'READ'); WHILE NOT EOF(points) DO READ(points, x); sum := sum + x;
    n := n + 1; ENDWHILE; CLOSE(points); WRITELN(n, ' numbers, sum ', sum:0:3); ENDPROGRAM"""
    starts = [reference.span.start for reference in analysed(text).references]
    assert len(starts) > 10
    assert starts == sorted(starts)
