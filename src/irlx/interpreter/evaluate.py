"""Values of expressions."""

from __future__ import annotations

from collections.abc import Mapping

from irlx.blocks import AskPostureOf
from irlx.diagnostics import SourceText
from irlx.diagnostics.diagnostic import near_matches
from irlx.interpreter.conversion import Where, assemble, count, finite, fit, part_type, whole_number
from irlx.interpreter.errors import InterpreterError, fail
from irlx.interpreter.functions import FUNCTIONS, Function
from irlx.interpreter.operators import binary, unary
from irlx.interpreter.scope import Scope, Variable
from irlx.interpreter.system_names import system_name
from irlx.interpreter.targets import origin_of, pose_target
from irlx.interpreter.types import INT, ORIENTATION, POSE, POSITION, REAL, Array, Record, Type
from irlx.interpreter.unanswered import Unanswered
from irlx.interpreter.values import ArrayValue, RecordValue, Value, is_of_type, is_set, type_name, unset_part
from irlx.language import tree

POSTURE = "posture"
"""The function that asks the machine, casefolded."""


class Evaluator:
    """Evaluates expressions of one program in its scope.

    `expected` is the type that the place of an expression asks for; aggregates take their type from
    it. All methods raise InterpreterError with the span of the part that is wrong, and Unanswered for what
    only the machine can tell and `answers` does not; where these are None, there is no machine to ask.
    """

    def __init__(
        self, source: SourceText, scope: Scope, answers: Mapping[AskPostureOf, Value] | None = None
    ) -> None:
        self.source = source
        self.scope = scope
        self._answers = answers

    def where(self, node: tree.Node) -> Where:
        """Place of a node for messages."""
        return Where(self.source, node.span)

    def value(self, node: tree.Argument, expected: Type | None = None) -> Value:
        """Value of an expression, fitted to the expected type where one is given."""
        if isinstance(node, tree.Aggregate | tree.Paren):
            return self._in_parentheses(node, expected)
        found = self._plain(node)
        return found if expected is None else fit(found, expected, self.where(node))

    def number(self, node: tree.Expression) -> float:
        """Value of an expression that must be a number."""
        value = self.value(node, REAL)
        if not isinstance(value, float):
            raise TypeError("a fitted REAL is a float")
        return value

    def whole(self, node: tree.Expression) -> int:
        """Value of an expression that must be a whole number."""
        value = self.value(node, INT)
        if not isinstance(value, int):
            raise TypeError("a fitted INT is an int")
        return value

    # ---- expressions without an expected type

    def _plain(self, node: tree.Argument) -> Value:
        match node:
            case tree.IntLiteral():
                return whole_number(node.value, f"the number {node.value}", self.where(node))
            case tree.RealLiteral() | tree.BoolLiteral() | tree.StringLiteral():
                return node.value
            case tree.Designator():
                return self._designated(node)
            case tree.FunctionCall():
                return self._call(node.name, node.arguments, node)
            case tree.Unary():
                return unary(node.op, self.value(node.operand), self.where(node))
            case tree.Binary():
                return self._binary(node)
            case _:
                raise fail("IRL590", self.source, node.span, what="this expression")

    def _binary(self, node: tree.Binary) -> Value:
        left = self.value(node.left)
        if node.op in ("AND", "OR"):
            if not isinstance(left, bool):
                raise fail("IRL222", self.source, node.left.span, expected="BOOL", found=type_name(left))
            if left is (node.op == "OR"):
                return left
            right = self.value(node.right)
            if not isinstance(right, bool):
                raise fail("IRL222", self.source, node.right.span, expected="BOOL", found=type_name(right))
            return right
        return binary(node.op, left, self.value(node.right), self.where(node))

    def _in_parentheses(self, node: tree.Aggregate | tree.Paren, expected: Type | None) -> Value:
        items = node.items if isinstance(node, tree.Aggregate) else (node.value,)
        if isinstance(node, tree.Paren) and not _one_part(expected):
            return self.value(node.value, expected)
        if not isinstance(expected, Record | Array):
            name = expected.name if expected is not None else "a single value"
            raise fail("IRL222", self.source, node.span, expected=name, found=f"{len(items)} values")
        whole = self._whole_in_parentheses(node, expected)
        if whole is not None:
            return whole
        parts = [self.value(item, part_type(expected, index)) for index, item in enumerate(items)]
        return assemble(expected, parts, self.where(node))

    def _whole_in_parentheses(self, node: tree.Expression, expected: Type) -> Value | None:
        """Value of what stands in parentheses where it is of the expected type already, like `(v)`."""
        while isinstance(node, tree.Paren):
            node = node.value
        if isinstance(node, tree.Aggregate):
            return None
        value = self._plain(node)
        return value if is_of_type(value, expected) else None

    # ---- functions

    def _call(self, name: tree.Name, arguments: tuple[tree.Expression, ...], node: tree.Node) -> Value:
        if name.key == POSTURE:
            return self._posture(name, arguments, node)
        function = FUNCTIONS.get(name.key)
        if function is None:
            raise fail("IRL590", self.source, name.span, what=f"the function {name.name}")
        if len(arguments) != len(function.parameters):
            expected = count(len(function.parameters), "value")
            data = {"function": function.name, "expected": expected, "found": len(arguments)}
            raise fail("IRL228", self.source, node.span, **data)
        pairs = zip(arguments, function.parameters, strict=True)
        values = [
            self.one_of(argument, type) if isinstance(type, tuple) else self.value(argument, type)
            for argument, type in pairs
        ]
        return self._apply(function, values, node)

    def _posture(self, name: tree.Name, arguments: tuple[tree.Expression, ...], node: tree.Node) -> Value:
        missing = missing_in_posture(len(arguments), in_declaration=self._answers is None)
        if missing or self._answers is None:
            raise fail("IRL590", self.source, name.span, what=missing)
        if len(arguments) != 1:
            data = {"function": "POSTURE", "expected": count(1, "value"), "found": len(arguments)}
            raise fail("IRL228", self.source, node.span, **data)
        value = self.one_of(arguments[0], (POSE, POSITION))
        if not isinstance(value, RecordValue):
            raise TypeError("poses are records")
        target = pose_target(value)
        question = AskPostureOf(origin_of(self.source, node), target.position, target.orientation)
        if question not in self._answers:
            raise Unanswered(question)
        return self._answers[question]

    def _apply(self, function: Function, values: list[Value], node: tree.Node) -> Value:
        where = self.where(node)
        if function.name == "ORIQUAT":
            # The general path for orientations: it refuses what is no unit quaternion.
            return assemble(ORIENTATION, values, where)
        try:
            result = function.apply(*values)
        except (ValueError, OverflowError, ZeroDivisionError):
            shown = ", ".join(
                f"{value:g}" if isinstance(value, float) else type_name(value) for value in values
            )
            raise fail("IRL506", self.source, node.span, function=function.name, value=shown) from None
        if isinstance(result, int) and not isinstance(result, bool):
            return whole_number(result, "the result", where)
        return finite(result, where)

    # ---- designators

    def variable(self, name: tree.Name) -> Variable:
        """The variable of a name. Raises InterpreterError: IRL201, with near matches; IRL590 for what the
        language has and this version does not execute."""
        found = self.scope.variables.get(name.key)
        if found is not None:
            return found
        what = system_name(name)
        if what:
            raise fail("IRL590", self.source, name.span, what=what)
        near = "; it is declared further down" if name.key in self.scope.announced else ""
        if name.key in self.scope.imported:
            near = "; it comes from a data list and is a variable, of which constants know nothing"
        if not near:
            near = near_matches(name.name, [variable.name for variable in self.scope.variables.values()])
        raise fail("IRL201", self.source, name.span, name=name.name, near=near)

    def _designated(self, node: tree.Designator) -> Value:
        if not node.selectors and node.base.key not in self.scope.variables and node.base.key in FUNCTIONS:
            return self._call(node.base, (), node)
        value: Value = self.variable(node.base).value
        for step in self.steps(node):
            value = _part(value, step)
        if not is_set(value):
            name = self.source.text[node.span.start : node.span.end]
            raise fail("IRL501", self.source, node.span, name=name + unset_part(value))
        return value

    def steps(self, node: tree.Designator) -> list[int]:
        """Positions to descend by from the variable to the part that a designator names.

        A dotted field is taken as long as it is declared: of `a1` and `a1.max`, `v.a1.max` is the latter.
        """
        type: Type = self.variable(node.base).type
        steps: list[int] = []
        selectors = list(node.selectors)
        while selectors:
            selector = selectors[0]
            if isinstance(selector, tree.Index):
                position, type = self._element(type, selector, node)
                selectors = selectors[1:]
            else:
                position, type, used = self._field(type, selectors, node)
                selectors = selectors[used:]
            steps.append(position)
        return steps

    def _field(
        self, type: Type, selectors: list[tree.Selector], node: tree.Designator
    ) -> tuple[int, Type, int]:
        fields: list[tree.Field] = []
        for selector in selectors:
            if not isinstance(selector, tree.Field):
                break
            fields.append(selector)
        index = type.index if isinstance(type, Record) else {}
        for used in range(len(fields), 0, -1):
            position = index.get(".".join(field.key for field in fields[:used]))
            if position is not None and isinstance(type, Record):
                return position, type.fields[position][1], used
        known = [name for name, _ in type.fields] if isinstance(type, Record) else []
        name = ".".join(field.name for field in fields)
        data = {"type": type.name, "name": name, "near": near_matches(name, known)}
        raise fail("IRL225", self.source, selectors[0].span, **data)

    def _element(self, type: Type, selector: tree.Index, node: tree.Designator) -> tuple[int, Type]:
        if not isinstance(type, Array):
            raise fail("IRL222", self.source, selector.span, expected="an ARRAY before [", found=type.name)
        if len(selector.indices) != len(type.ranges):
            expected = count(len(type.ranges), "index", "indices")
            data = {"type": type.name, "expected": expected, "found": len(selector.indices)}
            raise fail("IRL223", self.source, selector.span, **data)
        position = 0
        for expression, (low, high) in zip(selector.indices, type.ranges, strict=True):
            index = self.whole(expression)
            if not low <= index <= high:
                data = {"index": index, "name": node.base.name, "low": low, "high": high}
                raise fail("IRL504", self.source, expression.span, **data)
            position = position * (high - low + 1) + index - low
        return position, type.element

    # ---- values that could be of several types

    def one_of(self, node: tree.Expression, candidates: tuple[Type, ...]) -> Value:
        """Value of an expression that must be of exactly one of several types, like a target of MOVE."""
        if not isinstance(node, tree.Aggregate):
            value = self.value(node)
            if any(is_of_type(value, type) for type in candidates):
                return value
            expected = " or ".join(type.name for type in candidates)
            raise fail("IRL222", self.source, node.span, expected=expected, found=type_name(value))
        fitting: list[Value] = []
        for type in candidates:
            try:
                fitting.append(self.value(node, type))
            except InterpreterError as error:
                # Another code means that the aggregate fits and is wrong inside: that is the message to give.
                if error.reason.code not in ("IRL222", "IRL223"):
                    raise
        if len(fitting) == 1:
            return fitting[0]
        names = [type_name(value) for value in fitting]
        if fitting:
            raise fail("IRL229", self.source, node.span, candidates=" or ".join(names))
        expected = " or ".join(type.name for type in candidates)
        raise fail("IRL222", self.source, node.span, expected=expected, found=count(len(node.items), "value"))


def missing_in_posture(arguments: int, *, in_declaration: bool) -> str:
    """What a POSTURE with so many arguments asks for that is not executed, or ''."""
    if arguments == 2:
        return "the function POSTURE with an obstacle"
    return "the function POSTURE in a declaration" if in_declaration else ""


def _one_part(type: Type | None) -> bool:
    if isinstance(type, Record):
        return len(type.fields) == 1
    return isinstance(type, Array) and type.size == 1


def _part(value: Value, position: int) -> Value:
    if not isinstance(value, RecordValue | ArrayValue):
        raise TypeError("only structures have parts")
    return value.values[position]


def replaced(value: Value, steps: list[int], new: Value) -> Value:
    """Copy of a structured value with the part at `steps` replaced."""
    if not steps:
        return new
    if not isinstance(value, RecordValue | ArrayValue):
        raise TypeError("only structures have parts")
    parts = list(value.values)
    parts[steps[0]] = replaced(parts[steps[0]], steps[1:], new)
    if isinstance(value, RecordValue):
        return RecordValue(value.type, tuple(parts))
    return ArrayValue(value.type, tuple(parts))
