"""The way of the tool in the scene, in another colour where it is slower than programmed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from irlx.viewer.shown import Shown

if TYPE_CHECKING:
    from viser import SceneApi

ON_TIME = (28, 100, 200)
SLOWED = (232, 106, 10)
_MOST = 6000
"""Pieces of the way at most: of a long stream every k-th row is a corner of it."""
_PIXELS = 3.5


def draw_trail(scene: SceneApi, shown: Shown) -> None:
    """Draw the way of the tool through all rows; replaces the one before."""
    corners, slow = trail(shown)
    if len(corners) < 2:
        scene.remove_by_name("/trail")
        return
    pieces = np.stack([corners[:-1], corners[1:]], axis=1)
    colours = _linear(np.where(slow[1:, None], SLOWED, ON_TIME))
    both = np.repeat(colours[:, None, :], 2, axis=1)
    scene.add_line_segments("/trail", pieces, both, thickness=_PIXELS, thickness_units="screen")


def _linear(colours: NDArray[np.int64]) -> NDArray[np.uint8]:
    """Colours as the scene wants those of lines: in linear light, unlike those of shapes."""
    return np.round(255.0 * (colours / 255.0) ** 2.2).astype(np.uint8)


def trail(shown: Shown) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Corners (M, 3) m of the tool's way, and whether each was reached more slowly than programmed.

    Corners are rows, every k-th of a long stream, at which the tool is elsewhere than before.
    """
    rows = len(shown.stream.q)
    stride = max(1, -(-rows // _MOST))
    kept = np.unique(np.append(np.arange(0, rows, stride), rows - 1))
    slow = np.logical_or.reduceat(shown.slow_rows, np.concatenate([[0], kept[:-1] + 1]))
    corners = shown.stream.tool[kept, :3]
    moved = np.append(True, np.any(np.diff(corners, axis=0) != 0.0, axis=1))
    return corners[moved], slow[moved]
