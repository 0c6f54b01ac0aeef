"""Procedures and functions: their parameters, and the code of their bodies."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeAlias

from irlx.diagnostics import SourceText
from irlx.interpreter.code import Assembler, Code, Frame
from irlx.interpreter.compiled import Run, failing
from irlx.interpreter.context import Context
from irlx.interpreter.errors import InterpreterError, fail
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.scope import Local, Parameter, Routine, Scope, Variable
from irlx.interpreter.statements import Statements
from irlx.interpreter.type_forms import TypeForms
from irlx.interpreter.types import JOINT_RECORDS
from irlx.interpreter.values import unset_value
from irlx.language import tree
from irlx.language.builtins import SYSTEM_VARIABLES
from irlx.language.symbols import declared_symbols
from irlx.language.types import leaves

Declaration: TypeAlias = "tree.ProcedureDeclaration | tree.FunctionDeclaration"


def declared_routine(part: Declaration, types: TypeForms, source: SourceText) -> Routine:
    """A routine by its head; its code is still empty. Raises InterpreterError for its types."""
    parameters = tuple(
        Parameter(name.name, type, group.mode == "VAR")
        for group in part.parameters
        for type in (types.type(group.type),)
        for name in group.names
    )
    result = types.type(part.result) if isinstance(part, tree.FunctionDeclaration) else None
    return Routine(part.name.name, parameters, result, Code(source))


def compile_body(routine: Routine, part: Declaration, constants: Context) -> None:
    """Make the code of a routine; what is wrong with its declarations is told when it is called."""
    announced = frozenset(symbol.name.key for symbol in declared_symbols(part.declarations))
    scope = Scope(outer=constants.scope, announced=announced)
    assembler = Assembler(routine.code)
    inside = replace(constants, scope=scope)
    statements = Statements(replace(inside, assembler=assembler), routine.result)
    names = [name.key for group in part.parameters for name in group.names]
    for key, parameter in zip(names, routine.parameters, strict=True):
        slot = assembler.slot()
        scope.variables[key] = Local(parameter.name, parameter.type, slot, parameter.by_reference)
        routine.code.values += 1 if parameter.by_reference else leaves(parameter.type)
    try:
        _declare(part, inside, statements)
        statements.body(part.body)
    except InterpreterError as error:
        statements.run(part.name, failing(error).run)
    statements.end(part.name)
    assembler.finish()


def _declare(part: Declaration, constants: Context, statements: Statements) -> None:
    """Declare what is local to a routine: constants and types in text order, then variables."""
    scope, outer = constants.scope, constants.scope.outer
    known = frozenset(outer.types) if outer is not None else frozenset[str]()
    types = TypeForms(constants, known & frozenset(JOINT_RECORDS))
    for declaration in part.declarations:
        if isinstance(declaration, tree.TypeDefinition):
            types.define(declaration)
        elif isinstance(declaration, tree.ConstDeclaration):
            type = types.type(declaration.type)
            for constant in declaration.constants:
                value = unset_value(type)
                if constant.initial is not None:
                    value = Expressions(constants).value(constant.initial, type).run([])
                name = constant.name
                scope.variables[name.key] = Variable(name.name, type, value, constant=True)
    for declaration in part.declarations:
        if isinstance(declaration, tree.VarDeclaration):
            _variables(declaration, types, statements)


def _variables(part: tree.VarDeclaration, types: TypeForms, statements: Statements) -> None:
    context, assembler = statements.context, statements.assembler
    type = types.type(part.type)
    for variable in part.variables:
        name = variable.name
        if name.key in SYSTEM_VARIABLES:
            raise fail("IRL216", context.source, name.span, name=name.name)
        slot = assembler.slot(unset_value(type))
        assembler.code.values += leaves(type)
        if variable.initial is not None:
            run = statements.expressions.value(variable.initial, type).run
            statements.run(variable, _setting(slot, run))
        context.scope.variables[name.key] = Local(name.name, type, slot)


def _setting(slot: int, run: Run) -> Run:
    def set_slot(frame: Frame) -> None:
        frame[slot] = run(frame)

    return set_slot
