"""How many moves a program will make, where its text alone tells."""

from __future__ import annotations

from collections.abc import Iterable

from irlx.language import tree

__all__ = ["move_count"]

_ASTRAY = (tree.Goto, tree.Exit, tree.Halt, tree.Return)
"""Statements behind which others may be left out, or come again."""


def move_count(program: tree.Program, others: Iterable[tree.Module] = ()) -> int | None:
    """Number of moves and RECONFIGURATIONs that a straight program executes, None for any other.

    Straight is a program that has all of them in its main statements, none in a loop, a branch or a routine
    of its own or of the `others`, the modules that it needs, and nothing that leads past them.
    """
    declared = [*program.declarations, *(part for module in others for part in module.declarations)]
    if any(_moves(node) for part in declared for node in tree.walk(part)):
        return None
    count = 0
    for statement in program.body:
        inside = list(tree.walk(statement))
        if any(isinstance(node, _ASTRAY) for node in inside):
            return None
        own = _moves(statement)
        if not own and any(_moves(node) for node in inside):
            return None
        count += own
    return count


def _moves(node: tree.Node) -> int:
    """Moves that a statement makes by itself."""
    if isinstance(node, tree.Reconfiguration):
        return 1
    if not isinstance(node, tree.Move):
        return 0
    if node.path:
        return 1
    return len(node.targets) // 2 if node.kind == "CIRCLE" else len(node.targets)
