"""Curves as text: braille dots, for a terminal or a file, with or without colour."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from textwrap import wrap

import numpy as np
from numpy.typing import NDArray
from plotille import Canvas

from irlx.report.plot.curves import Curves, MoveMark, Track
from irlx.report.plot.move_marks import spaced_marks
from irlx.report.plot.quantity import JOINT_QUANTITIES, QUANTITIES, Quantity
from irlx.report.stretches import stretches

Array = NDArray[np.float64]

MOST_JOINTS = 4
"""Joints that are drawn where none are named."""

_HEIGHT, _LABEL, _GAP, _LEAST = 5, 8, 2, 28
"""Lines of a diagram; columns of its scale, between two of them, and of the narrowest, its scale included."""
_REACH = 0.35
_SOLID, _DASHED, _DOTTED = (1, 1), (4, 6), (1, 3)
_COLOURS = ("\x1b[33m", "\x1b[36m")
_LIMIT, _FAINT, _PLAIN = "\x1b[31m", "\x1b[2m", "\x1b[0m"


class _Pen:
    """Colours text, or leaves it as it is."""

    def __init__(self, coloured: bool) -> None:
        self._coloured = coloured

    def write(self, words: str, colour: str) -> str:
        return f"{colour}{words}{_PLAIN}" if self._coloured and words.strip() else words


def terminal_text(
    all_curves: Sequence[Curves], joints: Sequence[int], width: int, *, coloured: bool = False
) -> str:
    """Diagrams of one stream, or of two over each other, `width` columns wide; `joints` from 0.

    Limits in force are broken lines. The time axis of a diagram is heavy where the joint is at a limit, or
    the tool slower than programmed, and has a mark where a motion begins; below it are their program lines.
    """
    pen, first = _Pen(coloured), all_curves[0]
    quantities = [quantity for quantity in JOINT_QUANTITIES if quantity in first.values] if joints else []
    columns = max(1, min(len(quantities), (width + _GAP) // (_LEAST + _GAP)))
    each = (width - _GAP * (columns - 1)) // columns
    lines = _heading(all_curves, pen, width)
    for joint in joints:
        panels = [_joint_panel(all_curves, quantity, joint, each, pen) for quantity in quantities]
        for start in range(0, len(panels), columns):
            lines += _beside(panels[start : start + columns], each)
    for quantity in QUANTITIES:
        titles = dict.fromkeys(
            track.title for curves in all_curves for track in curves.tracks.get(quantity, ())
        )
        for title in titles:
            tracks = [
                next((track for track in curves.tracks.get(quantity, ()) if track.title == title), None)
                for curves in all_curves
            ]
            lines += _pad(_track_panel(all_curves, tracks, width, pen), width)
    return "\n".join(line.rstrip() for line in lines)


def _heading(all_curves: Sequence[Curves], pen: _Pen, width: int) -> list[str]:
    first = all_curves[0]
    if len(all_curves) == 1:
        words = f"{first.title}, {first.robot}" + ("" if first.complete else ", INCOMPLETE")
        return wrap(words, width)
    broken, solid = (pen.write(curves.name, _COLOURS[n]) for n, curves in enumerate(all_curves))
    length = len(f"{first.name} (dashed) and {all_curves[1].name}, {first.robot}")
    parts = [f"{broken} (dashed)", f"and {solid}, {first.robot}"]
    return [" ".join(parts)] if length <= width else parts


def _beside(panels: Sequence[list[tuple[str, int]]], each: int) -> list[str]:
    """Panels next to each other; their lines come with their visible lengths."""
    return [(" " * _GAP).join(_filled(line, each) for line in row) for row in zip(*panels, strict=True)]


def _pad(panel: list[tuple[str, int]], width: int) -> list[str]:
    return [_filled(line, width) for line in panel]


def _filled(line: tuple[str, int], width: int) -> str:
    return line[0] + " " * (width - line[1])


def _joint_panel(
    all_curves: Sequence[Curves], quantity: Quantity, joint: int, width: int, pen: _Pen
) -> list[tuple[str, int]]:
    """Lines of the diagram of a joint."""
    first = all_curves[0]
    title = f"{first.joint_names[joint]} {quantity.value}, {first.units[joint]}{quantity.per}"
    curves = [(own.t, own.values[quantity][:, joint]) for own in all_curves]
    limits = []
    for own in all_curves:
        times, lower, upper = own.bounds[quantity].steps(joint)
        limits += [(times, lower), (times, upper)]
    spans = [span for own in all_curves for span in own.spans(quantity, joint)]
    return _panel(title, curves, limits, spans, all_curves, width, pen, base=None)


def _track_panel(
    all_curves: Sequence[Curves], tracks: Sequence[Track | None], width: int, pen: _Pen
) -> list[tuple[str, int]]:
    """Lines of the diagram of something of the robot as a whole."""
    known = [track for track in tracks if track is not None]
    title = known[0].title + (f", {known[0].unit}" if known[0].unit else "")
    curves = [
        (track.t, track.values) if track is not None else (np.zeros(0), np.zeros(0)) for track in tracks
    ]
    limits = [(track.t, track.apart) for track in known]
    spans = [span for own in all_curves for span in own.slowed] if known[0].stepped else []
    return _panel(title, curves, limits, spans, all_curves, width, pen, base=0.0)


def _panel(
    title: str,
    curves: Sequence[tuple[Array, Array]],
    limits: Sequence[tuple[Array, Array]],
    spans: Sequence[tuple[float, float]],
    all_curves: Sequence[Curves],
    width: int,
    pen: _Pen,
    base: float | None,
) -> list[tuple[str, int]]:
    inner = width - _LABEL - 1
    times = _times(all_curves)
    low, high = _range([values for _, values in curves], [values for _, values in limits], base)
    patterns = (_SOLID,) if len(curves) == 1 else (_DASHED, _SOLID)
    canvases = [
        _canvas(inner, times, (low, high), [curve], pattern)
        for curve, pattern in zip(curves, patterns, strict=True)
    ]
    dashes = _canvas(inner, times, (low, high), limits, _DOTTED)
    shown = title[:width]
    lines = [(pen.write(shown, "\x1b[1m"), len(shown))]
    for row in range(_HEIGHT):
        label = _number(high) if row == 0 else _number(low) if row == _HEIGHT - 1 else ""
        dots = _merged([rows[row] for rows in canvases], dashes[row], pen)
        lines.append((f"{label:>{_LABEL}}\N{BOX DRAWINGS LIGHT VERTICAL}{dots}", width))
    axis = _axis(inner, times, spans, all_curves[-1])
    lines.append((" " * _LABEL + "\N{BOX DRAWINGS LIGHT UP AND RIGHT}" + axis, width))
    lines.append((" " * (_LABEL + 1) + _line_numbers(inner, times, all_curves[-1]), width))
    return lines


def _times(all_curves: Sequence[Curves]) -> tuple[float, float]:
    first = min(float(curves.t[0]) for curves in all_curves)
    last = max(float(curves.t[-1]) for curves in all_curves)
    return (first, last) if last > first else (first, first + 1.0)


def _range(curves: Sequence[Array], limits: Sequence[Array], base: float | None) -> tuple[float, float]:
    """Range of a diagram: that of the curves, and limits just outside of it."""
    finite = np.concatenate([values[np.isfinite(values)] for values in curves])
    if not finite.size:
        return 0.0, 1.0
    low, high = float(finite.min()), float(finite.max())
    low = low if base is None else min(base, low)
    room = max(high - low, 1e-6 if base is not None else 0.5)
    bounds = np.concatenate([values[np.isfinite(values)] for values in limits] or [np.zeros(0)])
    near = bounds[(bounds >= low - _REACH * room) & (bounds <= high + _REACH * room)]
    low, high = float(np.min(near, initial=low)), float(np.max(near, initial=high))
    wide_enough = high - low >= 0.5 or (base is not None and high > low)
    # Beside the largest numbers half a unit is nothing.
    more = 0.0 if wide_enough else max(0.5, 1e-9 * abs(low))
    return low - more, high + more


def _canvas(
    width: int,
    times: tuple[float, float],
    values: tuple[float, float],
    curves: Sequence[tuple[Array, Array]],
    pattern: tuple[int, int],
) -> list[str]:
    """Rows of braille of curves, the highest first; of so many columns of dots so many are drawn."""
    canvas = Canvas(width, _HEIGHT)
    dots = 2 * width, 4 * _HEIGHT
    for t, curve in curves:
        for column, least, most in _columns(t, curve, times, values, dots):
            if column % pattern[1] >= pattern[0]:
                continue
            for dot in range(least, most + 1):
                canvas.point((column + 0.25) / dots[0], (dot + 0.25) / dots[1])
    text: str = canvas.plot(linesep="\n")
    return text.split("\n")


def _columns(
    t: Array, values: Array, times: tuple[float, float], limits: tuple[float, float], dots: tuple[int, int]
) -> Iterator[tuple[int, int, int]]:
    """Columns of dots that a curve crosses, and its lowest and highest dot there: no peak gets lost.

    Between two rows a curve goes straight.
    """
    grid = times[0] + (times[1] - times[0]) * np.arange(dots[0]) / max(dots[0] - 1, 1)
    good = np.isfinite(values)
    for begin, end in stretches(good):
        part_t, part = t[begin : end + 1], values[begin : end + 1]
        inside = grid[(grid >= part_t[0]) & (grid <= part_t[-1])]
        at = np.concatenate([part_t, inside])
        order = np.argsort(at, kind="stable")
        at, height = at[order], np.concatenate([part, np.interp(inside, part_t, part)])[order]
        column = np.rint((at - times[0]) / (times[1] - times[0]) * (dots[0] - 1)).astype(int)
        dot = np.rint((height - limits[0]) / (limits[1] - limits[0]) * (dots[1] - 1))
        before: float | None = None
        for number in np.unique(column).tolist():
            here = dot[column == number]
            # From where the column before was left: a step is a line, too.
            joined = here if before is None else np.append(here, before + np.sign(here[0] - before))
            least, most, before = int(joined.min()), int(joined.max()), float(here[-1])
            if most >= 0 and least < dots[1]:
                yield number, max(least, 0), min(most, dots[1] - 1)


def _merged(curves: Sequence[str], limits: str, pen: _Pen) -> str:
    """One row of dots of all curves and the limits; a character has the colour of the last curve in it."""
    found, run, colour = [], "", ""
    for place in range(len(limits)):
        code, own = _dots(limits[place]), _LIMIT if _dots(limits[place]) else ""
        for number, row in enumerate(curves):
            dots = _dots(row[place])
            code |= dots
            own = _COLOURS[number if len(curves) > 1 else 1] if dots else own
        if own != colour:
            found.append(pen.write(run, colour) if colour else run)
            run, colour = "", own
        run += chr(0x2800 + code) if code else " "
    found.append(pen.write(run, colour) if colour else run)
    return "".join(found)


def _dots(character: str) -> int:
    return ord(character) - 0x2800 if character >= "\u2800" else 0


def _axis(
    width: int, times: tuple[float, float], spans: Sequence[tuple[float, float]], curves: Curves
) -> str:
    """The time axis: heavy in spans, with a mark where a motion begins."""
    scale = (width - 1) / (times[1] - times[0])
    axis = ["\N{BOX DRAWINGS LIGHT HORIZONTAL}"] * width
    for begin, end in spans:
        first, last = (round((at - times[0]) * scale) for at in (begin, end))
        for place in range(max(first, 0), min(last, width - 1) + 1):
            axis[place] = "\N{BOX DRAWINGS HEAVY HORIZONTAL}"
    for mark in _marks(width, times, curves):
        place = round((mark.time - times[0]) * scale)
        heavy = axis[place] == "\N{BOX DRAWINGS HEAVY HORIZONTAL}"
        axis[place] = (
            "\N{BOX DRAWINGS DOWN LIGHT AND HORIZONTAL HEAVY}"
            if heavy
            else "\N{BOX DRAWINGS LIGHT DOWN AND HORIZONTAL}"
        )
    return "".join(axis)


def _marks(width: int, times: tuple[float, float], curves: Curves) -> list[MoveMark]:
    """Marks of moves, not closer than every other column."""
    return spaced_marks(curves.moves, 1.5 * (times[1] - times[0]) / (width - 1))


def _line_numbers(width: int, times: tuple[float, float], curves: Curves) -> str:
    """Program lines below their marks, one for moves of the same line, as there is room; last the time."""
    end = f"{times[1]:.4g} s"
    row = [" "] * width
    scale = (width - 1) / (times[1] - times[0])
    free, told = 0, 0
    for mark in _marks(width, times, curves):
        place, words = round((mark.time - times[0]) * scale), str(mark.line)
        if mark.line == told or place < free or place + len(words) > width - len(end) - 1:
            continue
        row[place : place + len(words)] = words
        free, told = place + len(words) + 1, mark.line
    row[width - len(end) :] = end
    return "".join(row)


def _number(value: float) -> str:
    if value == 0.0 or abs(value) < 1e-9:
        return "0 "
    return f"{value:.4g} " if abs(value) >= 1e-3 else f"{value:.1e} "
