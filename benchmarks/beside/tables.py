"""The figures as tables, for a terminal and for a document."""

from __future__ import annotations

from statistics import median
from typing import Any

Figures = dict[str, Any]

REFERENCE = "Pink, daqp"
"""What others are compared with: of its two forms the faster one."""

PAIRS = (
    ("cyclic, of the plain run", "run, cyclic", "irlx, run to CSV"),
    ("slowed, per emitted tick, of the plain run", "run, slowed", "irlx, run to CSV"),
    ("links kept off each other, of the plain run", "run, links watched", "irlx, run to CSV"),
    ("pacer, n = 11 of n = 7", "pacer, n = 11 (koch11)", "pacer, n = 7 (arm7)"),
)
"""Quotients within irlx, at 1 kHz."""

HEADINGS = ("", "least us", "median us", "of Pink (DAQP)", "solves a tick", "worst error, m, rad")

Table = list[tuple[str, ...]]


def quotient(row: Figures, other: Figures) -> float:
    """Median over the rounds of the quotient within a round: a drift of the machine meets both."""
    return float(median(a / b for a, b in zip(row["cpu_us"], other["cpu_us"], strict=True)))


def reference(rows: dict[str, Figures]) -> Figures:
    """The row of Pink with DAQP with the least median."""
    found = [row for label, row in rows.items() if label.startswith(REFERENCE)]
    return min(found, key=lambda row: median(row["cpu_us"]))


def side_by_side(rows: dict[str, Figures]) -> Table:
    """Rows of irlx and of all others at one rate."""
    against = reference(rows)
    return [
        (
            label,
            f"{min(row['cpu_us']):.1f}",
            f"{median(row['cpu_us']):.1f}",
            f"{quotient(row, against):.2f}",
            f"{row['solves_per_tick']:.2f}",
            f"{row['position_error_m']:.2e}, {row['orientation_error_rad']:.2e}",
        )
        for label, row in rows.items()
        if not label.startswith(("run,", "pacer,"))
    ]


def within(rows: dict[str, Figures]) -> Table:
    """What options, limits and joints cost in irlx, at 1 kHz."""
    return [
        (
            name,
            *(f"{median(rows[one]['cpu_us']):.1f}" for one in (label, base)),
            f"{quotient(rows[label], rows[base]):.2f}",
        )
        for name, label, base in PAIRS
    ]


WITHIN_HEADINGS = ("", "median us", "compared with", "quotient")


def text(found: Figures) -> str:
    """Tables for a terminal."""
    parts = [about(found)]
    for rate, rows in found["rates"].items():
        parts.append(aligned([(rate, *HEADINGS[1:]), *side_by_side(rows)]))
    parts.append(aligned([("irlx, 1 kHz", *WITHIN_HEADINGS[1:]), *within(found["rates"]["1 kHz"])]))
    return "\n\n".join(parts)


def markdown(found: Figures) -> str:
    """Tables for docs/performance.md."""
    parts = [about(found)]
    for rate, rows in found["rates"].items():
        parts.append(piped([(rate, *HEADINGS[1:]), *side_by_side(rows)]))
    parts.append(piped([("irlx, 1 kHz", *WITHIN_HEADINGS[1:]), *within(found["rates"]["1 kHz"])]))
    return "\n\n".join(parts)


def about(found: Figures) -> str:
    """Where, when, of what, how often."""
    versions: dict[str, str] = {}
    for worker, told in found["versions"].items():
        versions |= {
            name if worker == "irlx" or name not in _TWICE else f"{name} of the others": number
            for name, number in told.items()
        }
    listed = ", ".join(f"{name} {number}" for name, number in versions.items())
    rounds = f"{found['rounds']} rounds of {found['simulated_s']:g} s of motion"
    return f"{found['date']}, {found['machine']}; {rounds}; {listed}."


_TWICE = {"pin", "numpy", "python"}
"""Packages of which irlx and the others may have another version each."""


def aligned(table: Table) -> str:
    """A table for a terminal."""
    widths = [max(len(cell) for cell in column) for column in zip(*table, strict=True)]
    lines = []
    for first, *cells in table:
        rest = "".join(f"  {cell:>{width}}" for cell, width in zip(cells, widths[1:], strict=True))
        lines.append(f"{first:<{widths[0]}}{rest}")
    return "\n".join(lines)


def piped(table: Table) -> str:
    """A table of Markdown."""
    head, *rows = table
    lines = [head, ("---", *["---:"] * (len(head) - 1)), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines)
