"""Random ticks of the inverse transform: a chain, its state and limits, a target, a criterion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.urdf import read_urdf
from irlx.transform.criteria.combined import Combined, Weighted
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture
from irlx.transform.criteria.term import MeasureTerm, Term
from irlx.transform.measures.joint_centring import JointCentring
from irlx.transform.measures.manipulability import Manipulability
from plain_chains import Chain

COORDINATES = ("x", "y", "z", "rx", "ry", "rz")
RESERVE = 1e-6
"""Part of bounds of speed and acceleration that a tick leaves unused."""


@dataclass(frozen=True)
class Tick:
    """All that a tick depends on. phi = 1/2 (S - wish)' W (S - wish) + b'S + 1/2 S'B S."""

    chain: Chain
    q: np.ndarray
    speed: np.ndarray
    limits: tuple[np.ndarray, ...]
    dt: float
    target: tuple[np.ndarray, np.ndarray]
    free: np.ndarray
    weights: np.ndarray
    wish: np.ndarray
    b: np.ndarray
    more: np.ndarray
    criterion: object
    kind: str

    def phi(self, step):
        away = step - self.wish
        return 0.5 * away @ (self.weights * away) + self.b @ step + 0.5 * step @ self.more @ step

    def gradient(self, step):
        return self.weights * (step - self.wish) + self.b + self.more @ step

    def bounds(self):
        """Bounds of the step by the table of the reference."""
        p_low, p_high, v, a = self.limits
        dt, keep = self.dt, 1.0 - RESERVE
        lower, upper = p_low - self.q, p_high - self.q
        brake_low, brake_high = (brake(np.maximum(r, 0.0), a * keep, dt) for r in (-lower, upper))
        lower = np.max([lower, -dt * v * keep, dt * (self.speed - dt * a * keep), -dt * brake_low], axis=0)
        upper = np.min([upper, dt * v * keep, dt * (self.speed + dt * a * keep), dt * brake_high], axis=0)
        return lower, upper


def brake(room, a, dt):
    """Fastest speed from which whole ticks of deceleration stop within the room: by trying numbers of ticks.

    m + 1 steps of v, v - a dt, .. cover dt ((m + 1) v - a dt m (m + 1) / 2): the room, for the largest v.
    """
    speeds = []
    for x, slower in zip(room, a, strict=True):
        if not np.isfinite(slower) or not np.isfinite(x):
            speeds.append(np.inf)
            continue
        m = 0
        while dt * slower * dt * (m + 1) * (m + 2) / 2 <= x:
            m += 1
        speeds.append(x / (dt * (m + 1)) + slower * dt * m / 2)
    return np.array(speeds)


class OwnTerm(Term):
    """A term of fixed numbers."""

    name = "own"

    def __init__(self, b, more):
        self.b, self.more = b, more

    def linear(self, q, elapsed):
        return self.b

    def quadratic(self, q):
        return self.more


def drawn_chain(rng, n):
    axes = np.eye(3)[rng.integers(0, 3, n)] * rng.choice([1.0, -1.0], (n, 1))
    skew = rng.random(n) < 0.3
    axes[skew] = rng.normal(size=(np.count_nonzero(skew), 3))
    axes /= np.linalg.norm(axes, axis=1)[:, None]
    slides = rng.random(n) < 0.15
    at = np.concatenate(
        [rng.uniform(-0.1, 0.1, (n + 1, 3)), rng.choice([0.0, 0.0, np.pi / 2, 0.7], (n + 1, 3))], axis=1
    )
    at[:, 2] += rng.choice([0.0, 0.2, 0.4], n + 1)
    tasks = (
        [(0, 1, 2), (0, 1, 2, 5), (0, 1, 2, 3, 4), (2,)]
        if n < 7
        else [tuple(range(6))] * 4 + [(0, 1, 2, 3, 4)]
    )
    task = tasks[rng.integers(len(tasks))]
    if n >= 6 and rng.random() < 0.3:
        task = tuple(range(6))
    return Chain(axes, slides, at, task if len(task) <= n else (0, 1, 2))


def drawn_limits(rng, n, q):
    """Position limits around q, some of them exactly at it, and limits of speed and acceleration or none."""
    room = rng.choice([1e-3, 0.1, 1.0, 3.0], (2, n)) * rng.uniform(0.2, 1.0, (2, n))
    room[rng.random((2, n)) < 0.12] = 0.0
    room[rng.random((2, n)) < 0.04] = 1e-16
    p_low, p_high = q - room[0], q + room[1]
    gone = rng.random(n) < 0.1
    p_low, p_high = np.where(gone, -np.inf, p_low), np.where(gone, np.inf, p_high)
    v = rng.choice([0.3, 1.0, 3.0], n) * rng.uniform(0.3, 1.0, n)
    a = rng.choice([2.0, 10.0, 50.0], n) * rng.uniform(0.3, 1.0, n)
    if rng.random() < 0.3:
        a = np.full(n, np.inf)
    return p_low, p_high, np.where(rng.random(n) < 0.05, 0.0, v), a


def drawn(seed):
    """A tick of a chain of 4 to 12 joints: state, limits, target, criterion."""
    rng = np.random.default_rng([2611, seed])
    n = int(rng.integers(4, 13))
    chain = drawn_chain(rng, n)
    q = rng.uniform(-1.5, 1.5, n) * rng.choice([1.0, 1.0, 0.0], n, p=[0.6, 0.3, 0.1])
    dt = float(rng.choice([0.001, 0.004, 0.01, 0.05]))
    limits = drawn_limits(rng, n, q)
    free = np.ones(n, dtype=bool)
    spare = n - len(chain.task)
    if spare > 1 and rng.random() < 0.3:
        free[rng.choice(n, int(rng.integers(1, spare)), replace=False)] = False
    tick = Tick(
        chain, q, np.zeros(n), limits, dt, chain.pose(q), free, np.ones(n), np.zeros(n), np.zeros(n),
        np.zeros((n, n)), None, "",
    )  # fmt: skip
    return with_criterion(rng, with_target(rng, with_speed(rng, tick)))


