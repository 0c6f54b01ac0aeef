"""The type check: what every expression is, and whether it may stand where it does, before anything runs."""

from irlx.language.checking.check import TypedText, check_types

__all__ = ["TypedText", "check_types"]
