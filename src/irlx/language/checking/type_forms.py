"""Types as a program writes them: names, arrays, records, and definitions of its own."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from irlx.diagnostics import Related
from irlx.language import tree
from irlx.language.checking.expressions import Expressions
from irlx.language.ranges import MOST_ELEMENTS
from irlx.language.references import Reference
from irlx.language.symbols import Symbol
from irlx.language.types import (
    ANY_BOUNDS,
    INT,
    JOINT_RECORDS,
    REAL,
    UNKNOWN,
    Array,
    Bounds,
    Record,
    Type,
    ambiguous_field,
    built_in_functions,
    joint_bounds,
    joint_type,
    known_types,
    leaves,
)
from irlx.language.words import count

FIXED_TYPES = frozenset(known_types(None)) - frozenset(JOINT_RECORDS)
"""Predefined types that mean one thing and are not defined again."""


@dataclass(frozen=True)
class Joints:
    """Joints of the robot as far as they are known.

    Their number, the type in the text that shows it, and their names where the cell is known.
    """

    number: int | None = None
    shown_by: tree.Name | None = None
    names: tuple[str, ...] = field(default=())


def joints_of(declarations: tuple[tree.Declaration, ...], names: tuple[str, ...]) -> Joints:
    """Joints of the robot: `names` by the cell where it is known, else what MAIN_JOINT or its kin show."""
    if names:
        return Joints(len(names), names=names)
    found = {
        part.name.key: part
        for part in reversed(declarations)
        if isinstance(part, tree.TypeDefinition) and part.name.key in JOINT_RECORDS
    }
    for key in ("main_joint", *reversed(found)):
        part = found.get(key)
        if part is not None and isinstance(part.type, tree.RecordType):
            return Joints(sum(len(group.names) for group in part.type.groups), part.name)
    return Joints()


class TypeForms(Expressions):
    """What type forms mean, and definitions of types."""

    joints = Joints()
    announced_types: frozenset[str] | set[str] = frozenset()
    """Types defined further down, by casefolded name."""

    def type_of(self, form: tree.TypeForm) -> Type:
        """The type that a form means."""
        if isinstance(form, tree.NamedType):
            return self._named(form.name)
        if isinstance(form, tree.ArrayType):
            return self._array(form)
        return self._record(form)

    def _named(self, name: tree.Name) -> Type:
        symbol = self.names.type_symbol(name.key)
        if symbol is not None:
            self.references.append(Reference(name.span, symbol, "type"))
        found = self.names.types.get(name.key)
        if found is not None:
            return found
        if name.key in self.announced_types:
            self.add("IRL204", name, name=name.name, near="; it is defined further down")
        return UNKNOWN

    def _record(self, form: tree.RecordType) -> Record:
        fields: list[tuple[str, Type]] = []
        for group in form.groups:
            type = self.type_of(group.type)
            fields += [(name.name, type) for name in group.names]
        record = Record("RECORD", tuple(fields))
        for name in (name for group in form.groups for name in group.names):
            clash = ambiguous_field(record, name.name) if "." in name.key else None
            if clash:
                self.add("IRL226", name, name=name.name, field=clash[0], rest=clash[1])
        return record

    def _array(self, form: tree.ArrayType) -> Array:
        array = Array(tuple([self._bounds(d) for d in form.dimensions]), self.type_of(form.element))
        size = max(array.size, leaves(array))
        # Of arrays in each other the innermost that is too large is told.
        if size > MOST_ELEMENTS >= leaves(array.element):
            self.add("IRL507", form, size=size, most=MOST_ELEMENTS)
        return array

    def _bounds(self, dimension: tree.Range) -> Bounds:
        low, high = self.fitted(dimension.lower, INT), self.fitted(dimension.upper, INT)
        if (
            not isinstance(low.value, int)
            or not isinstance(high.value, int)
            or not low.type is high.type is INT
        ):
            return ANY_BOUNDS
        if low.value > high.value:
            self.add("IRL508", dimension, low=low.value, high=high.value)
            return ANY_BOUNDS
        return low.value, high.value

    # ---- definitions

    def define(self, part: tree.TypeDefinition) -> None:
        """Define a type; that it is defined twice is told with the names."""
        name, key = part.name, part.name.key
        type = self.type_of(part.type)
        if isinstance(type, Record):
            type = Record(name.name, type.fields, type.pattern)
        if key in FIXED_TYPES:
            self.add("IRL202", name, name=name.name)
            return
        if not key or key in self.names.type_symbols:
            return
        if key in JOINT_RECORDS:
            self._check_joint_type(part, type)
        self.set_type(key, type)
        self.names.type_symbols[key] = Symbol(name, "type", part, None, type)

    def set_type(self, key: str, type: Type) -> None:
        """Give a name the meaning of a type from here on."""
        self.names.types[key] = type
        if key == "main_joint":
            self._joints_defined(type)
        bounds = self.names.value("r_jbd") if key in ("main_joint_min", "main_joint_max") else None
        if bounds is not None:
            bounds.type = joint_bounds(self.names.types)

    def _joints_defined(self, main: Type) -> None:
        types = self.names.types
        types["joint"] = joint_type(main)
        self.names.functions = built_in_functions(types)
        actual = self.names.value("r_joint_act")
        if actual is not None:
            actual.type = types["joint"]

    def _check_joint_type(self, part: tree.TypeDefinition, type: Type) -> None:
        name = part.name
        if type is UNKNOWN:
            return
        if not isinstance(type, Record):
            self.mismatch(part.type, f"a RECORD with one REAL a joint for {name.name}", type.name)
            return
        self._count_joints(name, type)
        # Groups show where a field gets its type; a type that only gets a second name has none.
        groups = part.type.groups if isinstance(part.type, tree.RecordType) else ()
        places = [group.type for group in groups for _ in group.names]
        for index, (_, found) in enumerate(type.fields):
            if found is not REAL and found is not UNKNOWN:
                place = places[index] if places else part.type
                self.mismatch(place, f"REAL for a field of {name.name}", found.name)

    def _count_joints(self, name: tree.Name, type: Record) -> None:
        joints, found = self.joints, len(type.fields)
        expected = joints.number
        if type.pattern or expected is None or found == expected:
            return
        if joints.names:
            names = ", ".join(joints.names)
            self.add("IRL221", name, type=name.name, found=found, joints=expected, names=names)
        elif joints.shown_by is not None:
            other = joints.shown_by
            related = (Related("the type that it must agree with", self.place(other)),)
            data: dict[str, Any] = {"type": name.name, "other": other.name}
            self.add("IRL246", name, related=related, found=count(found, "field"), expected=expected, **data)
