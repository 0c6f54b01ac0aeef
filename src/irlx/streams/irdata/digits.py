"""Float64 -> decimal text of fixed width, whole arrays at a time.

Seventeen significant digits identify every float64, so the text reads back to the same bits. The
digits of x come from the integer m = round(x 10^(16 - e)), e the decimal exponent, whose product is
formed as an unevaluated sum of two floats (Dekker): about 106 bits, where 57 are needed.
"""

from __future__ import annotations

from decimal import Decimal, localcontext

import numpy as np
from numpy.typing import NDArray

from irlx.streams.joint_stream import Floats, Integers

WIDTH = 24
"""Characters of a number: the longest that repr can give, which stands in for extreme values."""

_REACH = 90
"""Decimal exponents up to this size go the quick way."""

_LOWEST = 16 - _REACH - 2
_SPLITTER = 134217729.0  # 2^27 + 1 cuts a float64 into two halves of 26 bits

FIELD = np.dtype(
    [
        ("separator", "S2"),
        ("blank", "u1"),
        ("sign", "u1"),
        ("digit", "u1"),
        ("point", "u1"),
        ("groups", "<u4", (4,)),
        ("exponent", "<u4"),
    ]
)
"""A number in memory: ', ', a blank, sign or blank, d, '.', four groups of four digits, 'e+dd'."""


def powers_of_ten(lowest: int, highest: int) -> tuple[Floats, Floats]:
    """10^k as sums of two floats, k from `lowest` to `highest`."""
    with localcontext() as context:
        context.prec = 120
        exact = [Decimal(10) ** k for k in range(lowest, highest + 1)]
        high = [float(power) for power in exact]
        low = [float(power - Decimal(part)) for power, part in zip(exact, high, strict=True)]
    return np.array(high), np.array(low)


def _words(texts: list[str]) -> NDArray[np.uint32]:
    """Texts of four characters as integers that hold their bytes."""
    return np.frombuffer("".join(texts).encode(), dtype="<u4")


_HIGH, _LOW = powers_of_ten(_LOWEST, 16 + _REACH + 2)
_GROUPS = _words([f"{number:04d}" for number in range(10000)])
_EXPONENTS = _words([f"e{exponent:+03d}" for exponent in range(-_REACH - 2, _REACH + 3)])


def fill_fields(fields: NDArray[np.void], values: Floats) -> None:
    """Write the text of finite `values` into `fields` (same shape, dtype `FIELD`)."""
    size = np.abs(values)
    extreme = ((size < 10.0**-_REACH) | (size >= 10.0**_REACH)) & (size != 0.0)
    plain = np.where((size == 0.0) | extreme, 1.0, size)
    exponent = np.floor(np.log10(plain)).astype(np.int64)
    whole = _scaled(plain, exponent)
    # The logarithm errs next to powers of ten, and rounding may carry into an eighteenth digit.
    for wrong, shift in ((whole >= 10**17, 1), (whole < 10**16, -1)):
        if wrong.any():
            exponent[wrong] += shift
            whole[wrong] = _scaled(plain[wrong], exponent[wrong])
    zero = size == 0.0
    whole[zero] = 0
    exponent[zero] = 0
    _write(fields, values, whole, exponent)
    for place in zip(*np.nonzero(extreme), strict=True):
        _write_extreme(fields, place, float(values[place]))


def _scaled(size: Floats, exponent: Integers) -> Integers:
    """round(size 10^(16 - exponent)): the product's float, and its error as a second float."""
    which = 16 - exponent - _LOWEST
    high = _HIGH[which]
    product = size * high
    size_high, size_low = halves(size)
    power_high, power_low = halves(high)
    error = ((size_high * power_high - product) + size_high * power_low + size_low * power_high) + (
        size_low * power_low
    )
    # Products of 17 digits are beyond 2^53, so the first float is whole and only the second rounds.
    return product.astype(np.int64) + np.rint(error + size * _LOW[which]).astype(np.int64)


def halves(values: Floats) -> tuple[Floats, Floats]:
    """Two floats of half the bits each whose sum is the value (Veltkamp)."""
    spread = values * _SPLITTER
    high = spread - (spread - values)
    return high, values - high


def _write(fields: NDArray[np.void], values: Floats, whole: Integers, exponent: Integers) -> None:
    first = whole // 10**16
    rest = whole - first * 10**16
    upper = rest // 10**8
    lower = rest - upper * 10**8
    fields["separator"] = b", "
    fields["blank"] = ord(" ")
    fields["sign"] = np.where(np.signbit(values), ord("-"), ord(" "))
    fields["digit"] = first + ord("0")
    fields["point"] = ord(".")
    groups = fields["groups"]
    for number, eight in ((0, upper), (2, lower)):
        four = eight // 10**4
        groups[..., number] = _GROUPS[four]
        groups[..., number + 1] = _GROUPS[eight - four * 10**4]
    fields["exponent"] = _EXPONENTS[exponent + _REACH + 2]


def _write_extreme(fields: NDArray[np.void], place: tuple[np.intp, ...], value: float) -> None:
    """Python's shortest text, right-aligned, for a value that the tables do not reach."""
    text = np.frombuffer(b", " + repr(value).rjust(WIDTH).encode(), dtype=FIELD)
    fields[place] = text[0]
