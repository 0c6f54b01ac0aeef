"""The square of the monograph's chapter 6: its programs run once a tick, its robot and path written out."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from kept_runs import kept_run

PROGRAMS = Path(__file__).parents[2] / "programs" / "koch"

AXES = ["+z", "+y", "+y", "+y", "+y", "+y", "-x", "+z", "+y", "slide -z", "+z"]
OFFSETS = [(0, 0, 1.3), (-0.2, 0, 0.6), (6, 0, -0.3), (-4, 0, -0.3), (4, 0, -0.7), (-4.6, 0, -0.2)]
OFFSETS += [(0, 0, 0.4), (0, 0, 0.6), (0, 0, 0), (0, 0, 0), (0, 1, 0)]
TOOL = (0.0, 0.0, -1.5)

LEVEL, TILTED = Rotation.identity(), Rotation.from_euler("y", -85, degrees=True)
TURNED = Rotation.from_euler("z", 85, degrees=True)
CORNERS = [
    (np.array([11.5, 1.0, 3.5]), LEVEL),
    (np.array([9.5, 1.0, 3.5]), LEVEL),
    (np.array([9.5, -1.0, 3.5]), TILTED),
    (np.array([9.5, -1.0, 3.5]), TURNED),
    (np.array([11.5, -1.0, 3.5]), LEVEL),
    (np.array([11.5, 1.0, 3.5]), LEVEL),
]


def forward(q: np.ndarray) -> tuple[np.ndarray, Rotation]:
    """Tool positions (N, 3) and orientations of postures (N, 11), arm by arm (table of fig. 6.2)."""
    position, rotation = np.zeros((len(q), 3)), Rotation.identity(len(q))
    for values, axis, offset in zip(q.T, AXES, OFFSETS, strict=True):
        position = position + rotation.apply(offset)
        direction = np.eye(3)["xyz".index(axis[-1])] * (-1.0 if axis[-2] == "-" else 1.0)
        if axis.startswith("slide"):
            position = position + rotation.apply(np.outer(values, direction))
        else:
            rotation = rotation * Rotation.from_rotvec(np.outer(values, direction))
    return position + rotation.apply(TOOL), rotation


def share_of_way(ticks: int, length: float, speed: float, acc: float) -> np.ndarray:
    """Share of the way at ticks 1 .. n of a trapezoid stretched to whole ticks."""
    ramp, cruise = speed / acc, length / speed - speed / acc
    t = np.arange(1, ticks + 1) / ticks * (2 * ramp + cruise)
    left = 2 * ramp + cruise - t
    up, down = 0.5 * acc * t**2, length - 0.5 * acc * left**2
    return np.where(t <= ramp, up, np.where(left <= ramp, down, speed * (t - 0.5 * ramp))) / length


def demanded(tick_ms: int) -> tuple[np.ndarray, Rotation]:
    """Poses the tool should have at every tick: start, five motions of 2.5 s, each with a hold tick.

    Lines at 1 m/s and 2 m/s2; the turn on the spot at 57.1 deg/s and 114.5 deg/s2, stretched to 2.5 s.
    """
    ticks = int(np.ceil(2500 / tick_ms))
    positions, quaternions = [CORNERS[0][0][None]], [CORNERS[0][1].as_quat()[None]]
    for (p0, r0), (p1, r1) in pairwise(CORNERS):
        turn = (r0.inv() * r1).as_rotvec()
        length = float(np.linalg.norm(p1 - p0))
        law = (length, 1.0, 2.0) if length else (np.degrees(np.linalg.norm(turn)), 57.1, 114.5)
        share = np.append(share_of_way(ticks, *law), 1.0)[:, None]
        positions.append((1 - share) * p0 + share * p1)
        quaternions.append((r0 * Rotation.from_rotvec(share * turn)).as_quat())
    return np.vstack(positions), Rotation.from_quat(np.vstack(quaternions))


@pytest.fixture(scope="session")
def experiment():
    """`experiment(name, tick_ms, cell)`: the finished run of a program and a cell of programs/koch."""

    def run(name: str, tick_ms: int, cell: str = "square") -> irlx.Run:
        return kept_run(PROGRAMS / f"{name}.irl", PROGRAMS / f"{cell}.toml", tick_ms=tick_ms)

    return run


@pytest.fixture(scope="session")
def square():
    """The robot and the path as this file has them."""

    class Square:
        axes, offsets, tool, corners = AXES, OFFSETS, TOOL, CORNERS

    Square.forward, Square.demanded = staticmethod(forward), staticmethod(demanded)
    Square.share_of_way = staticmethod(share_of_way)
    return Square
