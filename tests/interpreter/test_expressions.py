"""Expressions on numbers, BOOLs and texts: precedence, types, the edges of INT and REAL."""

import math

import pytest

INT_MAX = 2**63 - 1


@pytest.mark.req("LANG-30")
@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("2 + 3 * 4", 14),
        ("(2 + 3) * 4", 20),
        ("10 - 4 - 3", 3),
        ("2 - -3", 5),
        ("-2 * 3", -6),
        ("- - 3", 3),
        ("+3", 3),
        ("7 DIV 2 * 2", 6),
        ("2 * 7 DIV 2", 7),
        ("7 MOD 4 + 1", 4),
        ("1 + 7 MOD 4", 4),
        ("2 * 3 = 6", True),
        ("1 < 2 AND 3 < 4", True),
        ("NOT FALSE AND FALSE", False),
        ("NOT (FALSE AND FALSE)", True),
        ("TRUE OR FALSE AND FALSE", True),
        ("(TRUE OR FALSE) AND FALSE", False),
        ("TRUE EXOR TRUE OR TRUE", True),
        ("TRUE EXOR (TRUE OR TRUE)", False),
        ("TRUE EXOR TRUE AND FALSE", True),
        ("(TRUE EXOR TRUE) AND FALSE", False),
        ("FALSE = TRUE AND FALSE = TRUE", False),
    ],
)
def test_precedence(value, expression, expected):
    found = value(expression)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.req("LANG-30")
@pytest.mark.parametrize(
    ("left", "right"), [(7, 2), (-7, 2), (7, -2), (-7, -2), (6, 3), (-6, 3), (0, 5), (1, 9), (-1, 9)]
)
def test_div_and_mod_round_towards_zero(value, left, right):
    quotient, rest = value(f"{left} DIV {right}"), value(f"{left} MOD {right}")
    assert quotient == math.trunc(left / right)
    assert quotient * right + rest == left
    assert rest == 0 or (rest > 0) is (left > 0)
    assert type(quotient) is int
    assert type(rest) is int


@pytest.mark.req("LANG-20")
@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("7 / 2", 3.5),
        ("6 / 2", 3.0),
        ("1 + 2.0", 3.0),
        ("2.5 - 1", 1.5),
        ("3 * 2.", 6.0),
        ("4 + 3", 7),
        ("1 = 1.0", True),
        ("2 > 1.5", True),
        ("1 <> 2", True),
        ("2 <= 2", True),
        ("2 >= 3", False),
        (f"{INT_MAX} - 1 + 1", INT_MAX),
        (f"-{INT_MAX} - 1", -INT_MAX - 1),
        (f"{INT_MAX} * 1.0", float(INT_MAX)),
        ("'it''s' = \"it's\"", True),
        ("'a' <> 'b'", True),
        ("TRUE = FALSE", False),
    ],
)
def test_types_of_results(value, expression, expected):
    found = value(expression)
    assert found == expected
    assert type(found) is type(expected)


@pytest.mark.req("LANG-20")
@pytest.mark.parametrize(
    ("expression", "marked"),
    [
        (f"1 + {INT_MAX + 1}", f"{INT_MAX + 1}"),
        (f"{INT_MAX} + 1", f"{INT_MAX} + 1"),
        (f"-{INT_MAX} - 2", f"-{INT_MAX} - 2"),
        (f"2 * {INT_MAX}", f"2 * {INT_MAX}"),
        (f"-(-{INT_MAX} - 1)", f"-(-{INT_MAX} - 1)"),
        (f"(-{INT_MAX} - 1) DIV -1", f"(-{INT_MAX} - 1) DIV -1"),
        ("1E308 * 10", "1E308 * 10"),
        ("1E308 + 1E308", "1E308 + 1E308"),
        ("1E308 / 0.01", "1E308 / 0.01"),
        ("POSITION(1E308, 0, 0) * 10", "POSITION(1E308, 0, 0) * 10"),
        (
            "POSITION(1E308, 0, 0) + POSITION(1E308, 0, 0)",
            "POSITION(1E308, 0, 0) + POSITION(1E308, 0, 0)",
        ),
        ("NORM((1E308, 0, 0))", "NORM((1E308, 0, 0))"),
        ("POSITION(1E308, 1, 0) / 0.5", "POSITION(1E308, 1, 0) / 0.5"),
    ],
)
def test_overflow(value_error, expression, marked):
    code, message, text = value_error(expression)
    assert (code, text) == ("IRL503", marked)
    assert message.endswith("leaves the range of REAL" if "E308" in expression else "leaves the range of INT")


@pytest.mark.req("LANG-30")
@pytest.mark.parametrize(
    "expression",
    ["1 / 0", "1 / 0.0", "0 / 0", "5 DIV 0", "5 MOD 0", "POSITION(1, 2, 3) / 0", "1 / (2 - 2)"],
)
def test_division_by_zero(value_error, expression):
    assert value_error(expression) == ("IRL502", "division by zero", expression)


