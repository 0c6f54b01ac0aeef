"""The front end as one function: text in, tree, symbols and diagnostics out."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TypeAlias

from irlx.diagnostics import Diagnostic, Place, SourceText, Span, report
from irlx.language import tree
from irlx.language.checking import check_types
from irlx.language.checking.consequences import standing_alone, without_missing_var
from irlx.language.criteria import check_criterion
from irlx.language.data_lists import DataListResolver, ImportedList, imports_of, in_order
from irlx.language.lints import first_of_each, lints_of
from irlx.language.modules import ImportedModule, ModuleProblem, exported, missing_exports, no_module
from irlx.language.moves import check_move
from irlx.language.names import check_names
from irlx.language.parser import parse
from irlx.language.references import Reference, RoutineScope
from irlx.language.suppression import Ignore, after_ignoring
from irlx.language.switches import check_freeze, check_switches
from irlx.language.symbols import Symbol
from irlx.language.uncollected import uncollected

__all__ = [
    "Analysis",
    "CellJoints",
    "CellNames",
    "CellObstacles",
    "DataListResolver",
    "Resolver",
    "analyse",
]

_Root: TypeAlias = "tree.Program | tree.Module | tree.DataList"

Resolver: TypeAlias = "Callable[[str], Analysis | None]"
"""Gives the analysis of a module by the name that FROM uses, or None where there is no such module.

Raises ModuleProblem for one that cannot be used.
"""

CellNames: TypeAlias = "Callable[[tree.Program | tree.Module], Collection[str] | None]"
"""Gives the names that the cell of a program adds to it and its modules, those of its frames, or None where
no cell is known. A mapping says of each whether it moves with a link of the robot."""


CellJoints: TypeAlias = "Callable[[tree.Program | tree.Module], tuple[str, ...]]"
"""Gives the names of the joints of a program's robot, none where they are not known."""

CellObstacles: TypeAlias = "Callable[[tree.Program | tree.Module], Collection[str] | None]"
"""Gives the names of obstacles and groups of a program's cell, None where it is not known."""


@dataclass(frozen=True)
class Analysis:
    """What a text means, as far as it could be understood.

    `tree` is partial after a mistake and None where nothing is left; `symbols` are the program's own
    declarations by casefolded name, `types` the types among them; `comments` are in the order of the text.
    Both carry their types. `references` are all uses of declared names in the order of the text, without
    those in data lists; `routines` are the names that procedures and functions declare. `data_lists` are
    those that it imports, in order, as far as they could be read; `modules` all that it needs, each behind
    those that it imports itself. `ignores` are what comments ask to ignore and only a later stage can find.
    """

    source: SourceText
    tree: tree.Program | tree.Module | tree.DataList | None
    diagnostics: tuple[Diagnostic, ...]
    comments: tuple[Span, ...]
    symbols: Mapping[str, Symbol] = field(default_factory=dict)
    types: Mapping[str, Symbol] = field(default_factory=dict)
    data_lists: tuple[ImportedList, ...] = ()
    ignores: tuple[Ignore, ...] = ()
    modules: tuple[ImportedModule, ...] = ()
    references: tuple[Reference, ...] = ()
    routines: tuple[RoutineScope, ...] = ()

    @property
    def has_errors(self) -> bool:
        """Whether the program cannot be used."""
        return any(diagnostic.is_error for diagnostic in self.diagnostics)


