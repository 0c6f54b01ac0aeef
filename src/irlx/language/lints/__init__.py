"""Lints: what is allowed and seldom meant (LANG-73)."""

from irlx.language.lints.lints import first_of_each, lints_of

__all__ = ["first_of_each", "lints_of"]
