"""Visiting every node of a tree."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from functools import cache
from typing import Any

from irlx.language.tree.nodes import Node

__all__ = ["walk"]


_PLAIN = frozenset({"bool", "float", "int", "str"})
"""Types, as the annotations spell them, of fields without nodes."""


@cache
def _child_fields(kind: Any) -> tuple[str, ...]:
    """Fields of a kind of nodes that may hold nodes, the last one first."""
    return tuple(
        field.name
        for field in reversed(fields(kind))
        if field.name not in ("span", "key", "op", "kind") and field.type not in _PLAIN
    )


def walk(*roots: Node) -> Iterator[Node]:
    """The roots and all nodes below them, each before what it holds, in the order of the text.

    Works without recursion, so the depth of a tree does not matter.
    """
    stack: list[Node] = list(reversed(roots))
    while stack:
        node = stack.pop()
        yield node
        kind: Any = type(node)
        for name in _child_fields(kind):
            child = getattr(node, name)
            if isinstance(child, tuple):
                stack.extend(reversed(child))
            elif isinstance(child, Node):
                stack.append(child)
