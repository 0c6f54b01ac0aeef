"""What a formatted text must share with the one it comes from."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from irlx.diagnostics import SourceText, Span
from irlx.language.lexing import Lexed, lex
from irlx.language.parser import Parse, parse

__all__ = ["what_is_lost"]

_SPELLED = frozenset({"NAME", "INT", "REAL", "STRING"})


def what_is_lost(before: SourceText, parsed: Parse, after: SourceText) -> str:
    """What of a text is not the same in its formatted form, or '' where all is."""
    again = parse(after)
    if any(finding.code.startswith("IRL1") for finding in again.findings) or again.tree != parsed.tree:
        return "the meaning of the program"
    old, new = lex(before), lex(after)
    if _spellings(old) != _spellings(new):
        return "the spelling of a name or a literal"
    if _comments(before, old.comments) != _comments(after, new.comments):
        return "every comment"
    return ""


def _spellings(lexed: Lexed) -> list[str]:
    return [str(token) for token in lexed.tokens if token.type in _SPELLED]


def _comments(source: SourceText, comments: Sequence[Span]) -> Counter[str]:
    """The comments of a text; blanks at both ends of their lines do not count, since lines move."""
    texts = (source.text[span.start : span.end] for span in comments)
    return Counter("\n".join(line.strip() for line in text.split("\n")) for text in texts)
