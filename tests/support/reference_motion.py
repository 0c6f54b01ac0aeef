"""The reference motion of the acceptance tests: a line, then a full circle, for several robots.

From the start posture 0.40 m along -y of the world, then once round a circle of 0.12 m in the y-z plane,
both at 0.25 m/s and 1.5 m/s2 with the orientation kept. The circle hangs below the line's end: it is left
towards +y, so the tool is back where the line ended.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import degrees, pi
from pathlib import Path

import numpy as np

from irlx.cell.cell import Cell
from irlx.cell.load import load_cell
from irlx.robot.kinematics import Kinematics

LINE, RADIUS = 0.40, 0.12
"""Length of the line and radius of the circle, m."""
SPEED, ACCELERATION = 0.25, 1.5
"""Programmed for the tool, m/s and m/s2."""
LINE_TIME = LINE / SPEED + SPEED / ACCELERATION
CIRCLE_TIME = 2 * pi * RADIUS / SPEED + SPEED / ACCELERATION
DURATION = LINE_TIME + CIRCLE_TIME
"""Of the trapezoids, s, before they are stretched to whole ticks and without the hold ticks: 4.949."""

STARTS: dict[str, tuple[float, ...] | None] = {
    "panda": (0.45, 0.35, -0.25, -1.9, 0.1, 2.25, 0.9),
    "arm7": None,
    "rail6": None,
}
"""Start postures, rad; None for the robot's own."""

Bounds = Mapping[int, float | tuple[float, float]]
"""Bounds of some joints, counted from 1: plus or minus a number, or (lower, upper); rad or m, per s, s2."""


@dataclass(frozen=True)
class ReferenceMotion:
    """Program and cell as files, and the same motion as numbers: start posture (rad, m), tool points (m)."""

    program: Path
    cell: Path
    start: np.ndarray
    rotation: np.ndarray
    line_start: np.ndarray
    line_end: np.ndarray
    centre: np.ndarray

    def on_circle(self, angle: float) -> np.ndarray:
        """Point (3,) m after that part (rad) of the circle."""
        return self.centre + RADIUS * np.array([0.0, np.sin(angle), np.cos(angle)])


def reference_motion(
    folder: Path,
    robot: str,
    tick_ms: float = 4.0,
    *,
    position: Bounds | None = None,
    speed: Bounds | None = None,
    acceleration: Bounds | float | bool = True,
    weights: Sequence[float] | None = None,
) -> ReferenceMotion:
    """Program and cell of the reference motion, written to `folder`.

    Joints without a bound of their own keep the robot's. `acceleration` may also be one number for all
    joints, or False for none at all, as the URDF has it; `weights` are n, n-1, .. 1 where not given.
    """
    cell = folder / f"{robot}.toml"
    start = STARTS[robot]
    head = f'[robot]\nmodel = "{robot}"\n'
    if start is not None:
        head += f"start = {[degrees(angle) for angle in start]}\n"
    if weights is not None:
        head += f"weights = {[float(weight) for weight in weights]}\n"
    cell.write_text(head, encoding="utf-8")
    bare = load_cell(cell)
    if not isinstance(acceleration, Mapping):
        every = range(1, bare.start.size + 1) if not isinstance(acceleration, bool) else ()
        numbers = dict.fromkeys(every, acceleration)
    else:
        numbers = dict(acceleration)
    limits = "[robot.limits]\n"
    limits += _limits(bare, "position", position or {}) + _limits(bare, "speed", speed or {})
    limits += "acceleration = false\n" if acceleration is False else _limits(bare, "acceleration", numbers)
    motion = f"[motion]\ntick_ms = {tick_ms!r}\nspeed = {SPEED * 1e3!r}\nacc = {ACCELERATION * 1e3!r}\n"
    links = "[robot.self_collision]\nactive = false\n"
    cell.write_text(head + limits + links + motion, encoding="utf-8")
    return _with_program(folder / f"{robot}.irl", cell, bare)


def _with_program(program: Path, cell: Path, bare: Cell) -> ReferenceMotion:
    rotation, line_start = Kinematics(bare.robot).tool_pose(bare.start)
    line_end = line_start - [0.0, LINE, 0.0]
    motion = ReferenceMotion(
        program, cell, bare.start, rotation, line_start, line_end, line_end - [0.0, 0.0, RADIUS]
    )
    via, opposite = motion.on_circle(pi / 2), motion.on_circle(pi)
    program.write_text(
        f"PROGRAM reference_{bare.model};\n"
        f"SYSTEM SPECIFICATION {bare.model};\n"
        "BEGIN\n"
        f"  MOVE LIN {_point(line_end)};\n"
        f"  MOVE CIRCLE {_point(via)}, {_point(opposite)} ANGLE := 360;\n"
        "ENDPROGRAM;\n",
        encoding="utf-8",
    )
    return motion


def _point(point: np.ndarray) -> str:
    x, y, z = (repr(float(value) * 1e3) for value in point)
    return f"POSITION({x}, {y}, {z})"


def _limits(bare: Cell, kind: str, bounds: Bounds) -> str:
    """Line of the cell for one kind of limits, '' where nothing is bounded beside the robot's own."""
    if not bounds:
        return ""
    entries = []
    for number, (joint, *own) in enumerate(zip(bare.robot.axes, *bare.limits.pair(kind), strict=True), 1):
        bound = bounds.get(number, (float(own[0]), float(own[1])))
        lower, upper = bound if isinstance(bound, tuple) else (-bound, bound)
        scale = 1e3 if joint.is_prismatic else degrees(1.0)
        unlimited = np.isinf(lower) and np.isinf(upper)
        entries.append("false" if unlimited else f"[{lower * scale!r}, {upper * scale!r}]")
    return f"{kind} = [{', '.join(entries)}]\n"
