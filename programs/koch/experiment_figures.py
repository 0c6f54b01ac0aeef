"""Joint curves of an experiment: position, speed and acceleration over time, one row of diagrams a joint.

A distance that an experiment is about has a row of its own below them.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from experiment_facts import SLIDE, Experiment, Ranges, Variant, values
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import irlx

COLOURS = ("#8a8a8a", "#14566e", "#c2571a")
WIDTHS = (1.6, 1.0, 0.8)
"""Of the variants: the first is the ground the others are seen against."""
LIMIT = "#a02040"
KINDS = ("position", "speed", "acceleration")
PER = ("", "/s", "/s²")
ROW, WIDTH, HEAD, FOOT = 1.35, 10.0, 0.75, 0.45
"""Height of a row, width of a page, room above and below, inches."""
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 8.0,
    "axes.linewidth": 0.6,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "axes.unicode_minus": True,
    "svg.hashsalt": "irlx",
}


def draw_experiment(
    name: str,
    experiment: Experiment,
    runs: Sequence[irlx.Run],
    joints: Sequence[int],
    window: tuple[float, float] | None,
    picture: Path,
) -> None:
    """Draw the joints (numbered from 1) of all variants into `picture`, PNG or SVG by its ending.

    `window` is the first and last second shown, None for the whole run.
    """
    first, last = window or (0.0, float(runs[0].t[-1]))
    with mpl.rc_context(STYLE):
        count = len(joints) + (experiment.distance is not None)
        height = HEAD + FOOT + ROW * count
        figure = Figure(figsize=(WIDTH, height))
        diagrams = figure.subplots(count, 3, sharex=True, squeeze=False)
        shown = [[values(rows) for rows in (run.q, run.qd, run.qdd)] for run in runs]
        for row, joint in zip(diagrams, joints, strict=False):
            for kind, axes in enumerate(row):
                curves = [rows[kind][:, joint - 1] for rows in shown]
                axes.set_xlim(first, last)
                draw_curves(axes, runs, curves, kind)
                draw_limits(axes, experiment.variants, joint - 1, kind)
                draw_stops(axes, runs)
            row[0].set_ylabel(f"joint {joint}")
        for kind, axes in enumerate(diagrams[0]):
            slide_only = all(joint - 1 == SLIDE for joint in joints)
            units = f"mm{PER[kind]}" if slide_only else f"deg{PER[kind]}"
            if not slide_only and SLIDE + 1 in joints:
                units += f"; joint 10 mm{PER[kind]}"
            axes.set_title(f"{KINDS[kind]}, {units}", fontsize=8.5)
        for axes in diagrams[-1]:
            axes.set_xlabel("time, s")
        if experiment.distance is not None:
            draw_distance(diagrams[-1], diagrams[-2], experiment, runs)
        add_heading(figure, name, experiment, runs, height)
        figure.subplots_adjust(0.075, FOOT / height, 0.985, 1.0 - HEAD / height, 0.19, 0.16)
        metadata = {"Date": None} if picture.suffix == ".svg" else {}
        figure.savefig(picture, dpi=110, metadata=metadata)


def draw_curves(axes: Axes, runs: Sequence[irlx.Run], curves: Sequence[np.ndarray], kind: int) -> None:
    """One curve a variant. A difference belongs to the whole tick before its sample: drawn as steps."""
    for run, curve, colour, width in zip(runs, curves, COLOURS, WIDTHS, strict=False):
        style = "default" if kind == 0 else "steps-pre"
        axes.plot(run.t, curve, color=colour, linewidth=width, drawstyle=style, solid_joinstyle="round")
    first, last = axes.get_xlim()
    seen = np.concatenate(
        [curve[(run.t >= first) & (run.t <= last)] for run, curve in zip(runs, curves, strict=True)]
    )
    least, most = float(seen.min()), float(seen.max())
    # Joints that stand still get a window as wide as their unit, not one of rounding errors.
    margin = max(0.08 * (most - least), 0.5)
    axes.set_ylim(least - margin, most + margin)
    axes.set_xlim(first, last)
    axes.grid(True, color="#eceff3", linewidth=0.5)


def draw_distance(
    row: Sequence[Axes], above: Sequence[Axes], experiment: Experiment, runs: Sequence[irlx.Run]
) -> None:
    """One wide diagram in the place of a row: the distance of all variants, and what is to be kept."""
    assert experiment.distance is not None
    place = row[0].get_subplotspec()
    for axes in above:
        axes.tick_params(labelbottom=True)
    for axes in row[1:]:
        axes.remove()
    row[0].set_subplotspec(place.get_gridspec()[place.rowspan.start, :])
    draw_curves(row[0], runs, [experiment.distance(run) for run in runs], 0)
    row[0].axhline(0.0, color="#555555", linewidth=0.6)
    row[0].axhline(experiment.kept, color=LIMIT, linewidth=0.8, linestyle=(0, (6, 3)))
    row[0].set_ylabel("distance, mm")


def draw_limits(axes: Axes, variants: Sequence[Variant], joint: int, kind: int) -> None:
    """Dashed lines at the limits of the variants, in the colour of the first variant that has them.

    A limit far outside the curves is left out: it would flatten them. Where one lies just outside, the window
    grows to show it.
    """
    drawn: set[float] = set()
    low, high = axes.get_ylim()
    reach = 0.25 * (high - low)
    for index, variant in enumerate(variants):
        ranges: Ranges | None = (variant.position, variant.speed, variant.acceleration)[kind]
        for bound in ranges[joint] if ranges else ():
            if bound in drawn or not low - reach <= bound <= high + reach:
                continue
            drawn.add(bound)
            colour = LIMIT if index == 0 else COLOURS[index]
            axes.axhline(bound, color=colour, linewidth=0.8, linestyle=(0, (6, 3)))
    if drawn:
        room = 0.04 * (high - low)
        axes.set_ylim(min(low, min(drawn) - room), max(high, max(drawn) + room))


def draw_stops(axes: Axes, runs: Sequence[irlx.Run]) -> None:
    """Dotted lines where a move of the first variant ends and the tool stands."""
    block = runs[0].block
    for tick in np.flatnonzero(np.diff(block) != 0)[1:]:
        axes.axvline(float(runs[0].t[tick]), color="#555555", linewidth=0.6, linestyle=(0, (1, 2)))


def add_heading(
    figure: Figure, name: str, experiment: Experiment, runs: Sequence[irlx.Run], height: float
) -> None:
    """Title, and what each colour and line stands for."""
    tick = 1000.0 * float(runs[0].t[1] - runs[0].t[0])
    title = f"Experiment {name}: {experiment.title}; tick {tick:g} ms"
    figure.text(0.075, 1.0 - 0.2 / height, title, fontsize=9.5, va="center")
    x = 0.075
    y = 1.0 - 0.41 / height
    for variant, colour in zip(experiment.variants, COLOURS, strict=False):
        figure.text(x, y, f"━ {variant.label}", color=colour, fontsize=8.5, va="center")
        x += 0.045 + 0.0075 * len(variant.label)
    figure.text(x, y, "– – limits     ⋯ stops", color=LIMIT, fontsize=8.5, va="center")
