"""Variables and constants that nothing uses, and variables that are read but never set."""

from __future__ import annotations

from collections.abc import Iterator

from irlx.diagnostics import Diagnostic, Place, Related, SourceText, report
from irlx.language.checking import TypedText
from irlx.language.checking.names import Entry
from irlx.language.references import Reference
from irlx.language.types import FILE, SEMAPHORE


def unused_names(typed: TypedText, source: SourceText) -> Iterator[Diagnostic]:
    """A warning at every such declaration of the text; data lists may hold more than a program needs."""
    uses: dict[int, list[Reference]] = {}
    for reference in typed.references:
        uses.setdefault(id(reference.symbol), []).append(reference)
    for entry in typed.entries:
        symbol = entry.symbol
        if symbol is None or symbol.source is not None or symbol.kind not in ("variable", "constant"):
            continue
        found = uses.get(id(symbol), [])
        place = Place.in_text(source, symbol.name.span)
        if not found:
            yield report("IRL281", place, name=symbol.name.name, kind=symbol.kind)
        elif _never_set(entry, found):
            related = (Related("declared here", place),)
            first = Place.in_text(source, found[0].span)
            yield report("IRL282", first, related=related, name=symbol.name.name)


def _never_set(entry: Entry, uses: list[Reference]) -> bool:
    if entry.kind != "variable" or entry.settings or entry.type in (FILE, SEMAPHORE):
        return False
    return all(use.access == "read" for use in uses)
