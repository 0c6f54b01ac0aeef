"""Switches of the redundancy extension along the straight line of the main statements."""

from __future__ import annotations

from typing import Any

from irlx.diagnostics import Diagnostic, Place, Related, SourceText, Span, report
from irlx.language import tree
from irlx.language.builtins import LIMIT_WORDS

__all__ = ["check_freeze", "check_switches"]


def check_switches(program: tree.Program, source: SourceText) -> list[Diagnostic]:
    """Switches left on, switched off without being on, switched on twice.

    Only what the main statements do one after the other counts; a switch that a routine, a loop or a
    branch touches is left out, and so is everything where the program jumps.
    """
    if not any(_switched(statement) for statement in program.body):
        return []
    if any(isinstance(node, (tree.Goto, tree.Halt)) for node in tree.walk(*program.body)):
        return []
    line = _StraightLine(source, _touched_elsewhere(program))
    for statement in program.body:
        line.visit(statement)
    line.finish()
    return line.findings


def check_freeze(freeze: tree.FreezeStart, source: SourceText) -> list[Diagnostic]:
    """Joint numbers that cannot be meant."""
    findings = []
    seen: set[int] = set()
    for joint in freeze.joints:
        number = _literal(joint)
        if number is None:
            continue
        if number < 1:
            findings.append(report("IRL305", Place.in_text(source, joint.span), number=number))
        elif number in seen:
            findings.append(report("IRL304", Place.in_text(source, joint.span), number=number))
        seen.add(number)
    return findings


def _literal(expression: tree.Expression) -> int | None:
    match expression:
        case tree.IntLiteral(value=value):
            return value
        case tree.Unary(op="-", operand=tree.IntLiteral(value=value)):
            return -value
    return None


def _switched(node: tree.Node) -> tuple[str, bool] | None:
    """The switch that a statement turns, by its words, and whether on or off."""
    match node:
        case tree.LimitSwitch(kind=kind):
            return LIMIT_WORDS[kind], True
        case tree.LimitSwitchEnd(kind=kind):
            return LIMIT_WORDS[kind], False
        case tree.FreezeStart() | tree.FreezeEnd():
            return "FREEZESTART", isinstance(node, tree.FreezeStart)
        case tree.CyclicStart() | tree.CyclicEnd():
            return "CYCLICSTART", isinstance(node, tree.CyclicStart)
        case tree.ObstacleStart(name=name) | tree.ObstacleEnd(name=name):
            return f"OBSTACLE {name.key}", isinstance(node, tree.ObstacleStart)
        case tree.CriterionStart(name=name) | tree.CriterionEnd(name=name):
            return f"CRITERION {name.key}", isinstance(node, tree.CriterionStart)
    return None


def _touched_elsewhere(program: tree.Program) -> set[str]:
    """Switches turned in routines or inside structured statements."""
    straight = {id(statement) for statement in program.body}
    touched = set()
    for node in tree.walk(program):
        switched = _switched(node)
        if switched is not None and id(node) not in straight:
            touched.add(switched[0])
    return touched


def _end_words(switch: str) -> str:
    words = {"FREEZESTART": "FREEZEEND", "CYCLICSTART": "CYCLICEND"}
    first, _, name = switch.partition(" ")
    return words.get(switch) or f"{first}END {name}".rstrip()


class _StraightLine:
    def __init__(self, source: SourceText, left_out: set[str]) -> None:
        self.source = source
        self.left_out = left_out
        self.on: dict[str, Span] = {}
        self.findings: list[Diagnostic] = []

    def visit(self, statement: tree.Statement) -> None:
        switched = _switched(statement)
        if switched is None or switched[0] in self.left_out:
            return
        switch, on = switched
        before = self.on.pop(switch, None)
        if on:
            if before is not None:
                self._add("IRL303", statement.span, before, switch=switch, end=_end_words(switch))
            self.on[switch] = statement.span
        elif before is None:
            self._add("IRL302", statement.span, None, switch=switch, end=_end_words(switch))

    def finish(self) -> None:
        end = len(self.source.text.rstrip())
        for switch, span in self.on.items():
            related = Related("the program ends here", Place.in_text(self.source, Span(end, end)))
            place = Place.in_text(self.source, span)
            data = {"switch": switch, "end": _end_words(switch)}
            self.findings.append(report("IRL301", place, related=(related,), **data))

    def _add(self, code: str, span: Span, before: Span | None, **data: Any) -> None:
        related: tuple[Related, ...] = ()
        if before is not None:
            related = (Related("switched on here", Place.in_text(self.source, before)),)
        self.findings.append(report(code, Place.in_text(self.source, span), related=related, **data))
