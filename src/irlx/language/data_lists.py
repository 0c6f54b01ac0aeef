"""Data lists that a text imports: finding and parsing them, and whether their values are constant."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from irlx.diagnostics import Diagnostic, IrlxError, Place, Related, SourceText, Span, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.language import tree
from irlx.language.builtins import ASKING_FUNCTIONS, FUNCTIONS, SYSTEM_VARIABLES, TYPES, is_port_name
from irlx.language.obstacles import own_nodes
from irlx.language.parser import Parse, parse
from irlx.language.scope import Scope
from irlx.language.symbols import declared_symbols

__all__ = ["DataListResolver", "ImportedList", "Imports", "check_values", "imports_of", "in_order"]

DataListResolver: TypeAlias = Callable[[str, Place], SourceText]
"""Gives the text of a data list by the name that IMPORT uses and the place of that name.

Raises IrlxError where there is none; its diagnostics become findings as they are.
"""


@dataclass(frozen=True)
class ImportedList:
    """A data list: its text, and the tree of it."""

    source: SourceText
    tree: tree.DataList


@dataclass(frozen=True)
class Imports:
    """The data lists of a text in the order of its IMPORTs, and the findings on getting and parsing them.

    `whole` is False where names may come in that are not known.
    """

    lists: tuple[ImportedList, ...] = ()
    findings: tuple[Diagnostic, ...] = ()
    whole: bool = True


def imports_of(
    root: tree.Program | tree.Module | tree.DataList, source: SourceText, resolver: DataListResolver | None
) -> Imports:
    """Get and parse all data lists that a text imports; without a `resolver` none is looked at."""
    importing = [part for part in root.declarations if isinstance(part, tree.ImportDatalist)]
    if resolver is None or not importing:
        return Imports(whole=not importing)
    gathered = _Gathered(source, resolver)
    for part in importing:
        gathered.add(part)
    return Imports(tuple(gathered.lists), tuple(gathered.findings), gathered.whole)


class _Gathered:
    def __init__(self, source: SourceText, resolver: DataListResolver) -> None:
        self._source = source
        self._resolver = resolver
        self._first: dict[str, Place] = {}
        self.lists: list[ImportedList] = []
        self.findings: list[Diagnostic] = []
        self.whole = True

    def add(self, part: tree.ImportDatalist) -> None:
        name, place = part.name, Place.in_text(self._source, part.name.span)
        if not name.key:
            self.whole = False
            return
        first = self._first.setdefault(name.key, place)
        if first is not place:
            related = (Related("imported here first", first),)
            self.findings.append(report("IRL244", place, related=related, name=name.name))
            return
        try:
            text = self._resolver(name.name, place)
        except IrlxError as error:
            self.findings += error.diagnostics
            self.whole = False
            return
        self._parsed(part.name, place, text)

    def _parsed(self, name: tree.Name, place: Place, text: SourceText) -> None:
        parsed = parse(text)
        related = (Related("imported here", place),)
        other = _no_data_list(parsed, text)
        if other is not None:
            where, found = other
            self.findings.append(report("IRL242", where, related=related, found=found))
            self.whole = False
            return
        self.findings += parsed.findings
        self.whole = self.whole and parsed.complete
        root = parsed.tree
        if not isinstance(root, tree.DataList):
            self.whole = False
            return
        if root.name.key and root.name.key != name.key:
            where = Place.in_text(text, root.name.span)
            data = {"found": root.name.name, "name": name.name}
            self.findings.append(report("IRL243", where, related=related, **data))
        self.lists.append(ImportedList(text, root))


def _no_data_list(parsed: Parse, text: SourceText) -> tuple[Place, str] | None:
    """Where a text shows that it is no data list, and what stands there; None where it is one."""
    root = parsed.tree
    if isinstance(root, tree.Program | tree.Module):
        word = type(root).__name__.upper()
        return Place.in_text(text, Span(root.span.start, root.name.span.end)), f"{word} {root.name.name}"
    for finding in parsed.findings:
        if finding.code in ("IRL116", "IRL117") and finding.place is not None:
            return finding.place, str(finding.data.get("found", "an empty text"))
    return None


def check_values(found: ImportedList, scope: Scope, *, alone: bool) -> list[Diagnostic]:
    """Findings on the types and values of a data list; `scope` is that of the program that imports it.

    A list looked at `alone` may use types of a program that is not known.
    """
    check = _ValueCheck(found, scope, types_known=not alone)
    for part in found.tree.declarations:
        check.uses(part.type)
        for variable in part.variables:
            if variable.initial is not None:
                check.uses(variable.initial)
            check.usable[variable.name.key] = variable.name.name
    return check.findings


class _ValueCheck:
    """Looks at what types and values use; `usable` are the names further up, by key."""

    def __init__(self, found: ImportedList, scope: Scope, *, types_known: bool) -> None:
        self._source = found.source
        self._scope = scope
        self._own = {symbol.name.key for symbol in declared_symbols(found.tree.declarations)}
        self._types_known = types_known
        self._reported: set[str] = set()
        self.usable: dict[str, str] = {}
        self.findings: list[Diagnostic] = []

    def uses(self, root: tree.Node) -> None:
        for node in own_nodes(root):
            match node:
                case tree.NamedType(name=name):
                    self._type(name)
                case tree.RecordType():
                    self._fields(node)
                case tree.Designator(base=name):
                    self._name(name)
                case tree.FunctionCall(name=name):
                    self._function(name)

    def _type(self, name: tree.Name) -> None:
        if self._types_known and name.key not in TYPES and self._scope.type(name.key) is None:
            self._unknown("IRL204", name, self._scope.known_types())

    def _fields(self, node: tree.RecordType) -> None:
        seen: set[str] = set()
        for name in (name for group in node.groups for name in group.names):
            if name.key in seen:
                self._add("IRL214", name)
            seen.add(name.key)

    def _name(self, name: tree.Name) -> None:
        if name.key in self.usable:
            return
        what = self._what(name)
        if what:
            self._once("IRL245", name, what=what)
        else:
            self._unknown("IRL201", name, list(self.usable.values()))

    def _what(self, name: tree.Name) -> str:
        """What a name is that no value may use, or '' where it is nothing."""
        if name.key in self._own:
            return "which does not stand further up in it"
        if name.key in SYSTEM_VARIABLES:
            return "a system variable"
        if is_port_name(name.key):
            return "a port"
        if self._scope.is_given(name.key):
            return "a frame of the cell"
        symbol = self._scope.value(name.key)
        if symbol is None:
            return ""
        words = {"import": "a name of a module", "input": "an input", "output": "an output"}
        return words.get(symbol.kind, f"a {symbol.kind} of the program")

    def _function(self, name: tree.Name) -> None:
        if name.key in ASKING_FUNCTIONS:
            self._once("IRL245", name, what="which asks the robot")
        elif name.key in FUNCTIONS or name.key in TYPES or self._scope.type(name.key) is not None:
            return
        elif name.key in self._own:
            self._once("IRL209", name)
        elif self._what(name):
            self._once("IRL245", name, what=self._what(name))
        else:
            self._unknown("IRL206", name, list(FUNCTIONS.values()))

    def _unknown(self, code: str, name: tree.Name, known: list[str]) -> None:
        # Where text was left out, a declaration may have been.
        if not self._scope.open:
            self._once(code, name, near=near_matches(name.name, known))

    def _once(self, code: str, name: tree.Name, **data: Any) -> None:
        if name.key and name.key not in self._reported:
            self._reported.add(name.key)
            self._add(code, name, **data)

    def _add(self, code: str, name: tree.Name, **data: Any) -> None:
        place = Place.in_text(self._source, name.span)
        self.findings.append(report(code, place, name=name.name, **data))


def in_order(
    findings: Sequence[Diagnostic], source: SourceText, lists: Sequence[ImportedList]
) -> tuple[Diagnostic, ...]:
    """Findings in the order of the text, then those in the data lists, one list after the other."""
    ranks = {id(found.source): rank for rank, found in enumerate(lists, 1)}

    def key(finding: Diagnostic) -> tuple[int, int]:
        place = finding.place
        if place is None or place.span is None:
            return 0, 0
        rank = 0 if place.text is source else ranks.get(id(place.text), len(lists) + 1)
        return rank, place.span.start

    return tuple(sorted(findings, key=key))