def with_speed(rng, tick):
    """Joints as fast as they may be at most where they stand, some at rest, some by a rounding."""
    low, high = tick.bounds()
    most = np.where(rng.random(tick.chain.n) < 0.5, low, high) / tick.dt
    share = rng.choice([0.0, 1e-16, 0.3, 0.9, 1.0], tick.chain.n, p=[0.3, 0.1, 0.3, 0.2, 0.1])
    # From rest one tick of acceleration is all the bounds tell: more is drawn from the limits of speed.
    faster = rng.random() < 0.5
    p_low, p_high, v, a = tick.limits
    room = np.minimum(p_high - tick.q, tick.q - p_low)
    stops = np.minimum(v, brake(np.maximum(room, 0.0), a * (1 - RESERVE), tick.dt)) * (1 - 2 * RESERVE)
    speed = share * (np.sign(most) * np.where(np.isfinite(stops), stops, v) if faster else most)
    return replace(tick, speed=np.where(tick.free, speed, 0.0))


def with_target(rng, tick):
    low, high = (np.where(tick.free, bound, 0.0) for bound in tick.bounds())
    kind = str(rng.choice(["inside", "edge", "beyond", "still", "residue"], p=[0.45, 0.25, 0.15, 0.1, 0.05]))
    low, high = np.minimum(low, high), np.maximum(low, high)
    step = low + rng.random(tick.chain.n) * (high - low)
    if kind == "edge":
        chosen = rng.random(tick.chain.n)
        step = np.where(chosen < 0.3, low, np.where(chosen > 0.7, high, step))
    if kind == "beyond":
        step = step * rng.choice([1.2, 3.0, 20.0])
    if kind in ("still", "residue"):
        step = np.zeros(tick.chain.n)
    rotation, position = tick.chain.pose(tick.q + step)
    if kind == "residue":
        position = position + 1e-16 * rng.normal(size=3)
    return replace(tick, target=(rotation, position), kind=kind)


def with_criterion(rng, tick):
    n = tick.chain.n
    weights = rng.choice([np.ones(n), np.arange(n, 0.0, -1.0), 10.0 ** rng.uniform(-2, 2, n)])
    wish = np.zeros(n)
    base = LeastMotion(weights)
    if rng.random() < 0.5:
        wish = rng.normal(size=n) * rng.choice([0.0, 1e-3, 0.1, 1.0]) * rng.choice([0.0, 1.0, 1.0], n)
        base = Posture(weights, tick.q + wish)
        wish = (tick.q + wish) - tick.q
    tick = replace(tick, weights=weights, wish=wish, criterion=base)
    kind = rng.choice(["none", "own", "centring", "manipulability"], p=[0.55, 0.2, 0.15, 0.1])
    weight, elapsed = float(rng.choice([0.3, 1.0, 5.0])), tick.dt * float(rng.choice([0.0, 0.5, 1.0]))
    if kind == "none":
        return tick
    b, more = np.zeros(n), np.zeros((n, n))
    if kind == "own":
        b = rng.normal(size=n) * rng.choice([0.0, 1e-3, 0.1])
        root = rng.normal(size=(n, n))
        more = root @ root.T * rng.choice([0.1, 1.0])
        term = OwnTerm(b, more)
    elif kind == "centring":
        p_low, p_high = tick.limits[:2]
        term = MeasureTerm(JointCentring(joint_limits(tick)), 10.0, tick.q)
        part = np.isfinite(p_low) & np.isfinite(p_high) & (p_high > p_low)
        with np.errstate(invalid="ignore"):
            half, middle = (p_high - p_low) / 2, (p_high + p_low) / 2
            slope = np.where(part, 2 * (tick.q - middle) / np.where(part, half, 1.0) ** 2, 0.0)
        b = 10.0 * elapsed * slope / max(np.count_nonzero(part), 1)
    else:
        kinematics = robot(tick)[0]
        term = MeasureTerm(Manipulability(kinematics), 10.0, tick.q)
        b = -10.0 * elapsed * slope_of_log(tick, kinematics.description.reach)
        if not np.all(np.isfinite(b)):
            return tick
    criterion = Combined(base, (Weighted(term, weight),), elapsed)
    return replace(tick, criterion=criterion, b=weight * b, more=weight * more)


def slope_of_log(tick, reach, h=1e-3):
    """Gradient of the logarithm of sqrt(det(J J')), position rows divided by the reach, by differences."""
    chain = tick.chain
    scale = np.where(np.array(chain.task) < 3, reach, 1.0)

    def value(q):
        rows = chain.slope(q, chain.pose(q)) / scale[:, None]
        return 0.5 * np.linalg.slogdet(rows @ rows.T)[1]

    def along(u):
        near, far = (value(tick.q + k * u) - value(tick.q - k * u) for k in (1, 2))
        return (8 * near - far) / (12 * h)

    return np.array([along(u) for u in np.eye(chain.n) * h])


def joint_limits(tick):
    p_low, p_high, v, a = tick.limits
    return JointLimits(p_low, p_high, -v, v, -a, a)


def robot(tick):
    description = read_urdf(tick.chain.urdf())
    if len(tick.chain.task) < 6:
        description = replace(description, coordinates=tuple(COORDINATES[row] for row in tick.chain.task))
    kinematics = Kinematics(description)
    return kinematics, kinematics.target(*tick.target)