@pytest.mark.req("LANG-30")
@pytest.mark.parametrize(
    ("expression", "expected"),
    [("FALSE AND 1 / 0 = 1", False), ("TRUE OR 1 / 0 = 1", True)],
)
def test_and_or_look_no_further_than_needed(value, expression, expected):
    assert value(expression) is expected


@pytest.mark.req("LANG-30")
@pytest.mark.parametrize("expression", ["TRUE AND 1 / 0 = 1", "FALSE OR 1 / 0 = 1", "TRUE EXOR 1 / 0 = 1"])
def test_the_right_side_counts_where_it_is_needed(value_error, expression):
    assert value_error(expression)[0] == "IRL502"


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("1 AND TRUE", ("IRL222", "expected BOOL, found INT", "1")),
        ("TRUE AND 1", ("IRL222", "expected BOOL, found INT", "1")),
        ("FALSE OR 'a'", ("IRL222", "expected BOOL, found STRING", "'a'")),
        ("7.0 DIV 2", ("IRL227", "DIV is not defined for REAL and INT", "7.0 DIV 2")),
        ("7 MOD 2.0", ("IRL227", "MOD is not defined for INT and REAL", "7 MOD 2.0")),
        ("TRUE + 1", ("IRL227", "+ is not defined for BOOL and INT", "TRUE + 1")),
        ("TRUE < FALSE", ("IRL227", "< is not defined for BOOL and BOOL", "TRUE < FALSE")),
        ("'a' < 'b'", ("IRL227", "< is not defined for STRING and STRING", "'a' < 'b'")),
        ("1 = TRUE", ("IRL227", "= is not defined for INT and BOOL", "1 = TRUE")),
        ("1 EXOR TRUE", ("IRL227", "EXOR is not defined for INT and BOOL", "1 EXOR TRUE")),
        ("1 @ 2", ("IRL227", "@ is not defined for INT and INT", "1 @ 2")),
    ],
)
def test_operands_that_do_not_fit(value_error, expression, expected):
    assert value_error(expression) == expected


@pytest.mark.parametrize("expression", ["NOT 1", "-TRUE", "+'a'"])
def test_signs_of_what_has_none(value_error, expression):
    code, message, text = value_error(expression)
    assert (code, text) == ("IRL227", expression)
    assert "is not defined for" in message
    assert " and " not in message


@pytest.mark.req("LANG-34")
@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("SIN(30)", 0.5),
        ("COS(60)", 0.5),
        ("TAN(45)", 1.0),
        ("ASIN(1)", 90.0),
        ("ACOS(-1)", 180.0),
        ("ATAN(1)", 45.0),
        ("ATAN2(1, -1)", 135.0),
        ("ATAN2(-1, -1)", -135.0),
        ("SQRT(2)", math.sqrt(2)),
        ("EXP(1)", math.e),
        ("LN(EXP(2))", 2.0),
        ("ABS(-3.5)", 3.5),
        ("NORM((3, 4, 12))", 13.0),
        ("sqrt(Sqrt(16))", 2.0),
    ],
)
def test_functions(value, expression, expected):
    assert value(expression) == pytest.approx(expected, abs=1e-15, rel=1e-15)


@pytest.mark.req("LANG-34")
@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("SQRT(-1)", "SQRT has no value at -1"),
        ("LN(0)", "LN has no value at 0"),
        ("ASIN(1.5)", "ASIN has no value at 1.5"),
        ("ACOS(-2)", "ACOS has no value at -2"),
        ("TAN(90)", "TAN has no value at 90"),
        ("TAN(-270)", "TAN has no value at -270"),
    ],
)
def test_functions_outside_their_domain(value_error, expression, expected):
    assert value_error(expression) == ("IRL506", expected, expression)


def test_a_result_beyond_the_range_is_no_gap_of_the_function(value_error):
    assert value_error("EXP(1000)") == ("IRL503", "the result leaves the range of REAL", "EXP(1000)")


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("SIN()", "SIN takes 1 value, found 0"),
        ("SIN(1, 2)", "SIN takes 1 value, found 2"),
        ("ATAN2(1)", "ATAN2 takes 2 values, found 1"),
        ("POSITION(1, 2)", "POSITION takes 3 values, found 2"),
    ],
)
def test_wrong_number_of_arguments(value_error, expression, expected):
    assert value_error(expression) == ("IRL228", expected, expression)


@pytest.mark.req("LANG-34")
def test_abs_keeps_int(value, value_error):
    assert type(value("ABS(-3)")) is int
    assert type(value("ABS(-3.0)")) is float
    assert value_error("ABS(TRUE)") == ("IRL222", "expected INT or REAL, found BOOL", "TRUE")
    assert value_error(f"ABS(-{INT_MAX} - 1)")[0] == "IRL503"
