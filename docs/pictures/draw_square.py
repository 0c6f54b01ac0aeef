"""Draws docs/pictures/square.svg: the closed square of programs/koch with and without CYCLICSTART.

python docs/pictures/draw_square.py
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pinocchio as pin

import irlx
from irlx.cell.load import load_cell
from irlx.robot.kinematics import Kinematics

HERE = Path(__file__).resolve().parent
KOCH = HERE.parents[1] / "programs" / "koch"
WIDTH, HEIGHT = 960, 400
LEAST, CYCLIC, LIMIT, INK, FAINT = "#c2571a", "#1f6f8b", "#a02040", "#222222", "#c9ced6"


def main() -> None:
    """Run both programs and write the picture."""
    least = irlx.run(KOCH / "square.irl")
    cyclic = irlx.run(KOCH / "square_cyclic.irl")
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
        f'font-size="13" fill="{INK}">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
        *postures(least, cyclic),
        *curves(least, cyclic),
        "</svg>",
    ]
    (HERE / "square.svg").write_text("\n".join(parts) + "\n", encoding="utf-8")


def polyline(points: np.ndarray, colour: str, width: float, extra: str = "") -> str:
    """SVG polyline through points (N, 2) of the picture."""
    text = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    style = (
        f'fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round"'
    )
    return f'<polyline points="{text}" {style} {extra}/>'


def text(x: float, y: float, words: str, colour: str = INK, anchor: str = "start", size: int = 13) -> str:
    """SVG text."""
    place = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"'
    return f'<text {place} fill="{colour}" font-size="{size}">{words}</text>'


def arm(kinematics: Kinematics, q: np.ndarray) -> np.ndarray:
    """Points of the arm from the base to the tool, shape (N, 3), m."""
    pin.forwardKinematics(kinematics.model, kinematics.data, q)
    joints = [kinematics.data.oMi[index].translation for index in range(1, kinematics.model.njoints)]
    _, tool = kinematics.tool_pose(q)
    return np.array([[0.0, 0.0, 0.0], *joints, tool])


def postures(least: irlx.Run, cyclic: irlx.Run) -> list[str]:
    """Left half: the arm at the start, and at the end of both runs, seen obliquely."""
    kinematics = Kinematics(load_cell(KOCH / "square.toml").robot)

    def seen(points: np.ndarray) -> np.ndarray:
        depth = 0.42 * points[:, 1:2]
        return np.hstack([60 + 33 * (points[:, :1] + 0.9 * depth), 345 - 33 * (points[:, 2:] + 0.6 * depth)])

    parts = [text(20, 28, "The arm before and after the closed square", size=15)]
    parts.append(polyline(seen(np.array([[-1, 0, 0], [12.6, 0, 0]])), FAINT, 1))
    parts.append(polyline(seen(least.tool[:, :3]), INK, 1.5, 'stroke-dasharray="1 3"'))
    for q, colour, width in (
        (least.q[0], FAINT, 9.0),
        (cyclic.q[-1], CYCLIC, 3.0),
        (least.q[-1], LEAST, 3.0),
    ):
        points = seen(arm(kinematics, q))
        parts.append(polyline(points, colour, width))
        parts += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3" fill="{colour}"/>' for x, y in points]
    closing = least.summary.closure, cyclic.summary.closure
    worst = [np.degrees(found.difference) if found else float("nan") for found in closing]
    parts.append(text(20, 370, "start", "#8a919c"))
    parts.append(text(60, 370, f"end, least motion: off by {worst[0]:.1f}&#176;", LEAST))
    parts.append(text(275, 370, f"end, CYCLICSTART: off by {worst[1]:.0e}&#176;", CYCLIC))
    return parts


def curves(least: irlx.Run, cyclic: irlx.Run) -> list[str]:
    """Right half: joint 11 over time, its limits dashed."""
    left, right, top, bottom = 560, 930, 60, 320
    limits = least.stream.header.limits
    low, high = np.degrees(limits.position_lower[10]), np.degrees(limits.position_upper[10])
    end = least.t[-1]

    def at(t: np.ndarray, degrees: np.ndarray) -> np.ndarray:
        x = left + (right - left) * t / end
        y = bottom - (bottom - top) * (degrees - (low - 5)) / (high - low + 10)
        return np.stack([x, y], axis=1)

    parts = [text(left - 36, 28, "Joint 11: its limit is met, the tool stays on the path", size=15)]
    for degrees in range(-20, 61, 20):
        (x0, y), (x1, _) = at(np.array([0.0, end]), np.array([degrees, degrees]))
        parts.append(polyline(np.array([[x0, y], [x1, y]]), "#eceff3", 1))
        parts.append(text(x0 - 8, y + 4, f"{degrees}&#176;", anchor="end"))
    for t in np.arange(0.0, end, 2.5):
        ((x, y),) = at(np.array([t]), np.array([low - 5]))
        parts.append(polyline(np.array([[x, y], [x, top]]), "#eceff3", 1))
        parts.append(text(x, y + 18, f"{t:g} s", anchor="middle"))
    for limit in (low, high):
        line = at(np.array([0.0, end]), np.array([limit, limit]))
        parts.append(polyline(line, LIMIT, 1.2, 'stroke-dasharray="6 4"'))
    for run, colour in ((least, LEAST), (cyclic, CYCLIC)):
        parts.append(polyline(at(run.t, np.degrees(run.q[:, 10])), colour, 2.2))
    parts.append(text(right, top - 14, "upper limit", LIMIT, "end"))
    parts += legend(left, 370)
    return parts


def legend(x: float, y: float) -> Sequence[str]:
    """Names of the two curves."""
    return [text(x, y, "least motion", LEAST), text(x + 110, y, "with CYCLICSTART", CYCLIC)]


if __name__ == "__main__":
    main()
