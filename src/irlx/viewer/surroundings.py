"""The floor, the frames of the cell, and where one looks from at first."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx.viewer.robot_nodes import RobotNodes
from irlx.viewer.shown import Shown

Array = NDArray[np.float64]
_FROM = np.array([1.0, -1.35, 0.7])
"""Direction from what is looked at to the eye."""
_POSTURES = 24
"""Rows of which the robot's links are taken into the picture, beside the whole way of the tool."""


def bounds_of(shown: Shown, robot: RobotNodes) -> Array:
    """Lowest and highest corner (2, 3), m, of the frames of the robot's links and the tool's way."""
    rows = np.unique(np.linspace(0, len(shown.stream.q) - 1, _POSTURES).astype(int))
    frames = [robot.origins(shown.stream.q[row]) for row in rows]
    points = np.vstack([*frames, shown.stream.tool[:, :3]])
    return np.stack([points.min(axis=0), points.max(axis=0)])


def draw_surroundings(scene: Any, shown: Shown, bounds: Array) -> Any:
    """A grid on the floor and the named frames of the cell with their names; returns axes for the tool."""
    size = _size(bounds)
    scene.set_up_direction("+z")
    scene.world_axes.visible = False
    _draw_floor(scene, bounds, size)
    axes = float(np.clip(0.08 * size, 0.04, 0.5))
    for name, frame in shown.cell.frames.items():
        position = tuple(1e-3 * value for value in frame.position)
        node = f"/places/{name}"
        scene.add_frame(
            node,
            axes_length=0.8 * axes,
            axes_radius=0.02 * axes,
            origin_radius=0.05 * axes,
            wxyz=frame.quaternion,
            position=position,
        )
        scene.add_label(f"{node}/name", name)
    return scene.add_frame("/tool", axes_length=axes, axes_radius=0.03 * axes, origin_radius=0.06 * axes)


def _draw_floor(scene: Any, bounds: Array, size: float) -> None:
    """Squares of a power of ten, or half of it, below all that moves."""
    cell = 10.0 ** np.floor(np.log10(size / 2.0))
    edge = 2.0 * cell * np.ceil(1.6 * size / (2.0 * cell))
    middle = 2.0 * cell * np.round(np.mean(bounds[:, :2], axis=0) / (2.0 * cell))
    scene.add_grid(
        "/floor",
        width=2.0 * edge,
        height=2.0 * edge,
        cell_size=cell,
        section_size=2.0 * cell,
        cell_thickness=0.6,
        cell_color=(226, 230, 235),
        section_color=(196, 202, 210),
        position=(*middle, min(0.0, float(bounds[0, 2])) - 1e-3),
    )


def look_at_it(server: Any, bounds: Array) -> None:
    """Look at the robot and the way of its tool as a whole, from the front, the right and above."""
    middle = np.mean(bounds, axis=0)
    away = 1.2 * _size(bounds) * _FROM / np.linalg.norm(_FROM)
    camera = server.initial_camera
    camera.position, camera.look_at, camera.up = tuple(middle + away), tuple(middle), (0.0, 0.0, 1.0)


def handle_size(bounds: Array) -> float:
    """Length of the arrows of a handle, m."""
    return 0.22 * _size(bounds)


def _size(bounds: Array) -> float:
    """How large what is seen is, m."""
    return max(float(np.linalg.norm(bounds[1] - bounds[0])), 0.4)
