"""The scope pass: unknown and duplicate names, wrong assignments, labels."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace
from typing import Any

from irlx.diagnostics import Diagnostic, Place, SourceText, Span, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.language import tree
from irlx.language.builtins import (
    BARE_FUNCTIONS,
    FUNCTIONS,
    MOVE_PARAMETERS,
    PROCEDURES,
    SYSTEM_VARIABLES,
    TYPES,
    is_analog_port,
    is_input_port,
    is_port_name,
)
from irlx.language.data_lists import ImportedList, Imports, check_values
from irlx.language.labels import check_jumps
from irlx.language.obstacles import names_of_cell
from irlx.language.scope import Scope
from irlx.language.symbols import Routine, Symbol, declared_symbols, parameter_symbols

__all__ = ["NamePass", "check_names"]

_NO_IMPORTS = Imports()
_READ_ONLY = {"constant": "a constant", "input": "an input"}
_NOT_SET = {"procedure": "a procedure", "function": "a function", "robot": "a robot"}


def check_names(
    root: tree.Program | tree.Module | tree.DataList,
    source: SourceText,
    given: Collection[str] = (),
    imports: Imports = _NO_IMPORTS,
    *,
    complete: bool,
) -> tuple[Scope, list[Diagnostic]]:
    """Scope of a text and the findings on its names and on those of the data lists that it imports.

    `given` are constants of its cell. Without `complete`, unknown names prove nothing, because their
    declarations may have been dropped.
    """
    scope = Scope(source, given=given, open=not (imports.whole and complete))
    names = NamePass(scope, complete=complete)
    if isinstance(root, tree.DataList):
        names.imported(ImportedList(source, root))
        return scope, names.findings + check_values(ImportedList(source, root), scope, alone=True)
    for data_list in imports.lists:
        names.imported(data_list)
    names.declarations(root.declarations)
    for data_list in imports.lists:
        names.findings += check_values(data_list, scope, alone=False)
    if isinstance(root, tree.Program):
        names.body(root.body)
    return scope, names.findings


class NamePass:
    """Checks the names of one scope; routines get a pass of their own."""

    def __init__(self, scope: Scope, reported: set[str] | None = None, *, complete: bool) -> None:
        self.scope = scope
        self._complete = complete
        self.findings: list[Diagnostic] = []
        self._reported: set[str] = set() if reported is None else reported

    def declarations(self, declarations: Sequence[tree.Declaration]) -> None:
        """Declare everything, then look at what the declarations use."""
        self._declare(declared_symbols(declarations))
        for declaration in declarations:
            if isinstance(declaration, (tree.ProcedureDeclaration, tree.FunctionDeclaration)):
                self._routine(declaration)
            elif isinstance(declaration, tree.Export):
                self._exported(declaration)
            else:
                self._uses(declaration)

    def imported(self, data_list: ImportedList) -> None:
        """Declare the names of a data list: variables of the program."""
        symbols = declared_symbols(data_list.tree.declarations)
        self._declare(replace(symbol, source=data_list.source) for symbol in symbols)

    def body(self, body: Sequence[tree.Statement]) -> None:
        """Look at the names that statements use."""
        self._uses(*body)
        if self._complete:
            self.findings += check_jumps(body, self.scope.source)

    def _declare(self, symbols: Iterable[Symbol]) -> None:
        usable = []
        for symbol in symbols:
            if symbol.name.key in SYSTEM_VARIABLES and symbol.kind != "type":
                self.findings.append(report("IRL216", self.scope.place(symbol), name=symbol.name.name))
            else:
                usable.append(symbol)
        self.findings += self.scope.declare(usable)

    def _routine(self, routine: Routine) -> None:
        inner = NamePass(Scope(self.scope.source, self.scope), self._reported, complete=self._complete)
        inner._declare(parameter_symbols(routine))
        for parameter in routine.parameters:
            inner._uses(parameter.type)
        if isinstance(routine, tree.FunctionDeclaration):
            inner._uses(routine.result)
        inner.declarations(routine.declarations)
        inner.body(routine.body)
        self.findings += inner.findings

    def _exported(self, export: tree.Export) -> None:
        for name in export.names:
            if self.scope.value(name.key) is None and self.scope.type(name.key) is None:
                self._unknown("IRL201", name, [*self.scope.known_values(), *self.scope.known_types()])

    def _uses(self, *roots: tree.Node) -> None:
        of_cell: set[int] = set()
        for node in tree.walk(*roots):
            check = _CHECKS.get(type(node))
            if check is not None and id(node) not in of_cell:
                check(self, node)
            if isinstance(node, tree.FunctionCall):
                routine = self.scope.value(node.name.key)
                if routine is None or routine.kind not in ("function", "import"):
                    of_cell |= names_of_cell(node)

    def _named_type(self, node: tree.NamedType) -> None:
        key = node.name.key
        if key not in TYPES and self.scope.type(key) is None:
            self._unknown("IRL204", node.name, self.scope.known_types())

    def _record(self, node: tree.RecordType) -> None:
        first: dict[str, tree.Name] = {}
        for group in node.groups:
            for name in group.names:
                if name.key in first:
                    self._add("IRL214", name.span, name=name.name)
                first.setdefault(name.key, name)

    def _designator(self, node: tree.Designator) -> None:
        name = node.base
        known = name.key in SYSTEM_VARIABLES or self.scope.value(name.key) is not None
        known = known or (name.key in BARE_FUNCTIONS and not node.selectors)
        if known or self.scope.is_given(name.key):
            return
        if is_port_name(name.key):
            if name.key not in self._reported:
                self._reported.add(name.key)
                self._add("IRL205", name.span, help=_port_declared(name), name=name.name)
            return
        self._unknown("IRL201", name, self.scope.known_values())

    def _function_call(self, node: tree.FunctionCall) -> None:
        key = node.name.key
        # `POSE(..)` stays the constructor where a variable is called pose.
        if key in FUNCTIONS or key in TYPES or self.scope.type(key) is not None:
            return
        symbol = self.scope.value(key)
        if self.scope.is_given(key):
            self._add("IRL209", node.name.span, name=node.name.name)
        elif symbol is None:
            self._unknown("IRL206", node.name, self.scope.known_functions())
        elif symbol.kind in ("variable", "constant", "parameter", "input", "output"):
            self._add("IRL209", node.name.span, name=node.name.name)

    def _call(self, node: tree.Call) -> None:
        symbol = self.scope.value(node.name.key)
        if symbol is None and node.name.key not in PROCEDURES:
            self._unknown("IRL207", node.name, self.scope.known_procedures())

    def _move(self, node: tree.Move) -> None:
        first: set[str] = set()
        for param in node.params:
            key = param.name.key
            if key and key not in MOVE_PARAMETERS:
                near = near_matches(param.name.name, list(MOVE_PARAMETERS.values()))
                self._add("IRL203", param.name.span, name=param.name.name, near=near)
            elif key in first:
                self._add("IRL212", param.name.span, name=param.name.name)
            first.add(key)

    def _assignment(self, node: tree.Assignment) -> None:
        self._is_settable(node.target)

    def _for(self, node: tree.For) -> None:
        self._is_settable(node.variable)

    def _is_settable(self, target: tree.Designator) -> None:
        symbol = self.scope.value(target.base.key)
        kind = symbol.kind if symbol is not None else ""
        words = _READ_ONLY.get(kind) or _NOT_SET.get(kind)
        if symbol is None and target.base.key in BARE_FUNCTIONS and not target.selectors:
            words = "a function"
        if symbol is None and is_input_port(target.base.key) and not self.scope.open:
            words = "an input"
        if self.scope.is_given(target.base.key):
            words = "a frame of the cell"
        if words:
            self._add("IRL211", target.base.span, name=target.base.name, kind=words)

    def _unknown(self, code: str, name: tree.Name, known: list[str]) -> None:
        if not name.key or self.scope.open or name.key in self._reported:
            return
        self._reported.add(name.key)
        self._add(code, name.span, name=name.name, near=near_matches(name.name, known))

    def _add(self, code: str, span: Span, **data: Any) -> None:
        self.findings.append(report(code, Place.in_text(self.scope.source, span), **data))


def _port_declared(name: tree.Name) -> str:
    """How the declaration of a port reads that is used by its own name."""
    direction = "INPUT" if is_input_port(name.key) else "OUTPUT"
    type = "REAL" if is_analog_port(name.key) else "BOOL"
    number = name.key.rpartition("_")[2].lstrip("0") or "0"
    return f"declare it: VAR {direction} {type}: {name.name} AT {number}; irlx fmt does so"


_CHECKS: dict[type[tree.Node], Any] = {
    tree.NamedType: NamePass._named_type,
    tree.RecordType: NamePass._record,
    tree.Designator: NamePass._designator,
    tree.FunctionCall: NamePass._function_call,
    tree.Call: NamePass._call,
    tree.Move: NamePass._move,
    tree.Assignment: NamePass._assignment,
    tree.For: NamePass._for,
}
