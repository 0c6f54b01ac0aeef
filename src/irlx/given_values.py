"""What a caller gives in Python, checked: numbers that are none are told as those that are out of range."""

from __future__ import annotations

from collections.abc import Callable
from numbers import Integral, Real
from typing import Any

from irlx.diagnostics import IrlxError, report


def check_number(option: str, given: Any, cause: str, fits: Callable[[Any], bool]) -> None:
    """Raises IrlxError, IRL006 with what it should be, for what is no number or does not fit; None passes."""
    if given is not None and not (_is(Real, given) and _is_of_floats(given) and fits(given)):
        raise _refused(option, given, cause)


def check_count(option: str, given: Any, least: int) -> None:
    """Raises IrlxError, IRL006, for what is no whole number from `least` on; None passes."""
    if given is not None and not (_is(Integral, given) and given >= least):
        raise _refused(option, given, f"a whole number, at least {least}")


def check_kind(option: str, given: object, kinds: tuple[type, ...], cause: str) -> None:
    """Raises IrlxError, IRL006 with what it should be, for what is of none of some kinds; None passes."""
    if given is not None and not isinstance(given, kinds):
        raise _refused(option, given, cause)


def _is(kind: type, given: object) -> bool:
    """Whether a value is a number of a kind; truth values are none."""
    return isinstance(given, kind) and not isinstance(given, bool)


def _is_of_floats(given: Any) -> bool:
    """Whether a number is not beyond all floats, as whole ones and fractions may be."""
    try:
        float(given)
    except OverflowError:
        return False
    return True


def _refused(option: str, given: Any, cause: str) -> IrlxError:
    value = f"{given:g}" if isinstance(given, float) else repr(given)
    return IrlxError(report("IRL006", option=option, value=value, cause=cause))
