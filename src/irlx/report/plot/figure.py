"""Curves as a figure of matplotlib: a row a joint, a column a quantity, wide rows for the whole robot."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from textwrap import wrap
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import GridSpec
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from irlx.report.plot.curves import Curves
from irlx.report.plot.move_marks import spaced_marks, told_marks
from irlx.report.plot.panel import (
    ACTIVE,
    COLOURS,
    DASHED,
    HELD_AGAINST,
    INK,
    LIMIT,
    MARKS_APART,
    SLOW,
    WIDTHS,
    draw_joint,
    draw_track,
    finish,
    seconds,
)
from irlx.report.plot.quantity import JOINT_QUANTITIES, QUANTITIES, Quantity
from irlx.report.plot.styled_figure import STYLE, StyledFigure
from irlx.streams.atomic import AtomicFile

PAGE_WIDTH = 10.0
"""Width of a figure where none is asked for, inches."""

_HEAD, _FOOT, _RIGHT, _GAP, _AXIS = 0.92, 0.44, 0.14, 0.13, 0.38
"""Room above, below and to the right of the diagrams, between rows, and for a time axis between; inches."""
_LETTER = 0.075
"""Width of a letter, inches."""
_NUMBERS_APART = 0.16
"""Least distance between program lines above the diagrams, inches."""
_TITLE = 0.18
"""Of the room above, what titles of columns take, inches."""
_JOINTS_HEIGHT, _TALLEST, _LOWEST = 9.0, 1.3, 0.56
_TRACK, _LOW_TRACK = 1.0, 0.72
"""Height of all rows of joints, most and least of one of them, that of a wide row; inches."""


@dataclass(frozen=True)
class _Page:
    """Sizes of a page in inches: `joints` rows of diagrams of joints, `tracks` wide ones below them."""

    width: float
    left: float
    joints: int
    tracks: int
    joint_height: float
    track_height: float

    @property
    def apart(self) -> float:
        """Room between the joints and what is below them, for the time axis."""
        return _AXIS if self.joints and self.tracks else 0.0

    @property
    def head(self) -> float:
        """Height of what stands above the diagrams; those of joints have titles."""
        return _HEAD if self.joints else _HEAD - _TITLE

    @property
    def height(self) -> float:
        """Height of the page."""
        return self.head + _FOOT + self.joints_height + self.apart + _stacked(self.tracks, self.track_height)

    @property
    def joints_height(self) -> float:
        """Height of all diagrams of joints."""
        return _stacked(self.joints, self.joint_height)


def _stacked(rows: int, height: float) -> float:
    return rows * height + max(rows - 1, 0) * _GAP


def draw_figure(all_curves: Sequence[Curves], joints: Sequence[int], width: float | None = None) -> Figure:
    """Figure of one stream, or of two over each other; `joints` from 0, `width` in mm.

    Drawn is what the curves have. All of them have the same joints.
    """
    first = all_curves[0]
    quantities = [quantity for quantity in JOINT_QUANTITIES if quantity in first.values] if joints else []
    rows = len(joints) if quantities else 0
    tracks = _tracks(all_curves)
    mixed = len({first.units[joint] for joint in joints}) > 1
    labels = [_label(first, joint, mixed) for joint in joints] if rows else []
    page = _page(labels, rows, len(tracks), PAGE_WIDTH if width is None else width / 25.4)
    with mpl.rc_context(STYLE):
        figure = StyledFigure(figsize=(page.width, page.height))
        span = _time_span(all_curves)
        upper, lower = _grids(figure, page, len(quantities))
        made: list[list[Axes]] = []
        for row in range(rows):
            made.append([figure.add_subplot(upper[row, column]) for column in range(len(quantities))])
            for axes, quantity in zip(made[-1], quantities, strict=True):
                draw_joint(axes, all_curves, quantity, joints[row])
                finish(axes, all_curves, span, page.joint_height)
            _name_row(made[-1][0], labels[row], page)
        for row, (title, key) in enumerate(tracks):
            axes = figure.add_subplot(lower[row, 0])
            made.append([axes])
            draw_track(axes, [_track(curves, *key) for curves in all_curves], all_curves)
            finish(axes, all_curves, span, page.track_height)
            _name_row(axes, title, page)
        titles = [_column_title(first, quantity, joints) for quantity in quantities]
        _finish_page(figure, made, all_curves, page, titles)
    return figure


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure in the format of the path's ending, whole or not at all: the same figure gives the same
    bytes.

    Raises StreamError, IRL003, where the file cannot be written.
    """
    with AtomicFile(path) as file:
        figure.savefig(file.handle, format=path.suffix[1:].lower())


def _label(curves: Curves, joint: int, mixed: bool) -> str:
    name = curves.joint_names[joint]
    return f"{name}, {curves.units[joint]}" if mixed else name


def _column_title(curves: Curves, quantity: Quantity, joints: Sequence[int]) -> str:
    units = dict.fromkeys(curves.units[joint] for joint in joints)
    return f"{quantity.value}, " + " or ".join(f"{unit}{quantity.per}" for unit in units)


def _tracks(all_curves: Sequence[Curves]) -> list[tuple[str, tuple[Quantity, str]]]:
    """Labels of the wide rows, and which track of any of the streams each shows."""
    found: dict[tuple[Quantity, str], str] = {}
    for quantity in QUANTITIES:
        for curves in all_curves:
            for track in curves.tracks.get(quantity, ()):
                unit = f", {track.unit}" if track.unit else ""
                found.setdefault((quantity, track.title), f"{track.title}{unit}")
    return [(label, key) for key, label in found.items()]


