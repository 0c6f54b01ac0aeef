"""Comments whose end is missing: where they end in all likelihood."""

from __future__ import annotations

import re
from functools import lru_cache

from irlx.diagnostics import Span
from irlx.language.keywords import keyword_table

__all__ = ["TO_IRLX", "opens_another", "repaired", "speaks_to_irlx"]

_MOST = 20
# Texts and comments, so that a sign inside one of them opens nothing.
_PARTS = re.compile(
    r"'(?:[^'\n]|'')*'?|\"(?:[^\"\n]|\"\")*\"?|//[^\n]*|(\{[^}]*\}?)|(\(\*[\s\S]*?(?:\*\)|\Z))"
)
_LATER_OPENING = re.compile(r"\n[^\n]*?(\{|\(\*)")
_WORD = re.compile(r"[^\W\d_]\w*")
TO_IRLX = re.compile(
    r"(?:\{|\(\*)\s*irlx\s*:\s*(?:ignore\b(?P<codes>.*?)|.*?)(?:\}|\*\))", re.IGNORECASE | re.DOTALL
)
"""A comment that speaks to irlx; `codes` is what it asks to ignore, None where it asks for something else."""


def speaks_to_irlx(comment: str) -> bool:
    """Whether a comment is meant for irlx, such as one that asks to ignore a warning."""
    return TO_IRLX.fullmatch(comment) is not None


def opens_another(comment: str) -> int | None:
    """Offset in a comment of the beginning of another one on a later line, or None."""
    found = _LATER_OPENING.search(comment) if "\n" in comment else None
    return None if found is None else found.start(1)


def repaired(text: str, *, trust: bool) -> tuple[str, tuple[Span, ...]]:
    """A text of the same length whose comments without end are blanked, and where they were.

    Without `trust` a comment that holds the beginning of another one counts as one without end.
    """
    spans: list[Span] = []
    while len(spans) < _MOST:
        found = _unclosed(text, trust=trust, start=spans[-1].end if spans else 0)
        if found is None:
            break
        span = Span(found, _likely_end(text, found))
        spans.append(span)
        blank = re.sub(r"[^\n]", " ", text[span.start : span.end])
        text = text[: span.start] + blank + text[span.end :]
    return text, tuple(spans)


def _unclosed(text: str, *, trust: bool, start: int) -> int | None:
    """Offset of the first comment without end."""
    if trust and _all_closed(text, start):
        return None
    for part in _PARTS.finditer(text, start):
        comment = part[1] or part[2]
        if comment is None:
            continue
        closed = comment.endswith("}") if part[1] else len(comment) >= 4 and comment.endswith("*)")
        if not closed or (not trust and opens_another(comment) is not None):
            return part.start()
    return None


def _all_closed(text: str, start: int) -> bool:
    """Whether the last beginning of a comment has an end behind it, which is quick to see."""
    return text.rfind("{", start) <= text.rfind("}", start) and text.rfind("(*", start) + 1 < max(
        text.rfind("*)", start), 1
    )


def _likely_end(text: str, start: int) -> int:
    """Where a comment without end was to end: with its line, or before the next line that looks like code."""
    end = text.find("\n", start)
    while 0 <= end < len(text):
        after = text.find("\n", end + 1)
        line = text[end + 1 : after if after >= 0 else len(text)].strip()
        if after < 0 or not line or _looks_like_code(line):
            return end
        end = after
    return len(text)


@lru_cache(maxsize=256)
def _looks_like_code(line: str) -> bool:
    if line.endswith(";") or line.startswith(("{", "(*")) or ":=" in line:
        return True
    word = _WORD.match(line)
    # Prose is rarely in capitals, keywords mostly are.
    return word is not None and word[0].casefold() in keyword_table() and word[0].isupper()
