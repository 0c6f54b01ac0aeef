"""Which parts of the language are executed; the others are read, checked and named, never skipped."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields

from irlx.diagnostics import Diagnostic, Place, SourceText, report
from irlx.interpreter.functions import FUNCTIONS
from irlx.language import tree

_DECLARATIONS = (
    tree.VarDeclaration,
    tree.ConstDeclaration,
    tree.TypeDefinition,
    tree.SystemSpecification,
)
_STATEMENTS = (
    tree.Assignment,
    tree.Halt,
    tree.Move,
    tree.LimitSwitch,
    tree.LimitSwitchEnd,
    tree.FreezeStart,
    tree.FreezeEnd,
    tree.CyclicStart,
    tree.CyclicEnd,
)
MOVE_PARAMS = {
    "speed": "R_SPEED",
    "acc": "R_ACC",
    "speed_ori": "R_SPEED_ORI",
    "acc_ori": "R_ACC_ORI",
    "speed_ptp": "R_SPEED_PTP",
    "acc_ptp": "R_ACC_PTP",
    "time": "",
}
"""Executed parameters of MOVE by casefolded name, and the system variable with their default."""

_NAMES = {
    "ImportFrom": "FROM .. IMPORT",
    "ImportDatalist": "IMPORT DATALIST",
    "Export": "EXPORT",
    "RobotBinding": "ROBOT",
    "StandardChannel": "STANDARD_IN and STANDARD_OUT",
    "SignalDeclaration": "INPUT and OUTPUT",
    "ProcedureDeclaration": "PROCEDURE",
    "FunctionDeclaration": "FUNCTION",
    "Call": "a procedure call",
    "Return": "RETURN",
    "Goto": "GOTO",
    "Label": "a label",
    "If": "IF",
    "Case": "CASE",
    "For": "FOR",
    "While": "WHILE",
    "Repeat": "REPEAT",
    "Exit": "EXIT",
    "Pause": "PAUSE",
    "WaitTime": "WAIT",
    "WaitFor": "WAIT FOR",
    "ObstacleStart": "OBSTACLE",
    "ObstacleEnd": "OBSTACLEEND",
    "Reconfiguration": "RECONFIGURATION",
    "CriterionStart": "CRITERION",
    "CriterionEnd": "CRITERIONEND",
    "WithReconfiguration": "WITH RECONFIGURATION",
    "WithCriterion": "WITH CRITERION",
    "WithTolerance": "WITH TOLERANCE",
}


def part_name(node: tree.Node) -> str:
    """What a program calls a part: its keywords."""
    return _NAMES.get(type(node).__name__, type(node).__name__)


def missing_in_move(move: tree.Move) -> tuple[tree.Node, str] | None:
    """First part of a MOVE that is not executed, and its name, or None."""
    if move.incremental:
        return move, "MOVE_INC"
    if move.path:
        return move, f"MOVE {move.kind} PATH"
    if move.kind not in ("PTP", "LIN"):
        return move, f"MOVE {move.kind}"
    for param in move.params:
        if param.name.key not in MOVE_PARAMS:
            return param, f"the parameter {param.name.name}"
    for clause in move.clauses:
        if not isinstance(clause, tree.WithLimit):
            return clause, part_name(clause)
    return None


def unsupported(program: tree.Program, source: SourceText) -> list[Diagnostic]:
    """A warning, IRL591, for every part of a program that a run would stop at."""
    found: list[tuple[tree.Node, str]] = []
    for declaration in program.declarations:
        if not isinstance(declaration, _DECLARATIONS):
            found.append((declaration, part_name(declaration)))
    for statement in program.body:
        if not isinstance(statement, _STATEMENTS):
            found.append((statement, part_name(statement)))
            continue
        missing = missing_in_move(statement) if isinstance(statement, tree.Move) else None
        if missing is not None:
            found.append(missing)
        found += [(call, f"the function {call.name.name}") for call in _calls(statement)]
    return [report("IRL591", Place.in_text(source, node.span), what=what) for node, what in found]


def _calls(node: object) -> Iterator[tree.FunctionCall]:
    """Calls of functions that are not executed, in a statement of the executed kinds."""
    if isinstance(node, tree.FunctionCall) and node.name.key not in FUNCTIONS:
        yield node
    if isinstance(node, tree.Node):
        for field in fields(node):
            yield from _calls(getattr(node, field.name))
    elif isinstance(node, tuple):
        for item in node:
            yield from _calls(item)


def reads_actual(node: object) -> bool:
    """Whether a statement reads R_JOINT_ACT, the posture of the robot at that moment."""
    if isinstance(node, tree.Designator) and node.base.key == "r_joint_act":
        return True
    if isinstance(node, tree.Node):
        return any(reads_actual(getattr(node, field.name)) for field in fields(node))
    return isinstance(node, tuple) and any(reads_actual(item) for item in node)
