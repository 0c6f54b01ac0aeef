"""A verification report as a text table, and as plain data for JSON."""

from __future__ import annotations

from math import isfinite
from typing import Any

from irlx.verifier.report import Check, Finding, Report

_COLUMNS = ("check", "status", "worst", "allowed", "where")


def render_table(report: Report) -> str:
    """Table of all checks, one line each with the worst value and its place, then the findings in words."""
    rows = [_COLUMNS, *(_row(check) for check in report.checks)]
    widths = [max(len(row[column]) for row in rows) for column in range(len(_COLUMNS))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) for row in rows]
    lines.insert(1, "  ".join("-" * width for width in widths))
    notes = [f"{check.name}: {check.text}" for check in report.failed]
    notes += [
        f"{check.name}: {check.detail}" for check in report.checks if check.detail and check.status == "ok"
    ]
    notes += [f"{check.name} not checked: {check.detail}" for check in report.unchecked]
    verdict = "passed" if report.passed else f"FAILED: {len(report.failed)} of {len(report.checks)} checks"
    if report.passed and report.unchecked:
        verdict += f", {len(report.unchecked)} checks not made"
    return "\n".join(line.rstrip() for line in [*lines, "", *notes, verdict])


def _row(check: Check) -> tuple[str, ...]:
    worst = check.worst
    if worst is None:
        return check.name, check.status, "", "", ""
    unit = f" {check.unit}" if check.unit else ""
    place = [f"tick {worst.tick}"]
    if worst.joint is not None:
        place.append(f"joint {worst.joint}")
    if worst.line is not None:
        place.append(f"line {worst.line}")
    return check.name, check.status, f"{worst.value:.6g}{unit}", f"{worst.allowed:.6g}", ", ".join(place)


def to_plain(report: Report) -> dict[str, Any]:
    """Dictionary of a report that JSON can hold; numbers that are not finite become strings."""
    return {"passed": report.passed, "checks": [_check_to_plain(check) for check in report.checks]}


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
    }


def _number(value: float) -> float | str:
    return value if isfinite(value) else repr(value)
