"""The task of all: a Panda leads its tool along a line, once round a circle, and back along the line.

Each of the three motions runs from rest to rest by constant acceleration, cruise, constant deceleration, its
orientation kept, and takes whole ticks of 1, 4 and 10 ms; one more tick repeats its last pose, as irlx does
at every stop. The poses are worked out here, by numpy alone; irlx gets the program, all others these poses.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TIP = "panda_hand_tcp"
FINGERS = ("panda_finger_joint1", "panda_finger_joint2")
START = np.radians([0.0, -45.0, 0.0, -135.0, 0.0, 90.0, 45.0])
"""Franka's ready posture, rad."""

SPEED, ACC = 0.25, 1.0
"""Speed and acceleration of the tool along its path, m/s and m/s^2."""

WAY = np.array([0.15, 0.2, -0.1875])
"""The line, m; its length is what takes `LINE_TIME`."""

LINE_TIME, CIRCLE_TIME = 1.5, 2.0
LAP_TIME = 2 * LINE_TIME + CIRCLE_TIME
RADIUS = SPEED * (CIRCLE_TIME - SPEED / ACC) / (2.0 * np.pi)
"""Radius of the circle, m; it lies level, its centre in the direction of y from where it begins."""

SLOW_JOINT, SLOW_SPEED = 3, 30.0
"""Joint 4 of the slowed motion, and its speed limit, deg/s; it would turn with 50 deg/s."""


def program(laps: int, cyclic: bool = False) -> str:
    """The task as a program of irlx."""
    x, y, z = (repr(float(c) * 1e3) for c in WAY)
    back = ", ".join(repr(-float(c) * 1e3) for c in WAY)
    radius, twice = repr(RADIUS * 1e3), repr(2e3 * RADIUS)
    begin, end = ("  CYCLICSTART;\n", "  CYCLICEND;\n") if cyclic else ("", "")
    return (
        "PROGRAM line_and_circle;\nVAR\n  INT: lap;\nBEGIN\n"
        f"{begin}  FOR lap := 1 TO {laps} DO\n"
        f"    MOVE_INC LIN POSITION({x}, {y}, {z});\n"
        f"    MOVE_INC CIRCLE POSITION({radius}, {radius}, 0), POSITION(0, {twice}, 0) ANGLE := 360;\n"
        f"    MOVE_INC LIN POSITION({back});\n"
        f"  ENDFOR;\n{end}ENDPROGRAM;\n"
    )


def cell(watched: bool = False, speeds: Array | None = None) -> str:
    """A cell for the program, the links `watched` or free to touch; other speed limits (n,), rad/s."""
    text = '[robot]\nmodel = "panda"\n'
    if speeds is not None:
        text += f"[robot.limits]\nspeed = {np.degrees(speeds).tolist()}\n"
    text += f"[robot.self_collision]\nactive = {'true' if watched else 'false'}\n"
    return text + f"[motion]\nspeed = {SPEED * 1e3}\nacc = {ACC * 1e3}\n"


def positions(start: Array, dt: float, laps: int) -> Array:
    """Where the tool is to be at every tick (N, 3), m, after a start (3,) that is not among them."""
    line, circle = distances(LINE_TIME, dt), distances(CIRCLE_TIME, dt)
    corner, direction = start + WAY, WAY / np.linalg.norm(WAY)
    there = start + line[:, None] * direction
    back = corner - line[:, None] * direction
    turn = circle / RADIUS
    level = RADIUS * np.column_stack([np.sin(turn), 1.0 - np.cos(turn), np.zeros(len(turn))])
    return np.tile(np.vstack([there, corner + level, back]), (laps, 1))


def distances(time: float, dt: float) -> Array:
    """Way along a motion of `time` s at its ticks (N,), m, the last one twice."""
    rising, ticks = SPEED / ACC, round(time / dt)
    t = np.arange(1, ticks + 1) * dt
    length = SPEED * (time - rising)
    up, along = ACC * t**2 / 2.0, SPEED * (t - rising / 2.0)
    down = length - ACC * (time - t) ** 2 / 2.0
    way = np.where(t < rising, up, np.where(t < time - rising, along, down))
    return np.append(way, way[-1])


def off_the_path(points: Array, start: Array) -> Array:
    """Distance (N,), m, of points (N, 3) from the line or the circle, whichever is nearer."""
    corner, length = start + WAY, float(np.linalg.norm(WAY))
    along = np.clip((points - start) @ WAY / length, 0.0, length)
    from_line = np.linalg.norm(points - start - along[:, None] * WAY / length, axis=1)
    across = points - corner - np.array([0.0, RADIUS, 0.0])
    from_circle = np.hypot(np.hypot(across[:, 0], across[:, 1]) - RADIUS, across[:, 2])
    away: Array = np.minimum(from_line, from_circle)
    return away
