"""Findings that follow from a mistake which is told already."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby

from irlx.diagnostics import Diagnostic, Span
from irlx.language import tree
from irlx.language.parsing.driver import MAX_ERRORS

_DECLARING = (tree.Program, tree.Module, tree.ProcedureDeclaration, tree.FunctionDeclaration)
_MISSING_VAR = "should VAR stand above its declaration? Other constants of the list are set as well"
_STATEMENT_ENDS = frozenset({"IRL102", "IRL122"})
"""Mistakes at the end of a statement, behind which the next one begins."""
_SEVERAL = 3
"""So many constants of one list are not set by mistake."""


def standing_alone(findings: list[Diagnostic], syntax: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Findings away from mistakes in the text: in a statement with one, words are missing or guessed.

    None where the text has more mistakes than are told: any of these may be the cause.
    """
    syntax = [mistake for mistake in syntax if mistake.is_error]
    if len(syntax) >= MAX_ERRORS:
        return []
    torn: dict[str, list[Span]] = {}
    for mistake in syntax:
        place = mistake.place
        if place is not None and place.text is not None and place.span is not None:
            span = _statement(place.text.text, place.span, ends_there=mistake.code in _STATEMENT_ENDS)
            torn.setdefault(place.file, []).append(span)
    return [finding for finding in findings if not _stands_in(finding, torn)] if torn else findings


def _statement(text: str, mistake: Span, *, ends_there: bool) -> Span:
    """The statement or declaration with a mistake, as ``;`` shows it; one that `ends_there` lacks its own."""
    start = text.rfind(";", 0, mistake.start) + 1
    if start and text[start : mistake.start].isspace() and "\n" not in text[start : mistake.start]:
        # What begins with a mistake on a line that goes on may belong to the statement before.
        start = text.rfind(";", 0, start - 1) + 1
    if ends_there and not text[mistake.end :].partition("\n")[0].strip():
        return Span(start, mistake.end)
    end = text.find(";", mistake.start if text[mistake.start : mistake.end] == ";" else mistake.end)
    return Span(start, len(text) if end < 0 else end)


def _stands_in(finding: Diagnostic, torn: Mapping[str, Sequence[Span]]) -> bool:
    place = finding.place
    if place is None or place.span is None:
        return False
    at = place.span.start
    return any(span.start <= at <= span.end for span in torn.get(place.file, ()))


def without_missing_var(
    findings: Sequence[Diagnostic], root: tree.Node, syntax: Iterable[Diagnostic]
) -> list[Diagnostic]:
    """Findings without those on what stands below CONST only because a VAR is missing or misspelt.

    Of constants without a value and what follows them in their list only the first is told; nothing where a
    mistake in the text stands among them. Three constants of a list that are set are meant to be variables:
    the first one is told. A constant that is set in several places is told once.
    """
    told = sorted(((_constant(finding), finding) for finding in findings), key=_offset)
    if not any(key for key, _ in told):
        return list(findings)
    errors = [one.place.span.start for one in syntax if one.is_error and one.place and one.place.span]
    lists = [_Constants(run, errors, told) for run in _const_lists(root)]
    seen: set[str] = set()
    kept = []
    for key, finding in told:
        is_set = key != "" and finding.code == "IRL211"
        if not (is_set and key in seen) and not any(each.hides(key, finding) for each in lists):
            first = is_set and any(finding is each.first for each in lists)
            kept.append(replace(finding, help=_MISSING_VAR) if first else finding)
        seen.update({key} if is_set else ())
    return kept


def _offset(told: tuple[str, Diagnostic]) -> int:
    place = told[1].place
    return place.span.start if place is not None and place.span is not None else 0


def _const_lists(root: tree.Node) -> Iterator[list[tree.ConstDeclaration]]:
    """Declarations of constants that follow each other, of the text and of its routines."""
    for node in tree.walk(root):
        parts = node.declarations if isinstance(node, _DECLARING) else ()
        for is_const, run in groupby(parts, lambda part: isinstance(part, tree.ConstDeclaration)):
            if is_const:
                yield [one for one in run if isinstance(one, tree.ConstDeclaration)]


def _constant(finding: Diagnostic) -> str:
    """Casefolded name of the constant that a finding is about, or ''."""
    place, data = finding.place, finding.data
    of_constant = finding.code == "IRL251" or "a constant" in (data.get("kind"), data.get("found"))
    if not of_constant or finding.code not in ("IRL211", "IRL249", "IRL251"):
        return ""
    if place is None or place.text is None or place.span is None:
        return ""
    return place.text.text[place.span.start : place.span.end].casefold()


class _Constants:
    """A list of constants, which of them are likely variables, and the first finding that shows it.

    `first` is None where nothing shows it, or a mistake in the text that is told anyway.
    """

    def __init__(
        self,
        run: Sequence[tree.ConstDeclaration],
        errors: Sequence[int],
        told: Sequence[tuple[str, Diagnostic]],
    ) -> None:
        start, end = run[0].span.start, run[-1].span.end
        torn = min((error for error in errors if start <= error <= end), default=end)
        bare = [part for part in run if any(one.initial is None for one in part.constants)]
        begin = min(torn, bare[0].span.start if bare else end)
        self._likely = {one.name.key for part in run if part.span.end > begin for one in part.constants}
        names = {one.name.key for part in run for one in part.constants}
        valueless = [finding for key, finding in told if finding.code == "IRL251" and key in names]
        settings = [(key, finding) for key, finding in told if finding.code == "IRL211" and key in names]
        self.first: Diagnostic | None = None
        if torn < end:
            return
        if valueless:
            self.first = valueless[0]
        elif len({key for key, _ in settings}) >= _SEVERAL:
            self.first, self._likely = settings[0][1], names
        else:
            self._likely = set()

    def hides(self, key: str, finding: Diagnostic) -> bool:
        """Whether a finding on a constant follows from what is told already."""
        return key in self._likely and finding is not self.first
