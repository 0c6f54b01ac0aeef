"""Declarations: from the text of a program part to its scope, and to the code of its routines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from irlx.diagnostics import SourceText
from irlx.diagnostics.diagnostic import near_matches
from irlx.interpreter.code import Assembler, Code, Frame
from irlx.interpreter.compiled import Run
from irlx.interpreter.context import Context
from irlx.interpreter.errors import fail
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.routines import compile_body, declared_routine
from irlx.interpreter.scope import Routine, Scope, Variable
from irlx.interpreter.signals import declared_signals
from irlx.interpreter.statements import Statements
from irlx.interpreter.support import EXECUTED_DECLARATIONS, part_name
from irlx.interpreter.type_forms import TypeForms
from irlx.interpreter.types import FILE, JOINT_RECORDS
from irlx.interpreter.values import unset_value
from irlx.interpreter.world import World
from irlx.language import tree
from irlx.language.builtins import SYSTEM_VARIABLES
from irlx.language.data_lists import ImportedList
from irlx.language.symbols import declared_symbols


class Unit:
    """A program or module: its scope, and the code of its initial values."""

    def __init__(
        self,
        world: World,
        source: SourceText,
        root: tree.Program | tree.Module,
        lists: Sequence[ImportedList],
    ) -> None:
        """Declare everything that the text declares and imports.

        Raises InterpreterError: IRL202 for a predefined type defined again, IRL221, IRL222 for a joint
        type that does not fit the robot, IRL204 for an unknown type, IRL216 for a system variable declared,
        IRL226 for a record of ambiguous fields, IRL508, IRL507 for arrays, IRL590 for a part that is not
        executed yet, and what initial values may raise.
        """
        announced = frozenset(symbol.name.key for symbol in declared_symbols(root.declarations))
        imported = frozenset(s.name.key for found in lists for s in declared_symbols(found.tree.declarations))
        self.scope = world.scope(announced, imported)
        # Programs may define the joint types themselves; the other predefined types mean one thing.
        fixed = frozenset(self.scope.types) - frozenset(JOINT_RECORDS)
        self._world, self._source = world, source
        self._constants = Context(
            source, self.scope, world.setting, world.machine, None, world.rest, world.channels
        )
        self._types = TypeForms(self._constants, fixed)
        self.code = Code(source)
        self.assembler = Assembler(self.code)
        self.context = replace(self._constants, assembler=self.assembler)
        self._at_start = False
        self._declare(root, lists)

    def _declare(self, root: tree.Program | tree.Module, lists: Sequence[ImportedList]) -> None:
        """Constants and types in text order, then data lists, then variables: parts come in any order."""
        self._declare_fixed(root)
        for found in lists:
            self.scope.variables.update(self._world.data_list(found, self.scope, list_values))
        routines: list[tuple[Routine, tree.ProcedureDeclaration | tree.FunctionDeclaration]] = []
        for part in root.declarations:
            if isinstance(part, tree.ProcedureDeclaration | tree.FunctionDeclaration):
                routine = declared_routine(part, self._types, self._source)
                self.scope.routines[part.name.key] = routine
                routines.append((routine, part))
            elif isinstance(part, tree.SignalDeclaration):
                for signal in declared_signals(part, Expressions(self._constants), self.scope):
                    self.scope.variables[signal.name.casefold()] = signal
        for part in root.declarations:
            if isinstance(part, tree.VarDeclaration):
                self._add(part.type, part.variables, constant=False)
        for part in root.declarations:
            if isinstance(part, tree.StandardChannel):
                self._bind(part)
        for routine, part in routines:
            compile_body(routine, part, self._constants)

    def _declare_fixed(self, root: tree.Program | tree.Module) -> None:
        """What is imported from modules, types and constants."""
        for part in root.declarations:
            if isinstance(part, tree.ImportFrom):
                self._import(part)
        for part in root.declarations:
            if isinstance(part, tree.TypeDefinition):
                self._types.define(part)
            elif isinstance(part, tree.ConstDeclaration):
                self._add(part.type, part.constants, constant=True)
            elif isinstance(part, tree.RobotBinding):
                self._check_robot(part)
            elif not isinstance(part, EXECUTED_DECLARATIONS):
                raise fail("IRL590", self._source, part.span, what=part_name(part))

    def _check_robot(self, part: tree.RobotBinding) -> None:
        """A cell has one robot, and ROBOT names it. Raises InterpreterError, IRL572, for another one."""
        known = self._world.setting.robots
        if known and part.robot.key not in {name.casefold() for name in known}:
            data = {"near": near_matches(part.robot.name, known), "known": " or ".join(known)}
            raise fail("IRL572", self._source, part.robot.span, name=part.robot.name, **data)

    def _bind(self, part: tree.StandardChannel) -> None:
        """Put a variable of type FILE in the place of a standard channel. Raises InterpreterError, IRL222."""
        found = self.scope.found(part.channel.key)
        if found is None:
            # KEYBOARD or SCREEN: the channels as they are.
            return
        if not isinstance(found, Variable) or found.type != FILE:
            name = f"the variable {found.name}" if isinstance(found, Variable) else found.name
            data = {"expected": "a variable of FILE", "found": name}
            raise fail("IRL222", self._source, part.channel.span, **data)
        self._world.channels.bound[part.direction] = found

    def finish(self, root: tree.Node, body: Sequence[tree.Statement]) -> Code:
        """Add statements behind the initial values, and make the code."""
        statements = Statements(self.context)
        statements.body(body)
        statements.end(root)
        self.assembler.finish()
        return self.code

    def _import(self, part: tree.ImportFrom) -> None:
        """Bring in names of a module. Raises InterpreterError, IRL218, IRL219."""
        exporting = self._world.modules.get(part.module.key)
        if exporting is None:
            raise fail("IRL218", self._source, part.module.span, module=part.module.name, near="")
        for name in part.names:
            found = exporting.found(name.key)
            type = exporting.type(name.key) if name.key in exporting.announced else None
            if isinstance(found, Routine):
                self.scope.routines[name.key] = found
            elif isinstance(found, Variable) and name.key in exporting.announced:
                self.scope.variables[name.key] = found
            elif type is not None:
                self.scope.types[name.key] = type
                if name.key == "main_joint":
                    self.scope.types["joint"] = exporting.types["joint"]
            else:
                data = {"name": name.name, "file": f"{part.module.name}.irl", "near": ""}
                raise fail("IRL219", self._source, name.span, **data)

    def _add(self, form: tree.TypeForm, variables: tuple[tree.Variable, ...], *, constant: bool) -> None:
        """Declare variables or constants. Values that call or ask, and all behind them, come at the start
        of the run; the others are there at once, for the bounds of array types."""
        type = self._types.type(form)
        expressions = Expressions(self._constants)
        for variable in variables:
            name = variable.name
            if name.key in SYSTEM_VARIABLES:
                raise fail("IRL216", self._source, name.span, name=name.name)
            declared = Variable(name.name, type, unset_value(type), constant)
            if variable.initial is not None:
                asks = Expressions(self.context).suspends(variable.initial)
                self._at_start = self._at_start or (asks and not constant)
                if self._at_start and not constant:
                    found = Expressions(self.context).value(variable.initial, type)
                    Statements(self.context).run(variable, _setting(declared, found.run))
                else:
                    declared.value = expressions.value(variable.initial, type).run([])
            self.scope.variables[name.key] = declared


def _setting(variable: Variable, run: Run) -> Run:
    def set_variable(frame: Frame) -> None:
        variable.value = run(frame)

    return set_variable


def list_values(found: ImportedList, scope: Scope, world: World) -> dict[str, Variable]:
    """Variables of a data list, whose values know the types of the program and each other, nothing else."""
    own = Scope(types=scope.types)
    context = Context(found.source, own, world.setting, world.machine, None, world.rest)
    types, expressions = TypeForms(context, frozenset()), Expressions(context)
    declared: dict[str, Variable] = {}
    for part in found.tree.declarations:
        type = types.type(part.type)
        for variable in part.variables:
            name = variable.name
            if name.key in SYSTEM_VARIABLES:
                raise fail("IRL216", found.source, name.span, name=name.name)
            value = unset_value(type)
            if variable.initial is not None:
                value = expressions.value(variable.initial, type).run([])
            declared[name.key] = own.variables[name.key] = Variable(name.name, type, value)
    return declared
