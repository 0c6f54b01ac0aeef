"""What a verification found: checks with their worst value and its place."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.diagnostics import Diagnostic, Place, report

OK = "ok"
FAILED = "failed"
NOT_CHECKED = "not checked"


@dataclass(frozen=True)
class Finding:
    """A value at a place: what is allowed there, tick, joint name (or None), block id and program line."""

    value: float
    allowed: float
    tick: int
    joint: str | None = None
    block: int = 0
    line: int | None = None

    def __str__(self) -> str:
        joint = f", joint {self.joint}" if self.joint is not None else ""
        line = f", line {self.line}" if self.line is not None else ""
        block = f", block {self.block}" if self.block else ""
        return f"{self.value:.10g} (allowed {self.allowed:.10g}) at tick {self.tick}{joint}{block}{line}"


@dataclass(frozen=True)
class Check:
    """One check: `status` is 'ok', 'failed' or 'not checked'.

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
class Report:
    """All checks of one stream, in a fixed order."""

    checks: tuple[Check, ...]

    @property
    def passed(self) -> bool:
        """Whether no check failed; those that could not be made do not count."""
        return not self.failed

    @property
    def failed(self) -> tuple[Check, ...]:
        """The checks that failed."""
        return tuple(check for check in self.checks if check.status == FAILED)

    @property
    def unchecked(self) -> tuple[Check, ...]:
        """The checks that could not be made, with the reason as detail."""
        return tuple(check for check in self.checks if check.status == NOT_CHECKED)

    def __getitem__(self, name: str) -> Check:
        """The check of a name; raises KeyError for a name that no check has."""
        for check in self.checks:
            if check.name == name:
                return check
        raise KeyError(name)

    def diagnostics(self, file: str) -> tuple[Diagnostic, ...]:
        """IRL709 for every failed check; `file` is the stream's file name."""
        return tuple(
            report("IRL709", Place(file), check=check.name, finding=check.text or "it does not hold")
            for check in self.failed
        )
