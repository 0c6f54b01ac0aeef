"""A verification report as a text table, and as plain data for JSON."""

from __future__ import annotations

from math import isfinite
from typing import Any

from irlx.diagnostics import told_apart
from irlx.verifier.findings.finding import FAILED, NO_CASE, NOT_CHECKED, OK, Check, Finding, Subject

_STATUSES = (OK, FAILED, NOT_CHECKED, NO_CASE)
_COLUMNS = ("check", "status", "worst", "allowed", "where")


def text_table(subject: Subject, checks: tuple[Check, ...]) -> str:
    """Table of all checks, one line each with the worst value and its place, then the findings in words."""
    rows = [_COLUMNS, *(_row(check) for check in checks)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(_COLUMNS))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    lines.insert(1, "  ".join("-" * width for width in widths))
    notes = [f"{check.name}: {check.text}" for check in checks if check.status == FAILED]
    notes += [f"{check.name}: {check.detail}" for check in checks if check.detail and check.status == OK]
    text = [_title(subject), *lines, "", *notes, *_unmade(checks), verdict_of(checks)]
    return "\n".join(printable(line).rstrip() for line in text)


def printable(text: str) -> str:
    """The text with control characters, which names in a stream may hold, written as escapes."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


def verdict_of(checks: tuple[Check, ...]) -> str:
    """One line: how many checks passed, failed, could not be made, and had no case."""
    count = {status: sum(check.status == status for check in checks) for status in _STATUSES}
    made = count[OK] + count[FAILED]
    parts = [f"FAILED: {count[FAILED]} of {made} checks" if count[FAILED] else f"{made} checks passed"]
    if count[NOT_CHECKED]:
        parts.append(f"{count[NOT_CHECKED]} not made")
    if count[NO_CASE]:
        parts.append(f"{count[NO_CASE]} without a case")
    return ", ".join(parts)


def _title(subject: Subject) -> str:
    words = [subject.name or "stream"]
    if subject.tick_ns:
        words.append(
            f"{subject.samples} samples, {subject.duration:.6g} s in ticks of {subject.tick_ns / 1e6:g} ms"
        )
        words.append(f"program {subject.program}, robot {subject.robot}")
    return ": ".join([words[0], "; ".join(words[1:])]) if len(words) > 1 else words[0]


def _unmade(checks: tuple[Check, ...]) -> list[str]:
    """Why checks were not made, each reason once with the names it holds for."""
    reasons: dict[str, list[str]] = {}
    for check in checks:
        if check.status != NOT_CHECKED:
            continue
        reasons.setdefault(check.detail, []).append(check.name)
    return [f"not checked, since {why}: {', '.join(names)}" for why, names in reasons.items()]


def _row(check: Check) -> tuple[str, ...]:
    worst = check.worst
    status = "FAILED" if check.status == FAILED else check.status
    if worst is None:
        return check.name, status, "", "", ""
    unit = f" {worst.unit}" if worst.unit else ""
    place = [f"tick {worst.tick}"]
    if worst.joint is not None:
        place.append(f"joint {worst.joint}")
    if worst.pair is not None:
        place.append(worst.pair)
    if worst.constraint is not None:
        place.append(worst.constraint)
    if worst.line is not None:
        place.append(f"line {worst.line}")
    if check.status == FAILED:
        value, allowed = told_apart(worst.value, worst.allowed)
    else:
        value, allowed = f"{worst.value:.6g}", f"{worst.allowed:.6g}"
    return check.name, status, f"{value}{unit}", allowed, ", ".join(place)


def plain_checks(subject: Subject, checks: tuple[Check, ...]) -> dict[str, Any]:
    """Stream and checks of a report as plain data."""
    return {
        "stream": {
            "name": subject.name,
            "program": subject.program,
            "robot": subject.robot,
            "samples": subject.samples,
            "duration": subject.duration,
        },
        "checks": [_check_to_plain(check) for check in checks],
    }


def _check_to_plain(check: Check) -> dict[str, Any]:
    return {
        "name": check.name,
        "status": check.status,
        "unit": check.unit,
        "worst": _finding_to_plain(check.worst),
        "first": _finding_to_plain(check.first),
        "detail": check.detail,
    }


def _finding_to_plain(finding: Finding | None) -> dict[str, Any] | None:
    if finding is None:
        return None
    return {
        "value": _number(finding.value),
        "allowed": _number(finding.allowed),
        "tick": finding.tick,
        "joint": finding.joint,
        "block": finding.block,
        "line": finding.line,
        "unit": finding.unit,
        **({} if finding.pair is None else {"pair": finding.pair}),
        **({} if finding.constraint is None else {"constraint": finding.constraint}),
    }


def _number(value: float) -> float | str:
    return value if isfinite(value) else repr(value)
