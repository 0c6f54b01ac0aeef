"""The base of every exception that irlx raises for its users."""

from __future__ import annotations

from collections.abc import Sequence

from irlx.diagnostics.diagnostic import Diagnostic


class IrlxError(Exception):
    """Something a user can act on; holds all diagnostics, the first error being the reason.

    Attributes: `diagnostics`, a tuple with at least one error.
    """

    def __init__(self, diagnostics: Diagnostic | Sequence[Diagnostic]) -> None:
        found = (diagnostics,) if isinstance(diagnostics, Diagnostic) else tuple(diagnostics)
        self.diagnostics: tuple[Diagnostic, ...] = found
        super().__init__("\n".join(str(diagnostic) for diagnostic in found))

    @property
    def reason(self) -> Diagnostic:
        """The first error among the diagnostics."""
        return next((d for d in self.diagnostics if d.is_error), self.diagnostics[0])
