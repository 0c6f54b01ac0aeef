"""Values that a text tells, of constants and of variables that it sets once."""

from __future__ import annotations

from irlx.language.checking.context import Settled
from irlx.language.checking.names import Constant, Entry


def value_of(settled: Settled) -> Constant | None:
    """The value, or None where a variable may have had another one before or after."""
    if isinstance(settled, Entry):
        return settled.settled if settled.settings == 1 else None
    return settled
