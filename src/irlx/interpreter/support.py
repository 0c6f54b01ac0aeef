"""Which parts of the language are executed; the others are read, checked and named, never skipped."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from irlx.blocks.criterion import LIBRARY
from irlx.diagnostics import Diagnostic, Place, SourceText, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.interpreter.evaluate import POSTURE, missing_in_posture
from irlx.interpreter.functions import FUNCTIONS
from irlx.interpreter.parameters import criterion_name
from irlx.interpreter.setting import SYSTEM_REALS
from irlx.interpreter.system_names import LATER_TYPES, system_name
from irlx.language import builtins, tree
from irlx.language.data_lists import ImportedList
from irlx.language.symbols import declared_symbols

_DECLARATIONS = (
    tree.VarDeclaration,
    tree.ConstDeclaration,
    tree.TypeDefinition,
    tree.SystemSpecification,
    tree.ImportDatalist,
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
    tree.Reconfiguration,
    tree.CriterionStart,
    tree.CriterionEnd,
)
_CLAUSES = (tree.WithLimit, tree.WithReconfiguration, tree.WithCriterion)
_EXECUTED_FUNCTIONS = frozenset({*FUNCTIONS, POSTURE})
_READ_ONLY_FUNCTIONS = (frozenset(builtins.FUNCTIONS) | frozenset(builtins.TYPES)) - _EXECUTED_FUNCTIONS
_ACTUAL = "r_joint_act"
_EXECUTED_NAMES = frozenset({_ACTUAL, *(name.casefold() for name in SYSTEM_REALS)})
MOVE_PARAMS = {
    "speed": "R_SPEED",
    "acc": "R_ACC",
    "speed_ori": "R_SPEED_ORI",
    "acc_ori": "R_ACC_ORI",
    "speed_ptp": "R_SPEED_PTP",
    "acc_ptp": "R_ACC_PTP",
    "time": "",
    "angle": "",
    "circ_ori": "",
}
"""Executed parameters of MOVE by casefolded name, and the system variable with their default, '' for none."""

_NAMES = {
    "ImportFrom": "FROM .. IMPORT",
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
    if move.kind not in ("PTP", "LIN", "CIRCLE"):
        return move, f"MOVE {move.kind}"
    for param in move.params:
        if param.name.key not in MOVE_PARAMS:
            return param, f"the parameter {param.name.name}"
    for clause in move.clauses:
        if not isinstance(clause, _CLAUSES):
            return clause, part_name(clause)
    return None


def unsupported(
    program: tree.Program, source: SourceText, lists: Sequence[ImportedList] = ()
) -> list[Diagnostic]:
    """A warning, IRL591, for every part of a program and its data lists that a run would stop at.

    IRL363 for criteria outside the library, at which it stops unless they are registered by then.
    """
    values = [part for data_list in lists for part in data_list.tree.declarations]
    declared = frozenset(symbol.name.key for symbol in declared_symbols([*program.declarations, *values]))
    found: list[tuple[tree.Node, str]] = []
    for declaration in program.declarations:
        if isinstance(declaration, _DECLARATIONS):
            found += _parts(declaration, declared)
        else:
            found.append((declaration, part_name(declaration)))
    for statement in program.body:
        if not isinstance(statement, _STATEMENTS):
            found.append((statement, part_name(statement)))
            continue
        missing = missing_in_move(statement) if isinstance(statement, tree.Move) else None
        if missing is not None:
            found.append(missing)
        found += _parts(statement, declared)
    warnings = [_unexecuted(source, node, what) for node, what in found]
    for data_list in lists:
        for part in data_list.tree.declarations:
            warnings += [_unexecuted(data_list.source, *missing) for missing in _parts(part, declared)]
    return [*warnings, *_unknown_criteria(program, source)]


def _unexecuted(source: SourceText, node: tree.Node, what: str) -> Diagnostic:
    return report("IRL591", Place.in_text(source, node.span), what=what)


def _unknown_criteria(program: tree.Program, source: SourceText) -> Iterator[Diagnostic]:
    """A warning at the first place of every criterion that is none of the library."""
    told: set[str] = set()
    for node in tree.walk(program):
        if not isinstance(node, tree.CriterionStart | tree.WithCriterion):
            continue
        name = criterion_name(node.name)
        if name not in LIBRARY and name not in told:
            told.add(name)
            near, place = near_matches(name, LIBRARY), Place.in_text(source, node.name.span)
            yield report("IRL363", place, name=name, near=near, known=", ".join(LIBRARY))


def _parts(root: tree.Node, declared: frozenset[str]) -> Iterator[tuple[tree.Node, str]]:
    """Parts that are not executed in a declaration or statement of the executed kinds, and their names."""
    for node in tree.walk(root):
        match node:
            case tree.FunctionCall(name=name) if name.key in (_READ_ONLY_FUNCTIONS | declared):
                yield node, f"the function {name.name}"
            case tree.FunctionCall(name=name, arguments=arguments) if name.key == POSTURE:
                in_declaration = isinstance(root, _DECLARATIONS)
                missing = missing_in_posture(len(arguments), in_declaration=in_declaration)
                if missing:
                    yield node, missing
            case tree.NamedType(name=name) if name.key in LATER_TYPES - declared:
                yield node, f"the type {name.name}"
            case tree.Designator(base=name) if name.key not in _EXECUTED_NAMES | declared:
                what = system_name(name)
                if what:
                    yield name, what


def reads_actual(node: tree.Node) -> bool:
    """Whether a statement reads R_JOINT_ACT, the posture of the robot at that moment."""
    return any(isinstance(part, tree.Designator) and part.base.key == _ACTUAL for part in tree.walk(node))
