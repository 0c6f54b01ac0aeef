"""By which names values may be given to the inputs of a program."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from irlx.language import tree
from irlx.language.builtins import is_port_name

__all__ = ["InputNames", "input_names"]

_PREFIXES = {"bool": ("IN_",), "boolean": ("IN_",), "int": ("AIN_",), "integer": ("AIN_",), "real": ("AIN_",)}
"""How ports of inputs of a type are called; a type of another name may be any of these."""
_EITHER = ("IN_", "AIN_")


@dataclass(frozen=True)
class InputNames:
    """Names of inputs, as spelt, and of their ports.

    `computed`: beginnings of the names of ports whose number only a run tells.
    """

    names: tuple[str, ...]
    computed: frozenset[str] = frozenset()

    def has(self, name: str) -> bool:
        """Whether a name, in any case, may be that of an input."""
        key = name.casefold()
        if key in (known.casefold() for known in self.names):
            return True
        return is_port_name(key) and key.rpartition("_")[0].upper() + "_" in self.computed


def input_names(roots: Iterable[tree.Node]) -> InputNames:
    """Names of the inputs that a program and its modules declare, their ports, and ports that are used."""
    found: dict[str, None] = {}
    computed = set[str]()
    for root in roots:
        for node in tree.walk(root):
            if isinstance(node, tree.SignalDeclaration) and node.direction == "INPUT":
                prefixes = _prefixes(node)
                for signal in node.signals:
                    found[signal.name.name] = None
                    if isinstance(signal.port, tree.IntLiteral):
                        found |= dict.fromkeys(f"{prefix}{signal.port.value}" for prefix in prefixes)
                    else:
                        computed.update(prefixes)
            found |= dict.fromkeys(_used(node))
    return InputNames(tuple(found), frozenset(computed))


def _prefixes(node: tree.SignalDeclaration) -> tuple[str, ...]:
    if node.medium is not None:
        return ("IN_",) if node.medium == "DIGITAL" else ("AIN_",)
    return _EITHER if node.type is None else _PREFIXES.get(node.type.name.key, _EITHER)


def _used(node: tree.Node) -> Iterator[str]:
    """A port of an input that is used by its own name."""
    if isinstance(node, tree.Designator) and is_port_name(node.base.key):
        word, _, number = node.base.key.partition("_")
        if word.endswith("in"):
            yield f"{word.upper()}_{int(number)}"
