"""Curves with closed forms, and a second solver for the fastest clock on a curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import linprog
from scipy.sparse import coo_matrix

from irlx.pacing.slowdown.curve import JointCurve
from irlx.robot.limits import JointLimits


def limits(
    n: int, speed=np.inf, acceleration=np.inf, slowest=None, hardest=None, position=np.inf
) -> JointLimits:
    """Limits of n joints; the lower sides mirror the upper ones where they are not given."""
    upper = [np.broadcast_to(np.asarray(side, dtype=float), n) for side in (position, speed, acceleration)]
    lower = [
        -side if own is None else np.broadcast_to(np.asarray(own, dtype=float), n)
        for side, own in zip(upper, (None, slowest, hardest), strict=True)
    ]
    return JointLimits(lower[0], upper[0], lower[1], upper[1], lower[2], upper[2])


@dataclass(frozen=True)
class Wave:
    """q_j(s) = sum_k a_jk sin(k s + p_jk) on [0, length], with exact derivatives."""

    amplitude: np.ndarray
    phase: np.ndarray
    length: float

    def of(self, s: np.ndarray, order: int = 0) -> np.ndarray:
        k = np.arange(1, self.amplitude.shape[1] + 1)
        angle = s[:, None, None] * k + self.phase + order * np.pi / 2
        return np.sum(self.amplitude * k**order * np.sin(angle), axis=2)

    def curve(self, intervals: int = 200) -> JointCurve:
        s = np.linspace(0.0, self.length, intervals + 1)
        return JointCurve(s, self.of(s))


def random_wave(rng: np.random.Generator, joints: int, length: float = 2.0) -> Wave:
    size = rng.normal(size=(joints, 3)) / np.arange(1, 4) ** 2
    return Wave(size, rng.uniform(0, 2 * np.pi, (joints, 3)), length)


def second_solver(wave, lim: JointLimits, rate, acc: float, knots: int = 600) -> float:
    """Duration of the fastest clock by a linear program on knots and midpoints of its own.

    The feasible x of a path are closed under the larger of two, so the largest sum is the fastest clock.
    `wave.of(s, order)` gives q and its exact derivatives, `rate(s)` the programmed rate.
    """
    # Knots crowd at the ends, where the rate rises as a root.
    s = wave.length * 0.5 * (1.0 - np.cos(np.linspace(0.0, np.pi, knots + 1)))
    h, middle = np.diff(s), 0.5 * (s[1:] + s[:-1])
    first, second = wave.of(middle, 1), wave.of(middle, 2)
    slope = np.abs(wave.of(s, 1))
    up = np.where(wave.of(s, 1) > 0, lim.speed_upper, -lim.speed_lower)
    with np.errstate(divide="ignore", invalid="ignore"):
        cap = np.min(np.where(slope > 0, up / slope, np.inf) ** 2, axis=1)
    cap = np.minimum(cap, rate(s) ** 2)
    cap[[0, -1]] = 0.0
    one = np.ones((knots, 1))
    a = np.hstack([first, one])
    b = np.hstack([second, 0.0 * one])
    high = np.append(lim.acceleration_upper, acc)
    low = np.append(lim.acceleration_lower, -acc)
    # (x_{i+1} - x_i) / 2h q' + (x_i + x_{i+1}) / 2 q'' within the accelerations.
    here, there = -a / (2 * h[:, None]) + b / 2, a / (2 * h[:, None]) + b / 2
    rows, right = [], []
    for sign, bound in ((1.0, high), (-1.0, -low)):
        for j in np.flatnonzero(np.isfinite(bound)):
            rows.append((sign * here[:, j], sign * there[:, j]))
            right.append(np.full(knots, bound[j]))
    count = len(rows) * knots
    index = np.tile(np.arange(knots), len(rows))
    matrix = coo_matrix(
        (
            np.concatenate([np.concatenate([r[0] for r in rows]), np.concatenate([r[1] for r in rows])]),
            (np.tile(np.arange(count), 2), np.concatenate([index, index + 1])),
        ),
        shape=(count, knots + 1),
    )
    found = linprog(
        -np.ones(knots + 1), matrix, np.concatenate(right), bounds=list(zip(0 * cap, cap, strict=True))
    )
    assert found.success, found.message
    root = np.sqrt(np.maximum(found.x, 0.0))
    return float(np.sum(2.0 * h / (root[1:] + root[:-1])))


@pytest.fixture(scope="session")
def tools():
    """Builders of this file under one name."""

    class Tools:
        pass

    made = Tools()
    made.limits, made.wave, made.random_wave = limits, Wave, random_wave
    made.second_solver = second_solver
    return made
