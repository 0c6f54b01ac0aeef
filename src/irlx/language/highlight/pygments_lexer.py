"""The lexer of Pygments, for whatever shows programs with it: terminals, notebooks, Sphinx, LaTeX."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, ClassVar

from pygments import token
from pygments.lexer import Lexer

from irlx.language.highlight.kind import Kind
from irlx.language.highlight.pieces import pieces

__all__ = ["TOKENS", "IrlLexer"]

TOKENS = {
    Kind.SPACE: token.Whitespace,
    Kind.COMMENT: token.Comment.Multiline,
    Kind.INSTRUCTION: token.Comment.Special,
    Kind.DECLARATION: token.Keyword.Declaration,
    Kind.CONTROL: token.Keyword,
    Kind.MOTION: token.Keyword.Reserved,
    Kind.REDUNDANCY: token.Keyword.Reserved,
    Kind.WORD_OPERATOR: token.Operator.Word,
    Kind.CONSTANT: token.Keyword.Constant,
    Kind.INT: token.Number.Integer,
    Kind.REAL: token.Number.Float,
    Kind.STRING: token.String,
    Kind.OPERATOR: token.Operator,
    Kind.PUNCTUATION: token.Punctuation,
    Kind.TYPE: token.Keyword.Type,
    Kind.OWN_TYPE: token.Name.Class,
    Kind.FUNCTION: token.Name.Builtin,
    Kind.PROCEDURE: token.Name.Builtin,
    Kind.SYSTEM_VARIABLE: token.Name.Variable.Magic,
    Kind.PORT: token.Name.Variable.Global,
    Kind.CHANNEL: token.Name.Builtin.Pseudo,
    Kind.PARAMETER: token.Name.Attribute,
    Kind.ROUTINE: token.Name.Function,
    Kind.PART: token.Name.Namespace,
    Kind.LABEL: token.Name.Label,
    Kind.FIELD: token.Name.Property,
    Kind.NAME: token.Name,
    Kind.WRONG: token.Error,
}
"""The token of Pygments for each kind."""
_BEGINNING = re.compile(
    r"(?:\s|\{[^}]*\}|\(\*[\s\S]*?\*\))*(PROGRAM|MODULE|DATALIST)\s+\w+\s*;", re.IGNORECASE
)
_END = re.compile(r"\b(?:ENDPROGRAM|ENDMODULE|ENDDATALIST)\b", re.IGNORECASE)


class IrlLexer(Lexer):  # type: ignore[misc]
    """Programs, modules and data lists of the irlx profile of IRL, and parts of them."""

    name: ClassVar[str] = "IRL"
    aliases: ClassVar[list[str]] = ["irl", "irlx"]
    filenames: ClassVar[list[str]] = ["*.irl"]
    mimetypes: ClassVar[list[str]] = ["text/x-irl"]
    version_added = ""

    def get_tokens_unprocessed(self, text: str) -> Iterator[tuple[int, Any, str]]:
        """Offset, token and text of each piece."""
        start = 0
        for kind, piece in pieces(text):
            yield start, TOKENS[kind], piece
            start += len(piece)

    @staticmethod
    def analyse_text(text: str) -> float:
        """How likely a text is IRL: the words around a program are in no other language known here."""
        return 0.2 * (_BEGINNING.match(text) is not None) + 0.6 * (_END.search(text) is not None)
