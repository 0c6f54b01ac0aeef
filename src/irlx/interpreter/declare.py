"""Declarations: from the text of a program part to its scope."""

from __future__ import annotations

from collections.abc import Sequence

from irlx.diagnostics import SourceText
from irlx.diagnostics.diagnostic import near_matches
from irlx.interpreter.errors import fail
from irlx.interpreter.evaluate import Evaluator
from irlx.interpreter.scope import Scope, Variable
from irlx.interpreter.setting import SYSTEM_REALS, Setting
from irlx.interpreter.support import part_name
from irlx.interpreter.system_names import LATER_TYPES
from irlx.interpreter.types import (
    JOINT_RECORDS,
    POSE,
    REAL,
    Array,
    Record,
    Type,
    ambiguous_field,
    joint_type,
    predefined_types,
)
from irlx.interpreter.values import RecordValue, Value, unset_value
from irlx.language import tree
from irlx.language.builtins import SYSTEM_VARIABLES
from irlx.language.data_lists import ImportedList
from irlx.language.symbols import declared_symbols


def declared_scope(
    program: tree.Program, source: SourceText, setting: Setting, lists: Sequence[ImportedList] = ()
) -> Scope:
    """Scope of a program: system variables, poses of the cell, then what the program declares and imports.

    Raises InterpreterError: IRL202 for a predefined type defined again, IRL221, IRL222 for a joint
    type that does not fit the robot, IRL204 for an unknown type, IRL216 for a system variable
    declared, IRL226 for a record of ambiguous fields, IRL508, IRL507 for arrays, IRL590 for a part
    that is not executed yet, and what initial values may raise.
    """
    announced = frozenset(symbol.name.key for symbol in declared_symbols(program.declarations))
    imported = frozenset(s.name.key for found in lists for s in declared_symbols(found.tree.declarations))
    types = predefined_types(len(setting.joint_names))
    scope = Scope(types=types, announced=announced, imported=imported)
    for name in SYSTEM_REALS:
        scope.variables[name.casefold()] = Variable(name, REAL, float(setting.defaults[name]))
    for name, (at, turned) in setting.poses.items():
        value = RecordValue(POSE, (_reals(POSE, 0, at), _reals(POSE, 1, turned)))
        scope.variables[name.casefold()] = Variable(name, POSE, value, constant=True)
    scope.variables["r_joint_act"] = _actual_joints(scope)
    _Declarer(source, scope, setting).program(program, lists)
    return scope


def _reals(record: Record, field: int, values: tuple[float, ...]) -> Value:
    type = record.fields[field][1]
    if not isinstance(type, Record):
        raise TypeError("parts of a pose are records")
    return RecordValue(type, values)


def _actual_joints(scope: Scope) -> Variable:
    type = scope.types["joint"]
    return Variable("R_JOINT_ACT", type, unset_value(type), constant=True)


