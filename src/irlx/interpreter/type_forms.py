"""Type forms: from how a declaration writes a type to the type."""

from __future__ import annotations

from irlx.diagnostics.diagnostic import near_matches
from irlx.interpreter.context import Context
from irlx.interpreter.errors import fail
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.system_names import LATER_TYPES
from irlx.interpreter.types import JOINT_RECORDS, REAL, Array, Record, Type, ambiguous_field, joint_type
from irlx.language import tree
from irlx.language.ranges import MOST_ELEMENTS
from irlx.language.types import leaves

"""Values that an array may hold, those of its elements counted one by one."""


class TypeForms:
    """Types of one scope; `context` is that of its constants."""

    def __init__(self, context: Context, fixed: frozenset[str]) -> None:
        self._context = context
        self._expressions = Expressions(context)
        self._fixed = fixed

    def define(self, part: tree.TypeDefinition) -> None:
        """Add a type to the scope. Raises InterpreterError: IRL202, IRL221, IRL222, and those of `type`."""
        source, scope = self._context.source, self._context.scope
        type = self.type(part.type)
        if isinstance(type, Record):
            type = Record(part.name.name, type.fields)
        key = part.name.key
        if key in self._fixed:
            raise fail("IRL202", source, part.name.span, name=part.name.name)
        if key in JOINT_RECORDS:
            self._check_joint_type(part, type)
        scope.types[key] = type
        if key == "main_joint":
            scope.types["joint"] = joint_type(type)

    def _check_joint_type(self, part: tree.TypeDefinition, type: Type) -> None:
        joints, name, source = self._context.setting.joint_names, part.name, self._context.source
        found = len(type.fields) if isinstance(type, Record) else 1
        if not isinstance(type, Record) or found != len(joints):
            data = {"type": name.name, "found": found, "joints": len(joints), "names": ", ".join(joints)}
            raise fail("IRL221", source, name.span, **data)
        # Groups show where a field gets its type; a type that only gets a second name has none.
        groups = part.type.groups if isinstance(part.type, tree.RecordType) else ()
        places = [group.type for group in groups for _ in group.names]
        for index, (_, field) in enumerate(type.fields):
            if field is not REAL:
                place = places[index] if places else part.type
                expected = f"REAL for a field of {name.name}"
                raise fail("IRL222", source, place.span, expected=expected, found=field.name)

    def type(self, form: tree.TypeForm) -> Type:
        """Type of a form. Raises InterpreterError: IRL204, IRL226, IRL507, IRL508, IRL590."""
        if isinstance(form, tree.NamedType):
            return self._named(form.name)
        if isinstance(form, tree.ArrayType):
            return self._array(form)
        fields: list[tuple[str, Type]] = []
        for group in form.groups:
            type = self.type(group.type)
            fields += [(name.name, type) for name in group.names]
        record = Record("RECORD", tuple(fields))
        for name in (name for group in form.groups for name in group.names):
            clash = ambiguous_field(record, name.name)
            if clash:
                data = {"name": name.name, "field": clash[0], "rest": clash[1]}
                raise fail("IRL226", self._context.source, name.span, **data)
        return record

    def _named(self, name: tree.Name) -> Type:
        scope, source = self._context.scope, self._context.source
        found = scope.type(name.key)
        if found is not None:
            return found
        if name.key in LATER_TYPES:
            raise fail("IRL590", source, name.span, what=f"the type {name.name}")
        near = "; it is defined further down" if scope.is_announced(name.key) else ""
        near = near or near_matches(name.name, [key.upper() for key in scope.type_keys()])
        raise fail("IRL204", source, name.span, name=name.name, near=near)

    def _array(self, form: tree.ArrayType) -> Type:
        source, whole = self._context.source, self._expressions.whole
        ranges = []
        for dimension in form.dimensions:
            low, high = whole(dimension.lower), whole(dimension.upper)
            if low > high:
                raise fail("IRL508", source, dimension.span, low=low, high=high)
            ranges.append((low, high))
        array = Array(tuple(ranges), self.type(form.element))
        size = max(array.size, leaves(array))
        if size > MOST_ELEMENTS:
            raise fail("IRL507", source, form.span, size=size, most=MOST_ELEMENTS)
        return array
