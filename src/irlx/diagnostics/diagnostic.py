"""One finding: a code, a place, the data behind the message, and what would help."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches

from irlx.diagnostics.codes import CATALOGUE, Severity
from irlx.diagnostics.place import Place

__all__ = ["Diagnostic", "Related", "Severity", "near_matches", "report"]


@dataclass(frozen=True)
class Related:
    """A second place that belongs to a diagnostic, with a word on why."""

    message: str
    place: Place


@dataclass(frozen=True)
class Diagnostic:
    """A finding of any stage; renderers turn it into text, JSON or what a tool wants.

    `data` holds what the message was made of, so that a program can use it without parsing prose.
    """

    code: str
    severity: Severity
    message: str
    place: Place | None = None
    help: str = ""
    related: tuple[Related, ...] = ()
    data: Mapping[str, object] = field(default_factory=dict, compare=False)

    @property
    def is_error(self) -> bool:
        """Whether this finding makes the program, file or command unusable."""
        return self.severity is Severity.ERROR

    def __str__(self) -> str:
        place = f"{self.place}: " if self.place else ""
        return f"{place}{self.severity.value} {self.code}: {self.message}"


def report(
    code: str,
    place: Place | None = None,
    *,
    help: str | None = None,
    related: tuple[Related, ...] = (),
    **data: object,
) -> Diagnostic:
    """Build the diagnostic of a code; `data` fills the placeholders of its message and help.

    Raises KeyError for a code or a placeholder that does not exist: both are errors of irlx itself.
    """
    entry = CATALOGUE[code]
    return Diagnostic(
        code=code,
        severity=entry.severity,
        message=entry.message.format_map(data),
        place=place,
        help=(entry.help if help is None else help).format_map(data),
        related=related,
        data=data,
    )


def near_matches(name: str, known: list[str] | tuple[str, ...]) -> str:
    """Clause with the known names most like `name`, for example ``; did you mean 'p1'?``, or ''."""
    close = near_names(name, known)
    return "; did you mean " + " or ".join(f"'{found}'" for found in close) + "?" if close else ""


def near_names(name: str, known: list[str] | tuple[str, ...]) -> list[str]:
    """The known names most like `name`, at most three, the most like first."""
    by_fold = {candidate.casefold(): candidate for candidate in known}
    return [by_fold[fold] for fold in get_close_matches(name.casefold(), list(by_fold), n=3, cutoff=0.6)]
