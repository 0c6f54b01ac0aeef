"""Layout of statements other than motion."""

from __future__ import annotations

from collections.abc import Sequence

from irlx.language import tree
from irlx.language.format.alignment import Alignment
from irlx.language.format.document import HARD, Doc, Indent
from irlx.language.format.motion import MotionLayout

__all__ = ["StatementLayout"]


class StatementLayout(MotionLayout):
    """One statement a line; blocks indented."""

    def block(self, statements: Sequence[tree.Statement]) -> Doc:
        """The statements of a block and the comments before the word that ends it, each after a line end."""
        inner, outer = self._block(statements)
        return (inner, *outer)

    def _block(self, statements: Sequence[tree.Statement]) -> tuple[Doc, list[Doc]]:
        """A block, and the comments that belong to the word after it."""
        lines: list[Doc] = []
        run = Alignment()
        for statement in statements:
            lines += self.before(first=not lines)
            lines += [HARD, self._aligned(statement, run)]
            if not isinstance(statement, tree.Label):
                lines.append(self.tokens.word("SEMICOLON"))
        inner, outer = self.before_end()
        run.close()
        return Indent((*lines, *inner)), outer

    def _aligned(self, statement: tree.Statement, run: Alignment) -> Doc:
        """A statement; assignments whose signs the text has aligned stay so."""
        if not isinstance(statement, tree.Assignment):
            run.close()
            return self.statement(statement)
        target = self.designator(statement.target)
        pad = run.add(target, None if self.tokens.has_comments else self.tokens.column)
        return (target, pad, " ", self.tokens.word("ASSIGN"), " ", self.expression(statement.value))

    def statement(self, node: tree.Statement) -> Doc:
        """A statement without its ``;``."""
        match node:
            case tree.Call():
                return self._call(node)
            case tree.Return(value=value):
                word = self.tokens.word("RETURN")
                return (word, " ", self.expression(value)) if value is not None else word
            case tree.Goto():
                return (self.tokens.word("GOTO"), " ", self.name(node.label))
            case tree.Label():
                return (self.name(node.name), self.tokens.word("COLON"))
            case tree.If():
                return self._if(node)
            case tree.Case():
                return self._case(node)
            case tree.For():
                return self._for(node)
            case tree.While():
                head = (self.tokens.word("WHILE"), " ", self.expression(node.condition), " ")
                body = (self.tokens.word("DO"), self.block(node.body))
                return (head, body, HARD, self.tokens.word("ENDWHILE"))
            case tree.Repeat():
                body = (self.tokens.word("REPEAT"), self.block(node.body))
                return (body, HARD, self.tokens.word("UNTIL"), " ", self.expression(node.condition))
            case tree.Exit() | tree.Halt() | tree.Pause():
                return self.tokens.word("EXIT", "HALT", "PAUSE")
            case tree.WaitTime() | tree.WaitFor():
                return self._wait(node)
            case _:
                return self.motion(node)

    def _call(self, node: tree.Call) -> Doc:
        name = self.name(node.name)
        if self.tokens.kind != "LEFT_PAREN":
            return name
        opening = self.tokens.word("LEFT_PAREN")
        inner = self.listed(node.arguments, self._argument, fill=True) if node.arguments else ""
        return (name, opening, inner, self.tokens.word("RIGHT_PAREN"))

    def _argument(self, node: tree.Argument) -> Doc:
        if not isinstance(node, tree.FormattedValue):
            return self.expression(node)
        parts = [self.expression(node.value), self.tokens.word("COLON"), self.expression(node.width)]
        if node.precision is not None:
            parts += [self.tokens.word("COLON"), self.expression(node.precision)]
        return tuple(parts)

    def _if(self, node: tree.If) -> Doc:
        parts: list[Doc] = []
        for branch in node.branches:
            parts += [HARD] if parts else []
            parts += [self.tokens.word("IF", "ELSIF"), " ", self.expression(branch.condition), " "]
            parts += [self.tokens.word("THEN"), self.block(branch.body)]
        if node.otherwise is not None:
            parts += [HARD, self.tokens.word("ELSE"), self.block(node.otherwise)]
        return (*parts, HARD, self.tokens.word("ENDIF"))

    def _case(self, node: tree.Case) -> Doc:
        head = (self.tokens.word("CASE"), " ", self.expression(node.selector), " ", self.tokens.word("OF"))
        parts: list[Doc] = []
        outer: list[Doc] = []
        for branch in node.branches:
            parts += [*outer, *self.before(first=not parts), HARD, self.tokens.word("WHEN"), " "]
            parts.append(self.listed(branch.labels, self.expression, fill=True))
            parts.append(self.tokens.word("COLON"))
            body, outer = self._block(branch.body)
            parts.append(body)
        if node.default is not None:
            parts += [*outer, *self.before(first=not parts), HARD, self.tokens.word("DEFAULT")]
            parts.append(self.tokens.word("COLON"))
            body, outer = self._block(node.default)
            parts.append(body)
        if not parts:
            parts, outer = self.before_end()
        return (head, Indent(tuple(parts)), *outer, HARD, self.tokens.word("ENDCASE"))

    def _for(self, node: tree.For) -> Doc:
        head: list[Doc] = [self.tokens.word("FOR"), " ", self.designator(node.variable), " "]
        head += [self.tokens.word("ASSIGN"), " ", self.expression(node.start), " "]
        head += [self.tokens.word("TO", "DOWNTO"), " ", self.expression(node.stop), " "]
        if node.step is not None:
            head += [self.tokens.word("STEP"), " ", self.expression(node.step), " "]
        return (*head, self.tokens.word("DO"), self.block(node.body), HARD, self.tokens.word("ENDFOR"))

    def _wait(self, node: tree.WaitTime | tree.WaitFor) -> Doc:
        word = self.tokens.word("WAIT")
        if isinstance(node, tree.WaitTime):
            return (word, " ", self.expression(node.duration), " ", self.tokens.word("SEC"))
        parts: list[Doc] = [word, " ", self.tokens.word("FOR"), " ", self.expression(node.condition)]
        if node.timeout is not None:
            parts += [" ", self.tokens.word("TIMEOUT"), " ", self.expression(node.timeout), " "]
            parts.append(self.tokens.word("SEC"))
        return tuple(parts)
