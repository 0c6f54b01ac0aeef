"""Moves that shall pass their target where what follows needs the robot at rest; outputs set on the way."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from irlx.diagnostics import Diagnostic, Place, Related, SourceText, Span, report
from irlx.language import tree
from irlx.language.builtins import ACTUAL_VARIABLES, FOLLOWED_VARIABLES, PROCEDURES, is_port_name
from irlx.language.obstacles import own_nodes
from irlx.language.symbols import declared_symbols, parameter_symbols

_STOPPING: dict[type[tree.Node], str] = {
    tree.WaitTime: "WAIT",
    tree.WaitFor: "WAIT FOR",
    tree.Pause: "PAUSE",
    tree.Halt: "HALT",
    tree.Reconfiguration: "RECONFIGURATION",
    tree.LimitSwitch: "the limit",
    tree.LimitSwitchEnd: "the end of the limit",
    tree.FreezeStart: "FREEZESTART",
    tree.FreezeEnd: "FREEZEEND",
    tree.CyclicStart: "CYCLICSTART",
    tree.CyclicEnd: "CYCLICEND",
    tree.ObstacleStart: "OBSTACLE",
    tree.ObstacleEnd: "OBSTACLEEND",
    tree.CriterionStart: "CRITERION",
    tree.CriterionEnd: "CRITERIONEND",
}
"""Statements before which the robot stops, and what messages call them."""
_PRESENT = frozenset({"posture", "ik"})
"""Functions whose value depends on where the robot stands."""
_LISTS = ("body", "otherwise", "default")


def lost_blends(root: tree.Program | tree.Module, source: SourceText) -> list[Diagnostic]:
    """Findings on moves that ask to pass their target by a literal parameter.

    Only what comes next for certain counts: behind a call, a loop or a jump nobody says what follows.
    """
    signals = _Signals.of(root.declarations)
    found: list[Diagnostic] = []
    for part in root.declarations:
        if isinstance(part, tree.ProcedureDeclaration | tree.FunctionDeclaration):
            local = [*parameter_symbols(part), *declared_symbols(part.declarations)]
            line = _Line(source, signals.without(symbol.name.key for symbol in local))
            for body in _bodies(part.body):
                found += line.findings(body)
    if isinstance(root, tree.Program):
        line = _Line(source, signals)
        for body in _bodies(root.body):
            found += line.findings(body, ends=body is root.body)
    return found


@dataclass(frozen=True)
class _Signals:
    """Casefolded names of inputs, outputs and routines in view."""

    inputs: frozenset[str]
    outputs: frozenset[str]
    routines: frozenset[str]

    @classmethod
    def of(cls, declarations: Sequence[tree.Declaration]) -> _Signals:
        names: dict[str, set[str]] = {"INPUT": set(), "OUTPUT": set(), "": set()}
        for part in declarations:
            if isinstance(part, tree.SignalDeclaration):
                names[part.direction] |= {signal.name.key for signal in part.signals}
            elif isinstance(part, tree.ProcedureDeclaration | tree.FunctionDeclaration):
                names[""].add(part.name.key)
            elif isinstance(part, tree.ImportFrom):
                # What a module gives may be a routine: nobody knows here.
                names[""] |= {name.key for name in part.names}
        return cls(*(frozenset(names[kind]) for kind in ("INPUT", "OUTPUT", "")))

    def without(self, hidden: Iterable[str]) -> _Signals:
        """What is left where other names hide some of them."""
        kept = frozenset(hidden)
        return _Signals(self.inputs - kept, self.outputs - kept, self.routines - kept)

    def is_input(self, key: str) -> bool:
        return key in self.inputs or (is_port_name(key) and key.lstrip("a").startswith("in"))

    def is_output(self, key: str) -> bool:
        return key in self.outputs or (is_port_name(key) and key.lstrip("a").startswith("out"))


@dataclass(frozen=True)
class _Line:
    """Looks along lists of statements."""

    source: SourceText
    signals: _Signals

    def findings(self, body: Sequence[tree.Statement], *, ends: bool = False) -> Iterator[Diagnostic]:
        """Findings on the moves of a list; with `ends` the program ends behind it."""
        for at, statement in enumerate(body):
            param = _passing(statement) if isinstance(statement, tree.Move) else None
            if param is not None and isinstance(statement, tree.Move):
                yield from self._behind(statement, param, body[at + 1 :], ends)

    def _behind(
        self, move: tree.Move, param: tree.MoveParam, rest: Sequence[tree.Statement], ends: bool
    ) -> Iterator[Diagnostic]:
        output: tree.Assignment | None = None
        for statement in rest:
            what = self._blocker(statement)
            if what is not None:
                line, _ = self.source.line_and_column(statement.span.start)
                yield from self._lost(move, param, f"{what} in line {line}", statement.span)
                return
            if self._leaves(statement):
                break
            if isinstance(statement, tree.Assignment) and self.signals.is_output(statement.target.base.key):
                output = output or statement
        else:
            if ends:
                end = len(self.source.text.rstrip())
                yield from self._lost(move, param, "the end of the program", Span(end, end))
                return
        if output is not None:
            place, name = Place.in_text(self.source, output.span), output.target.base.name
            related = (Related("the move that passes its target", Place.in_text(self.source, move.span)),)
            yield report("IRL289", place, related=related, output=name, param=param.name.name.upper())

    def _lost(self, move: tree.Move, param: tree.MoveParam, blocker: str, span: Span) -> Iterator[Diagnostic]:
        """The finding on a move, none on those whose blend counts at other targets or points as well."""
        if move.path or len(move.targets) > (2 if move.kind == "CIRCLE" else 1):
            return
        related = (Related("it stops for this", Place.in_text(self.source, span)),)
        place, word = Place.in_text(self.source, param.span), param.name.name.upper()
        yield report("IRL288", place, related=related, blocker=blocker, param=word)

    def _blocker(self, statement: tree.Statement) -> str | None:
        """What a statement is that the robot must stop for, or None."""
        word = _STOPPING.get(type(statement))
        if word is not None:
            return word
        match statement:
            case tree.Assignment(target=target) if target.base.key in FOLLOWED_VARIABLES:
                return f"setting {target.base.name}"
            case tree.Call(name=name) if name.key in PROCEDURES and name.key not in self.signals.routines:
                return name.name
            case tree.Assignment() | tree.Move():
                return self._asked(statement)
            case tree.If(branches=branches):
                return self._asked(branches[0].condition)
            case tree.While(condition=condition):
                return self._asked(condition)
            case tree.Case(selector=selector):
                return self._asked(selector)
        return None

    def _asked(self, root: tree.Node) -> str | None:
        """What a statement or expression reads of the robot or its inputs; None where it may call first."""
        nodes = list(own_nodes(root))
        if any(self._calls(node) for node in nodes):
            return None
        for node in nodes:
            if isinstance(node, tree.Designator):
                if node.base.key in ACTUAL_VARIABLES or self.signals.is_input(node.base.key):
                    return f"reading {node.base.name}"
            elif isinstance(node, tree.FunctionCall) and node.name.key in _PRESENT:
                return node.name.name
        return None

    def _leaves(self, statement: tree.Statement) -> bool:
        """Whether nobody says what comes behind a statement without a blocker, or a move does."""
        if isinstance(statement, tree.Assignment):
            return any(self._calls(node) for node in own_nodes(statement))
        return not isinstance(statement, tree.Label)

    def _calls(self, node: tree.Node) -> bool:
        """Whether an expression calls a routine of the program."""
        if isinstance(node, tree.Designator):
            return node.base.key in self.signals.routines
        return isinstance(node, tree.FunctionCall) and node.name.key in self.signals.routines


def _passing(move: tree.Move) -> tree.MoveParam | None:
    """The parameter by which a move clearly asks to pass its target."""
    given = {param.name.key: param for param in move.params}
    passes = given.get("c_pass")
    says = passes.value.value if passes and isinstance(passes.value, tree.BoolLiteral) else None
    if says is False:
        return None
    amount = given.get("c_ptp" if move.kind == "PTP" else "c_cp")
    if amount is not None and isinstance(amount.value, tree.IntLiteral | tree.RealLiteral):
        return amount if amount.value.value > 0 else passes if says else None
    return passes if says else None


def _bodies(body: Sequence[tree.Statement]) -> Iterator[Sequence[tree.Statement]]:
    """A list of statements and all lists inside it."""
    waiting = [body]
    while waiting:
        statements = waiting.pop()
        yield statements
        for statement in statements:
            for part in (statement, *getattr(statement, "branches", ())):
                waiting += [inner for name in _LISTS if (inner := getattr(part, name, None))]
