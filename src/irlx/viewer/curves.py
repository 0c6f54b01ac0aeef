"""Curves of joints and tool over time, as the viewer's plots take them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from irlx.viewer.shown import Shown

if TYPE_CHECKING:
    from viser import uplot

Array = NDArray[np.float64]
_POINTS = 700
"""Points of a curve at most; of more rows the largest of each portion stays: no peak is hidden."""
_COLOURS = (
    *("#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd", "#8c564b", "#e377c2"),
    *("#7f7f7f", "#bcbd22", "#17becf", "#003f5c", "#58508d", "#ffa600"),
)


class Curves(NamedTuple):
    """Data of one plot: times, and a curve each of `names`, with its title."""

    title: str
    data: tuple[Array, ...]
    names: tuple[str, ...]

    @property
    def series(self) -> tuple[uplot.Series, ...]:
        """How the curves are drawn."""
        lines: list[Any] = [{"label": "s"}]
        lines += [
            {"label": name, "stroke": colour, "width": 1.5}
            for name, colour in zip(self.names, self.colours, strict=True)
        ]
        return tuple(lines)

    @property
    def colours(self) -> tuple[str, ...]:
        """Colour of each curve."""
        return tuple(_COLOURS[number % len(_COLOURS)] for number in range(len(self.names)))


def curves(shown: Shown) -> tuple[Curves, ...]:
    """Positions and speeds of the joints that turn and of those that slide, and the tool's speed."""
    header, stream = shown.stream.header, shown.stream
    slides = np.array([unit == "m" for unit in header.joint_units])
    names = np.array(header.joint_names)
    found = []
    for kind, which, scale, unit in (
        ("Joints", ~slides, 180.0 / np.pi, "deg"),
        ("Sliding joints", slides, 1e3, "mm"),
    ):
        if which.any():
            labels = tuple(names[which].tolist())
            found.append(_plot(f"{kind}, {unit}", stream.t, scale * stream.q[:, which], labels))
            found.append(_plot(f"{kind}, {unit}/s", stream.t, scale * stream.qd[:, which], labels))
    steps = np.diff(stream.tool[:, :3], axis=0, prepend=stream.tool[:1, :3])
    speed = 1e3 * np.linalg.norm(steps, axis=1) / header.dt
    found.append(_plot("Tool, mm/s", stream.t, speed[:, None], ("tool",)))
    return tuple(found)


def _plot(title: str, t: Array, values: Array, names: tuple[str, ...]) -> Curves:
    rows = _kept(len(t))
    columns = (_largest(values[:, column], rows) for column in range(values.shape[1]))
    last = np.append(rows[1:], len(t)) - 1
    data = (t[last], *columns)
    if len(t) == 1:
        # One point is no curve.
        data = tuple(np.repeat(column, 2) for column in data)
    return Curves(title, data, names)


def _kept(rows: int) -> NDArray[np.int64]:
    """First rows of the portions."""
    return np.arange(0, rows, max(1, -(-rows // _POINTS)))


def _largest(values: Array, rows: NDArray[np.int64]) -> Array:
    """Of each portion of values (N,), beginning at `rows`, the one farthest from zero."""
    high, low = np.maximum.reduceat(values, rows), np.minimum.reduceat(values, rows)
    return np.where(high >= -low, high, low)
