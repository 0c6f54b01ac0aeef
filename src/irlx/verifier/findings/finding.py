"""What one check found: the worst value, the first offence, and where."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.diagnostics import told_apart

OK = "ok"
FAILED = "failed"
NOT_CHECKED = "not checked"
NO_CASE = "no case"


@dataclass(frozen=True)
class Finding:
    """A value at a place: what is allowed there, tick, joint name (or None), block id, program line, unit.

    `pair` names two bodies where the value is a distance between them, `constraint` that of the cell which
    the value is of.
    """

    value: float
    allowed: float
    tick: int
    joint: str | None = None
    block: int = 0
    line: int | None = None
    unit: str = ""
    pair: str | None = None
    constraint: str | None = None

    def __str__(self) -> str:
        joint = f", joint {self.joint}" if self.joint is not None else ""
        joint += f", {self.pair}" if self.pair is not None else ""
        joint += f", {self.constraint}" if self.constraint is not None else ""
        line = f", line {self.line}" if self.line is not None else ""
        block = f", block {self.block}" if self.block else ""
        unit = f" {self.unit}" if self.unit else ""
        value, allowed = told_apart(self.value, self.allowed, digits=10)
        return f"{value}{unit} (allowed {allowed}) at tick {self.tick}{joint}{block}{line}"


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
