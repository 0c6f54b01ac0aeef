"""Declares ports that a text uses by their own names, as OUT_3, so that nothing warns of them any more."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from irlx.diagnostics import SourceText
from irlx.language import tree
from irlx.language.builtins import PORT_NAME, is_analog_port, is_input_port
from irlx.language.data_lists import DataListResolver, imports_of
from irlx.language.format.reading import Reading
from irlx.language.lexing import Lexed
from irlx.language.names import check_names
from irlx.language.parser import Parse, parse
from irlx.language.ranges import INT_LIMIT
from irlx.language.source import source_text
from irlx.language.suppression import read_ignores, without_ignored

if TYPE_CHECKING:
    from irlx.language.analysis import CellNames

__all__ = ["DeclaredPorts", "declared_ports"]

_ANY_PORT = re.compile(rf"\b{PORT_NAME.pattern}\b", re.IGNORECASE)
_ROUTINES = (tree.ProcedureDeclaration, tree.FunctionDeclaration)
_ITEMS = (tree.VarDeclaration, tree.SignalDeclaration)


@dataclass(frozen=True)
class DeclaredPorts:
    """A text with the declarations that it lacked, as they are written, and as nodes of its tree."""

    text: str
    written: str = ""
    nodes: tuple[tree.Declaration, ...] = ()


def declared_ports(
    reading: Reading, data_lists: DataListResolver | None = None, cell_names: CellNames | None = None
) -> DeclaredPorts:
    """A text without errors, with a declaration of each port that is used without one and is not ignored.

    A name like OUT_3 may come from a data list: where one is imported that cannot be read, nothing is added.
    """
    source, parsed = reading.source, reading.parsed
    root = parsed.tree
    if _ANY_PORT.search(source.text) is None or root is None or isinstance(root, tree.DataList):
        return DeclaredPorts(source.text)
    names = _undeclared(source, parsed, root, data_lists, cell_names)
    if not names:
        return DeclaredPorts(source.text)
    written = _declarations(names)
    offset, before, after = _gap(source, parsed.lexed, root, min(name.span.start for name in names))
    rest = source.text[offset:]
    after = "" if rest.lstrip(" ").startswith("\n") else after
    text = f"{source.text[:offset]}{before}{written}{after}{rest}"
    alone = parse(source_text(source.name, f"PROGRAM p; VAR {written} BEGIN ENDPROGRAM")).tree
    assert isinstance(alone, tree.Program)
    return DeclaredPorts(text, written, alone.declarations)


def _undeclared(
    source: SourceText,
    parsed: Parse,
    root: tree.Program | tree.Module,
    data_lists: DataListResolver | None,
    cell_names: CellNames | None,
) -> list[tree.Name]:
    """Names of ports where IRL205 tells of them, each once."""
    imports = imports_of(root, source, data_lists)
    if not imports.whole:
        return []
    given = cell_names(root) if cell_names is not None else None
    _, findings = check_names(root, source, given or (), imports, complete=True)
    asked = read_ignores(source, parsed.comments).asked
    told, _ = without_ignored([found for found in findings if found.code == "IRL205"], asked)
    spans = [found.place.span for found in told if found.place is not None and found.place.text is source]
    names = [source.text[span.start : span.end] for span in spans if span is not None]
    return [
        tree.Name(span, name, name.casefold())
        for span, name in zip(spans, names, strict=True)
        if span is not None and _number(name) < INT_LIMIT
    ]


def _number(name: str) -> int:
    return int(name.rpartition("_")[2])


def _declarations(names: Sequence[tree.Name]) -> str:
    """Declarations of ports: inputs, then outputs; those that are on or off, then analogue ones."""
    groups: dict[str, list[tree.Name]] = {
        "INPUT BOOL": [],
        "INPUT REAL": [],
        "OUTPUT BOOL": [],
        "OUTPUT REAL": [],
    }
    for name in names:
        direction = "INPUT" if is_input_port(name.key) else "OUTPUT"
        groups[f"{direction} {'REAL' if is_analog_port(name.key) else 'BOOL'}"].append(name)
    lines = []
    for words, members in groups.items():
        ports = [f"{one.name} AT {_number(one.name)}" for one in sorted(members, key=_by_number)]
        lines += [f"{words}: {', '.join(ports)};"] if ports else []
    return "\n".join(lines)


def _by_number(name: tree.Name) -> int:
    return _number(name.name)


def _gap(
    source: SourceText, lexed: Lexed, root: tree.Program | tree.Module, first_use: int
) -> tuple[int, str, str]:
    """Where declarations fit, and what to write before and after them.

    Behind the signals or else the variables before the first routine; before a declaration that uses a port
    itself; without any such declaration in a section of their own.
    """
    before = []
    for part in root.declarations:
        if isinstance(part, _ROUTINES):
            break
        before.append(part)
        if isinstance(part, _ITEMS) and part.span.start <= first_use < part.span.end:
            return part.span.start, "", "\n"
    signals = [part for part in before if isinstance(part, tree.SignalDeclaration)]
    variables = [part for part in before if isinstance(part, tree.VarDeclaration)]
    beside = (signals or variables)[-1:]
    if beside:
        return _line_end(source, lexed, _behind_semicolon(lexed, beside[0].span.end)), "\n", "\n"
    if before:
        last = _line_end(source, lexed, _behind_semicolon(lexed, before[-1].span.end))
        return last, "\n\nVAR\n", "\n"
    header = _line_end(source, lexed, _behind_semicolon(lexed, root.name.span.end))
    return _below_title(source, lexed, header), "\nVAR\n", "\n"


def _behind_semicolon(lexed: Lexed, offset: int) -> int:
    """Offset behind the first ``;`` from an offset on, which has none only where a declaration lacks it."""
    for token in lexed.tokens:
        if token.type == "SEMICOLON" and token.start_pos >= offset:
            return token.end_pos or offset
    return offset


def _line_end(source: SourceText, lexed: Lexed, offset: int) -> int:
    """Offset behind the comments that follow on the same line."""
    for comment in lexed.comments:
        if comment.start >= offset:
            between = source.text[offset : comment.start]
            if between.strip() or "\n" in between:
                break
            offset = comment.end
    return offset


def _below_title(source: SourceText, lexed: Lexed, offset: int) -> int:
    """Offset behind the comments below the first line, as far as they do not belong to a routine."""
    text, found, end = source.text, offset, offset
    for comment in lexed.comments:
        if comment.start < offset:
            continue
        if text[end : comment.start].strip():
            break
        end = comment.end
        rest = text[end:]
        blank = rest[: len(rest) - len(rest.lstrip())].count("\n") > 1
        if blank or rest.lstrip()[:5].upper() == "BEGIN" or rest.lstrip()[:9].upper() == "ENDMODULE":
            found = end
    return found
