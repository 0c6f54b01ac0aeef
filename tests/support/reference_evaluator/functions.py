"""Built-in functions of numbers and texts, each as the table of the reference has it."""

from __future__ import annotations

import math
from fractions import Fraction

from reference_evaluator.geometry import NoValueThere
from reference_evaluator.types import CHAR, INT, REAL, STRING, Value


class OutOfRange(Exception):
    """A result beyond INT or REAL."""


def int_value(number):
    if not -(2**63) <= number < 2**63:
        raise OutOfRange
    return Value(INT, number)


def real_value(number):
    if not math.isfinite(number):
        raise OutOfRange
    return Value(REAL, number)


def rounded(x):
    """Nearest whole number, halves away from zero, in exact arithmetic."""
    size = math.floor(abs(Fraction(x)) + Fraction(1, 2))
    return int_value(-size if x < 0 else size)


def only(condition, function):
    def careful(*arguments):
        if not condition(*arguments):
            raise NoValueThere
        try:
            return real_value(function(*arguments))
        except OverflowError:
            raise OutOfRange from None

    return careful


def always(*_):
    return True


def character(number):
    if not 0 <= number <= 0x10FFFF or 0xD800 <= number <= 0xDFFF:
        raise NoValueThere
    return Value(CHAR, chr(number))


def degrees(function):
    return lambda *arguments: math.degrees(function(*arguments))


def of_degrees(function):
    return lambda angle: function(math.radians(angle))


FUNCTIONS = {
    "sqrt": ((REAL,), only(lambda x: x >= 0, math.sqrt)),
    "sin": ((REAL,), only(always, of_degrees(math.sin))),
    "cos": ((REAL,), only(always, of_degrees(math.cos))),
    "tan": ((REAL,), only(lambda x: math.fmod(abs(x), 180.0) != 90.0, of_degrees(math.tan))),
    "asin": ((REAL,), only(lambda x: -1 <= x <= 1, degrees(math.asin))),
    "acos": ((REAL,), only(lambda x: -1 <= x <= 1, degrees(math.acos))),
    "atan": ((REAL,), only(always, degrees(math.atan))),
    "atan2": ((REAL, REAL), only(always, degrees(math.atan2))),
    "exp": ((REAL,), only(always, math.exp)),
    "ln": ((REAL,), only(lambda x: x > 0, math.log)),
    "round": ((REAL,), rounded),
    "trunc": ((REAL,), lambda x: int_value(math.trunc(x))),
    "float": ((INT,), lambda i: Value(REAL, float(i))),
    "ord": ((CHAR,), lambda c: Value(INT, ord(c))),
    "chr": ((INT,), character),
    "len": ((STRING,), lambda s: Value(INT, len(s))),
}
