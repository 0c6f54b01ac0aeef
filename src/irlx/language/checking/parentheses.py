"""Values in parentheses: records and arrays by the type that is expected, or a value in its own right."""

from __future__ import annotations

from math import hypot

from irlx.diagnostics import SourceText
from irlx.language import tree
from irlx.language.checking.context import NOTHING, Context, Trial, Typed
from irlx.language.checking.decimal_commas import numbers_with_commas
from irlx.language.checking.names import Constant, Names
from irlx.language.ranges import UNIT_LENGTH
from irlx.language.types import (
    ORIENTATION,
    REAL,
    UNKNOWN,
    Array,
    Record,
    Type,
    is_number,
    same_type,
    values_of_joints,
)
from irlx.language.words import count

_NO_FIT = frozenset({"IRL222", "IRL223"})


class Parentheses(Context):
    """Types of values in parentheses."""

    def __init__(self, source: SourceText, names: Names) -> None:
        super().__init__(source, names)
        self._attempted: dict[tuple[int, tuple[str, ...]], Trial] = {}

    def in_parentheses(self, node: tree.Aggregate | tree.Paren, expected: Type | None) -> Typed:
        """Type of one or more values in parentheses where a type is expected, or None."""
        items = node.items if isinstance(node, tree.Aggregate) else (node.value,)
        if isinstance(node, tree.Paren):
            if expected is None:
                return self.typed(node.value)
            if _is_open(expected):
                return self._perhaps_one_part(node.value, expected)
            if not _one_part(expected):
                return self.fitted(node.value, expected)
        if expected is UNKNOWN:
            for item in items:
                self.fitted(item, UNKNOWN)
            return NOTHING
        if not isinstance(expected, Record | Array):
            for item in items:
                self.fitted(item, UNKNOWN)
            name = expected.name if expected is not None else "a single value"
            self.mismatch(node, name, f"{len(items)} values")
            return NOTHING
        return self._whole(node, expected) or self._assembled(node, items, expected)

    def _perhaps_one_part(self, node: tree.Expression, expected: Type) -> Typed:
        """`(v)` where the number of parts is not known: a value of the type, or its only part."""
        if isinstance(node, tree.Aggregate | tree.Paren):
            return self.in_parentheses(node, expected)
        found = self.typed(node)
        element = expected.element if isinstance(expected, Array) else REAL
        if not same_type(found.type, expected) and not (
            same_type(found.type, element) or is_number(found.type)
        ):
            self.mismatch(node, expected.name, found.type.name)
        return Typed(expected)

    def _whole(self, node: tree.Expression, expected: Type) -> Typed | None:
        """`(v)` where v is of the expected type of one part already."""
        while isinstance(node, tree.Paren):
            node = node.value
        if isinstance(node, tree.Aggregate) or not _one_part(expected):
            return None
        inner = node
        trial = self.trial(lambda: self.typed(inner))
        if trial.findings or not same_type(trial.typed.type, expected):
            return None
        return self.keep(trial)

    def _assembled(
        self, node: tree.Expression, items: tuple[tree.Expression, ...], expected: Record | Array
    ) -> Typed:
        wanted = _parts(expected)
        if wanted != len(items) and not _is_open(expected):
            for item in items:
                self.fitted(item, UNKNOWN)
            help = numbers_with_commas(items, (wanted,), self.source.text)
            needed = count(wanted, "value")
            self.add("IRL223", node, help=help, type=expected.name, expected=needed, found=len(items))
            return Typed(expected)
        if isinstance(expected, Record) and not expected.pattern:
            parts = [self.fitted(item, type) for item, (_, type) in zip(items, expected.fields, strict=True)]
            if len(parts) > 1:
                self.status(expected, items[1], parts[1])
        else:
            element = expected.element if isinstance(expected, Array) else REAL
            parts = [self.fitted(item, element) for item in items]
        value = tuple([part.value for part in parts])
        if expected is ORIENTATION:
            self.unit_length(node, value)
        return Typed(expected, value)

    def unit_length(self, node: tree.Node, quaternion: tuple[Constant | None, ...]) -> None:
        """A quaternion that the text tells must have length 1."""
        numbers = [part for part in quaternion if isinstance(part, int | float)]
        if len(numbers) == 4:
            length = hypot(*numbers)
            if abs(length - 1.0) > UNIT_LENGTH:
                self.add("IRL230", node, length=f"{length:.9g}")

    # ---- values that could be of several types

    def one_of(self, node: tree.Expression, candidates: tuple[Type, ...]) -> Typed:
        """Type of an expression that must be of exactly one of several types."""
        if not isinstance(node, tree.Aggregate):
            found = self.typed(node)
            if not any(same_type(found.type, type) for type in candidates):
                self.mismatch(node, " or ".join(type.name for type in candidates), found.type.name)
                return NOTHING
            return found
        # Attempts inside attempts would take for ever: what is found once holds in all of them.
        key = id(node), tuple([type.name for type in candidates])
        known = self._attempted.get(key)
        if known is None:
            known = self._attempted[key] = self.trial(lambda: self._one_of_values(node, candidates))
        return self.keep(known)

    def _one_of_values(self, node: tree.Aggregate, candidates: tuple[Type, ...]) -> Typed:
        likely = [type for type in candidates if _takes(type, len(node.items))]
        closed = [type for type in likely if not _is_open(type)]
        trials = [self._attempt(node, type) for type in closed]
        fitting = [trial for trial in trials if _fits(trial)]
        if not fitting:
            # A joint type takes any number of values while the robot is not known, so it comes last.
            fitting = [
                t for t in (self._attempt(node, type) for type in likely if _is_open(type)) if _fits(t)
            ]
        if len(fitting) > 1:
            self.keep(fitting[0])
            self.add("IRL229", node, candidates=" or ".join(trial.typed.type.name for trial in fitting))
            return NOTHING
        if fitting or (len(trials) == 1 and len(trials[0].findings) < len(node.items)):
            # Where some values fit the one type with that number, it is meant: what is wrong is inside.
            return self.keep(fitting[0] if fitting else trials[0])
        for item in node.items:
            self.fitted(item, UNKNOWN)
        expected = " or ".join(type.name for type in candidates)
        fixed = [_parts(type) for type in candidates if not _is_open(type)]
        help = numbers_with_commas(node.items, fixed, self.source.text) or values_of_joints(candidates)
        self.mismatch(node, expected, count(len(node.items), "value"), help)
        return NOTHING

    def _attempt(self, node: tree.Expression, type: Type) -> Trial:
        return self.trial(lambda: self.fitted(node, type))


def _fits(trial: Trial) -> bool:
    """Whether a type fits; what is wrong for another reason is wrong inside of what fits."""
    return not any(finding.code in _NO_FIT for finding in trial.findings)


def _takes(type: Type, values: int) -> bool:
    if isinstance(type, Record):
        return bool(type.pattern) or len(type.fields) == values
    return isinstance(type, Array) and (_is_open(type) or type.size == values)


def _parts(type: Type) -> int:
    """Number of values that make one of a type."""
    if isinstance(type, Record):
        return len(type.fields)
    return type.size if isinstance(type, Array) else 1


def _is_open(type: Type) -> bool:
    """Whether only the robot or a run tells the number of parts."""
    if isinstance(type, Record):
        return bool(type.pattern)
    return isinstance(type, Array) and type.size == 0


def _one_part(type: Type | None) -> bool:
    if isinstance(type, Record):
        return len(type.fields) == 1
    return isinstance(type, Array) and type.size == 1
