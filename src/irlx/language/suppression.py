"""Comments that make irlx ignore a warning where they stand: ``{ irlx: ignore IRL205 }``."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from irlx.diagnostics import CATALOGUE, Diagnostic, Place, Severity, SourceText, Span, report
from irlx.diagnostics.codes.lints import LINTS
from irlx.diagnostics.codes.pacing import PACING
from irlx.diagnostics.diagnostic import near_matches
from irlx.language.comments import TO_IRLX
from irlx.language.data_lists import ImportedList, Imports
from irlx.language.lexing import lex
from irlx.language.parser import Parse
from irlx.language.tree import DataList

__all__ = [
    "BY_MOTION",
    "Ignore",
    "Ignores",
    "after_ignoring",
    "read_ignores",
    "unused_finding",
    "without_ignored",
]

BY_MOTION = frozenset(entry.id for entry in PACING if entry.severity is not Severity.ERROR)
"""Codes that only motion gives: of a run, or of a dry run."""
_FOUND_LATER = frozenset({"IRL363", "IRL591"}) | BY_MOTION
"""Codes that only a look at what can be executed gives."""
_BY_LINTS = frozenset(lint.id for lint in LINTS)
"""Codes that only a check looks for, and a run does not."""
_OF_IMPORTED_LISTS = frozenset({"IRL243"})
"""Codes of a data list that only a program that imports it gives."""
_WORD = re.compile(r"[^\s,]+")


@dataclass(frozen=True)
class Ignore:
    """One code that a comment asks to ignore: on which line of its text, and where it is written."""

    code: str
    line: int
    place: Place


@dataclass(frozen=True)
class Ignores:
    """What the comments of a text ask for, and the findings on comments that ask for the impossible."""

    asked: tuple[Ignore, ...] = ()
    findings: tuple[Diagnostic, ...] = ()


def read_ignores(source: SourceText, comments: Sequence[Span]) -> Ignores:
    """Read all comments to irlx in a text."""
    asked: list[Ignore] = []
    findings: list[Diagnostic] = []
    for span in comments:
        for found in _read(source, span):
            if isinstance(found, Ignore):
                asked.append(found)
            else:
                findings.append(found)
    return Ignores(tuple(asked), tuple(findings))


def without_ignored(
    findings: Sequence[Diagnostic], asked: Sequence[Ignore]
) -> tuple[list[Diagnostic], list[Ignore]]:
    """Findings that no comment asks to ignore, and what is asked but found nothing to ignore."""
    wanted = {(ignore.code, ignore.place.file, ignore.line) for ignore in asked}
    used = set()
    kept = []
    for finding in findings:
        place = finding.place
        key = (finding.code, place.file, place.line or 0) if place is not None else None
        if key in wanted and not finding.is_error:
            used.add(key)
        else:
            kept.append(finding)
    return kept, [one for one in asked if (one.code, one.place.file, one.line) not in used]


def after_ignoring(
    findings: Sequence[Diagnostic], source: SourceText, parsed: Parse, imports: Imports, *, linted: bool
) -> tuple[list[Diagnostic], tuple[Ignore, ...]]:
    """Findings of the analysis of a text after its comments had their say, those on the comments included.

    Also gives what is asked for that only a later stage finds. What is missing in an incomplete tree proves
    nothing, so nothing counts as unused there. In imported lists comments only ignore: what they have to
    say of a list depends on who imports it. `linted` tells whether lints were looked for.
    """
    own = read_ignores(source, parsed.comments)
    lists = [one for found in imports.lists for one in read_ignores(found.source, _comments(found)).asked]
    kept, unused = without_ignored(findings, (*own.asked, *lists))
    kept += own.findings
    mine = [one for one in unused if one.place.text is source]
    if parsed.complete:
        known_later = {
            *_FOUND_LATER,
            *(_OF_IMPORTED_LISTS if isinstance(parsed.tree, DataList) else ()),
            *(() if linted else _BY_LINTS),
        }
        kept += [unused_finding(one) for one in mine if one.code not in known_later]
    return kept, tuple(one for one in unused if one.code in _FOUND_LATER)


def _comments(found: ImportedList) -> Sequence[Span]:
    # Most lists say nothing to irlx, and need not be split a second time.
    return lex(found.source).comments if "irlx" in found.source.text.casefold() else ()


def unused_finding(ignore: Ignore) -> Diagnostic:
    """The finding on a comment that ignores nothing."""
    return report("IRL140", ignore.place, ignored=ignore.code)


def _read(source: SourceText, span: Span) -> Iterator[Ignore | Diagnostic]:
    """What one comment asks for; nothing where it does not speak to irlx."""
    comment = TO_IRLX.fullmatch(source.text, span.start, span.end)
    if comment is None:
        return
    if comment["codes"] is None:
        yield report("IRL143", Place.in_text(source, span), cause="expected irlx: ignore, then codes")
        return
    line, _ = source.line_and_column(span.start)
    words = list(_WORD.finditer(source.text, *comment.span("codes")))
    if not words:
        yield report("IRL143", Place.in_text(source, span), cause="it names no code to ignore")
    for word in words:
        yield _asked(word[0], line, Place.in_text(source, Span(*word.span())))


def _asked(word: str, line: int, place: Place) -> Ignore | Diagnostic:
    code = word.upper()
    entry = CATALOGUE.get(code)
    if entry is None:
        return report("IRL142", place, unknown=word, near=near_matches(code, sorted(CATALOGUE)))
    if entry.severity is Severity.ERROR:
        return report("IRL141", place, ignored=code)
    return Ignore(code, line, place)
