"""Labels, GOTO and EXIT: whether every jump has a place to go to."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from irlx.diagnostics import Diagnostic, Place, Related, SourceText, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.language import tree

__all__ = ["check_jumps"]


def check_jumps(body: Sequence[tree.Statement], source: SourceText) -> list[Diagnostic]:
    """Findings on the jumps of one body: the main statements or those of a routine."""
    jumps = _Jumps(source)
    jumps.labels(body)
    jumps.visit(body, (), in_loop=False)
    jumps.unused()
    return jumps.findings


def _bodies(statement: tree.Statement) -> Iterator[tuple[tree.Statement, ...]]:
    """Statement lists inside a structured statement."""
    match statement:
        case tree.If(branches=branches, otherwise=otherwise):
            yield from (branch.body for branch in branches)
            yield otherwise or ()
        case tree.Case(branches=cases, default=default):
            yield from (branch.body for branch in cases)
            yield default or ()
        case tree.For(body=body) | tree.While(body=body) | tree.Repeat(body=body):
            yield body


class _Jumps:
    def __init__(self, source: SourceText) -> None:
        self.source = source
        self.findings: list[Diagnostic] = []
        self.declared: dict[str, tree.Name] = {}
        self.used: set[str] = set()
        self.missing = False

    def labels(self, body: Sequence[tree.Statement]) -> None:
        for statement in body:
            if isinstance(statement, tree.Label):
                name = statement.name
                first = self.declared.setdefault(name.key, name)
                if first is not name:
                    related = Related("declared here first", Place.in_text(self.source, first.span))
                    place = Place.in_text(self.source, name.span)
                    self.findings.append(report("IRL202", place, related=(related,), name=name.name))
            for inner in _bodies(statement):
                self.labels(inner)

    def visit(self, body: Sequence[tree.Statement], visible: tuple[str, ...], *, in_loop: bool) -> None:
        here = tuple(s.name.key for s in body if isinstance(s, tree.Label))
        visible = visible + here
        for statement in body:
            if isinstance(statement, tree.Goto):
                self._goto(statement, visible)
            elif isinstance(statement, tree.Exit) and not in_loop:
                self.findings.append(report("IRL217", Place.in_text(self.source, statement.span)))
            loop = in_loop or isinstance(statement, (tree.For, tree.While, tree.Repeat))
            for inner in _bodies(statement):
                self.visit(inner, visible, in_loop=loop)

    def _goto(self, goto: tree.Goto, visible: tuple[str, ...]) -> None:
        label = goto.label
        self.used.add(label.key)
        if label.key in visible:
            return
        place = Place.in_text(self.source, label.span)
        if label.key in self.declared:
            related = Related("the label", Place.in_text(self.source, self.declared[label.key].span))
            self.findings.append(report("IRL208", place, related=(related,), name=label.name))
        else:
            near = near_matches(label.name, [name.name for name in self.declared.values()])
            self.missing = True
            self.findings.append(report("IRL215", place, name=label.name, near=near))

    def unused(self) -> None:
        for key, name in self.declared.items():
            # A label that a misspelt GOTO misses is not called unused as well.
            if key not in self.used and not self.missing:
                self.findings.append(report("IRL210", Place.in_text(self.source, name.span), name=name.name))
