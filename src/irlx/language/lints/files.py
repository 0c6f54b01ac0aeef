"""Files that are used and never opened, and files that are opened and never closed."""

from __future__ import annotations

from collections.abc import Iterator

from irlx.diagnostics import Diagnostic, Place, SourceText, report
from irlx.language import tree
from irlx.language.checking import TypedText
from irlx.language.checking.names import Entry


def open_files(
    root: tree.Program | tree.Module, typed: TypedText, source: SourceText
) -> Iterator[Diagnostic]:
    """A warning at the first such use; variables that others see as well prove nothing."""
    exported = {
        name.key for part in root.declarations if isinstance(part, tree.Export) for name in part.names
    }
    uses: dict[int, tuple[Entry, dict[str, tree.Name]]] = {}
    unused = {f"STANDARD_{direction}" for direction in {"IN", "OUT"} - typed.facts.standard}
    for what, entry, name in typed.facts.files:
        if what in unused:
            continue
        uses.setdefault(id(entry), (entry, {}))[1].setdefault(what, name)
    for entry, found in uses.values():
        symbol = entry.symbol
        if symbol is None or symbol.kind != "variable" or symbol.name.key in exported or "" in found:
            continue
        first = min(found.values(), key=lambda name: name.span.start)
        if "OPEN" not in found:
            yield report("IRL268", Place.in_text(source, first.span), name=symbol.name.name)
        elif "CLOSE" not in found:
            place = Place.in_text(source, found["OPEN"].span)
            yield report("IRL269", place, name=symbol.name.name)
