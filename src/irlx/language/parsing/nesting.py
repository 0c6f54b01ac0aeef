"""Bound on the depth of expressions, so that whoever walks the tree may do so recursively."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from irlx.diagnostics import Diagnostic, report
from irlx.language.parsing.driver import Driver
from irlx.language.tree import Node

__all__ = ["MAX_DEPTH", "too_deep"]

MAX_DEPTH = 150
# A statement needs at least this many operators in a row before its tree can be too deep.
_SUSPICIOUS = 60
_DEEPENING = frozenset(
    [
        "PLUS",
        "MINUS",
        "STAR",
        "SLASH",
        "COMPOSE",
        "AND",
        "OR",
        "EXOR",
        "DIV",
        "MOD",
        "NOT",
        "LEFT_PAREN",
        "LEFT_BRACKET",
    ]
)


def too_deep(tree: Node, driver: Driver) -> Diagnostic | None:
    """The finding on an expression nested too deeply, or None; walks without recursion."""
    if not _is_suspicious(driver):
        return None
    stack: list[tuple[Any, int]] = [(tree, 0)]
    while stack:
        node, depth = stack.pop()
        if isinstance(node, tuple):
            stack.extend((item, depth) for item in node)
        elif isinstance(node, Node):
            if depth > MAX_DEPTH:
                place = driver.place(node.span)
                return report("IRL118", place, limit=MAX_DEPTH, what="expressions")
            stack.extend((getattr(node, field.name), depth + 1) for field in fields(node))
    return None


def _is_suspicious(driver: Driver) -> bool:
    count = 0
    for token in driver.tokens:
        kind = token.type
        if kind in _DEEPENING:
            count += 1
            if count > _SUSPICIOUS:
                return True
        elif kind == "SEMICOLON":
            count = 0
    return False
