"""The formatter: one look for all programs, the same program, every comment kept."""

from __future__ import annotations

from typing import TYPE_CHECKING

from irlx.diagnostics import Diagnostic, IrlxError, Place, SourceText, report
from irlx.language import tree
from irlx.language.format.kept import what_is_lost
from irlx.language.format.line_ends import text_of
from irlx.language.format.parts import PartLayout
from irlx.language.format.ports import declared_ports
from irlx.language.format.reading import Reading
from irlx.language.format.render import render
from irlx.language.format.repair import REPAIRED, repaired
from irlx.language.format.trivia import Tokens, UnexpectedToken
from irlx.language.moves import check_move
from irlx.language.parser import Parse, parse
from irlx.language.source import source_text
from irlx.language.uncollected import uncollected

if TYPE_CHECKING:
    from irlx.language.analysis import CellNames
    from irlx.language.data_lists import DataListResolver

__all__ = ["format_source"]

_ROUNDS = 6
"""A comment in an odd place may need more than one; text without any needs one."""


def format_source(
    text: str,
    name: str = "<text>",
    data_lists: DataListResolver | None = None,
    cell_names: CellNames | None = None,
) -> str:
    """The text of a program, module or data list in irlx's form.

    Raises IrlxError: with all findings of the syntax where the text has errors, IRL144 where the result would
    not mean the same, lose a comment, or change when formatted again. `name` is how findings name the text.
    `data_lists` and `cell_names`, as `analyse` takes them, tell names that are none of undeclared ports.
    """
    ends = "\r\n" if text.partition("\n")[0].endswith("\r") else "\n"
    with uncollected():
        formatted = _formatted(source_text(name, text.replace("\r\n", "\n")), data_lists, cell_names)
    return formatted.replace("\n", ends) if ends != "\n" else formatted


def _formatted(source: SourceText, data_lists: DataListResolver | None, cell_names: CellNames | None) -> str:
    """The text in irlx's form, everything made sure of."""
    parsed = parse(source)
    errors = _errors(parsed, source)
    if errors or parsed.tree is None:
        raise IrlxError(errors)
    before = Reading(source, parsed)
    mended = before.of(repaired(source.text, parsed.findings))
    declared = declared_ports(mended, data_lists, cell_names)
    settled = _settled(mended.of(declared.text))
    lost = what_is_lost(before, settled, declared)
    if lost:
        raise _given_up(source, lost)
    return settled.source.text


def _errors(parsed: Parse, source: SourceText) -> list[Diagnostic]:
    """Findings that keep a text from being formatted, and the others if there are any."""
    found = list(parsed.findings)
    for node in tree.walk(parsed.tree) if parsed.tree is not None else ():
        if isinstance(node, tree.Move):
            found += [one for one in check_move(node, source) if one.code == "IRL114"]
    return found if any(one.is_error for one in found) else []


def _settled(reading: Reading) -> Reading:
    """The text formatted until it stays as it is."""
    for _ in range(_ROUNDS):
        again = reading.of(_laid_out(reading))
        if again is reading:
            return reading
        reading = again
    raise _given_up(reading.source, "the form of a text that it has formatted")


def _laid_out(reading: Reading) -> str:
    """One round of formatting a text without findings of the syntax."""
    source, parsed = reading.source, reading.parsed
    if parsed.tree is None or any(one.is_error or one.code in REPAIRED for one in parsed.findings):
        raise _given_up(source, "the meaning of the program")
    lexed = parsed.lexed
    try:
        doc = PartLayout(Tokens(source, lexed.tokens, lexed.comments)).root(parsed.tree)
    except UnexpectedToken as cause:
        raise _given_up(source, f"the order of the text ({cause})") from cause
    return text_of(render(doc))


def _given_up(source: SourceText, what: str) -> IrlxError:
    return IrlxError(report("IRL144", Place(source.name), what=what))
