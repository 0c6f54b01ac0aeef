"""What a verification found: checks with their worst value and its place."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from irlx.diagnostics import Diagnostic, Place, report

OK = "ok"
FAILED = "failed"
NOT_CHECKED = "not checked"
NO_CASE = "no case"


@dataclass(frozen=True)
class Finding:
    """A value at a place: what is allowed there, tick, joint name (or None), block id, program line, unit."""

    value: float
    allowed: float
    tick: int
    joint: str | None = None
    block: int = 0
    line: int | None = None
    unit: str = ""

    def __str__(self) -> str:
        joint = f", joint {self.joint}" if self.joint is not None else ""
        line = f", line {self.line}" if self.line is not None else ""
        block = f", block {self.block}" if self.block else ""
        unit = f" {self.unit}" if self.unit else ""
        value = f"{self.value:.10g}{unit} (allowed {self.allowed:.10g})"
        return f"{value} at tick {self.tick}{joint}{block}{line}"


@dataclass(frozen=True)
class Check:
    """One check: `status` is 'ok', 'failed', 'not checked' (why is in `detail`), or 'no case' where the
    stream holds nothing that the check is about.

    `worst` is the value nearest to, or furthest beyond, what is allowed; `first` the first offence of a
    failed check, in order of ticks; `unit` that of both; `detail` says in words what numbers cannot.
    """

    name: str
    status: str
    unit: str = ""
    worst: Finding | None = None
    first: Finding | None = None
    detail: str = ""

    @property
    def text(self) -> str:
        """The finding in words: first offence, worst value, detail."""
        parts = []
        if self.first is not None:
            parts.append(f"first {self.first}")
        if self.worst is not None and self.worst != self.first:
            parts.append(f"worst {self.worst}")
        return "; ".join([*parts, *([self.detail] if self.detail else [])])


@dataclass(frozen=True)
class Subject:
    """What was verified: `name` of the file, or of the program of a run; program, robot, samples, tick in ns.

    Nothing but the name is known of a file whose header cannot be read.
    """

    name: str
    program: str = ""
    robot: str = ""
    samples: int = 0
    tick_ns: int = 0

    @property
    def duration(self) -> float:
        """Time of the last sample, s."""
        return max(self.samples - 1, 0) * self.tick_ns / 1e9


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

    def __str__(self) -> str:
        from irlx.verifier.table import render_table

        return render_table(self)

    def __repr__(self) -> str:
        from irlx.verifier.table import verdict

        return f"<Report of {self.subject.name or 'a stream'}: {verdict(self)}>"

    def to_plain(self) -> dict[str, Any]:
        """Dictionary of the report that JSON can hold; numbers that are not finite become strings."""
        from irlx.verifier.table import to_plain

        return to_plain(self)

    def diagnostics(self, file: str) -> tuple[Diagnostic, ...]:
        """IRL709 for every failed check; `file` is the stream's file name."""
        return tuple(
            report("IRL709", Place(file), check=check.name, finding=check.text or "it does not hold")
            for check in self.failed
        )
