"""Lints: what is allowed and seldom meant (LANG-73)."""

from irlx.language.lints.lints import lints_of

__all__ = ["lints_of"]