def _track(curves: Curves, quantity: Quantity, title: str) -> Any:
    return next((track for track in curves.tracks.get(quantity, ()) if track.title == title), None)


def _page(labels: Sequence[str], rows: int, tracks: int, width: float) -> _Page:
    longest = max((len(label) for label in labels), default=0)
    left = 0.62 + max(_LETTER * longest, 1.0 if tracks else 0.3)
    height = min(max(_JOINTS_HEIGHT / max(rows, 1) - _GAP, _LOWEST), _TALLEST)
    return _Page(width, left, rows, tracks, height, max(_LOW_TRACK, min(height, _TRACK)))


def _grids(figure: Figure, page: _Page, columns: int) -> tuple[GridSpec, GridSpec]:
    """Places of the diagrams of joints, and of the wide ones below them."""
    height = page.height
    below = 1.0 - (page.head + page.joints_height) / height
    sides = {"left": page.left / page.width, "right": 1.0 - _RIGHT / page.width}
    upper = figure.add_gridspec(
        max(page.joints, 1),
        max(columns, 1),
        **sides,
        top=1.0 - page.head / height,
        bottom=below if page.joints else 0.5,
        hspace=_GAP / page.joint_height,
        wspace=0.2,
    )
    lower = figure.add_gridspec(
        max(page.tracks, 1),
        1,
        **sides,
        top=below - page.apart / height if page.tracks else 0.5,
        bottom=_FOOT / height if page.tracks else 0.0,
        hspace=_GAP / page.track_height,
    )
    return upper, lower


def _time_span(all_curves: Sequence[Curves]) -> tuple[float, float]:
    """Times that all of the curves lie within, s."""
    first = min(float(curves.t[0]) for curves in all_curves)
    last = max(float(curves.t[-1]) for curves in all_curves)
    return (first, last) if last > first else (first - 0.5, last + 0.5)


def _name_row(axes: Axes, name: str, page: _Page) -> None:
    """Name of a row at the left edge of the page, halfway up, broken where it is long."""
    words = "\n".join(wrap(name, int((page.left - 0.45) / _LETTER), break_long_words=False))
    box = axes.get_position()
    axes.figure.text(0.1 / page.width, 0.5 * (box.y0 + box.y1), words, va="center", color=INK)


def _finish_page(
    figure: Figure, made: list[list[Axes]], all_curves: Sequence[Curves], page: _Page, titles: list[str]
) -> None:
    """Heading, legend, column titles, program lines above the first row, the time axis below the last."""
    for number, row in enumerate(made, 1):
        for axes in row:
            axes.tick_params(labelbottom=number in (page.joints, len(made)))
    for axes in made[-1]:
        axes.set_xlabel("time, s", labelpad=2.0)
    for axes, title in zip(made[0], titles, strict=False):
        axes.set_title(title, fontsize=8.5, pad=14.0)
    for axes in made[0]:
        _number_lines(axes, all_curves[-1])
    height = page.height
    at = page.left / page.width
    figure.text(at, 1.0 - 0.2 / height, _heading(all_curves), fontsize=9.5, va="center", color=INK)
    figure.legend(
        handles=_legend(all_curves, made),
        loc="center left",
        bbox_to_anchor=(at, 1.0 - 0.43 / height),
        bbox_transform=figure.transFigure,
        ncols=9,
        frameon=False,
        borderaxespad=0.0,
        borderpad=0.0,
        handlelength=1.8,
        handletextpad=0.5,
        columnspacing=1.4,
        fontsize=8.0,
    )


def _heading(all_curves: Sequence[Curves]) -> str:
    if len(all_curves) > 1:
        names = " and ".join(curves.name for curves in all_curves)
        return f"{names} · {all_curves[0].robot}"
    curves = all_curves[0]
    state = "" if curves.complete else ", not complete"
    return f"{curves.title}{state} · {curves.robot}"


def _legend(all_curves: Sequence[Curves], made: list[list[Axes]]) -> list[Any]:
    """What each kind of line and shade stands for, those that are on the page."""
    shown = {artist.get_gid() for row in made for axes in row for artist in axes.get_children()}
    found: list[Any] = []
    if len(all_curves) > 1:
        styles = zip(all_curves, COLOURS, WIDTHS, strict=False)
        found += [Line2D([], [], color=colour, lw=w, label=curves.name) for curves, colour, w in styles]
    if "limit" in shown:
        found.append(Line2D([], [], color=LIMIT, lw=0.9, ls=DASHED, label="limit in force"))
    for name, (own, dashes) in HELD_AGAINST.items():
        if name in shown:
            colour = own if len(all_curves) == 1 else INK
            found.append(Line2D([], [], color=colour, lw=0.9, ls=dashes, label=name))
    if "active" in shown:
        found.append(Patch(facecolor=ACTIVE, label="at or near a limit"))
    if "active bar" in shown:
        found.append(Line2D([], [], color=INK, lw=3.0, label="bar: at or near a limit"))
    if "slowed" in shown:
        found.append(Patch(facecolor=SLOW, label="slower than programmed"))
    if any(curves.moves for curves in all_curves):
        found.append(
            Line2D([], [], color="#555555", lw=0.7, ls=(0, (1, 2)), label="move begins, its line above")
        )
    return found


def _number_lines(axes: Axes, curves: Curves) -> None:
    """Program lines above the marks of moves, as there is room; one for moves of the same line."""
    marks = spaced_marks(curves.moves, seconds(axes, MARKS_APART))
    for mark in told_marks(marks, seconds(axes, _NUMBERS_APART)):
        axes.annotate(
            str(mark.line),
            (mark.time, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(0.0, 2.5),
            textcoords="offset points",
            ha="center",
            fontsize=6.5,
            color="#555555",
        )
