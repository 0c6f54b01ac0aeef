"""Nodes of expressions."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from irlx.language.tree.nodes import Name, Node


@dataclass(frozen=True, slots=True)
class IntLiteral(Node):
    """A whole number; its value may lie outside the range of INT."""

    value: int


@dataclass(frozen=True, slots=True)
class RealLiteral(Node):
    """A number with a decimal point or an exponent."""

    value: float


@dataclass(frozen=True, slots=True)
class StringLiteral(Node):
    """A text; doubled quotes are already resolved in `value`."""

    value: str


@dataclass(frozen=True, slots=True)
class BoolLiteral(Node):
    """TRUE or FALSE."""

    value: bool


@dataclass(frozen=True, slots=True)
class Field(Node):
    """Selector of a record field; ``a1.max`` gives two of them, the longest declared field is meant."""

    name: str = field(compare=False)
    key: str


@dataclass(frozen=True, slots=True)
class Index(Node):
    """Selector of an array element, one expression for each dimension."""

    indices: tuple[Expression, ...]


Selector: TypeAlias = "Field | Index"


@dataclass(frozen=True, slots=True)
class Designator(Node):
    """A variable, constant or signal, or a part of it: base name and selectors from left to right.

    A bare name may also be a function called without arguments; the text alone does not tell.
    """

    base: Name
    selectors: tuple[Selector, ...]


@dataclass(frozen=True, slots=True)
class FunctionCall(Node):
    """A function or constructor applied to the arguments in its parentheses."""

    name: Name
    arguments: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Aggregate(Node):
    """Two or more values in parentheses, the value of a record, array or geometric type."""

    items: tuple[Expression, ...]


@dataclass(frozen=True, slots=True)
class Paren(Node):
    """One value in parentheses; a one-field aggregate where such a type is expected."""

    value: Expression


@dataclass(frozen=True, slots=True)
class Unary(Node):
    """Sign or negation; `op` is ``+``, ``-`` or ``NOT``."""

    op: str
    operand: Expression


@dataclass(frozen=True, slots=True)
class Binary(Node):
    """Two operands; `op` is a sign (``+``, ``<>``, ``@``) or a word in capitals (``DIV``, ``AND``)."""

    op: str
    left: Expression
    right: Expression


@dataclass(frozen=True, slots=True)
class Range(Node):
    """``lower..upper``, both included: bounds of an array dimension or a label of CASE."""

    lower: Expression
    upper: Expression


@dataclass(frozen=True, slots=True)
class FormattedValue(Node):
    """Argument of an output call with its layout, ``value:width`` or ``value:width:precision``."""

    value: Expression
    width: Expression
    precision: Expression | None


Expression: TypeAlias = (
    "IntLiteral | RealLiteral | StringLiteral | BoolLiteral | Designator | FunctionCall"
    " | Aggregate | Paren | Unary | Binary"
)
Argument: TypeAlias = "Expression | FormattedValue"
