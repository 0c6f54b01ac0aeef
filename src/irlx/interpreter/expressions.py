"""Expressions: program tree -> functions that give values."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from irlx.diagnostics import SourceText
from irlx.interpreter.asking import Asking
from irlx.interpreter.calls import Calls
from irlx.interpreter.channel_access import end_of_file
from irlx.interpreter.code import Frame, Step
from irlx.interpreter.compiled import Compiled, Run, constant, failing, first_failing, folded
from irlx.interpreter.context import Context
from irlx.interpreter.conversion import (
    Where,
    assemble,
    fit,
    part_type,
    parts_needed,
    whole_number,
)
from irlx.interpreter.designators import Designators
from irlx.interpreter.errors import InterpreterError, fail
from irlx.interpreter.functions import Function
from irlx.interpreter.operators import binary, unary
from irlx.interpreter.rotations import FUNCTIONS
from irlx.interpreter.scope import Routine, Scope
from irlx.interpreter.types import BOOL, INT, ORIENTATION, REAL, STRING, Array, Record, Type, values_of_joints
from irlx.interpreter.values import Value, has_arrays
from irlx.language import tree
from irlx.language.builtins import ACTUAL_VARIABLES, ASKING_FUNCTIONS, BARE_FUNCTIONS
from irlx.language.checking.operators import aggregate_type, values_in_parentheses
from irlx.language.obstacles import own_nodes
from irlx.language.ranges import INT_LIMIT
from irlx.language.words import count

_LITERALS = (tree.IntLiteral, tree.RealLiteral, tree.BoolLiteral, tree.StringLiteral)

Parts = Sequence[tuple[tree.Node, Callable[[], Compiled]]]


class Expressions:
    """Compiles expressions of one body, or of a declaration, where nothing can be called or asked.

    `expected` is the type that the place of an expression asks for; aggregates take their type from it.
    What is wrong with a part is told when the program gets there, by an expression that fails.

    Calls and questions are steps of their own before that of the statement: what an expression evaluates
    before them is kept in slots, so that nothing happens twice and all in the order of the text.
    """

    def __init__(self, context: Context) -> None:
        self.context = context
        self.designators = Designators(self)
        self._asking = Asking(self)
        self._calls = Calls(self)
        self._suspends: dict[int, bool] = {}
        self._own_types: dict[int, Type | None] = {}
        self._chosen: dict[tuple[int, tuple[str, ...]], list[Type]] = {}

    @property
    def source(self) -> SourceText:
        """Text that the expressions come from."""
        return self.context.source

    @property
    def scope(self) -> Scope:
        """What names mean."""
        return self.context.scope

    def where(self, node: tree.Node) -> Where:
        """Place of a node for messages."""
        return Where(self.source, node.span)

    # ---- values

    def value(self, node: tree.Argument, expected: Type | None = None) -> Compiled:
        """An expression, fitted to the expected type where one is given."""
        try:
            if isinstance(node, tree.Aggregate | tree.Paren):
                return self._in_parentheses(node, expected)
            found = self._plain(node)
            return found if expected is None else fit(found, expected, self.where(node))
        except InterpreterError as error:
            return failing(error)

    def number(self, node: tree.Expression) -> Run:
        """An expression that must be a number."""
        return self.value(node, REAL).run

    def whole(self, node: tree.Expression) -> int:
        """Present value of an expression that must be a whole number. Raises InterpreterError."""
        value: int = self.value(node, INT).run([])
        return value

    def operands(self, parts: Parts) -> list[Compiled]:
        """Several expressions, evaluated in their order although some call or ask on the way."""
        last = next((at for at in range(len(parts) - 1, 0, -1) if self.suspends(parts[at][0])), 0)
        return [
            self.kept(node, compile()) if at < last else compile() for at, (node, compile) in enumerate(parts)
        ]

    def kept(self, node: tree.Node, found: Compiled) -> Compiled:
        """The value that an expression has here, also after what follows has changed something."""
        assembler = self.context.assembler
        if found.constant or assembler is None:
            return found
        slot, run = assembler.slot(), found.run

        def make(following: int) -> Step:
            def step(frame: Frame) -> int:
                frame[slot] = run(frame)
                return following

            return step

        assembler.add(node, make)
        return Compiled(found.type, lambda frame: frame[slot], found.error)

    def suspends(self, root: tree.Node) -> bool:
        """Whether an expression calls a routine of the program, or asks the machine."""
        if isinstance(root, _LITERALS):
            return False
        if isinstance(root, tree.Designator) and not root.selectors:
            return self._is_step(root)
        known = self._suspends.get(id(root))
        if known is None:
            known = self._suspends[id(root)] = any(map(self._is_step, own_nodes(root)))
        return known

    def _is_step(self, node: tree.Node) -> bool:
        if isinstance(node, tree.Designator):
            signal = self.designators.signal(node.base)
            reads = signal is not None and signal.is_input
            key = node.base.key
            bare = key in BARE_FUNCTIONS and self.scope.found(key) is None
            return reads or bare or key in ACTUAL_VARIABLES or self.is_routine(node)
        asks = isinstance(node, tree.FunctionCall) and (
            node.name.key in ASKING_FUNCTIONS or node.name.key == "eof"
        )
        return asks or self.is_routine(node)

    def is_routine(self, node: tree.Node) -> bool:
        """Whether an expression is the call of a routine of the program."""
        if isinstance(node, tree.Designator):
            return isinstance(self.scope.found(node.base.key), Routine)
        return isinstance(node, tree.FunctionCall) and isinstance(self.scope.found(node.name.key), Routine)

    # ---- expressions without an expected type

    def _plain(self, node: tree.Argument) -> Compiled:
        match node:
            case tree.IntLiteral():
                return constant(INT, whole_number(node.value, f"the number {node.value}", self.where(node)))
            case tree.RealLiteral():
                return constant(REAL, node.value)
            case tree.BoolLiteral():
                return constant(BOOL, node.value)
            case tree.StringLiteral():
                return constant(STRING, node.value, node.value)
            case tree.Designator():
                return self._designated(node)
            case tree.FunctionCall():
                return self._call(node.name, node.arguments, node)
            case tree.Unary(op="-", operand=tree.IntLiteral(value=value)) if value == INT_LIMIT:
                return constant(INT, -INT_LIMIT)
            case tree.Unary():
                operand = self.value(node.operand)
                return operand if operand.type is None else unary(node.op, operand, self.where(node))
            case tree.Binary():
                return self._logical(node) if node.op in ("AND", "OR") else self._binary(node)
            case _:
                raise fail("IRL590", self.source, node.span, what="this expression")

    def _designated(self, node: tree.Designator) -> Compiled:
        key = node.base.key
        if key in ACTUAL_VARIABLES:
            return self._asking.actual(node)
        signal = self.designators.signal(node.base)
        if signal is not None and signal.is_input and not node.selectors:
            return self._asking.input(node, signal)
        found = self.scope.found(key)
        if not node.selectors and (
            isinstance(found, Routine) or (found is None and (key in FUNCTIONS or key in BARE_FUNCTIONS))
        ):
            return self._call(node.base, (), node)
        return self.designators.read(node)

    def _binary(self, node: tree.Binary) -> Compiled:
        first: list[Compiled] = []
        values = values_in_parentheses(node.left)
        expected = None
        if values and not values_in_parentheses(node.right):
            other = self._own_type(node.right)
            if other is None:
                # What is wrong on the right keeps the left from being anything.
                return self.value(node.right)
            expected = aggregate_type(node.op, other, values, on_left=True)

        def left_side() -> Compiled:
            first.append(self.value(node.left, expected))
            return first[0]

        def right_side() -> Compiled:
            values, known = values_in_parentheses(node.right), first[0].type
            if not values or known is None:
                return self.value(node.right)
            return self.value(node.right, aggregate_type(node.op, known, values, on_left=False))

        left, right = self.operands([(node.left, left_side), (node.right, right_side)])
        return first_failing((left, right)) or binary(node.op, left, right, self.where(node))

    def _own_type(self, node: tree.Expression) -> Type | None:
        """Type of an expression by itself; tried once, since attempts inside attempts would take for ever."""
        if id(node) not in self._own_types:
            self._own_types[id(node)] = self._tried(lambda: self.value(node)).type
        return self._own_types[id(node)]

    def _tried(self, compile: Callable[[], Compiled]) -> Compiled:
        """What an attempt gives, its steps forgotten."""
        mark = self.context.mark()
        found = compile()
        self.context.undo(mark)
        return found

    def _logical(self, node: tree.Binary) -> Compiled:
        """AND and OR: the right side counts only where the left one does not tell."""
        decided = node.op == "OR"
        left = self._bool(node.left)
        if left.type is None:
            return left
        if not self.suspends(node.right):
            a, b = left.run, self._bool(node.right).run
            if decided:
                return Compiled(BOOL, lambda frame: a(frame) or b(frame))
            return Compiled(BOOL, lambda frame: a(frame) and b(frame))
        return self._calls.in_need(node, left, decided, lambda: self._bool(node.right))

    def _bool(self, node: tree.Expression) -> Compiled:
        return self.value(node, BOOL)

    # ---- parentheses

    def _in_parentheses(self, node: tree.Aggregate | tree.Paren, expected: Type | None) -> Compiled:
        items = node.items if isinstance(node, tree.Aggregate) else (node.value,)
        if isinstance(node, tree.Paren) and not _one_part(expected):
            return self.value(node.value, expected)
        if not isinstance(expected, Record | Array):
            name = expected.name if expected is not None else "a single value"
            raise fail("IRL222", self.source, node.span, expected=name, found=f"{len(items)} values")
        whole = self._whole_in_parentheses(node, expected)
        return whole or self.assembled(expected, items, node)

    def _whole_in_parentheses(self, node: tree.Expression, expected: Type) -> Compiled | None:
        """What stands in parentheses where it is of the expected type already, like `(v)`."""
        while isinstance(node, tree.Paren):
            node = node.value
        if isinstance(node, tree.Aggregate):
            return None
        return self.value(node) if self._own_type(node) == expected else None

    def assembled(
        self,
        type: Record | Array,
        items: Sequence[tree.Expression],
        node: tree.Node,
        rest: Sequence[Value] = (),
    ) -> Compiled:
        """Structured value of parts, with `rest` for those that are left out at its end."""
        wanted = [(item, partial(self.value, item, part_type(type, at))) for at, item in enumerate(items)]
        parts, where, needed = self.operands(wanted), self.where(node), parts_needed(type)
        if not needed - len(rest) <= len(items) <= needed:
            data = {"type": type.name, "expected": count(needed, "value"), "found": len(items)}
            wrong = fail("IRL223", self.source, node.span, **data)
            return first_failing(parts) or failing(wrong, parts)
        missing = tuple(rest[len(rest) - (needed - len(items)) :]) if needed > len(items) else ()
        runs = tuple(part.run for part in parts)

        def run(frame: Frame) -> Value:
            return assemble(type, [*(part(frame) for part in runs), *missing], where)

        # Arrays may change in place: each time a new one.
        plain = Compiled(type, run) if has_arrays(type) else folded(type, run, *parts)
        return first_failing(parts) or plain

    # ---- functions

    def _call(self, name: tree.Name, arguments: tuple[tree.Expression, ...], node: tree.Node) -> Compiled:
        routine = self.scope.found(name.key)
        if isinstance(routine, Routine):
            return self._calls.function(routine, arguments, node)
        if name.key in ASKING_FUNCTIONS:
            return self._asking.call(name, arguments, node)
        if name.key == "eof":
            return end_of_file(self, arguments, node)
        function = FUNCTIONS.get(name.key)
        if function is not None:
            return self._built_in(function, arguments, node)
        type = self.scope.type(name.key)
        if isinstance(type, Record | Array):
            rest = self.context.rest.get(type.name, ()) if isinstance(type, Record) else ()
            return self.assembled(type, arguments, node, rest)
        raise fail("IRL590", self.source, name.span, what=f"the function {name.name}")

    def arguments(
        self,
        name: str,
        types: Sequence[Type | tuple[Type, ...]],
        given: Sequence[tree.Expression],
        node: tree.Node,
    ) -> list[Compiled]:
        """Arguments of a function of this name, one for each type. Raises InterpreterError, IRL228."""
        if len(given) != len(types):
            data = {"function": name, "expected": count(len(types), "value"), "found": len(given)}
            raise fail("IRL228", self.source, node.span, **data)
        wanted = zip(given, types, strict=True)
        return self.operands([(argument, partial(self.fitting, argument, type)) for argument, type in wanted])

    def fitting(self, node: tree.Expression, type: Type | tuple[Type, ...]) -> Compiled:
        """An expression of a type, or of one of several."""
        return self.one_of(node, type) if isinstance(type, tuple) else self.value(node, type)

    def _built_in(self, function: Function, given: Sequence[tree.Expression], node: tree.Node) -> Compiled:
        if function.name == "ORIQUAT" and len(given) == len(function.parameters):
            # The general path for orientations: it refuses what is no unit quaternion.
            return self.assembled(ORIENTATION, given, node)
        parts = self.arguments(function.name, function.parameters, given, node)
        wrong = first_failing(parts)
        if wrong is not None:
            return wrong
        result = function.result or parts[0].type
        if result is None:
            raise TypeError("arguments that fit have a type")
        return folded(result, self._calls.built_in(function, parts, result, node), *parts)

    # ---- values that could be of several types

    def one_of(self, node: tree.Expression, candidates: tuple[Type, ...]) -> Compiled:
        """An expression that must be of exactly one of several types, like a target of MOVE."""
        expected = " or ".join(type.name for type in candidates)
        if not isinstance(node, tree.Aggregate):
            found = self.value(node)
            if found.type is None or found.type in candidates:
                return found
            data = {"expected": expected, "found": found.type.name}
            return failing(fail("IRL222", self.source, node.span, **data), (found,))
        alike = [type for type in candidates if parts_needed(type) == len(node.items)]
        fitting = alike if len(alike) == 1 else self._fitting(node, alike)
        if len(fitting) == 1:
            return self.value(node, fitting[0])
        if fitting:
            names = " or ".join(type.name for type in fitting)
            return failing(fail("IRL229", self.source, node.span, candidates=names))
        data = {"expected": expected, "found": count(len(node.items), "value")}
        return failing(fail("IRL222", self.source, node.span, help=values_of_joints(candidates), **data))

    def _fitting(self, node: tree.Aggregate, alike: Sequence[Type]) -> list[Type]:
        """Types that values in parentheses fit; one alone where they fit it and are wrong inside."""
        key = id(node), tuple(type.name for type in alike)
        if key not in self._chosen:
            fitting: list[Type] = []
            for type in alike:
                error = self._tried(partial(self.value, node, type)).error
                if error is None:
                    fitting.append(type)
                elif error.reason.code not in ("IRL222", "IRL223"):
                    fitting = [type]
                    break
            self._chosen[key] = fitting
        return self._chosen[key]


def _one_part(type: Type | None) -> bool:
    if isinstance(type, Record):
        return len(type.fields) == 1
    return isinstance(type, Array) and type.size == 1