@uncollected()
def analyse(
    source: SourceText,
    resolver: Resolver | None = None,
    cell_names: CellNames | None = None,
    data_lists: DataListResolver | None = None,
    *,
    joints: tuple[str, ...] | CellJoints = (),
    obstacles: CellObstacles | None = None,
    lints: bool = False,
) -> Analysis:
    """Parse and check a text; never raises for what a text may hold.

    Without a `resolver` imported names are taken as declared and modules are not looked at. What
    `cell_names` gives counts as constants of the program, which its own declarations may hide.
    `data_lists` gives the texts of data lists; without it, one that is imported may hold any name.
    `joints` are those of the robot where it is known, or what gives them for a tree; what `obstacles` gives
    OBSTACLE and CLEARANCE may name. With `lints` there are warnings of what is allowed but seldom meant.
    """
    parsed = parse(source)
    if parsed.tree is None:
        return Analysis(source, None, in_order(parsed.findings, source, ()), parsed.comments)
    text = parsed.tree if isinstance(parsed.tree, tree.Program | tree.Module) else None
    given = cell_names(text) if cell_names and text is not None else None
    known_obstacles = obstacles(text) if obstacles and text is not None else None
    imports = imports_of(parsed.tree, source, data_lists)
    names = _joint_names(parsed.tree, joints)
    scope, findings = check_names(parsed.tree, source, given or (), imports, complete=parsed.complete)
    findings += _static_findings(parsed.tree, source)
    modules, on_imports = _imported(parsed.tree, source, resolver)
    typed = check_types(
        parsed.tree,
        source,
        imports.lists,
        given,
        names,
        modules,
        obstacles=known_obstacles,
        complete=parsed.complete and imports.whole,
    )
    findings += standing_alone(typed.findings, (*parsed.findings, *imports.findings))
    findings = without_missing_var(findings, parsed.tree, parsed.findings)
    if lints and parsed.complete:
        findings += lints_of(parsed.tree, source, typed)
    findings += on_imports
    if parsed.complete and isinstance(parsed.tree, tree.Program):
        findings += check_switches(parsed.tree, source)
    found = (*parsed.findings, *imports.findings, *findings)
    told, later = after_ignoring(found, source, parsed, imports, linted=lints)
    return Analysis(
        source,
        parsed.tree,
        tuple(first_of_each(in_order(told, source, imports.lists))),
        parsed.comments,
        MappingProxyType({**scope.values, **typed.symbols}),
        MappingProxyType({**scope.types, **typed.types}),
        imports.lists,
        ignores=later,
        references=typed.references,
        routines=typed.routines,
    )


def _joint_names(root: _Root, joints: tuple[str, ...] | CellJoints) -> tuple[str, ...]:
    if isinstance(joints, tuple):
        return joints
    return () if isinstance(root, tree.DataList) else joints(root)


def _static_findings(root: tree.Node, source: SourceText) -> list[Diagnostic]:
    findings: list[Diagnostic] = []
    for node in tree.walk(root):
        check = _STATIC_CHECKS.get(type(node))
        if check is not None:
            findings += check(node, source)
    return findings


_STATIC_CHECKS: Mapping[type, Callable[..., list[Diagnostic]]] = {
    tree.Move: check_move,
    tree.FreezeStart: check_freeze,
    tree.CriterionStart: check_criterion,
    tree.WithCriterion: check_criterion,
}
"""What looks at nodes of a kind alone."""


def _imported(
    root: _Root, source: SourceText, resolver: Resolver | None
) -> tuple[dict[str, Mapping[str, Symbol]], list[Diagnostic]]:
    """What the modules of a text export, by casefolded names, and the findings on its imports."""
    modules: dict[str, Mapping[str, Symbol]] = {}
    findings: list[Diagnostic] = []
    if resolver is None:
        return modules, findings
    for declaration in root.declarations:
        if not isinstance(declaration, tree.ImportFrom) or not declaration.module.key:
            continue
        place = Place.in_text(source, declaration.module.span)
        try:
            module = resolver(declaration.module.name)
        except ModuleProblem as problem:
            findings.append(report(problem.code, place, **problem.data))
            continue
        if module is None:
            findings.append(report("IRL218", place, module=declaration.module.name, near=""))
            continue
        findings += no_module(declaration, module.source, module.tree, source)
        if isinstance(module.tree, tree.Module):
            findings += missing_exports(declaration, module.tree, module.source.name, source)
            known = {**module.types, **module.symbols}
            names = {name.key for name in exported(module.tree)}
            modules[declaration.module.key] = {key: known[key] for key in names & known.keys()}
    return modules, findings
