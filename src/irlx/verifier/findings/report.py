"""The report of a verification: all checks of one stream."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from irlx.diagnostics import Diagnostic, Place, report
from irlx.verifier.findings.finding import FAILED, NO_CASE, NOT_CHECKED, OK, Check, Subject
from irlx.verifier.findings.table import plain_checks, text_table, verdict_of


@dataclass(frozen=True)
class Report:
    """All checks of one stream, in a fixed order; `print(report)` shows them as a table."""

    checks: tuple[Check, ...]
    subject: Subject = field(default_factory=lambda: Subject(""))

    @property
    def passed(self) -> bool:
        """Whether no check failed; those that could not be made do not count."""
        return not self.failed

    @property
    def failed(self) -> tuple[Check, ...]:
        """The checks that failed."""
        return self._with(FAILED)

    @property
    def made(self) -> tuple[Check, ...]:
        """The checks that judged something: passed or failed."""
        return tuple(check for check in self.checks if check.status in (OK, FAILED))

    @property
    def unchecked(self) -> tuple[Check, ...]:
        """The checks that could not be made, with the reason as detail."""
        return self._with(NOT_CHECKED)

    @property
    def without_case(self) -> tuple[Check, ...]:
        """The checks about something that the stream does not hold."""
        return self._with(NO_CASE)

    def _with(self, status: str) -> tuple[Check, ...]:
        return tuple(check for check in self.checks if check.status == status)

    def __getitem__(self, name: str) -> Check:
        """The check of a name; raises KeyError for a name that no check has."""
        for check in self.checks:
            if check.name == name:
                return check
        raise KeyError(name)

    @property
    def verdict(self) -> str:
        """One line: how many checks passed, failed, could not be made, and had no case."""
        return verdict_of(self.checks)

    def __str__(self) -> str:
        return text_table(self.subject, self.checks)

    def __repr__(self) -> str:
        return f"<Report of {self.subject.name or 'a stream'}: {self.verdict}>"

    def to_plain(self) -> dict[str, Any]:
        """Dictionary of the report that JSON can hold; numbers that are not finite become strings."""
        return {"passed": self.passed, "verdict": self.verdict, **plain_checks(self.subject, self.checks)}

    def diagnostics(self, file: str) -> tuple[Diagnostic, ...]:
        """IRL709 for every failed check; `file` is the stream's file name."""
        return tuple(
            report("IRL709", Place(file), check=check.name, finding=check.text or "it does not hold")
            for check in self.failed
        )
