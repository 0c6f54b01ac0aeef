"""Values as WRITE writes them."""

from __future__ import annotations

from irlx.interpreter.values import Value


def plain(value: Value) -> str:
    """The text of a simple value; that of a REAL is the shortest that gives the very number again."""
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    return repr(value).upper() if isinstance(value, float) else str(value)


def laid_out(value: Value, width: int, precision: int | None) -> str:
    """The text of a value, at least `width` long and at its right; a number with `precision` decimals."""
    text = plain(value)
    if precision is not None and isinstance(value, float):
        text = f"{value:.{precision}f}"
    elif precision:
        # Not by way of a float, which has fewer digits than an INT.
        text = f"{text}.{'0' * precision}"
    return text.rjust(width)
