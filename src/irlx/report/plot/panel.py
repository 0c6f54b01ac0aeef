"""One diagram of a figure: curves over time, their limits, where these bind."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from irlx.report.plot.curves import Curves, Track
from irlx.report.plot.move_marks import spaced_marks
from irlx.report.plot.quantity import Quantity

Array = NDArray[np.float64]

COLOURS, WIDTHS = ("#8a8a8a", "#14566e"), (2.0, 1.0)
"""Of two streams: the first is the ground that the second is seen against. They differ in lightness, so that
every eye and a print without colour tell them apart."""
ONE, LIMIT, INK = "#14566e", "#a02040", "#222222"
ACTIVE, SLOW, GRID = "#f3d3da", "#f6e3b4", "#eceff3"
DASHED: Any = (0, (6, 3))
HELD_AGAINST: dict[str, tuple[str, Any]] = {
    "programmed": ("#7a5200", (0, (3, 2))),
    "margin": ("#2e6b34", (0, (7, 2, 1.5, 2))),
}
"""Colour and dashes of what a curve of the whole robot is held against; of two streams their own colours."""
MOST_POINTS = 12_000
"""Points of a curve from which on those are left out that no page shows."""
MARKS_APART = 0.08
"""Least distance between marks of moves, inches."""
_LETTER, _ROOM = 0.056, 0.3
"""Of the number of a limit: width of a letter, inches; the part of a diagram's height that it needs."""
_REACH = 0.35
"""How far a limit may lie outside of a curve and still be drawn, as a part of the curve's range."""


def style_of(number: int, count: int) -> tuple[str, float]:
    """Colour and width of the curves of one stream among `count`."""
    return (ONE, 1.1) if count == 1 else (COLOURS[number], WIDTHS[number])


