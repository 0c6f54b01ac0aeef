"""Statements that are never reached, loops without an exit, functions that end without a value."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from irlx.diagnostics import Diagnostic, Place, Related, SourceText, report
from irlx.language import tree

_ENDS = {tree.Halt: "HALT", tree.Return: "RETURN", tree.Exit: "EXIT", tree.Goto: "GOTO"}


def flow_lints(root: tree.Program | tree.Module, source: SourceText) -> list[Diagnostic]:
    """Warnings on the ways through a text, in no order."""
    routines = [
        part
        for part in root.declarations
        if isinstance(part, tree.ProcedureDeclaration | tree.FunctionDeclaration)
    ]
    halting = any(isinstance(node, tree.Halt) for part in routines for node in tree.walk(*part.body))
    called = frozenset(part.name.key for part in routines) if halting else frozenset()
    flow = _Flow(source, called)
    for routine in routines:
        goes_on = flow.passes(routine.body)
        if isinstance(routine, tree.FunctionDeclaration) and goes_on:
            place = Place.in_text(source, routine.name.span)
            flow.findings.append(report("IRL287", place, name=routine.name.name))
    if isinstance(root, tree.Program):
        flow.passes(root.body)
    return flow.findings


class _Flow:
    """Follows the ways through statements; `halting` are routines one of which may end the run."""

    def __init__(self, source: SourceText, halting: frozenset[str]) -> None:
        self._source = source
        self._halting = halting
        self.findings: list[Diagnostic] = []

    def passes(self, body: Sequence[tree.Statement]) -> bool:
        """Whether a way leads through a list of statements to its end."""
        end: tree.Statement | None = None
        told = False
        for statement in body:
            if isinstance(statement, tree.Label):
                end = None
            elif end is not None and not told:
                told = True
                self._unreachable(statement, end)
            if not self._passes(statement) and end is None:
                end = statement
        return end is None

    def _unreachable(self, statement: tree.Statement, end: tree.Statement) -> None:
        word = _ENDS.get(type(end), "this statement")
        related = (Related(f"{word} leaves no way past it", Place.in_text(self._source, end.span)),)
        self.findings.append(report("IRL283", Place.in_text(self._source, statement.span), related=related))

    def _passes(self, statement: tree.Statement) -> bool:
        if type(statement) in _ENDS:
            return False
        match statement:
            case tree.If(branches=branches, otherwise=otherwise):
                ways = [self.passes(branch.body) for branch in branches]
                return self.passes(otherwise) or any(ways) if otherwise else True
            case tree.Case(branches=cases, default=default):
                ways = [self.passes(case.body) for case in cases]
                return self.passes(default) or any(ways) if default else True
            case tree.For(body=body):
                self.passes(body)
            case tree.While(body=body, condition=condition):
                self.passes(body)
                return self._leaves(statement, body) if _is(condition, value=True) else True
            case tree.Repeat(body=body, condition=condition):
                self.passes(body)
                return self._leaves(statement, body) if _is(condition, value=False) else True
        return True

    def _leaves(self, loop: tree.While | tree.Repeat, body: Sequence[tree.Statement]) -> bool:
        """Whether a way leads past a loop whose condition never ends it; without any exit it is told."""
        if any(isinstance(node, tree.Exit) for node in _outside_loops(body)):
            return True
        nodes = list(tree.walk(*body))
        inside = {node.name.key for node in nodes if isinstance(node, tree.Label)}
        if any(isinstance(node, tree.Goto) and node.label.key not in inside for node in nodes):
            return True
        if any(isinstance(node, tree.Return | tree.Halt) for node in nodes) or self._may_halt(nodes):
            return False
        word = "WHILE" if isinstance(loop, tree.While) else "REPEAT"
        self.findings.append(report("IRL284", Place.in_text(self._source, loop.span), loop=word))
        # What follows is not told as well.
        return True

    def _may_halt(self, nodes: Iterable[tree.Node]) -> bool:
        return any(
            isinstance(node, tree.Call | tree.FunctionCall) and node.name.key in self._halting
            for node in nodes
        )


def _is(condition: tree.Expression, *, value: bool) -> bool:
    """Whether a condition is that literal."""
    while isinstance(condition, tree.Paren):
        condition = condition.value
    return isinstance(condition, tree.BoolLiteral) and condition.value is value


def _outside_loops(body: Sequence[tree.Statement]) -> Iterator[tree.Statement]:
    """Statements of a loop that are in no loop inside it."""
    stack = list(body)
    while stack:
        statement = stack.pop()
        yield statement
        match statement:
            case tree.If(branches=branches, otherwise=otherwise):
                stack += [inner for branch in branches for inner in branch.body]
                stack += otherwise or ()
            case tree.Case(branches=cases, default=default):
                stack += [inner for case in cases for inner in case.body]
                stack += default or ()
