"""What a formatted text must share with the one it comes from."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, TypeAlias

from irlx.diagnostics import SourceText, Span
from irlx.language import tree
from irlx.language.format.ports import DeclaredPorts
from irlx.language.format.reading import Reading
from irlx.language.format.repair import REPAIRED
from irlx.language.lexing import Lexed, lex
from irlx.language.source import source_text

__all__ = ["what_is_lost"]

_Root: TypeAlias = "tree.Program | tree.Module | tree.DataList"
_SPELLED = frozenset({"NAME", "INT", "REAL", "STRING"})


def what_is_lost(before: Reading, after: Reading, ports: DeclaredPorts) -> str:
    """What of a text is not the same in its formatted form, or '' where all is.

    Nothing but the declarations of `ports` may be there that was not before.
    """
    # What is mended must be gone; a warning that is nobody's to mend, of a comment in a comment, may stay.
    known = {finding.code for finding in before.parsed.findings if not finding.is_error} - REPAIRED
    codes = {finding.code for finding in after.parsed.findings}
    faulty = any(code.startswith("IRL1") for code in codes - known)
    if faulty or _without(after.parsed.tree, ports.nodes) != before.parsed.tree:
        return "the meaning of the program"
    old, new = before.parsed.lexed, after.parsed.lexed
    added = _spellings(lex(source_text("", ports.written))) if ports.written else []
    if not _differs_by(_spellings(old), _spellings(new), added):
        return "the spelling of a name or a literal"
    if _comments(before.source, old.comments) != _comments(after.source, new.comments):
        return "every comment"
    return ""


def _without(root: _Root | None, nodes: Sequence[tree.Declaration]) -> _Root | None:
    """A tree without declarations that all must be in it, else None."""
    if root is None or not nodes:
        return root
    left: list[Any] = list(root.declarations)
    for node in nodes:
        if node not in left:
            return None
        left.remove(node)
    return replace(root, declarations=tuple(left))


def _differs_by(old: list[str], new: list[str], added: list[str]) -> bool:
    """Whether `new` is `old` with `added` in one place."""
    if not added:
        return old == new
    same = next((i for i, (one, other) in enumerate(zip(old, new, strict=False)) if one != other), len(old))
    places = range(max(same - len(added), 0), same + 1)
    return any(new == [*old[:place], *added, *old[place:]] for place in places)


def _spellings(lexed: Lexed) -> list[str]:
    return [str(token) for token in lexed.tokens if token.type in _SPELLED]


def _comments(source: SourceText, comments: Sequence[Span]) -> Counter[str]:
    """The comments of a text; blanks at both ends of their lines do not count, since lines move."""
    texts = (source.text[span.start : span.end] for span in comments)
    return Counter("\n".join(line.strip() for line in text.split("\n")) for text in texts)
