"""Which parts of the language are executed; the others are read, checked and named, never skipped."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from irlx.blocks.criterion import LIBRARY
from irlx.diagnostics import Diagnostic, Place, SourceText, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.interpreter.parameters import criterion_name
from irlx.interpreter.system_names import LATER_TYPES
from irlx.language import tree
from irlx.language.data_lists import ImportedList
from irlx.language.modules import ImportedModule
from irlx.language.symbols import declared_symbols, parameter_symbols

EXECUTED_DECLARATIONS = (
    tree.VarDeclaration,
    tree.ConstDeclaration,
    tree.TypeDefinition,
    tree.SystemSpecification,
    tree.ImportDatalist,
    tree.ImportFrom,
    tree.Export,
    tree.ProcedureDeclaration,
    tree.FunctionDeclaration,
    tree.SignalDeclaration,
    tree.StandardChannel,
    tree.RobotBinding,
)


def part_name(node: tree.Node) -> str:
    """What a program calls a part."""
    return type(node).__name__


def unsupported(
    program: tree.Program,
    source: SourceText,
    lists: Sequence[ImportedList] = (),
    modules: Sequence[ImportedModule] = (),
) -> list[Diagnostic]:
    """A warning, IRL591, for every part of a program, its data lists and modules that a run would stop at.

    IRL363 for criteria outside the library, at which it stops unless they are registered by then.
    """
    found = _of_text(program, source, lists)
    for module in modules:
        found += _of_text(module.tree, module.source, module.data_lists)
    return found


def _of_text(
    root: tree.Program | tree.Module, source: SourceText, lists: Sequence[ImportedList]
) -> list[Diagnostic]:
    values = [part for data_list in lists for part in data_list.tree.declarations]
    declared = frozenset(_declared([*root.declarations, *values]))
    warnings = [_unexecuted(source, *missing) for missing in _parts(root, declared)]
    for data_list in lists:
        for part in data_list.tree.declarations:
            warnings += [_unexecuted(data_list.source, *missing) for missing in _parts(part, declared)]
    return [*warnings, *_unknown_criteria(root, source)]


def _declared(declarations: Sequence[tree.Declaration]) -> Iterator[str]:
    """Casefolded names of everything that is declared, local names of routines included."""
    yield from (symbol.name.key for symbol in declared_symbols(declarations))
    for part in declarations:
        if isinstance(part, tree.ProcedureDeclaration | tree.FunctionDeclaration):
            yield from (symbol.name.key for symbol in parameter_symbols(part))
            yield from _declared(part.declarations)


def _unexecuted(source: SourceText, node: tree.Node, what: str) -> Diagnostic:
    return report("IRL591", Place.in_text(source, node.span), what=what)


def _unknown_criteria(root: tree.Node, source: SourceText) -> Iterator[Diagnostic]:
    """A warning at the first place of every criterion that is none of the library."""
    told: set[str] = set()
    for node in tree.walk(root):
        if not isinstance(node, tree.CriterionStart | tree.WithCriterion):
            continue
        name = criterion_name(node.name)
        if name not in LIBRARY and name not in told:
            told.add(name)
            near, place = near_matches(name, LIBRARY), Place.in_text(source, node.name.span)
            yield report("IRL363", place, name=name, near=near, known=", ".join(LIBRARY))


def _parts(root: tree.Node, declared: frozenset[str]) -> Iterator[tuple[tree.Node, str]]:
    """Parts that are not executed in a text, and their names."""
    for node in tree.walk(root):
        if isinstance(node, tree.NamedType) and node.name.key in LATER_TYPES - declared:
            yield node, f"the type {node.name.name}"
