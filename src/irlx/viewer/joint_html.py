"""Values of the joints in one row as an HTML table, with bars between their limits."""

from __future__ import annotations

from html import escape

import numpy as np

from irlx.viewer.shown import Shown

_AT_A_LIMIT = 1e-6
"""A joint this near to a position limit (rad or m) stands on it."""


def joint_html(shown: Shown, row: int) -> str:
    """Name, value, speed (deg or mm, per s) of each joint, and where it stands between its limits."""
    header, stream = shown.stream.header, shown.stream
    lower, upper = shown.cell.limits.position_lower, shown.cell.limits.position_upper
    rows = []
    before = stream.q[max(row - 1, 0)]
    for joint, name in enumerate(header.joint_names):
        slides = header.joint_units[joint] == "m"
        scale, unit = (1e3, "mm") if slides else (180.0 / np.pi, "°")
        value = float(stream.q[row, joint])
        speed = float(value - before[joint]) / header.dt
        low, high = float(lower[joint]), float(upper[joint])
        rows.append(
            f"<tr><td>{escape(name)}</td><td {_RIGHT}>{_tenths(scale * value)} {unit}</td>"
            f"<td {_RIGHT}>{_tenths(scale * speed)} {unit}/s</td><td>{_bar(value, low, high)}</td></tr>"
        )
    head = "<tr style='color:#868e96'><td>joint</td><td></td><td></td><td>between its limits</td></tr>"
    style = "font-size: 12px; width: 100%; border-spacing: 6px 3px; font-variant-numeric: tabular-nums"
    return f'<table style="{style}">{head}{"".join(rows)}</table>'


_RIGHT = 'style="text-align: right; white-space: nowrap"'


def _tenths(value: float) -> str:
    return f"{round(value, 1) + 0.0:.1f}"


def _bar(value: float, lower: float, upper: float) -> str:
    if not (np.isfinite(lower) and np.isfinite(upper) and upper > lower):
        return '<span style="color: #868e96">no limits</span>'
    share = min(max((value - lower) / (upper - lower), 0.0), 1.0)
    at_limit = min(value - lower, upper - value) <= _AT_A_LIMIT
    colour = "#e03131" if at_limit else "#2e7dd6"
    mark = f"position:absolute; left:calc({100 * share:.1f}% - 4px); top:0; width:8px; height:8px"
    return (
        '<div style="position:relative; height:8px; min-width:90px; border-radius:4px; '
        'background: rgba(134, 142, 150, .28)">'
        f'<div style="{mark}; border-radius:4px; background:{colour}"></div></div>'
    )
