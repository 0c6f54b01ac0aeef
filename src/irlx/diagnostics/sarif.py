"""Renderer of diagnostics as a SARIF 2.1.0 log, which code hosts and editors read."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from urllib.parse import quote

from irlx._version import __version__
from irlx.diagnostics.codes import CATALOGUE
from irlx.diagnostics.diagnostic import Diagnostic
from irlx.diagnostics.pages import page_text, page_title
from irlx.diagnostics.place import Place, SourceText, Span

__all__ = ["sarif_log"]

_SCHEMA = "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
_LEVELS = {"error": "error", "warning": "warning", "info": "note"}


def sarif_log(diagnostics: Sequence[Diagnostic]) -> dict[str, Any]:
    """The whole log; its rules are the codes that occur, in the order of the catalogue's numbers."""
    codes = sorted({diagnostic.code for diagnostic in diagnostics})
    driver = {"name": "irlx", "version": __version__, "rules": [_rule(code) for code in codes]}
    return {
        "$schema": _SCHEMA,
        "version": "2.1.0",
        "runs": [
            {
                "tool": {"driver": driver},
                "columnKind": "utf16CodeUnits",
                "results": [_result(one, codes.index(one.code)) for one in diagnostics],
            }
        ],
    }


def _rule(code: str) -> dict[str, Any]:
    """A code; a helpUri would have to be absolute, so the page itself goes along."""
    page = page_text(code)
    return {
        "id": code,
        "shortDescription": {"text": page_title(code)},
        "help": {"text": page, "markdown": page},
        "defaultConfiguration": {"level": _LEVELS[CATALOGUE[code].severity.value]},
        "properties": {"page": f"docs/diagnostics/{code}.md"},
    }


def _result(diagnostic: Diagnostic, rule: int) -> dict[str, Any]:
    message = f"{diagnostic.message}\n{diagnostic.help}" if diagnostic.help else diagnostic.message
    result: dict[str, Any] = {
        "ruleId": diagnostic.code,
        "ruleIndex": rule,
        "level": _LEVELS[diagnostic.severity.value],
        "message": {"text": message},
        "locations": [_location(diagnostic.place)] if diagnostic.place is not None else [],
    }
    if diagnostic.related:
        result["relatedLocations"] = [
            {"id": number, "message": {"text": one.message}, **_location(one.place)}
            for number, one in enumerate(diagnostic.related, 1)
        ]
    return result


def _location(place: Place) -> dict[str, Any]:
    physical: dict[str, Any] = {"artifactLocation": {"uri": _uri(place.file)}}
    if place.text is not None and place.span is not None:
        physical["region"] = _region(place.text, place.span)
    location: dict[str, Any] = {"physicalLocation": physical}
    if place.key:
        location["logicalLocations"] = [{"fullyQualifiedName": place.key}]
    return location


def _region(text: SourceText, span: Span) -> dict[str, int]:
    (line, column), (end_line, end_column) = (
        _in_code_units(text, *text.line_and_column(offset)) for offset in (span.start, span.end)
    )
    return {"startLine": line, "startColumn": column, "endLine": end_line, "endColumn": end_column}


def _in_code_units(text: SourceText, line: int, column: int) -> tuple[int, int]:
    """A place with its column counted in UTF-16: characters beyond U+FFFF take two units."""
    before = text.line_text(line)[: column - 1]
    return line, column + sum(ord(character) > 0xFFFF for character in before)


def _uri(file: str) -> str:
    """A relative path stays relative, in the form of a URI; names that are no text keep their bytes."""
    path = Path(file)
    if path.is_absolute():
        return path.as_uri()
    return quote(os.fsencode(path.as_posix()))
