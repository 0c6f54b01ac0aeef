"""Names that the language has and this version does not execute: system variables and types."""

from __future__ import annotations

from irlx.language import tree
from irlx.language.builtins import SYSTEM_VARIABLES

LATER_TYPES = frozenset({"semaphore", "signal"})
"""Predefined types that are read only, by casefolded name."""


def system_name(name: tree.Name) -> str:
    """What a name without a variable is in the language, for messages, or '' where it is nothing."""
    return f"the system variable {name.name}" if name.key in SYSTEM_VARIABLES else ""
