"""Variables and their parts: fields with dots in their names, elements of arrays."""

from __future__ import annotations

from dataclasses import replace

from irlx.diagnostics.diagnostic import near_matches
from irlx.language import tree
from irlx.language.builtins import BARE_FUNCTIONS, FOLLOWED
from irlx.language.checking.context import NOTHING, Context, Typed
from irlx.language.checking.names import Entry, port_entry
from irlx.language.references import Access, Reference
from irlx.language.types import (
    ANY_BOUNDS,
    CHAR,
    INT,
    STRING,
    UNKNOWN,
    Array,
    Record,
    Type,
    field_names,
    holds_files,
    longest_field,
    same_type,
)
from irlx.language.words import count

NOT_A_VALUE = {"procedure": "a procedure", "robot": "a robot"}


class Designators(Context):
    """Types of designators."""

    def entry(self, name: tree.Name, access: Access) -> Entry | None:
        """What a name means that is no type; the use is kept. None where it is unknown, which is told."""
        found = self.names.value(name.key)
        if found is None:
            near = self.announced.get(name.key)
            if near is not None:
                self.add("IRL201", name, name=name.name, near=near)
                return None
            found = port_entry(name.key)
        elif found.symbol is not None:
            self.references.append(Reference(name.span, found.symbol, access))
        return found

    def designated(self, node: tree.Designator, access: Access = "read") -> Typed:
        """Type of a designator; a function without parameters is called by its bare name."""
        entry = self.entry(node.base, access)
        if entry is None and node.base.key in BARE_FUNCTIONS and not node.selectors:
            return self.function_call(tree.FunctionCall(node.span, node.base, ()))
        if entry is None:
            self._indices(node.selectors)
            return NOTHING
        if entry.signature is not None or entry.kind in NOT_A_VALUE:
            return self._routine(entry, node)
        if entry.kind == "moving frame":
            self._indices(node.selectors)
            self.add("IRL291", node.base, name=node.base.name)
            return NOTHING
        type = self.part(entry.type, node) if node.selectors else entry.type
        if holds_files(type):
            self.add("IRL267", node, what="copied")
            return NOTHING
        return Typed(type, None if node.selectors else entry.value)

    def _routine(self, entry: Entry, node: tree.Designator) -> Typed:
        signature = entry.signature
        if signature is None or signature.result is None:
            self._indices(node.selectors)
            found = NOT_A_VALUE.get(entry.kind, "a procedure")
            self.add("IRL250", node.base, name=node.base.name, found=found, expected="a value")
            return NOTHING
        if signature.least:
            expected = count(signature.least, "value")
            self.add("IRL228", node, function=signature.name, expected=expected, found=0)
        return Typed(self.part(signature.result, node))

    def part(self, type: Type, node: tree.Designator) -> Type:
        """Type of the part of a value that the selectors of a designator lead to."""
        selectors, position = node.selectors, 0
        while position < len(selectors):
            selector = selectors[position]
            if type is UNKNOWN:
                self._indices(selectors[position:])
                return UNKNOWN
            if type is STRING and isinstance(selector, tree.Index) and position == len(selectors) - 1:
                return self._character(selector)
            if isinstance(selector, tree.Index):
                type = self._element(type, selector, node)
                position += 1
            else:
                type, used = self._field(type, selectors[position:])
                position += used
        return type

    def _indices(self, selectors: tuple[tree.Selector, ...]) -> None:
        """Look at indices behind something unknown."""
        for selector in selectors:
            if isinstance(selector, tree.Index):
                for index in selector.indices:
                    self.fitted(index, INT)

    def _field(self, type: Type, selectors: tuple[tree.Selector, ...]) -> tuple[Type, int]:
        fields: list[tree.Field] = []
        for selector in selectors:
            if not isinstance(selector, tree.Field):
                break
            fields.append(selector)
        if isinstance(type, Record):
            found = longest_field(type, [field.key for field in fields])
            if found is not None:
                return found
        if all(field.key for field in fields):
            name = ".".join(field.name for field in fields)
            near = near_matches(name, field_names(type)) if isinstance(type, Record) else ""
            self.add("IRL225", fields[0], type=type.name, name=name, near=near)
        return UNKNOWN, len(fields)

    def _character(self, selector: tree.Index) -> Type:
        """A character of a text, counted from 1."""
        self._indices((selector,))
        found = len(selector.indices)
        if found != 1:
            self.add("IRL223", selector, type=STRING.name, expected="1 index", found=found)
        return CHAR

    def _element(self, type: Type, selector: tree.Index, node: tree.Designator) -> Type:
        if not isinstance(type, Array):
            self._indices((selector,))
            self.mismatch(selector, "an ARRAY before [", type.name)
            return UNKNOWN
        if len(selector.indices) != len(type.ranges):
            self._indices((selector,))
            expected = count(len(type.ranges), "index", "indices")
            self.add("IRL223", selector, type=type.name, expected=expected, found=len(selector.indices))
            return type.element
        for expression, bounds in zip(selector.indices, type.ranges, strict=True):
            index = self.fitted(expression, INT)
            value, (low, high) = index.value, bounds
            if (
                isinstance(value, int)
                and index.type is INT
                and bounds != ANY_BOUNDS
                and not low <= value <= high
            ):
                self.add("IRL504", expression, index=value, name=node.base.name, low=low, high=high)
        return type.element

    # ---- variables that are set

    def set_target(self, node: tree.Designator, access: Access = "set") -> tuple[Type, Entry | None]:
        """Type of a variable, or part of one, that is set; for constants that is told with the names."""
        entry = self.entry(node.base, access)
        if entry is None:
            self._indices(node.selectors)
            return UNKNOWN, None
        if entry.signature is not None or entry.kind in NOT_A_VALUE:
            self._indices(node.selectors)
            return UNKNOWN, None
        if entry.kind == "system":
            kind = "a system variable that only the robot sets"
            self.add("IRL211", node.base, name=node.base.name, kind=kind)
        if entry.kind == "constant" and entry.symbol is not None and entry.symbol.kind == "import":
            self.add("IRL211", node.base, name=node.base.name, kind="a constant")
        type = self.part(entry.type, node)
        if type is CHAR and self._is_character(entry.type, node):
            self.mismatch(node, "a variable", "a character of a text")
        return type, entry

    def _is_character(self, type: Type, node: tree.Designator) -> bool:
        """Whether a designator of a CHAR means a character of a text."""
        if not node.selectors or not isinstance(node.selectors[-1], tree.Index):
            return False
        whole = replace(node, selectors=node.selectors[:-1])
        return self.trial(lambda: Typed(self.part(type, whole))).typed.type is STRING

    def variable_argument(self, node: tree.Argument, where: str, expected: Type | None) -> None:
        """An argument that the routine sets: only a variable will do, of the very same type."""
        inner = node
        while isinstance(inner, tree.Paren):
            inner = inner.value
        if not isinstance(inner, tree.Designator) or inner is not node:
            self.fitted(inner if isinstance(inner, tree.Designator) else node, UNKNOWN)
            self.add("IRL249", node, where=where, found=_what(inner))
            return
        entry = self.names.value(inner.base.key) or port_entry(inner.base.key)
        fixed = {
            "constant": "a constant",
            "moving frame": "a frame that moves",
            "input": "an input",
            "output": "an output",
            "followed": FOLLOWED,
            "procedure": "a procedure",
            "function": "a function",
        }
        if entry is None and inner.base.key in BARE_FUNCTIONS:
            self.add("IRL249", node, where=where, found="a function")
            return
        if entry is not None and entry.kind in fixed:
            self.designated(inner)
            self.add("IRL249", node, where=where, found=fixed[entry.kind], related=self.declared_here(entry))
            return
        type, entry = self.set_target(inner, "change")
        if entry is not None:
            entry.set(None, whole=False)
        self._same(node, type, expected)

    def _same(self, node: tree.Node, found: Type, expected: Type | None) -> None:
        if expected is not None and not same_type(found, expected):
            self.mismatch(node, f"a variable of {expected.name}", found.name)


def _what(node: tree.Argument) -> str:
    """What an expression is that is no variable."""
    if isinstance(node, tree.Designator):
        return "a value in parentheses"
    if isinstance(node, tree.IntLiteral | tree.RealLiteral):
        return "a number"
    if isinstance(node, tree.StringLiteral):
        return "a text"
    return "an expression"
