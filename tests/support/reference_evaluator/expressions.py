"""Expressions: walks the tree, left to right, with the type that is expected where one is."""

from __future__ import annotations

from fractions import Fraction

from irlx.language import tree
from reference_evaluator import functions, geometry
from reference_evaluator.functions import OutOfRange, int_value, real_value
from reference_evaluator.geometry import NoValueThere
from reference_evaluator.trouble import Trouble
from reference_evaluator.types import (
    BOOL,
    CHAR,
    INT,
    POSE,
    POSITION,
    REAL,
    STRING,
    Array,
    Place,
    Simple,
    Value,
    fitted,
    zeros,
)

NUMBERS, TEXTS = (INT, REAL), (CHAR, STRING)
OPTIONAL = {"joint": 1, "robtarget": 1}
"""Constructors that may leave out values from the end, and how many they need."""
LONGEST_TEXT = 1_000_000


class Expressions:
    """Evaluates expressions; `names` finds variables and types, `call` carries out functions."""

    def __init__(self, names, call):
        self.names, self.call = names, call

    def of_type(self, node, type):
        return fitted(self.value(node, type), type)

    def value(self, node, expected=None):
        return getattr(self, type(node).__name__)(node, expected)

    def IntLiteral(self, node, expected):  # noqa: N802
        return self.ranged(int_value, node.value, node)

    def RealLiteral(self, node, expected):  # noqa: N802
        return self.ranged(real_value, node.value, node)

    def BoolLiteral(self, node, expected):  # noqa: N802
        return Value(BOOL, node.value)

    def StringLiteral(self, node, expected):  # noqa: N802
        return Value(CHAR if expected == CHAR and len(node.value) == 1 else STRING, node.value)

    def Paren(self, node, expected):  # noqa: N802
        if isinstance(expected, Simple | None) or (
            len(expected.parts) != 1 and getattr(expected, "name", "") not in OPTIONAL
        ):
            return self.value(node.value, expected)
        if isinstance(node.value, tree.Aggregate | tree.Paren | tree.Designator | tree.FunctionCall):
            inner = self.value(node.value, expected.parts[0])
            return inner if inner.type == expected else self.constructed(expected, [inner], node)
        return self.constructed(expected, [self.value(node.value, expected.parts[0])], node)

    def Aggregate(self, node, expected):  # noqa: N802
        items = [self.value(item, part) for item, part in zip(node.items, expected.parts, strict=False)]
        return self.constructed(expected, items, node)

    def constructed(self, type, items, node):
        name = getattr(type, "name", "")
        assert len(items) == len(type.parts) or (name in OPTIONAL and len(items) >= 1), (type, items)
        data = [fitted(item, part).data for item, part in zip(items, type.parts, strict=False)]
        return Value(type, data + [zeros(part) for part in type.parts[len(items) :]])

    def Unary(self, node, expected):  # noqa: N802
        operand = self.value(node.operand, BOOL if node.op == "NOT" else None)
        if node.op == "NOT":
            return Value(BOOL, not operand.data)
        if node.op == "+":
            return operand
        if operand.type == INT:
            return self.ranged(int_value, -operand.data, node)
        return Value(operand.type, -operand.data)

    def Binary(self, node, expected):  # noqa: N802
        left = self.value(node.left, self.beside(node.op, node.left, node.right))
        if (node.op, left.type, left.data) in (("AND", BOOL, False), ("OR", BOOL, True)):
            return left
        right = self.value(node.right, self.beside(node.op, node.right, node.left))
        return self.combined(node, node.op, left, right)

    def beside(self, op, node, other):
        """The type of a list of values beside an operator."""
        while isinstance(node, tree.Paren):
            node = node.value
        if not isinstance(node, tree.Aggregate):
            return None
        return POSE if op == "@" and len(node.items) == 2 else POSITION

    def combined(self, node, op, left, right):
        if op in ("AND", "OR"):
            return right
        if op == "EXOR":
            return Value(BOOL, left.data != right.data)
        if op in ("=", "<>", "<", ">", "<=", ">="):
            return Value(BOOL, compared(op, left, right))
        if op in ("/", "DIV", "MOD") and right.type in NUMBERS and right.data == 0:
            raise Trouble("IRL502", node)
        if left.type in TEXTS and right.type in TEXTS:
            joined = left.data + right.data
            if len(joined) > LONGEST_TEXT:
                raise Trouble("IRL512", node)
            return Value(STRING, joined)
        if left.type in NUMBERS and right.type in NUMBERS:
            return self.calculated(node, op, left, right)
        return geometry.combined(op, left, right)

    def calculated(self, node, op, left, right):
        a, b = left.data, right.data
        if op in ("DIV", "MOD"):
            size = abs(a) // abs(b)
            quotient = size if (a < 0) == (b < 0) else -size
            return self.ranged(int_value, quotient if op == "DIV" else a - b * quotient, node)
        if REAL in (left.type, right.type):
            a, b = float(a), float(b)
        elif op == "/":
            return self.ranged(real_value, a / b, node)
        result = a / b if op == "/" else a + b if op == "+" else a - b if op == "-" else a * b
        return self.ranged(int_value if isinstance(result, int) else real_value, result, node)

    def ranged(self, make, number, node):
        try:
            return make(number)
        except OutOfRange:
            raise Trouble("IRL503", node) from None

    def Designator(self, node, expected):  # noqa: N802
        if self.names.is_function(node.base.key):
            return self.call(node.base, ())
        found = self.place(node)
        return found.read(node) if isinstance(found, Place) else found

    def place(self, node):
        """The variable that a designator names or the part of it; of a character in a text its value."""
        found = self.names.variable(node.base.key)
        selectors = list(node.selectors)
        while selectors:
            if isinstance(selectors[0], tree.Field):
                found, used = self.field(found, selectors)
                del selectors[:used]
            else:
                index = selectors.pop(0)
                if isinstance(found.type, Array):
                    found = found.part(self.element(found.type, index))
                else:
                    found = self.character(found, index, node)
        return found

    def field(self, found, selectors):
        """The longest declared field that the next selectors name, and how many of them it takes."""
        words = []
        for selector in selectors:
            if not isinstance(selector, tree.Field):
                break
            words.append(selector.key)
        keys = [key for key, _ in found.type.fields]
        for used in range(len(words), 0, -1):
            if ".".join(words[:used]) in keys:
                return found.part(keys.index(".".join(words[:used]))), used
        raise KeyError(words)

    def element(self, type, index):
        """Number of an element among all of an array, the last index counting fastest."""
        number = 0
        wanted = [self.value(node).data for node in index.indices]
        for node, at, (low, high) in zip(index.indices, wanted, type.bounds, strict=True):
            if not low <= at <= high:
                raise Trouble("IRL504", node)
            number = number * (high - low + 1) + at - low
        return number

    def character(self, found, index, node):
        text = found.read(node).data
        (at,) = [self.value(part).data for part in index.indices]
        if not 1 <= at <= len(text):
            raise Trouble("IRL504", index.indices[0])
        return Value(CHAR, text[at - 1])

    def FunctionCall(self, node, expected):  # noqa: N802
        key = node.name.key
        if self.names.is_function(key):
            return self.call(node.name, node.arguments)
        if key in ("abs", "inv", "distance"):
            return self.of_several_types(key, node)
        found = functions.FUNCTIONS.get(key) or geometry.FUNCTIONS.get(key)
        if found is None:
            type = self.names.type(key)
            items = [self.value(a, part) for a, part in zip(node.arguments, type.parts, strict=False)]
            return self.constructed(type, items, node)
        parameters, function = found
        return self.applied(
            function, [self.of_type(a, p) for a, p in zip(node.arguments, parameters, strict=True)], node
        )

    def of_several_types(self, key, node):
        arguments = [self.value(a) for a in node.arguments]
        if key == "inv":
            return geometry.inverse(arguments[0])
        if key == "distance":
            return geometry.distance(*(a.data[0] if a.type == POSE else a.data for a in arguments))
        (value,) = arguments
        return self.ranged(int_value if value.type == INT else real_value, abs(value.data), node)

    def applied(self, function, arguments, node):
        try:
            return function(*(a.data for a in arguments))
        except NoValueThere:
            raise Trouble("IRL506", node) from None
        except OutOfRange:
            raise Trouble("IRL503", node) from None


def compared(op, left, right):
    a, b = left.data, right.data
    if left.type in NUMBERS:
        a, b = Fraction(a), Fraction(b)
    return {"=": a == b, "<>": a != b, "<": a < b, ">": a > b, "<=": a <= b, ">=": a >= b}[op]
