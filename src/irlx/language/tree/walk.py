"""Visiting every node of a tree."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from functools import cache
from typing import Any

from irlx.language.tree.nodes import Name, Node

__all__ = ["walk"]


@cache
def _child_fields(kind: Any) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind) if field.name not in ("span", "key", "op", "kind"))


def walk(*roots: Node) -> Iterator[Node]:
    """The roots and all nodes below them, each before what it holds, in the order of the text.

    Works without recursion, so the depth of a tree does not matter.
    """
    stack: list[Node] = list(reversed(roots))
    while stack:
        node = stack.pop()
        yield node
        if isinstance(node, Name):
            continue
        kind: Any = type(node)
        for name in reversed(_child_fields(kind)):
            child = getattr(node, name)
            if isinstance(child, Node):
                stack.append(child)
            elif isinstance(child, tuple):
                stack.extend(reversed(child))