class _Declarer:
    def __init__(self, source: SourceText, scope: Scope, setting: Setting) -> None:
        self._source = source
        self._scope = scope
        self._setting = setting
        self._evaluator = Evaluator(source, scope)
        # Programs may define the joint types themselves; the other predefined types mean one thing.
        self._fixed = frozenset(scope.types) - frozenset(JOINT_RECORDS)

    def program(self, program: tree.Program, lists: Sequence[ImportedList]) -> None:
        """Constants and types in text order, then data lists, then variables: parts come in any order."""
        variables: list[tree.VarDeclaration] = []
        for part in program.declarations:
            if isinstance(part, tree.VarDeclaration):
                variables.append(part)
            elif isinstance(part, tree.TypeDefinition):
                self._define(part)
            elif isinstance(part, tree.ConstDeclaration):
                self._variables(part.type, part.constants, constant=True)
            elif not isinstance(part, tree.SystemSpecification | tree.ImportDatalist):
                raise fail("IRL590", self._source, part.span, what=part_name(part))
        for found in lists:
            # Values of a list know the types of the program and each other, nothing else.
            own = Scope(types=self._scope.types)
            _Declarer(found.source, own, self._setting).variables(found.tree.declarations)
            self._scope.variables.update(own.variables)
        self.variables(variables)

    def variables(self, parts: Sequence[tree.VarDeclaration]) -> None:
        for part in parts:
            self._variables(part.type, part.variables, constant=False)

    def _define(self, part: tree.TypeDefinition) -> None:
        type = self._type(part.type)
        if isinstance(type, Record):
            type = Record(part.name.name, type.fields)
        key = part.name.key
        if key in self._fixed:
            raise fail("IRL202", self._source, part.name.span, name=part.name.name)
        if key in JOINT_RECORDS:
            self._check_joint_type(part, type)
        self._scope.types[key] = type
        if key == "main_joint":
            self._scope.types["joint"] = joint_type(type)
            self._scope.variables["r_joint_act"] = _actual_joints(self._scope)

    def _check_joint_type(self, part: tree.TypeDefinition, type: Type) -> None:
        joints, name = self._setting.joint_names, part.name
        found = len(type.fields) if isinstance(type, Record) else 1
        if not isinstance(type, Record) or found != len(joints):
            data = {"type": name.name, "found": found, "joints": len(joints), "names": ", ".join(joints)}
            raise fail("IRL221", self._source, name.span, **data)
        # Groups show where a field gets its type; a type that only gets a second name has none.
        groups = part.type.groups if isinstance(part.type, tree.RecordType) else ()
        places = [group.type for group in groups for _ in group.names]
        for index, (_, field) in enumerate(type.fields):
            if field is not REAL:
                place = places[index] if places else part.type
                expected = f"REAL for a field of {name.name}"
                raise fail("IRL222", self._source, place.span, expected=expected, found=field.name)

    def _variables(
        self, form: tree.TypeForm, variables: tuple[tree.Variable, ...], *, constant: bool
    ) -> None:
        type = self._type(form)
        for variable in variables:
            if variable.name.key in SYSTEM_VARIABLES:
                raise fail("IRL216", self._source, variable.name.span, name=variable.name.name)
            value = unset_value(type)
            if variable.initial is not None:
                value = self._evaluator.value(variable.initial, type)
            name = variable.name
            self._scope.variables[name.key] = Variable(name.name, type, value, constant)

    def _type(self, form: tree.TypeForm) -> Type:
        if isinstance(form, tree.NamedType):
            return self._named(form.name)
        if isinstance(form, tree.ArrayType):
            return self._array(form)
        fields: list[tuple[str, Type]] = []
        for group in form.groups:
            type = self._type(group.type)
            fields += [(name.name, type) for name in group.names]
        record = Record("RECORD", tuple(fields))
        for name in (name for group in form.groups for name in group.names):
            clash = ambiguous_field(record, name.name)
            if clash:
                data = {"name": name.name, "field": clash[0], "rest": clash[1]}
                raise fail("IRL226", self._source, name.span, **data)
        return record

    def _named(self, name: tree.Name) -> Type:
        found = self._scope.types.get(name.key)
        if found is not None:
            return found
        if name.key in LATER_TYPES:
            raise fail("IRL590", self._source, name.span, what=f"the type {name.name}")
        near = "; it is defined further down" if name.key in self._scope.announced else ""
        near = near or near_matches(name.name, [key.upper() for key in self._scope.types])
        raise fail("IRL204", self._source, name.span, name=name.name, near=near)

    def _array(self, form: tree.ArrayType) -> Type:
        ranges = []
        for dimension in form.dimensions:
            low, high = self._evaluator.whole(dimension.lower), self._evaluator.whole(dimension.upper)
            if low > high:
                raise fail("IRL508", self._source, dimension.span, low=low, high=high)
            ranges.append((low, high))
        array = Array(tuple(ranges), self._type(form.element))
        if array.size > _MOST_ELEMENTS:
            raise fail("IRL507", self._source, form.span, size=array.size, most=_MOST_ELEMENTS)
        return array


_MOST_ELEMENTS = 10_000_000
