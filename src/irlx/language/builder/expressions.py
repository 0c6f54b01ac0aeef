"""Reductions of expressions and names."""

from __future__ import annotations

from irlx.diagnostics.place import Span
from irlx.language import tree
from irlx.language.builder.children import Children, nodes_of, span_of, word_of
from irlx.language.token import Token

# Longer whole numbers are out of range whatever their value, and Python refuses to convert very long ones.
_LONGEST_INT = 30


class ExpressionBuilder:
    """Methods for the rules of expressions."""

    def name(self, children: Children) -> tree.Name:
        """Reduce NAME."""
        token: Token = children[0]
        text = str(token)
        return tree.Name(Span(token.start_pos, token.end_pos), text, text.casefold())

    def names(self, children: Children) -> tuple[tree.Name, ...]:
        """Reduce a list of names."""
        return nodes_of(children)

    def int_literal(self, children: Children) -> tree.IntLiteral:
        """Reduce INT."""
        digits = children[0].lstrip("0") or "0"
        value = int(digits) if len(digits) <= _LONGEST_INT else 10**_LONGEST_INT
        return tree.IntLiteral(span_of(children), value)

    def real_literal(self, children: Children) -> tree.RealLiteral:
        """Reduce REAL."""
        return tree.RealLiteral(span_of(children), float(children[0]))

    def string_literal(self, children: Children) -> tree.StringLiteral:
        """Reduce STRING; takes the quotes off."""
        text = str(children[0])
        quote = text[0]
        inner = text[1:-1] if len(text) > 1 and text.count(quote) % 2 == 0 else text[1:]
        return tree.StringLiteral(span_of(children), inner.replace(quote * 2, quote))

    def bool_literal(self, children: Children) -> tree.BoolLiteral:
        """Reduce TRUE or FALSE."""
        return tree.BoolLiteral(span_of(children), children[0].type == "TRUE")

    def designator(self, children: Children) -> tree.Designator:
        """Reduce a base name with its selectors."""
        return tree.Designator(span_of(children), children[0], tuple(children[1:]))

    def field(self, children: Children) -> tree.Field:
        """Reduce ``.name``."""
        name: tree.Name = children[1]
        return tree.Field(span_of(children), name.name, name.key)

    def index(self, children: Children) -> tree.Index:
        """Reduce ``[..]``."""
        return tree.Index(span_of(children), nodes_of(children))

    def function_call(self, children: Children) -> tree.FunctionCall:
        """Reduce a name applied to arguments."""
        return tree.FunctionCall(span_of(children), children[0], nodes_of(children[1:]))

    def paren(self, children: Children) -> tree.Paren:
        """Reduce one value in parentheses."""
        return tree.Paren(span_of(children), children[1])

    def aggregate(self, children: Children) -> tree.Aggregate:
        """Reduce several values in parentheses."""
        return tree.Aggregate(span_of(children), nodes_of(children))

    def unary(self, children: Children) -> tree.Unary:
        """Reduce a sign or NOT."""
        return tree.Unary(span_of(children), word_of(children[0]), children[1])

    def binary(self, children: Children) -> tree.Binary:
        """Reduce two operands."""
        return tree.Binary(span_of(children), word_of(children[1]), children[0], children[2])

    def range(self, children: Children) -> tree.Range:
        """Reduce ``lower..upper``."""
        return tree.Range(span_of(children), children[0], children[2])
