"""What a reduction gets: the tokens and nodes of a rule's right side, in order, none left out."""

from __future__ import annotations

from typing import Any, TypeAlias

from irlx.diagnostics.place import Span
from irlx.language.token import Token
from irlx.language.tree import Node

Children: TypeAlias = list[Any]


def span_of(children: Children) -> Span:
    """Span from the first child to the last; both have to be tokens or nodes."""
    first, last = children[0], children[-1]
    start: Any = first.start_pos if type(first) is Token else first.span.start
    end: Any = last.end_pos if type(last) is Token else last.span.end
    return Span(start, end)


def nodes_of(children: Children) -> tuple[Any, ...]:
    """The nodes among the children."""
    return tuple([child for child in children if isinstance(child, Node)])


def word_of(token: Token) -> str:
    """A keyword or sign as the tree writes it: words in capitals."""
    return str(token.type) if token[0].isalpha() else str(token)
