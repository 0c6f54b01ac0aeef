"""Draws docs/pictures/slowdown.svg: the tool slows down where joint 4 of a Panda must not turn faster.

python docs/pictures/draw_slowdown.py     (needs the extra `robots`; prints the figures that the docs quote)
"""

from __future__ import annotations

from math import degrees
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import irlx
from irlx.cell.load import load_cell
from irlx.robot.kinematics import Kinematics

HERE = Path(__file__).resolve().parent
WIDTH, HEIGHT = 960, 474
FREE, SLOWED, LIMIT, INK, FAINT = "#d98a55", "#14566e", "#a02040", "#222222", "#eceff3"
FREE_WORDS = "#a8561a"
DOTTED, DASHED = 'stroke-dasharray="1.5 3.5"', 'stroke-dasharray="7 4"'
LEFT, RIGHT = 64, 756
SPEED_PANEL, JOINT_PANEL = (64, 214), (268, 418)

START = (0.45, 0.35, -0.25, -1.9, 0.1, 2.25, 0.9)
LINE, RADIUS = 0.40, 0.12
SPEED, ACC = 0.25, 1.5
TICK_MS = 4.0
JOINT, FASTEST = 3, 0.376
"""The joint (from 0) with a limit of its own, and that limit, rad/s."""


def main() -> None:
    """Run the motion without and with the limit, print the figures, write the picture."""
    with TemporaryDirectory() as folder:
        free, slowed = motion(Path(folder), None), motion(Path(folder), FASTEST)
    print_figures(free, slowed)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" '
        f'font-size="13" fill="{INK}">',
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
        *path_speeds(free, slowed),
        *joint_speeds(free, slowed),
        *seconds(float(slowed.t[-1])),
        "</svg>",
    ]
    (HERE / "slowdown.svg").write_text("\n".join(parts) + "\n", encoding="utf-8")


def motion(folder: Path, fastest: float | None) -> irlx.Run:
    """0.40 m along -y, then once round a circle of 0.12 m; joint 4 no faster than `fastest`, rad/s."""
    cell, program = folder / "panda.toml", folder / "panda.irl"
    text_of_cell = f'[robot]\nmodel = "panda"\nstart = {[degrees(value) for value in START]}\n'
    cell.write_text(text_of_cell, encoding="utf-8")
    robot = load_cell(cell)
    if fastest is not None:
        speeds = robot.limits.speed_upper.copy()
        speeds[JOINT] = fastest
        text_of_cell += f"[robot.limits]\nspeed = {[degrees(value) for value in speeds]}\n"
    text_of_cell += f"[motion]\ntick_ms = {TICK_MS}\nspeed = {SPEED * 1e3}\nacc = {ACC * 1e3}\n"
    cell.write_text(text_of_cell, encoding="utf-8")
    _, start = Kinematics(robot.robot).tool_pose(robot.start)
    end = start - [0.0, LINE, 0.0]
    via = end + np.array([0.0, RADIUS, -RADIUS])
    opposite = end - [0.0, 0.0, 2.0 * RADIUS]
    program.write_text(
        f"PROGRAM panda;\nSYSTEM SPECIFICATION panda;\nBEGIN\n  MOVE LIN {point(end)};\n"
        f"  MOVE CIRCLE {point(via)}, {point(opposite)} ANGLE := 360;\nENDPROGRAM;\n",
        encoding="utf-8",
    )
    return irlx.run(program)


def point(place: np.ndarray) -> str:
    """A position (3,), m, as IRL has it."""
    x, y, z = (repr(float(value) * 1e3) for value in place)
    return f"POSITION({x}, {y}, {z})"


def print_figures(free: irlx.Run, slowed: irlx.Run) -> None:
    """What the docs say of this motion."""
    for name, run in (("without the limit", free), ("with the limit", slowed)):
        summary = run.summary
        fastest = np.max(np.abs(run.qd[:, JOINT]))
        print(f"{name}: {summary.duration:.3f} s, joint 4 at {fastest:.4f} rad/s at most", end="; ")
        print(f"planned {summary.planned}, path error {summary.path_position_error:.1e} m")
        for event in summary.slowed:
            print(f"  line {event.line}, {event.first_time:.3f}-{event.last_time:.3f} s", end=": ")
            print(f"{event.achieved:.4f} of {event.requested:.4f} m/s, {event.lost:.4f} s lost", end=", ")
            print(f"{event.joint} {event.kind}")
    tick = slowed.summary.slowed[0].first_tick
    apart = np.max(np.abs(free.q[tick] - slowed.q[tick]))
    way = np.linalg.norm(free.tool[tick, :3] - slowed.tool[tick, :3])
    print(f"at the first slowed tick, {tick}, the postures are {apart:.2g} rad apart, the tools {way:.1g} m")


def polyline(points: np.ndarray, colour: str, width: float, extra: str = "") -> str:
    """SVG polyline through points (N, 2) of the picture."""
    places = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    style = (
        f'fill="none" stroke="{colour}" stroke-width="{width}" stroke-linejoin="round" stroke-linecap="round"'
    )
    return f'<polyline points="{places}" {style} {extra}/>'


def text(x: float, y: float, words: str, colour: str = INK, anchor: str = "start", size: int = 13) -> str:
    """SVG text."""
    place = f'x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"'
    return f'<text {place} fill="{colour}" font-size="{size}">{words}</text>'


