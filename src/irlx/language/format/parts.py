"""Layout of programs, modules, data lists and their declarations."""

from __future__ import annotations

from collections.abc import Sequence

from irlx.language import tree
from irlx.language.format.alignment import Alignment
from irlx.language.format.document import HARD, Doc, Fill, Here, Indent
from irlx.language.format.statements import StatementLayout

__all__ = ["PartLayout"]

_SECTIONS = ("CONST", "TYPE", "VAR")
_ITEMS = (tree.ConstDeclaration, tree.TypeDefinition, tree.VarDeclaration, tree.SignalDeclaration)


class PartLayout(StatementLayout):
    """The words of sections at the margin, what they hold indented."""

    def root(self, node: tree.Program | tree.Module | tree.DataList) -> Doc:
        """A whole text."""
        opening = self.before(first=True)
        head = (self.tokens.word("PROGRAM", "MODULE", "DATALIST"), " ", self.name(node.name))
        parts: list[Doc] = [*opening, HARD, head, self.tokens.word("SEMICOLON")]
        match node:
            case tree.Program():
                parts.append(self._declarations(node.declarations))
                parts += [HARD, self.tokens.word("BEGIN"), self.block(node.body)]
            case tree.Module():
                parts.append(self._declarations(node.declarations))
            case tree.DataList():
                parts.append(self._items(list(node.declarations)))
        parts += [HARD, self.tokens.word("ENDPROGRAM", "ENDMODULE", "ENDDATALIST")]
        parts.append(self.tokens.optional("SEMICOLON"))
        for after_blank, remark in self.tokens.leading():
            parts += [HARD, HARD, remark] if after_blank else [HARD, remark]
        return tuple(parts)

    def _declarations(self, declarations: Sequence[tree.Declaration]) -> Doc:
        """All declarations of a program, module or routine, and what stands before the word after them."""
        waiting = list(declarations)
        parts: list[Doc] = []
        while waiting or self.tokens.kind in _SECTIONS:
            parts += self.before(first=False)
            if self.tokens.kind in _SECTIONS:
                parts += [HARD, self.tokens.word(*_SECTIONS), self._items(waiting)]
            else:
                parts += [HARD, self._declaration(waiting.pop(0), Alignment())]
                parts.append(self.tokens.word("SEMICOLON"))
        return (*parts, *self.before(first=False))

    def _items(self, waiting: list[tree.Declaration]) -> Doc:
        """What a section declares; takes it from the front of `waiting`."""
        lines: list[Doc] = []
        run = Alignment()
        while waiting and isinstance(waiting[0], _ITEMS) and self.tokens.kind not in _SECTIONS:
            lines += self.before(first=not lines)
            lines += [HARD, self._declaration(waiting.pop(0), run), self.tokens.word("SEMICOLON")]
        run.close()
        inner, outer = self.before_end()
        return (Indent((*lines, *inner)), *outer)

    def _declaration(self, node: tree.Declaration, run: Alignment) -> Doc:
        word = self.tokens.word
        match node:
            case tree.ConstDeclaration():
                return self._variables(node.type, node.constants, run)
            case tree.VarDeclaration():
                return self._variables(node.type, node.variables, run)
            case tree.TypeDefinition():
                return (self.type_form(node.type), " ", word("EQUAL"), " ", self.name(node.name))
            case tree.SignalDeclaration():
                return self._signals(node)
            case tree.ProcedureDeclaration() | tree.FunctionDeclaration():
                return self._routine(node)
            case tree.SystemSpecification():
                return (word("SYSTEM"), " ", word("SPECIFICATION"), " ", self.name(node.name))
            case tree.ImportFrom():
                module = (word("FROM"), " ", self.name(node.module), " ")
                return (module, word("IMPORT"), " ", self.names(node.names))
            case tree.ImportDatalist():
                return (word("IMPORT"), " ", word("DATALIST"), " ", self.name(node.name))
            case tree.Export():
                return self._export(node)
            case tree.RobotBinding():
                name = (word("ROBOT"), " ", self.name(node.name), " ")
                return (name, word("ASSIGN"), " ", self.name(node.robot))
            case tree.StandardChannel():
                channel = word("STANDARD_IN", "STANDARD_OUT")
                return (channel, " ", word("EQUAL"), " ", self.name(node.channel))

    def _export(self, node: tree.Export) -> Doc:
        names = (self.tokens.word("EXPORT"), " ", self.names(node.names))
        if node.recipient is None:
            return names
        return (names, " ", self.tokens.word("TO"), " ", self.name(node.recipient))

    def _variables(self, form: tree.TypeForm, variables: Sequence[tree.Variable], run: Alignment) -> Doc:
        """Names alone fill lines; with values each has its own line where not all fit."""
        kind: Doc = (self.type_form(form), self.tokens.word("COLON"), " ")
        if len(variables) == 1:
            return (kind, self._variable(variables[0], run, kind))
        run.close()
        bare = all(variable.initial is None for variable in variables)
        own = Alignment()
        listed = self.listed(variables, lambda variable: self._variable(variable, own, ""), fill=bare)
        own.close()
        return (kind, listed)

    def _variable(self, node: tree.Variable, run: Alignment, before: Doc) -> Doc:
        """A name and its value, aligned with others of the run; `before` stands before it on its line."""
        name = self.name(node.name)
        if node.initial is None:
            return name
        pad = run.add((before, name), None if self.tokens.has_comments else self.tokens.column)
        return (name, pad, " ", self.tokens.word("ASSIGN"), " ", self.expression(node.initial))

    def _signals(self, node: tree.SignalDeclaration) -> Doc:
        words: list[Doc] = [self.tokens.word("DIGITAL", "ANALOG"), " "] if node.medium is not None else []
        words.append(self.tokens.word("INPUT", "OUTPUT"))
        if node.type is not None:
            words += [" ", self.type_form(node.type)]
        colon = self.tokens.word("COLON")
        return (*words, colon, " ", self.listed(node.signals, self._signal, fill=True))

    def _signal(self, node: tree.SignalPort) -> Doc:
        return (self.name(node.name), " ", self.tokens.word("AT"), " ", self.expression(node.port))

    def _routine(self, node: tree.ProcedureDeclaration | tree.FunctionDeclaration) -> Doc:
        head: list[Doc] = [self.tokens.word("PROCEDURE", "FUNCTION"), " ", self.name(node.name)]
        head.append(self._parameters(node.parameters))
        if isinstance(node, tree.FunctionDeclaration):
            head += [self.tokens.word("COLON"), " ", self.type_form(node.result)]
        head.append(self.tokens.word("SEMICOLON"))
        body = [self._declarations(node.declarations), HARD, self.tokens.word("BEGIN")]
        body += [self.block(node.body), HARD, self.tokens.word("ENDPROC", "ENDFCT")]
        return (*head, *body)

    def _parameters(self, parameters: Sequence[tree.Parameter]) -> Doc:
        if self.tokens.kind != "LEFT_PAREN":
            return ""
        opening = self.tokens.word("LEFT_PAREN")
        docs: list[Doc] = []
        for index, parameter in enumerate(parameters):
            doc = self._parameter(parameter)
            docs.append((doc, self.tokens.word("SEMICOLON")) if index + 1 < len(parameters) else doc)
        return (opening, Here(Fill(tuple(docs))) if docs else "", self.tokens.word("RIGHT_PAREN"))

    def _parameter(self, node: tree.Parameter) -> Doc:
        mode = (self.tokens.word("IN", "VAR"), " ") if self.tokens.kind in ("IN", "VAR") else ""
        return (mode, self.type_form(node.type), self.tokens.word("COLON"), " ", self.names(node.names))
