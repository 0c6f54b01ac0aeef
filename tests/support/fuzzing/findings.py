"""What has to hold of every finding: a known code, words for people, and a place that there is."""

from __future__ import annotations

import re

from fuzzing.case import Fault
from irlx.cli.painting import painted_line
from irlx.diagnostics import CATALOGUE, Diagnostic, Place
from irlx.diagnostics.concise import render_concise
from irlx.diagnostics.plain import plain_diagnostic
from irlx.diagnostics.text import render_text

_BARE_OBJECT = re.compile(r" object at 0x|<class '|<function |Traceback \(most")
INTERNAL = "IRL090"
_VALUES = re.compile(r"'[^']*'|[0-9]+")
_NEEDS_NO_PLACE = "IRL0"
"""Codes of the command line tell of files and options as a whole."""


def look_at(found: Diagnostic, thorough: bool = False) -> None:
    """Raises Fault for a finding that is not as it has to be."""
    if found.code == INTERNAL:
        raise Fault("an internal error", "", found.message)
    if found.code not in CATALOGUE:
        raise Fault("no such code", found.code)
    if found.place is None and not found.code.startswith(_NEEDS_NO_PLACE):
        raise Fault("a finding without a place", found.code, str(found))
    for place in (found.place, *(one.place for one in found.related)):
        if place is not None:
            _check_place(place, found)
    words = render_text(found, painted_line) if thorough else render_text(found)
    concise = render_concise(found)
    if not found.message or "\n" in concise or _BARE_OBJECT.search(words):
        raise Fault("words that are for nobody", found.code, words)
    plain_diagnostic(found)


def wording(found: Diagnostic) -> tuple[str, str]:
    """Code and message without what they tell of."""
    return found.code, _VALUES.sub("", found.message)[:200]


def _check_place(place: Place, found: Diagnostic) -> None:
    if place.text is None or place.span is None:
        if not (place.key or place.file):
            raise Fault("a place that is nowhere", found.code, str(found))
    elif place.span.end > len(place.text.text):
        raise Fault("a place behind the end of the text", found.code, str(found))
