"""Decimal text -> float64, whole arrays at a time: the way back from `digits`.

Numbers in the form d.dddddddddddddddde+dd are m 10^k with a whole m of 17 digits. The product is formed
as an unevaluated sum of two floats (Dekker) with a bound of its error. Where that bound leaves open which
float64 is nearest, and for numbers in any other form, Python reads the text: every result is the nearest.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.streams.irdata.digits import halves, powers_of_ten
from irlx.streams.joint_stream import Floats, Integers

Flags = NDArray[np.bool_]
Words = NDArray[np.uint64]

_TEXT = np.dtype(
    [
        ("digit", "u1"),
        ("point", "u1"),
        ("upper", "<u8"),
        ("lower", "<u8"),
        ("mark", "<u2"),
        ("exponent", "<u2"),
    ]
)
"""A number without its sign: d, '.', twice eight digits, 'e+' or 'e-', dd."""

_LENGTH = _TEXT.itemsize
_LOWEST = -99 - 16
_BLANK, _POINT, _MINUS, _ZERO = b" .-0"
_SMALLER, _LARGER = (int.from_bytes(mark, "little") for mark in (b"e-", b"e+"))

_HIGH, _LOW = powers_of_ten(_LOWEST, 99 - 16)
_HIGH_UPPER, _HIGH_LOWER = halves(_HIGH)

_DOUBT = 2.0**-100
"""Bound of the product's relative error; its terms add up to less than 2^-103."""

_MOST_DIGITS = 15


def _exponents() -> Integers:
    """Numbers of two digits by the integer that their two bytes are; -1 for all other bytes."""
    table = np.full(1 << 16, -1, dtype=np.int64)
    for number in range(100):
        table[int.from_bytes(f"{number:02d}".encode(), "little")] = number
    return table


_EXPONENTS = _exponents()


def floats_of(text: bytes, starts: Integers, ends: Integers, allowed: bytes) -> Floats:
    """Values of the numbers text[start:end], `starts` and `ends` of any same shape.

    Numbers consist of the characters `allowed` and may have blanks in front where a blank is one of
    them. Raises ValueError where one is no number.
    """
    bytes_ = np.frombuffer(text, dtype=np.uint8)
    first, last = starts.ravel(), ends.ravel()
    if len(text) < _LENGTH:
        values, plain = np.zeros(len(first)), np.zeros(len(first), dtype=bool)
    else:
        windows = np.ndarray((len(text) - _LENGTH + 1,), _TEXT, text, strides=(1,))
        negative, framed = _framed(bytes_, first, last, _BLANK in allowed)
        values, plain = _values(windows[np.maximum(last - _LENGTH, 0)])
        plain &= framed
        np.negative(values, out=values, where=negative)
    for place in np.flatnonzero(~plain).tolist():
        word = text[first[place] : last[place]]
        if word.translate(None, allowed):
            raise ValueError("a number holds other characters")
        values[place] = float(word)
    return values.reshape(starts.shape)


def counts_of(text: bytes, starts: Integers, ends: Integers) -> Integers:
    """Values of the counts text[start:end], up to 15 digits each and nothing else; otherwise ValueError."""
    bytes_ = np.frombuffer(text, dtype=np.uint8)
    length = ends - starts
    if length.size and not 1 <= length.min() <= length.max() <= _MOST_DIGITS:
        raise ValueError("a count has another length")
    values = np.zeros(length.shape, dtype=np.int64)
    for place in range(int(length.max(initial=0))):
        digit = bytes_[np.maximum(ends - 1 - place, 0)].astype(np.int64) - _ZERO
        digit[place >= length] = 0
        if ((digit < 0) | (digit > 9)).any():
            raise ValueError("a count holds other characters")
        values += digit * 10**place
    return values


def _framed(text: NDArray[np.uint8], first: Integers, last: Integers, padded: bool) -> tuple[Flags, Flags]:
    """Which numbers have a minus before their last 22 characters; where sign and blanks are as written."""
    before = last - first - _LENGTH
    sign = text[np.maximum(last - _LENGTH - 1, 0)]
    minus = sign == _MINUS
    if not padded:
        return minus & (before == 1), before == minus
    blank = text[np.maximum(last - _LENGTH - 2, 0)] == _BLANK
    return minus, (before == 2) & blank & (minus | (sign == _BLANK))


def _values(texts: NDArray[np.void]) -> tuple[Floats, Flags]:
    """Values of numbers without sign, and which of them are sure: in the one form, and correctly rounded."""
    upper, upper_whole = _eight_digits(texts["upper"].copy())
    lower, lower_whole = _eight_digits(texts["lower"].copy())
    first = texts["digit"].astype(np.int64) - _ZERO
    mark, size = texts["mark"], _EXPONENTS[texts["exponent"]]
    smaller = mark == _SMALLER
    sure = upper_whole & lower_whole & (first >= 0) & (first <= 9) & (texts["point"] == _POINT)
    sure &= (smaller | (mark == _LARGER)) & (size >= 0)
    power = np.where(smaller, -size, size) - 16 - _LOWEST
    power[~sure] = 0
    whole = first * 10**16 + upper * 10**8 + lower
    values, rounded = _times_power(whole, power)
    return values, sure & rounded


def _eight_digits(words: Words) -> tuple[Integers, Flags]:
    """Numbers that words of eight characters spell, and which words are eight digits."""
    high_halves = np.uint64(0xF0F0F0F0F0F0F0F0)
    # Only '0' to '9' have the upper half 3, and keep it when 6 is added.
    carried = ((words + np.uint64(0x0606060606060606)) & high_halves) >> np.uint64(4)
    digits = ((words & high_halves) | carried) == np.uint64(0x3333333333333333)
    # Neighbours are joined: digits to pairs, pairs to fours, fours to eight.
    value = words & np.uint64(0x0F0F0F0F0F0F0F0F)
    for factor, shift, mask in (
        (10 * 2**8 + 1, 8, 0x00FF00FF00FF00FF),
        (100 * 2**16 + 1, 16, 0x0000FFFF0000FFFF),
        (10000 * 2**32 + 1, 32, 0x00000000FFFFFFFF),
    ):
        value *= np.uint64(factor)
        value >>= np.uint64(shift)
        value &= np.uint64(mask)
    return value.view(np.int64), digits


def _times_power(whole: Integers, power: Integers) -> tuple[Floats, Flags]:
    """Float64 nearest to whole 10^(power + `_LOWEST`), whole up to 17 digits, and where that is sure."""
    size = whole.astype(np.float64)
    rest = (whole - size.astype(np.int64)).astype(np.float64)
    high, upper, lower = _HIGH[power], _HIGH_UPPER[power], _HIGH_LOWER[power]
    product = size * high
    size_upper, size_lower = halves(size)
    error = ((size_upper * upper - product) + size_upper * lower + size_lower * upper) + size_lower * lower
    error += size * _LOW[power] + rest * high
    doubt = product * _DOUBT
    values = product + (error - doubt)
    return values, values == product + (error + doubt)
