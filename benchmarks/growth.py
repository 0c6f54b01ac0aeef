"""How times and memory grow: with joints, lines of a program, length of a stream, obstacles, routines.

    python benchmarks/growth.py             measures, stores growth.json beside this file, prints a table
    python benchmarks/growth.py --only lines,obstacles    measures these anew, and keeps the others
    python benchmarks/growth.py --stored    measures nothing

In each case the table of docs/performance.md becomes that of what is stored; `python docs/pictures growth`
draws the picture.

Each point is measured in a process of its own, by computing time, the least of some rounds; memory is the
most that the process ever had beyond that of its imports. The exponent of a curve is the slope of the line
through its last three points when both axes are logarithmic: 1 is linear.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import sys
from collections.abc import Mapping
from datetime import date
from pathlib import Path

HERE = Path(__file__).resolve().parent
STORED = HERE / "growth.json"
DOCUMENT = HERE.parent / "docs" / "performance.md"
HEAD = "| grows | from | to | exponent |\n|---|---|---|---|\n"
FITTED = 3
"""Through how many of the last points the line goes that gives the exponent."""
POINTS: dict[str, tuple[int, ...]] = {
    "joints": (7, 11, 15, 20),
    "lines": (10, 100, 1_000, 10_000, 100_000),
    "routines": (10, 100, 1_000, 10_000),
    "seconds": (1, 10, 60, 600, 3_600),
    "obstacles": (1, 10, 100),
}
"""Where each curve is measured."""
Curve = list[tuple[int, float]]


def exponent(curve: Curve) -> float:
    """Slope of the last points of a curve, both axes logarithmic, by least squares.

    NaN for fewer than two points with a value above zero.
    """
    points = [(math.log(x), math.log(y)) for x, y in curve[-FITTED:] if y > 0.0]
    if len(points) < 2:
        return math.nan
    mean_x, mean_y = (sum(side) / len(points) for side in zip(*points, strict=True))
    over = sum((x - mean_x) * (y - mean_y) for x, y in points)
    return over / sum((x - mean_x) ** 2 for x, _ in points)


def measured(kind: str) -> dict[str, Curve]:
    """All curves of one kind by their name, unit behind a comma."""
    curves: dict[str, Curve] = {}
    for x in POINTS[kind]:
        command = [sys.executable, str(HERE / "growth_points.py"), kind, str(x)]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        for name, value in json.loads(done.stdout).items():
            curves.setdefault(name, []).append((x, float(f"{value:.4g}")))
        print(f"{kind} {x}", file=sys.stderr, flush=True)
    return curves


def rows(stored: Mapping[str, Mapping[str, Curve]]) -> list[tuple[str, str, str, str]]:
    """What grows with what, its first and last value, its exponent."""
    found = []
    for kind, curves in stored.items():
        for name, curve in curves.items():
            what, _, unit = name.rpartition(", ")
            ends = [f"{_told(value)} {unit} at {x:,}" for x, value in (curve[0], curve[-1])]
            found.append((f"{what} by {kind}", *ends, f"{exponent(curve):.2f}"))
    return found


def _told(value: float) -> str:
    """Three digits, and no exponent."""
    return f"{value:,.0f}" if value >= 999.5 else f"{value:.3g}"


def table(stored: Mapping[str, Mapping[str, Curve]]) -> str:
    """The rows as text."""
    return "\n".join(f"{row[0]:46}{row[1]:>24}{row[2]:>28}{row[3]:>8}" for row in rows(stored))


def with_table(text: str, stored: Mapping[str, Mapping[str, Curve]]) -> str:
    """A text of Markdown in which the table of growth has these rows. ValueError where it has none."""
    before, head, after = text.partition(HEAD)
    if not head:
        raise ValueError("the document has no table of growth")
    rest = after[after.index("\n\n") :]
    return before + head + "\n".join(f"| {' | '.join(row)} |" for row in rows(stored)) + rest


def main() -> None:
    """Measure and store, or print what is stored."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--stored", action="store_true", help="measure nothing")
    parser.add_argument("--only", default=",".join(POINTS), help="kinds to measure, commas between them")
    asked = parser.parse_args()
    before = json.loads(STORED.read_text(encoding="utf-8")) if STORED.exists() else {"curves": {}}
    if not asked.stored:
        found = {kind: measured(kind) for kind in asked.only.split(",")}
        curves = {kind: found.get(kind) or before["curves"].get(kind, {}) for kind in POINTS}
        exponents = {
            kind: {name: round(exponent(curve), 2) for name, curve in some.items()}
            for kind, some in curves.items()
        }
        before = {"date": date.today().isoformat(), "exponents": exponents, "curves": curves}
        STORED.write_text(json.dumps(before, indent=1) + "\n", encoding="utf-8")
    text = DOCUMENT.read_text(encoding="utf-8")
    DOCUMENT.write_text(with_table(text, before["curves"]), encoding="utf-8")
    print(table(before["curves"]))


if __name__ == "__main__":
    main()