def thinned(t: Array, values: Array) -> tuple[Array, Array]:
    """A curve of N rows by fewer that look the same: of every k rows the first, the least, the greatest and
    the last. Curves of no more than `MOST_POINTS` rows stay as they are."""
    rows = len(t)
    if rows <= MOST_POINTS:
        return t, values
    each = -(-4 * rows // MOST_POINTS)
    begins = np.arange(0, rows, each)
    filled = np.where(np.isfinite(values), values, 0.0)
    filled = np.concatenate([filled, np.full(-rows % each, filled[-1])]).reshape(-1, each)
    picked = [begins, begins + filled.argmin(axis=1), begins + filled.argmax(axis=1), begins + each - 1]
    which = np.unique(np.minimum(np.concatenate(picked), rows - 1))
    return t[which], values[which]


def draw_joint(axes: Axes, all_curves: Sequence[Curves], quantity: Quantity, joint: int) -> None:
    """Curves of one quantity of a joint, its limits in force, and where it is at them."""
    count = len(all_curves)
    # A difference belongs to the whole tick before its row: drawn as steps.
    style = "default" if quantity is Quantity.POSITION else "steps-pre"
    seen = []
    for number, curves in enumerate(all_curves):
        colour, width = style_of(number, count)
        values = curves.values[quantity][:, joint]
        seen.append(values)
        axes.plot(
            *thinned(curves.t, values),
            color=colour,
            linewidth=width,
            drawstyle=style,
            solid_joinstyle="round",
            label=curves.name,
            gid=f"curve {number}",
            zorder=3.0 + 0.1 * number,
        )
        _mark_spans(axes, curves.spans(quantity, joint), number, count)
    barred = count > 1 and any(curves.spans(quantity, joint) for curves in all_curves)
    _set_range(axes, np.concatenate(seen), 0.3 if barred else 0.1)
    _draw_limits(axes, all_curves, quantity, joint)


def draw_track(axes: Axes, tracks: Sequence[Track | None], all_curves: Sequence[Curves]) -> None:
    """Curves of the robot as a whole, from zero on, and what they are held against."""
    count, highest = len(all_curves), 0.0
    for number, (track, curves) in enumerate(zip(tracks, all_curves, strict=True)):
        if track is None:
            continue
        colour, width = style_of(number, count)
        style: Any = "steps-pre" if track.stepped else "default"
        apart = track.apart
        held, dashes = HELD_AGAINST.get(track.bound_name, (INK, DASHED))
        if np.isfinite(apart).any():
            axes.plot(
                *thinned(track.t, apart),
                color=held if count == 1 else colour,
                linewidth=0.9,
                linestyle=dashes,
                drawstyle=style,
                gid=track.bound_name,
                zorder=2.5,
            )
            highest = max(highest, _greatest(apart))
        axes.plot(
            *thinned(track.t, track.values),
            color=colour,
            linewidth=width,
            drawstyle=style,
            label=curves.name,
            gid=f"curve {number}",
            zorder=3.0 + 0.1 * number,
        )
        highest = max(highest, _greatest(track.values))
        least = float(np.nanmin(track.values, initial=0.0))
        axes.set_ylim(bottom=min(axes.get_ylim()[0], 1.08 * least) if least < 0.0 else 0.0)
        if track.stepped:
            for begin, end in curves.slowed if number == count - 1 else ():
                axes.axvspan(begin, end, color=SLOW, linewidth=0.0, gid="slowed", zorder=0.5)
    axes.set_ylim(top=1.12 * highest if highest > 0.0 else 1.0)


def finish(axes: Axes, all_curves: Sequence[Curves], span: tuple[float, float], height: float) -> None:
    """Marks of moves, grid and ticks, as many as a diagram of a `height` (inches) has room for."""
    axes.set_xlim(*span)
    for mark in spaced_marks(all_curves[-1].moves, seconds(axes, MARKS_APART)):
        axes.axvline(mark.time, color="#555555", linewidth=0.6, linestyle=(0, (1, 2)), gid="move", zorder=1.5)
    axes.grid(True, color=GRID, linewidth=0.5)
    axes.set_axisbelow(True)
    axes.yaxis.set_major_locator(MaxNLocator(max(2, min(5, int(height / 0.24))), steps=[1, 2, 2.5, 5, 10]))
    axes.xaxis.set_major_locator(MaxNLocator(7))


def seconds(axes: Axes, inches: float) -> float:
    """Time, s, that so much of the width of a diagram stands for."""
    first, last = axes.get_xlim()
    return (last - first) * inches / _width(axes)


def _width(axes: Axes) -> float:
    """Width of a diagram, inches."""
    figure: Any = axes.figure
    return float(axes.get_position().width * figure.get_figwidth())


def _greatest(values: Array) -> float:
    finite = values[np.isfinite(values)]
    return float(finite.max()) if finite.size else 0.0


def _mark_spans(axes: Axes, spans: list[tuple[float, float]], number: int, count: int) -> None:
    """Where a joint is at a limit: shaded, or of two streams a bar of its own for each at the upper edge."""
    if count == 1:
        for begin, end in spans:
            axes.axvspan(begin, end, color=ACTIVE, linewidth=0.0, gid="active", zorder=0.5)
        return
    colour, _ = style_of(number, count)
    top = 0.97 - 0.07 * number
    for begin, end in spans:
        axes.axvspan(begin, end, top - 0.05, top, color=colour, linewidth=0.0, gid="active bar", zorder=4.0)


def _set_range(axes: Axes, values: Array, above: float) -> None:
    """Range of a diagram, with a part of it left free `above`. Joints that stand still get one as wide as
    their unit, not one of rounding."""
    least, most = float(values.min()), float(values.max())
    whole, smallest = most - least, max(0.5, 1e-9 * abs(most))
    axes.set_ylim(least - max(0.1 * whole, smallest), most + max(above * whole, smallest))


def _draw_limits(axes: Axes, all_curves: Sequence[Curves], quantity: Quantity, joint: int) -> None:
    """Limits in force, dashed. One far outside of the curves would flatten them: its value stands there."""
    low, high = axes.get_ylim()
    reach = _REACH * (high - low)
    shown, edges, far = [low, high], [low, high], ["", ""]
    lines: list[tuple[Array, Array, str]] = []
    for number, curves in enumerate(all_curves):
        times, *sides = curves.bounds[quantity].steps(joint)
        for side, values in enumerate(sides):
            near = (values >= low - reach) & (values <= high + reach)
            if near.any():
                drawn = np.where(near, values, np.nan)
                colour = LIMIT if number == len(all_curves) - 1 else COLOURS[number]
                known = any(_same_line((times, drawn), line[:2]) for line in lines)
                lines += [] if known and number == 0 else [(times, drawn, colour)]
                shown += [float(np.nanmin(drawn)), float(np.nanmax(drawn))]
            elif np.isfinite(values).any():
                edge = values[np.isfinite(values)]
                far[side] = f"{edge.max() if side == 0 else edge.min():.4g}".replace("-", "\N{MINUS SIGN}")
    for times, drawn, colour in lines:
        axes.plot(times, drawn, color=colour, linewidth=0.9, linestyle=DASHED, gid="limit", zorder=2.0)
    room = 0.06 * (high - low)
    edges = [min(low, min(shown) - room), max(high, max(shown) + room)]
    axes.set_ylim(*edges)
    shapes = [(curves.t, curves.values[quantity][:, joint]) for curves in all_curves]
    for side, words in enumerate(far):
        if words:
            arrow = "\N{UPWARDS ARROW}" if side else "\N{DOWNWARDS ARROW}"
            _write_far_limit(axes, f"{arrow} {words}", bool(side), shapes)


def _write_far_limit(axes: Axes, words: str, upper: bool, curves: Sequence[tuple[Array, Array]]) -> None:
    """The value of a limit that is not drawn, in the corner of its side, or halfway, where no curve is."""
    wide = _LETTER * len(words) / _width(axes)
    places = {1.0 - 0.5 * wide: "right", 0.5 * wide: "left", 0.5: "center"}
    rooms = {side: _room(axes, (at - wide, at + wide), upper, curves) for at, side in places.items()}
    side = next((side for side in rooms if rooms[side] >= _ROOM), max(rooms, key=rooms.__getitem__))
    at, shift = {"right": (1.0, -4.0), "left": (0.0, 4.0), "center": (0.5, 0.0)}[side]
    axes.annotate(
        words, (at, float(upper)), xycoords="axes fraction", xytext=(shift, -4.0 if upper else 4.0),
        textcoords="offset points", ha=side, va="top" if upper else "bottom", fontsize=6.0, color=LIMIT,
        bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.8, "alpha": 0.85},
        gid="far limit", zorder=3.5,
    )  # fmt: skip


def _room(axes: Axes, part: tuple[float, float], upper: bool, curves: Sequence[tuple[Array, Array]]) -> float:
    """Part of the height of a diagram that curves leave free at an edge, over a part of its width."""
    low, high = axes.get_ylim()
    first, last = min(float(t[0]) for t, _ in curves), max(float(t[-1]) for t, _ in curves)
    begin, end = (first + (last - first) * at for at in part)
    found = 1.0
    for t, values in curves:
        here = np.append(values[(t >= begin) & (t <= end)], np.interp([begin, end], t, values))
        heights = (here - low) / (high - low)
        found = min(found, float(np.min(1.0 - heights if upper else heights)))
    return found


def _same_line(one: tuple[Array, Array], other: tuple[Array, Array]) -> bool:
    return all(np.array_equal(a, b, equal_nan=True) for a, b in zip(one, other, strict=True))