class Panel:
    """A diagram over time: seconds 0 to `end`, values `low` to `high` between two heights."""

    def __init__(self, heights: tuple[int, int], low: float, high: float, end: float) -> None:
        self.top, self.bottom = heights
        self.low, self.high, self.end = low, high, end

    def at(self, t: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Points (N, 2) of the picture."""
        x = LEFT + (RIGHT - LEFT) * t / self.end
        y = self.bottom - (self.bottom - self.top) * (values - self.low) / (self.high - self.low)
        return np.stack([x, y], axis=1)

    def height(self, value: float) -> float:
        """Height of a value in the picture."""
        return float(self.at(np.zeros(1), np.array([value]))[0, 1])

    def level(self, value: float, colour: str, width: float, extra: str = "") -> str:
        """Line across the diagram at a value."""
        y = self.height(value)
        return polyline(np.array([[LEFT, y], [RIGHT, y]]), colour, width, extra)

    def grid(self, values: list[float], name: str) -> list[str]:
        """Name of the diagram, lines and figures at values, lines at every half second."""
        parts = [text(LEFT, self.top - 12, name)]
        for value in values:
            parts.append(self.level(value, FAINT, 1))
            figure = f"{value:g}".replace("-", "&#8722;")
            parts.append(text(LEFT - 8, self.height(value) + 4, figure, anchor="end"))
        for t in np.arange(0.0, self.end, 0.5):
            (x, _), *_ = self.at(np.array([t]), np.array([self.low]))
            parts.append(polyline(np.array([[x, self.top], [x, self.bottom]]), FAINT, 1))
        return parts


def path_speeds(free: irlx.Run, slowed: irlx.Run) -> list[str]:
    """Upper diagram: speed of the tool along its path, by differences."""
    panel = Panel(SPEED_PANEL, 0.0, 300.0, float(slowed.t[-1]))
    longer = slowed.summary.duration - free.summary.duration
    parts = [
        text(
            LEFT,
            26,
            f"Where joint 4 cannot follow, the tool slows down on its path: {longer:.3f} s more in all",
            size=15,
        )
    ]
    parts += panel.grid([0.0, 100.0, 200.0, 300.0], "speed of the tool along its path, mm/s")
    for run, colour, width, extra in ((free, FREE, 2.2, DOTTED), (slowed, SLOWED, 2.2, "")):
        steps = np.linalg.norm(np.diff(run.tool[:, :3], axis=0), axis=1)
        speed = np.concatenate([[0.0], steps]) / (TICK_MS / 1e3) * 1e3
        parts.append(polyline(thinned(panel.at(run.t, speed)), colour, width, extra))
    y = panel.height(250.0)
    parts.append(text(RIGHT + 14, y - 4, "limit off, as programmed:", FREE_WORDS))
    parts.append(text(RIGHT + 14, y + 12, f"{free.summary.duration:.3f} s", FREE_WORDS))
    parts.append(text(RIGHT + 14, y + 44, "slowed by irlx:", SLOWED))
    parts.append(text(RIGHT + 14, y + 60, f"{slowed.summary.duration:.3f} s", SLOWED))
    return parts


def joint_speeds(free: irlx.Run, slowed: irlx.Run) -> list[str]:
    """Lower diagram: speed of joint 4, its limits dashed."""
    panel = Panel(JOINT_PANEL, -0.6, 0.6, float(slowed.t[-1]))
    parts = panel.grid([-0.5, -0.25, 0.0, 0.25, 0.5], "speed of joint 4, rad/s")
    parts += [panel.level(side * FASTEST, LIMIT, 1.3, DASHED) for side in (-1.0, 1.0)]
    for run, colour, width, extra in ((free, FREE, 2.2, DOTTED), (slowed, SLOWED, 2.2, "")):
        parts.append(polyline(thinned(panel.at(run.t, run.qd[:, JOINT])), colour, width, extra))
    fastest = np.max(np.abs(free.qd[:, JOINT]))
    upper, lower = panel.height(FASTEST), panel.height(-FASTEST)
    parts.append(text(RIGHT + 14, upper + 4, f"limit {FASTEST:g} rad/s", LIMIT))
    kept = np.max(np.abs(slowed.qd[:, JOINT]))
    parts.append(text(RIGHT + 14, panel.height(0.0) - 4, "slowed by irlx:", SLOWED))
    parts.append(text(RIGHT + 14, panel.height(0.0) + 12, f"at most {kept:.3f} rad/s", SLOWED))
    parts.append(text(RIGHT + 14, lower + 4, f"limit &#8722;{FASTEST:g} rad/s", LIMIT))
    parts.append(text(RIGHT + 14, lower + 24, f"limit off: {fastest:.3f} rad/s", FREE_WORDS))
    return parts


def seconds(end: float) -> list[str]:
    """Figures of the time axis, below both diagrams."""
    parts = []
    for t in np.arange(0.0, end, 0.5):
        x = LEFT + (RIGHT - LEFT) * t / end
        parts.append(text(x, JOINT_PANEL[1] + 20, f"{t:g}", anchor="middle"))
    parts.append(text(RIGHT + 14, JOINT_PANEL[1] + 20, "time, s"))
    parts.append(
        text(
            LEFT,
            HEIGHT - 10,
            "Panda, tick 4 ms: a line of 0.40 m, a stop, once round a circle of radius 0.12 m",
        )
    )
    return parts


def thinned(points: np.ndarray) -> np.ndarray:
    """Points (N, 2) without those that a straight line to the next ones shows as well."""
    kept = [0]
    for k in range(1, len(points) - 1):
        before, here, behind = points[kept[-1]], points[k], points[k + 1]
        share = (here[0] - before[0]) / max(behind[0] - before[0], 1e-9)
        if abs(before[1] + share * (behind[1] - before[1]) - here[1]) > 0.1 or here[0] - before[0] > 6.0:
            kept.append(k)
    return points[[*kept, len(points) - 1]]


if __name__ == "__main__":
    main()
