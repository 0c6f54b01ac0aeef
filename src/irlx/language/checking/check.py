"""The type check of a whole text."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from irlx.diagnostics import Diagnostic, SourceText
from irlx.language import tree
from irlx.language.checking.context import Facts
from irlx.language.checking.declarations import Declarations
from irlx.language.checking.names import Entry, Names, system_names
from irlx.language.checking.statements import Statements
from irlx.language.checking.type_forms import Joints, joints_of
from irlx.language.data_lists import ImportedList
from irlx.language.references import Reference, RoutineScope
from irlx.language.symbols import Routine, Symbol
from irlx.language.types import known_types

__all__ = ["TypedText", "check_types"]

_NO_MODULES: Mapping[str, Mapping[str, Symbol]] = {}


@dataclass(frozen=True)
class TypedText:
    """What the type check tells of a text.

    Findings, lints that it met on the way, uses of names, symbols with their types, scopes of routines.
    """

    findings: list[Diagnostic]
    lints: list[Diagnostic]
    references: tuple[Reference, ...]
    symbols: Mapping[str, Symbol]
    types: Mapping[str, Symbol]
    routines: tuple[RoutineScope, ...]
    facts: Facts
    entries: list[Entry] = field(default_factory=list)
    """Everything declared, of the program, its data lists and routines."""


def check_types(
    root: tree.Program | tree.Module | tree.DataList,
    source: SourceText,
    lists: Sequence[ImportedList] = (),
    frames: Collection[str] | None = None,
    joints: tuple[str, ...] = (),
    modules: Mapping[str, Mapping[str, Symbol]] = _NO_MODULES,
    *,
    obstacles: Collection[str] | None = None,
    complete: bool = True,
) -> TypedText:
    """Give everything in a text its type. `joints` are those of the robot where the cell is known.

    `modules` are what those modules export that are known, by casefolded names; `frames` and `obstacles` are
    names of the cell, None where it is not known; a mapping says of frames which move with a link.
    Without `complete`, parts of the text have been left out.
    """
    if isinstance(root, tree.DataList):
        of_robot = Joints(len(joints) or None, names=joints)
        check = type_check(source, of_robot, frames, obstacles, complete=complete)
        check.data_list(ImportedList(source, root))
        return check.outcome()
    of_robot = joints_of(root.declarations, joints)
    check = type_check(source, of_robot, frames, obstacles, complete=complete)
    check.modules, check.is_program = modules, isinstance(root, tree.Program)
    check.declare(root.declarations, lists)
    for part in root.declarations:
        if isinstance(part, tree.ProcedureDeclaration | tree.FunctionDeclaration):
            check.inside(part)
    if isinstance(root, tree.Program):
        check.in_main = True
        check.body(root.body)
    return check.outcome()


def type_check(
    source: SourceText,
    joints: Joints,
    frames: Collection[str] | None = None,
    obstacles: Collection[str] | None = None,
    *,
    complete: bool = True,
) -> TypeCheck:
    """A type check that has looked at nothing yet."""
    types = known_types(joints.number)
    check = TypeCheck(source, Names(types, system_names(types, frames, joints.number, obstacles)))
    check.joints, check.complete = joints, complete
    return check


class TypeCheck(Statements, Declarations):
    """The parts of the type check put together."""

    def __init__(self, source: SourceText, names: Names) -> None:
        super().__init__(source, names)
        self._program = names
        self._routines: list[RoutineScope] = []
        self._entries: list[Entry] = []
        self._channels: dict[str, tree.StandardChannel] = {}

    def inside(self, routine: Routine) -> None:
        """Look at the declarations and the body of a routine."""
        entry = self._program.values.get(routine.name.key)
        symbol = entry.symbol if entry is not None else None
        if entry is None or entry.signature is None or symbol is None or symbol.declaration is not routine:
            # Declared twice: which of the two is meant is not known.
            return
        self.names = self._program.inner()
        self.routine, self.result = routine, entry.signature.result
        self.enter_parameters(routine, entry.signature)
        self.declare(routine.declarations)
        self.body(routine.body)
        values, types = _symbols(self.names), dict(self.names.type_symbols)
        self._routines.append(RoutineScope(routine.span, values, types))
        self._entries += self.names.values.values()
        self.names, self.routine, self.result = self._program, None, None

    def outcome(self) -> TypedText:
        """Everything found."""
        return TypedText(
            self.findings,
            self.lints,
            tuple(sorted(self.references, key=lambda reference: reference.span.start)),
            _symbols(self._program),
            dict(self._program.type_symbols),
            tuple(self._routines),
            self.facts,
            [*self._program.values.values(), *self._entries],
        )


def _symbols(names: Names) -> dict[str, Symbol]:
    return {key: entry.symbol for key, entry in names.values.items() if entry.symbol is not None}
