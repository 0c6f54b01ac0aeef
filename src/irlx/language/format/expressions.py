"""Layout of expressions, names and types."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from irlx.language import tree
from irlx.language.format.document import HARD, Doc, Fill, Group, Here, Indent, Line, separated
from irlx.language.format.trivia import Tokens

__all__ = ["ExpressionLayout"]

_T = TypeVar("_T")
_LEVELS = (
    {"OR"},
    {"EXOR"},
    {"AND"},
    {"=", "<>", "<", ">", "<=", ">="},
    {"+", "-"},
    {"*", "/", "DIV", "MOD"},
    {"@"},
)
_LEVEL_OF = {op: level for level, ops in enumerate(_LEVELS) for op in ops}


class ExpressionLayout:
    """Takes the tokens of expressions in the order of the text; the tree says what comes."""

    def __init__(self, tokens: Tokens) -> None:
        self.tokens = tokens

    def listed(self, items: Sequence[_T], layout: Callable[[_T], Doc], *, fill: bool) -> Doc:
        """Items with commas, aligned where they take several lines.

        With `fill` as many as fit stand on a line; else each has its own line, where not all fit or the
        text had the second on a new line.
        """
        docs: list[Doc] = []
        broken = False
        for index, item in enumerate(items):
            if index == 1:
                broken = self.tokens.on_new_line
            doc = layout(item)
            docs.append((doc, self.tokens.word("COMMA")) if index + 1 < len(items) else doc)
        if fill or len(docs) < 2:
            return Here(Fill(tuple(docs)))
        return Here(Group(separated(docs, Line()), broken))

    def names(self, names: Sequence[tree.Name]) -> Doc:
        """Names with commas."""
        return self.listed(names, self.name, fill=True)

    def name(self, name: tree.Name) -> Doc:
        """A name; that of a field may have dots."""
        doc = self.tokens.spelled()
        for _ in range(name.key.count(".")):
            doc = (doc, self.tokens.word("DOT"), self.tokens.spelled())
        return doc

    def expressions(self, items: Sequence[tree.Expression]) -> Doc:
        """Values with commas: numbers and names fill lines, else each has its own where not all fit."""
        plain = all(not isinstance(item, tree.Aggregate | tree.FunctionCall) for item in items)
        return self.listed(items, self.expression, fill=plain)

    def expression(self, node: tree.Expression | tree.Range) -> Doc:
        """Any expression, and a range of values."""
        match node:
            case tree.Designator():
                return self.designator(node)
            case tree.FunctionCall():
                return (self.name(node.name), self.bracketed(node.arguments))
            case tree.Aggregate():
                return self.bracketed(node.items)
            case tree.Paren():
                return self.bracketed((node.value,))
            case tree.Unary():
                return self._unary(node)
            case tree.Binary():
                return self._chain(node)
            case tree.Range():
                return self._range(node)
            case tree.BoolLiteral():
                return self.tokens.word("TRUE", "FALSE")
            case _:
                return self.tokens.spelled()

    def bracketed(self, items: Sequence[tree.Expression]) -> Doc:
        """Values in parentheses."""
        opening = self.tokens.word("LEFT_PAREN")
        inner = self.expressions(items) if items else ""
        return (opening, inner, self.tokens.word("RIGHT_PAREN"))

    def designator(self, node: tree.Designator) -> Doc:
        """A name with its selectors."""
        parts = [self.name(node.base)]
        for selector in node.selectors:
            if isinstance(selector, tree.Field):
                parts += [self.tokens.word("DOT"), self.tokens.spelled()]
            else:
                parts.append(self.tokens.word("LEFT_BRACKET"))
                parts.append(self.expressions(selector.indices))
                parts.append(self.tokens.word("RIGHT_BRACKET"))
        return tuple(parts)

    def _unary(self, node: tree.Unary) -> Doc:
        sign = self.tokens.word("PLUS", "MINUS", "NOT")
        blank = " " if node.op == "NOT" or isinstance(node.operand, tree.Unary) else ""
        return (sign, blank, self.expression(node.operand))

    def _chain(self, node: tree.Binary) -> Doc:
        """Operators of one level in a row are broken together, each line after the first with its own."""
        level = _LEVEL_OF[node.op]
        operands: list[tree.Expression] = []
        left: tree.Expression = node
        while isinstance(left, tree.Binary) and _LEVEL_OF[left.op] == level:
            operands.append(left.right)
            left = left.left
        parts: list[Doc] = [self.expression(left)]
        for operand in reversed(operands):
            parts += [Line(), self.tokens.word(self.tokens.kind), " ", self.expression(operand)]
        return Here(Group(tuple(parts)))

    def _range(self, node: tree.Range) -> Doc:
        lower = self.expression(node.lower)
        dots = self.tokens.word("RANGE")
        touching = isinstance(node.lower, tree.RealLiteral) or isinstance(node.upper, tree.RealLiteral)
        # A point beside the two dots would be read as something else.
        return (lower, " " if touching else "", dots, " " if touching else "", self.expression(node.upper))

    def type_form(self, node: tree.TypeForm) -> Doc:
        """A type where it is used or defined."""
        match node:
            case tree.ArrayType():
                head: list[Doc] = [self.tokens.word("ARRAY"), " ", self.tokens.word("LEFT_BRACKET")]
                head.append(self.listed(node.dimensions, self.expression, fill=True))
                head += [self.tokens.word("RIGHT_BRACKET"), " ", self.tokens.word("OF"), " "]
                return (*head, self.type_form(node.element))
            case tree.RecordType():
                return self._record(node)
            case tree.NamedType():
                return self.name(node.name)

    def _record(self, node: tree.RecordType) -> Doc:
        word = self.tokens.word("RECORD")
        lines: list[Doc] = []
        for group in node.groups:
            lines += self.before(first=not lines)
            kind = (self.type_form(group.type), self.tokens.word("COLON"), " ")
            lines += [HARD, kind, self.names(group.names), self.tokens.word("SEMICOLON")]
        inner, outer = self.before_end()
        return (word, Indent((*lines, *inner)), *outer, HARD, self.tokens.word("ENDRECORD"))

    def before(self, *, first: bool) -> list[Doc]:
        """Comments on lines of their own before what comes next, and the blank line that may stay.

        The `first` of a block has none before it.
        """
        parts: list[Doc] = []
        for after_blank, remark in self.tokens.leading():
            blank = after_blank and not (first and not parts)
            parts += [HARD, HARD, remark] if blank else [HARD, remark]
        if self.tokens.after_blank_line and not (first and not parts):
            parts.append(HARD)
        return parts

    def before_end(self) -> tuple[list[Doc], list[Doc]]:
        """Comments before a word that ends a block: those of the block, and those of the word.

        Of the word are those that the text does not indent further than the word.
        """
        inner: list[Doc] = []
        outer: list[Doc] = []
        column = self.tokens.column
        for after_blank, remark in self.tokens.leading():
            into = outer if outer or remark.column <= column else inner
            into += [HARD, HARD, remark] if after_blank else [HARD, remark]
        return inner, outer
