"""Draws docs/pictures/growth.png: how times and memory grow, as benchmarks/growth.json has it.

python docs/pictures/draw_growth.py    (needs matplotlib; `python benchmarks/growth.py` measures anew)
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

HERE = Path(__file__).resolve().parent
STORED = HERE.parents[1] / "benchmarks" / "growth.json"
COLOURS = ("#14566e", "#c2571a", "#6f8f2a", "#8a4f9e")
GUIDE = "#9a9a9a"
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.linewidth": 0.6,
    "xtick.direction": "in",
    "ytick.direction": "in",
}
ROOM = 0.62
"""Part of the height, in decades, that the legend has above the curves."""


@dataclass(frozen=True)
class Panel:
    """One picture: its title, what the axes are called, and its curves, 'kind: name', by their labels."""

    title: str
    x: str
    y: str
    curves: Mapping[str, str]


PANELS = (
    Panel(
        "A tick, by joints",
        "joints",
        "µs a tick",
        {
            "least motion": "joints: tick, least motion, us",
            "return": "joints: tick, cyclic, us",
            "slowed": "joints: tick, slowed, us",
        },
    ),
    Panel(
        "A tick, by obstacles",
        "obstacles",
        "µs a tick",
        {"far away": "obstacles: tick, far, us", "all felt": "obstacles: tick, felt, us"},
    ),
    Panel(
        "A program, by procedures",
        "procedures",
        "s",
        {"check": "routines: check, s", "run": "routines: run, s"},
    ),
    Panel(
        "A program, by lines",
        "lines",
        "s",
        {
            "check": "lines: check, s",
            "check --motion": "lines: check --motion, s",
            "run, nothing moves": "lines: run, computing, s",
            "run, 1 of 21 moves": "lines: run, moving, s",
        },
    ),
    Panel(
        "A stream at 1 kHz, by length",
        "s of stream",
        "s",
        {
            "write IRDATA": "seconds: write .irdata, s",
            "read": "seconds: read .irdata, s",
            "verify": "seconds: verify .irdata, s",
            "verify CSV": "seconds: verify .csv, s",
        },
    ),
    Panel(
        "Memory beyond that of imports",
        "lines | s of stream",
        "MB",
        {
            "check, by lines": "lines: check, memory, MB",
            "run, by lines": "lines: run, memory, MB",
            "verify, by s of stream": "seconds: memory, MB",
        },
    ),
)


def draw(stored: Mapping[str, Any]) -> None:
    """Write the figure."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(10.0, 6.4), layout="constrained")
        for axes, panel in zip(figure.subplots(2, 3).ravel(), PANELS, strict=True):
            fill(axes, panel, stored)
        figure.savefig(HERE / "growth.png", dpi=100, facecolor="white")


def fill(axes: Axes, panel: Panel, stored: Mapping[str, Any]) -> None:
    """The curves of a picture, each with its exponent, beside a line with 1."""
    spans = []
    for (label, where), colour in zip(panel.curves.items(), COLOURS, strict=False):
        kind, _, name = where.partition(": ")
        x, y = np.array(stored["curves"][kind][name], dtype=float).T
        told = f"{label}  $\\propto x^{{{stored['exponents'][kind][name]:.2f}}}$"
        # Of a short program no memory may be left to see, which has no place in these axes.
        x, y = x[y > 0.0], y[y > 0.0]
        axes.loglog(x, y, "o-", color=colour, linewidth=1.4, markersize=3.6, label=told)
        spans.append((x.min(), x.max(), y.min(), y.max()))
    starts, ends, lows, highs = zip(*spans, strict=True)
    left, right, low, high = min(starts), max(ends), min(lows), max(highs)
    if "|" not in panel.x:
        # Twice as long for twice as much.
        axes.plot([left, right], [low, low * right / left], "--", color=GUIDE, linewidth=0.8, zorder=1)
    decades = np.log10(high / low)
    axes.set_ylim(low * 10 ** (-0.08 * decades), high * 10 ** (ROOM * max(decades, 0.6)))
    axes.set_title(panel.title, fontsize=10.0, loc="left")
    axes.set_xlabel(panel.x)
    axes.set_ylabel(panel.y)
    axes.grid(linewidth=0.3, color="#d8d8d8")
    plain = FuncFormatter(lambda value, _: f"{value / 1000:g}k" if value >= 10_000 else f"{value:,g}")
    axes.xaxis.set_major_formatter(plain)
    axes.yaxis.set_major_formatter(plain)
    if decades < 2.0:
        axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.yaxis.set_minor_formatter(NullFormatter())
    if panel.x == "joints":
        joints = [x for x, _ in stored["curves"]["joints"]["tick, least motion, us"]]
        axes.set_xticks(joints, [str(x) for x in joints])
        axes.xaxis.set_minor_formatter(NullFormatter())
    axes.legend(loc="upper left", frameon=False, fontsize=8.0, handlelength=1.6, labelspacing=0.25)


def main() -> None:
    """Draw what is stored."""
    draw(json.loads(STORED.read_text(encoding="utf-8")))


if __name__ == "__main__":
    main()
