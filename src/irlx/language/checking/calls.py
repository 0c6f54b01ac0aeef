"""Calls: of built-in functions, constructors, and the functions and procedures that a program declares."""

from __future__ import annotations

from typing import Any

from irlx.diagnostics import Related
from irlx.language import tree
from irlx.language.builtins import LAYOUT_BOUNDS
from irlx.language.checking.context import NOTHING, Context, Typed
from irlx.language.checking.decimal_commas import numbers_with_commas
from irlx.language.checking.names import Constant, Entry
from irlx.language.obstacles import OBSTACLE_NAME, obstacle_name, unknown_obstacle
from irlx.language.references import Reference
from irlx.language.types import (
    ORIENTATION,
    REAL,
    UNKNOWN,
    Array,
    Parameter,
    Record,
    Signature,
    Type,
    is_number,
)
from irlx.language.words import count

_OPTIONAL_PARTS = frozenset({"joint", "robtarget"})
"""Constructors that may leave out all but the first part."""


class Calls(Context):
    """Types of calls."""

    def unit_length(self, node: tree.Node, quaternion: tuple[Constant | None, ...]) -> None:
        """A quaternion that the text tells must have length 1."""
        raise NotImplementedError

    def variable_argument(self, node: tree.Argument, where: str, expected: Type | None) -> None:
        """An argument that the routine sets."""
        raise NotImplementedError

    def file_use(self, node: tree.Argument, what: str) -> None:
        """Remember that a variable of type FILE may be used; `what` is '' where a routine has it."""
        raise NotImplementedError

    def function_call(self, node: tree.FunctionCall) -> Typed:
        """Type of a call; a declared function hides a built-in one, a variable does not."""
        name = node.name
        entry = self.names.value(name.key)
        if entry is not None and entry.signature is not None and entry.signature.result is not None:
            return self._declared(entry, entry.signature, node)
        type = self.names.types.get(name.key)
        if type is not None:
            self._uses_type(name)
            return self._constructed(node, type)
        signature = self.names.functions.get(name.key)
        if signature is not None:
            return self._built_in(node, signature)
        self.unknown_arguments(node.arguments)
        if entry is not None and entry.symbol is not None:
            self.references.append(Reference(name.span, entry.symbol, "call"))
            if entry.kind == "procedure":
                self.add("IRL250", name, name=name.name, found="a procedure", expected="a function")
        return NOTHING

    def _uses_type(self, name: tree.Name) -> None:
        symbol = self.names.type_symbol(name.key)
        if symbol is not None:
            self.references.append(Reference(name.span, symbol, "type"))

    def _declared(self, entry: Entry, signature: Signature, node: tree.FunctionCall) -> Typed:
        if entry.symbol is not None:
            self.references.append(Reference(node.name.span, entry.symbol, "call"))
        self.arguments(signature, node.arguments, node, self.declared_here(entry))
        return Typed(signature.result or UNKNOWN)

    def _built_in(self, node: tree.FunctionCall, signature: Signature) -> Typed:
        if signature.name == "EOF" and not node.arguments:
            self.facts.standard.add("IN")
        found = self.arguments(signature, node.arguments, node)
        if signature.like_first:
            return Typed(found[0].type) if found else NOTHING
        if signature.name == "ORIQUAT":
            self.unit_length(node, tuple([part.value for part in found]))
        return Typed(signature.result or UNKNOWN)

    def _constructed(self, node: tree.FunctionCall, type: Type) -> Typed:
        """A record or array made by the name of its type and its parts."""
        arguments = node.arguments
        symbol = self.names.type_symbol(node.name.key)
        name = symbol.name.name if symbol is not None else node.name.key.upper()
        if isinstance(type, Record) and not type.pattern:
            parameters = tuple([Parameter("", (part,)) for _, part in type.fields])
            least = 1 if node.name.key in _OPTIONAL_PARTS else len(parameters)
            found = self.arguments(Signature(name, parameters, type, least), arguments, node)
        elif isinstance(type, Record | Array):
            element = type.element if isinstance(type, Array) else REAL
            size = type.size if isinstance(type, Array) and type.size else len(arguments)
            parameters = (Parameter("", (element,)),) * size
            found = self.arguments(Signature(name, parameters, type, size), arguments, node)
        else:
            self.unknown_arguments(arguments)
            return Typed(type)
        value = tuple([part.value for part in found]) if found else None
        if len(found) > 1:
            self.status(type, arguments[1], found[1])
        if type is ORIENTATION and value is not None:
            self.unit_length(node, value)
        return Typed(type, value)

    # ---- arguments

    def arguments(
        self,
        signature: Signature,
        arguments: tuple[tree.Argument, ...],
        node: tree.Node,
        related: tuple[Related, ...] = (),
    ) -> list[Typed]:
        """Types of arguments that a routine takes; none where their number is wrong, which is told."""
        parameters = signature.parameters
        if not signature.least <= len(arguments) <= len(parameters):
            self.unknown_arguments(arguments)
            data: dict[str, Any] = {"function": signature.name, "expected": _expected(signature)}
            wanted = range(signature.least, len(parameters) + 1)
            help = numbers_with_commas(arguments, wanted, self.source.text)
            self.add("IRL228", node, related=related, help=help, found=len(arguments), **data)
            return []
        return [
            self._argument(argument, parameter, signature)
            for argument, parameter in zip(arguments, parameters, strict=False)
        ]

    def _argument(self, argument: tree.Argument, parameter: Parameter, signature: Signature) -> Typed:
        if isinstance(argument, tree.FormattedValue):
            self.layout_unexpected(argument)
            return NOTHING
        if parameter.by_reference:
            where = f"the VAR parameter '{parameter.name}' of {signature.name}"
            if not parameter.name:
                where = signature.name
            self.file_use(argument, signature.name if not parameter.name else "")
            self.variable_argument(argument, where, parameter.types[0])
            return NOTHING
        if parameter.names_obstacle:
            name = obstacle_name(argument)
            if name is None:
                self.mismatch(argument, OBSTACLE_NAME, "an expression")
            else:
                self.obstacle(name)
            return NOTHING
        if len(parameter.types) == 1:
            return self.fitted(argument, parameter.types[0])
        return self.one_of(argument, parameter.types)

    def obstacle(self, name: tree.Name) -> None:
        """A name of an obstacle or group of the cell: IRL573 where the cell is known and has none like it."""
        known = self.names.obstacles
        if known is not None and name.key and name.key not in {one.casefold() for one in known}:
            self.findings.append(unknown_obstacle(name.name, known, self.place(name)))

    def unknown_arguments(self, arguments: tuple[tree.Argument, ...]) -> None:
        """Look at arguments of which no type is known to be expected."""
        for argument in arguments:
            if isinstance(argument, tree.FormattedValue):
                self.formatted(argument)
            else:
                trial = self.trial(lambda argument=argument: self.fitted(argument, UNKNOWN))  # type: ignore[misc]
                # A FILE may stand there: what takes it is not known.
                self.keep(trial._replace(findings=[f for f in trial.findings if f.code != "IRL267"]))

    def formatted(self, node: tree.FormattedValue) -> Typed:
        """A value with its layout; a precision is for numbers."""
        found = self.typed(node.value)
        self._bounded(node.width, "width")
        if node.precision is not None:
            self._bounded(node.precision, "precision")
            if found.type is not UNKNOWN and not is_number(found.type):
                self.mismatch(node.value, "a number before :width:precision", found.type.name)
        return found

    def _bounded(self, node: tree.Expression, what: str) -> None:
        """A number of a layout, within its bounds where the text tells it."""
        value, most = self.whole(node).value, LAYOUT_BOUNDS[what]
        if isinstance(value, int) and not isinstance(value, bool) and not 0 <= value <= most:
            data: dict[str, Any] = {
                "param": f"the {what} of WRITE",
                "expected": f"0 to {most:,}",
                "value": str(value),
            }
            self.add("IRL505", node, **data)

    def whole(self, node: tree.Expression) -> Typed:
        """An expression that must be an INT."""
        raise NotImplementedError

    def layout_unexpected(self, node: tree.FormattedValue) -> None:
        """A layout where none belongs."""
        self.formatted(node)
        self.mismatch(node, "a value without a layout", "one with :width")


def _expected(signature: Signature) -> str:
    most = len(signature.parameters)
    if signature.least == most:
        return count(most, "value")
    return (
        f"{signature.least} to {most} values"
        if most > signature.least + 1
        else f"{signature.least} or {most} values"
    )
