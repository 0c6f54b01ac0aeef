"""Numbers in messages that compare them: as many digits as tell them apart."""

from __future__ import annotations

_MOST_DIGITS = 17


def plain(value: float, digits: int) -> str:
    """A number in so many significant digits, or in all before its point, never with an exponent above."""
    return f"{value:.0f}" if abs(value) >= 10.0 ** (digits - 1) else f"{value:.{digits}g}"


def told_apart(*values: float, digits: int = 6) -> list[str]:
    """Texts of some numbers, in `digits` significant digits, or more where two of them would read alike.

    Numbers that are the same have the same text.
    """
    different = len(set(values))
    for count in range(digits, _MOST_DIGITS):
        told = [f"{value:.{count}g}" for value in values]
        if len(set(told)) == different:
            return told
    return [repr(float(value)).removesuffix(".0") for value in values]
