"""What names mean: the symbols that a program, a module or a routine declares."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Literal, TypeAlias

from irlx.diagnostics import SourceText
from irlx.language import tree
from irlx.language.types import Signature, Type

__all__ = ["Routine", "Symbol", "SymbolKind", "declared_symbols", "parameter_symbols"]

SymbolKind: TypeAlias = Literal[
    "variable",
    "constant",
    "type",
    "input",
    "output",
    "procedure",
    "function",
    "robot",
    "import",
    "parameter",
]
Routine: TypeAlias = "tree.ProcedureDeclaration | tree.FunctionDeclaration"


@dataclass(frozen=True, slots=True)
class Symbol:
    """A declared name: how it is spelt where declared, what it is, and the node that declares it.

    `source` is the text that declares it where that is not the program's own: a data list. The check of types
    adds `type`, of a function that of its result, and the `signature` of routines.
    """

    name: tree.Name
    kind: SymbolKind
    declaration: tree.Node
    source: SourceText | None = None
    type: Type | None = None
    signature: Signature | None = None


def declared_symbols(declarations: Iterable[tree.Declaration]) -> Iterator[Symbol]:
    """Symbols of a list of declarations in order, duplicates included."""
    for declaration in declarations:
        match declaration:
            case tree.VarDeclaration(variables=variables):
                for variable in variables:
                    yield Symbol(variable.name, "variable", declaration)
            case tree.ConstDeclaration(constants=constants):
                for constant in constants:
                    yield Symbol(constant.name, "constant", declaration)
            case tree.SignalDeclaration(signals=signals, direction=direction):
                for signal in signals:
                    yield Symbol(signal.name, "input" if direction == "INPUT" else "output", declaration)
            case tree.ImportFrom(names=names):
                for name in names:
                    yield Symbol(name, "import", declaration)
            case _:
                yield from _single(declaration)


def _single(declaration: tree.Declaration) -> Iterator[Symbol]:
    match declaration:
        case tree.TypeDefinition(name=name):
            yield Symbol(name, "type", declaration)
        case tree.ProcedureDeclaration(name=name):
            yield Symbol(name, "procedure", declaration)
        case tree.FunctionDeclaration(name=name):
            yield Symbol(name, "function", declaration)
        case tree.RobotBinding(name=name):
            yield Symbol(name, "robot", declaration)


def parameter_symbols(routine: Routine) -> Iterator[Symbol]:
    """Symbols of a routine's parameters."""
    for parameter in routine.parameters:
        for name in parameter.names:
            yield Symbol(name, "parameter", parameter)
