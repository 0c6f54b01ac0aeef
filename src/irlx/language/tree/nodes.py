"""What every node of the tree has, and names as a program spells them."""

from __future__ import annotations

from dataclasses import dataclass, field

from irlx.diagnostics.place import Span


@dataclass(frozen=True, slots=True)
class Node:
    """Any node of the tree; two nodes are equal when they say the same, wherever they stand."""

    span: Span = field(compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Name(Node):
    """A name where a program writes it: `name` as spelt, `key` casefolded for comparison."""

    name: str = field(compare=False)
    key: str
