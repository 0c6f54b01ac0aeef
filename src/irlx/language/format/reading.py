"""A text with what the parser makes of it, so that it is read once."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.diagnostics import SourceText
from irlx.language.parser import Parse, parse
from irlx.language.source import source_text

__all__ = ["Reading"]


@dataclass(frozen=True)
class Reading:
    """A text and its parse."""

    source: SourceText
    parsed: Parse

    def of(self, text: str) -> Reading:
        """The reading of a text of the same name; this one where it is the same text."""
        if text == self.source.text:
            return self
        source = source_text(self.source.name, text)
        return Reading(source, parse(source))
