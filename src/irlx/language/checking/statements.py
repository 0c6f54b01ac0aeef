"""Types in statements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from irlx.language import tree
from irlx.language.builtins import FOLLOWED, PROCEDURES
from irlx.language.checking.case_labels import twice_chosen
from irlx.language.checking.channels import Channels
from irlx.language.checking.motion import Motion
from irlx.language.references import Reference
from irlx.language.types import BOOL, CHAR, INT, REAL, STRING, UNKNOWN, Type, is_number, same_type

_CHOOSING: tuple[Type, ...] = (INT, CHAR, BOOL, STRING)
_KINDS = {
    "variable": "a variable",
    "constant": "a constant",
    "parameter": "a parameter",
    "input": "an input",
    "output": "an output",
    "robot": "a robot",
    "system": "a system variable",
    "followed": "a system variable",
}


class Statements(Motion, Channels):
    """Types in statements; `routine` is the one whose body is looked at, None for the main statements."""

    routine: tree.ProcedureDeclaration | tree.FunctionDeclaration | None = None
    result: Type | None = None
    """Type of the result of that routine."""

    def body(self, statements: Sequence[tree.Statement]) -> None:
        """Look at a list of statements and all inside them; works without recursion over the nesting."""
        self._pending: list[Sequence[tree.Statement]] = [statements]
        while self._pending:
            for statement in self._pending.pop():
                look = _STATEMENTS.get(type(statement))
                if look is not None:
                    look(self, statement)

    def _later(self, statements: Sequence[tree.Statement] | None) -> None:
        if statements:
            self._pending.append(statements)

    # ---- control

    def _assignment(self, node: tree.Assignment) -> None:
        type, entry = self.set_target(node.target)
        found = self.fitted(node.value, type)
        if entry is not None:
            entry.set(found.value, whole=not node.target.selectors)
        *outer, last = node.target.selectors or (None,)
        if isinstance(last, tree.Field) and last.key == "status":
            whole = replace(node.target, selectors=tuple(outer))
            self.status(self.trial(lambda: self.typed(whole)).typed.type, node.value, found)

    def _if(self, node: tree.If) -> None:
        for branch in node.branches:
            self.fitted(branch.condition, BOOL)
            self._later(branch.body)
        self._later(node.otherwise)

    def _while(self, node: tree.While) -> None:
        self.fitted(node.condition, BOOL)
        self._later(node.body)

    def _repeat(self, node: tree.Repeat) -> None:
        self.fitted(node.condition, BOOL)
        self._later(node.body)

    def _for(self, node: tree.For) -> None:
        type, entry = self.set_target(node.variable)
        if entry is not None and entry.kind == "followed":
            self.add("IRL249", node.variable, where="this statement", found=FOLLOWED)
        if entry is not None:
            entry.set(None, whole=False)
        if not is_number(type) and type is not UNKNOWN:
            self.mismatch(node.variable, "a variable of type INT or REAL", type.name)
            # One thing is wrong, not the bounds as well.
            type = UNKNOWN
        self.fitted(node.start, type)
        self.fitted(node.stop, type)
        if node.step is not None:
            value = self.fitted(node.step, type).value
            if isinstance(value, int | float) and not isinstance(value, bool) and value <= 0:
                shown = f"{value:g}" if isinstance(value, float) else str(value)
                self.add("IRL505", node.step, param="STEP", expected="greater than 0", value=shown)
        self._later(node.body)

    def _case(self, node: tree.Case) -> None:
        type = self.typed(node.selector).type
        if not any(same_type(type, possible) for possible in _CHOOSING):
            self.mismatch(node.selector, "INT, CHAR, STRING or BOOL", type.name)
            type = UNKNOWN
        labels = []
        for branch in node.branches:
            for label in branch.labels:
                ends = (label.lower, label.upper) if isinstance(label, tree.Range) else (label, label)
                if isinstance(label, tree.Range) and type in (BOOL, STRING):
                    self.mismatch(label, "INT or CHAR before a CASE with ranges", type.name)
                    continue
                low = self.fitted(ends[0], type).value
                high = low if ends[0] is ends[1] else self.fitted(ends[1], type).value
                labels.append((label, low, high))
            self._later(branch.body)
        self._later(node.default)
        for code, place, data, related in twice_chosen(labels, self.text, self.place):
            self.add(code, place, related=related, **data)

    def _return(self, node: tree.Return) -> None:
        if self.result is None:
            if node.value is not None:
                self.typed(node.value)
                where = f"the procedure {self.routine.name.name}" if self.routine else "the program"
                self.add("IRL248", node.value, where=where)
        elif node.value is None:
            name = self.routine.name.name if self.routine else ""
            self.add("IRL247", node, name=name, type=self.result.name)
        else:
            self.fitted(node.value, self.result)

    def _call(self, node: tree.Call) -> None:
        entry = self.names.value(node.name.key)
        if entry is None:
            if node.name.key in PROCEDURES:
                self.built_in_procedure(node)
            else:
                self.unknown_arguments(node.arguments)
            return
        if entry.symbol is not None:
            self.references.append(Reference(node.name.span, entry.symbol, "call"))
        if entry.signature is not None:
            # A function stands here as well; its value is dropped.
            self.arguments(entry.signature, node.arguments, node, self.declared_here(entry))
            return
        self.unknown_arguments(node.arguments)
        found = _KINDS.get(entry.kind)
        if found is not None:
            self.add("IRL250", node.name, name=node.name.name, found=found, expected="a procedure")

    def _obstacle(self, node: tree.ObstacleStart | tree.ObstacleEnd) -> None:
        self.obstacle(node.name)

    def _wait_time(self, node: tree.WaitTime) -> None:
        self._seconds(node.duration, "WAIT")

    def _wait_for(self, node: tree.WaitFor) -> None:
        self.fitted(node.condition, BOOL)
        if node.timeout is None:
            self.lint("IRL285", node)
        else:
            self._seconds(node.timeout, "TIMEOUT")

    def _seconds(self, node: tree.Expression, word: str) -> None:
        value = self.fitted(node, REAL).value
        if isinstance(value, int | float) and value < 0:
            self.add("IRL505", node, param=word, expected="0 or more", value=f"{value:g}")


_STATEMENTS: dict[type[tree.Node], Callable[[Statements, Any], None]] = {
    tree.Assignment: Statements._assignment,
    tree.If: Statements._if,
    tree.While: Statements._while,
    tree.Repeat: Statements._repeat,
    tree.For: Statements._for,
    tree.Case: Statements._case,
    tree.Return: Statements._return,
    tree.Call: Statements._call,
    tree.WaitTime: Statements._wait_time,
    tree.WaitFor: Statements._wait_for,
    tree.Move: Statements.move,
    tree.LimitSwitch: Statements.limits,
    tree.FreezeStart: Statements.freeze,
    tree.Reconfiguration: Statements.reconfiguration,
    tree.CriterionStart: Statements.criterion,
    tree.ObstacleStart: Statements._obstacle,
    tree.ObstacleEnd: Statements._obstacle,
}
