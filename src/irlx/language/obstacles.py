"""Obstacles of the cell in a program: where it names them, and what is said of names that the cell lacks."""

from __future__ import annotations

from collections.abc import Collection, Iterator

from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.language import tree

__all__ = ["OBSTACLE_NAME", "names_of_cell", "obstacle_name", "own_nodes", "unknown_obstacle"]

OBSTACLE_NAME = "the name of an obstacle or group of the cell"
"""What messages call an argument that must be one."""

_AVOIDING = frozenset({"clearance", "posture"})
"""Built-in functions, casefolded, whose second argument names an obstacle or group of the cell."""


def names_of_cell(call: tree.FunctionCall) -> set[int]:
    """The argument of a built-in function that names an obstacle and means nothing else, by its identity."""
    if call.name.key not in _AVOIDING or len(call.arguments) != 2:
        return set()
    argument = call.arguments[1]
    return set() if obstacle_name(argument) is None else {id(argument)}


def own_nodes(*roots: tree.Node) -> Iterator[tree.Node]:
    """All nodes as `tree.walk` gives them, but for arguments that name an obstacle."""
    of_cell: set[int] = set()
    for node in tree.walk(*roots):
        if id(node) in of_cell:
            continue
        if isinstance(node, tree.FunctionCall):
            of_cell |= names_of_cell(node)
        yield node


def obstacle_name(argument: tree.Argument) -> tree.Name | None:
    """The name that an argument is, None where it is anything else."""
    if isinstance(argument, tree.Designator) and not argument.selectors:
        return argument.base
    return None


def unknown_obstacle(name: str, known: Collection[str], place: Place) -> Diagnostic:
    """The finding, IRL573, on a name that is none of those `known` in the cell."""
    names = sorted(known)
    return report(
        "IRL573", place, name=name, near=near_matches(name, names), known=", ".join(names) or "none"
    )
