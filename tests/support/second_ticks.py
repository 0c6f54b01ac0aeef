"""Random ticks of the inverse transform, and what independent mathematics says of them.

A robot is a chain of plain numbers. It goes to irlx as a URDF; here its forward kinematics are products of
matrices, its Jacobian is made of differences of them, the bounds of a step are those of the table in
docs/reference/inverse-transform.md, and the tick is the nonlinear problem itself:

    min phi(S)     subject to  F(q + S) = 0,  lower <= S <= upper.

It is solved by sequential quadratic programming over DAQP, and by SLSQP of SciPy where the seed says so.
Whether any step meets the pose is asked of SciPy's bounded least squares.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import daqp
import numpy as np
from scipy.optimize import least_squares, minimize, nnls
from scipy.spatial.transform import Rotation

from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.urdf import read_urdf
from irlx.transform.criteria.combined import Combined, Weighted
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.criteria.posture import Posture
from irlx.transform.criteria.term import MeasureTerm, Term
from irlx.transform.measures.joint_centring import JointCentring
from irlx.transform.measures.manipulability import Manipulability
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import StepLimiter
from irlx.transform.tick import TickSolver, TickStatus
from irlx.transform.tick_problem import TickProblem

COORDINATES = ("x", "y", "z", "rx", "ry", "rz")
PATH, SAME, OPTIMAL = 1e-9, 1e-7, 1e-6
"""Pose error (m, rad), difference of steps (rad, m), and what may be left of the conditions of an optimum, as
a share of the largest slope."""
BRINK = 1e-9
"""Bounds (rad, m) narrower by this that leave no step: then both answers are right."""
RESERVE = 1e-6
"""Part of bounds of speed and acceleration that a tick leaves unused."""
SINGULAR = 1e3
"""Condition of the rows from which on two solvers need not agree to the last digits."""


@dataclass(frozen=True)
class Chain:
    """Joints from the root to the tool: `at` (n + 1, 6) is xyz and rpy to each joint, then the tool."""

    axes: np.ndarray
    slides: np.ndarray
    at: np.ndarray
    task: tuple[int, ...]

    @property
    def n(self):
        return len(self.axes)

    @cached_property
    def fixed(self):
        """Rotations (n + 1, 3, 3) of the places of the joints."""
        return Rotation.from_euler("xyz", self.at[:, 3:]).as_matrix()

    @cached_property
    def crosses(self):
        """Matrices (n, 3, 3) of the cross products with the axes."""
        return np.cross(np.eye(3)[None], -self.axes[:, None, :]).transpose(0, 2, 1)

    def poses(self, q):
        """Rotations (N, 3, 3) and positions (N, 3) of the tool in postures q (N, n)."""
        rotation, position = np.broadcast_to(np.eye(3), (len(q), 3, 3)), np.zeros((len(q), 3))
        for number in range(self.n):
            position = position + rotation @ self.at[number, :3]
            rotation = rotation @ self.fixed[number]
            value = q[:, number, None]
            if self.slides[number]:
                position = position + (rotation @ self.axes[number]) * value
                continue
            cross = self.crosses[number]
            sine, cosine = np.sin(value)[..., None], np.cos(value)[..., None]
            rotation = rotation @ (np.eye(3) + sine * cross + (1.0 - cosine) * (cross @ cross))
        return rotation @ self.fixed[-1], position + rotation @ self.at[-1, :3]

    def pose(self, q):
        rotations, positions = self.poses(q[None])
        return rotations[0], positions[0]

    def all_left(self, q, target):
        """Coordinates (N, m) of the task that are missing from the tool at q (N, n) to the target."""
        rotations, positions = self.poses(q)
        back = rotations.transpose(0, 2, 1)
        shift = (back @ (target[1] - positions)[..., None])[..., 0]
        turn = Rotation.from_matrix(back @ target[0]).as_rotvec()
        return np.concatenate([shift, turn], axis=1)[:, list(self.task)]

    def left(self, q, target):
        return self.all_left(q[None], target)[0]

    def slope(self, q, target, h=3e-4):
        """Derivative (m, n) of `left`, by central differences of the fourth order."""
        units = np.eye(self.n) * h
        near, back, far, behind = np.split(
            self.all_left(np.concatenate([q + units, q - units, q + 2 * units, q - 2 * units]), target), 4
        )
        return ((8 * (near - back) - (far - behind)) / (12 * h)).T

    def urdf(self):
        """The same for irlx."""
        joints = ""
        for number, place in enumerate(self.at):
            moves = number < self.n
            kind = ("prismatic" if self.slides[number] else "revolute") if moves else "fixed"
            axis = f'<axis xyz="{numbers(self.axes[number])}"/>' if moves else ""
            limit = '<limit lower="-9" upper="9" velocity="1" effort="1"/>' if moves else ""
            joints += (
                f'<joint name="j{number}" type="{kind}"><parent link="l{number}"/>'
                f'<child link="l{number + 1}"/>'
                f'<origin xyz="{numbers(place[:3])}" rpy="{numbers(place[3:])}"/>{axis}{limit}</joint>'
            )
        links = "".join(f'<link name="l{number}"/>' for number in range(self.n + 2))
        return f'<robot name="chain">{links}{joints}</robot>'


def numbers(values):
    return " ".join(repr(float(value)) for value in values)


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


def by_irlx(tick):
    """The tick as irlx takes it, and the bounds that it found."""
    kinematics, target = robot(tick)
    bounds = StepLimiter(joint_limits(tick), tick.dt).bounds(tick.q, tick.speed)
    problem = TickProblem(target, tick.q, bounds, tick.criterion, tick.free)
    return TickSolver(kinematics, ProxQpSolver()).solve(problem), bounds


def by_daqp(tick, low, high):
    """Step of sequential quadratic programming with Jacobians by differences, None where it finds none."""
    free, chain = tick.free, tick.chain
    step = np.where(free, np.clip(np.zeros(chain.n), low, high), 0.0)
    hessian = (np.diag(tick.weights) + tick.more)[np.ix_(free, free)]
    size = np.sqrt(np.mean(np.diag(hessian)))
    share, before = 1.0, None
    for _ in range(60):
        left = chain.left(tick.q + step, tick.target)
        rows = chain.slope(tick.q + step, tick.target)[:, free]
        m, n = rows.shape
        matrix = np.vstack([np.eye(n), rows])
        upper = np.concatenate([(high - step)[free], -left])
        lower = np.concatenate([(low - step)[free], -left])
        sense = np.concatenate([np.zeros(n), np.full(m, 5)]).astype(np.int32)
        d, _, flag, _ = daqp.solve(
            hessian / size**2, tick.gradient(step)[free] / size**2, matrix, upper, lower, sense,
            primal_tol=1e-13, dual_tol=1e-13,
        )  # fmt: skip
        if flag < 1:
            return None
        if np.max(np.abs(d)) < 1e-11 and np.max(np.abs(left)) < 1e-11:
            return step
        # Where steps along a curved path turn back on themselves they are shortened.
        if before is not None and d @ before < 0.0:
            share = max(0.5 * share, 0.05)
        before = d
        step = step.copy()
        step[free] += share * d
        step = np.where(free, np.clip(step, low, high), 0.0)
    return None


def by_slsqp(tick, low, high):
    """Step of SciPy's SLSQP from the demand itself, None where it says that it failed."""
    free = tick.free & (high > low)
    fixed = np.where(tick.free, np.clip(0.0, low, high), 0.0)

    def whole(part):
        step = fixed.copy()
        step[free] = part
        return step

    scale = max(np.max(np.abs(tick.gradient(fixed))) * np.max((high - low)[free], initial=1e-9), 1e-12)
    found = minimize(
        lambda part: tick.phi(whole(part)) / scale,
        fixed[free],
        jac=lambda part: tick.gradient(whole(part))[free] / scale,
        bounds=list(zip(low[free], high[free], strict=True)),
        constraints={
            "type": "eq",
            "fun": lambda part: tick.chain.left(tick.q + whole(part), tick.target),
            "jac": lambda part: tick.chain.slope(tick.q + whole(part), tick.target)[:, free],
        },
        method="SLSQP",
        options={"ftol": 1e-15, "maxiter": 200},
    )
    return whole(found.x) if found.success else None


def reachable(tick, low, high):
    """A step within the bounds that meets the pose, by least squares from several beginnings, or None."""
    free = tick.free & (high > low)
    fixed = np.where(tick.free, np.clip(0.0, low, high), 0.0)
    rng = np.random.default_rng(1)
    for attempt in range(4):
        start = np.clip(0.0, low, high) if attempt == 0 else low + rng.random(low.size) * (high - low)
        start = np.where(np.isfinite(start), start, 0.0)

        def missing(part):
            step = fixed.copy()
            step[free] = part
            return tick.chain.left(tick.q + step, tick.target)

        def slope(part):
            step = fixed.copy()
            step[free] = part
            return tick.chain.slope(tick.q + step, tick.target)[:, free]

        inside = np.clip(start, low + 1e-3 * (high - low), high - 1e-3 * (high - low))[free]
        if not inside.size:
            return fixed if np.max(np.abs(missing(inside))) < 1e-10 else None
        found = least_squares(
            missing, inside, slope, (low[free], high[free]), xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=200
        )
        if np.max(np.abs(found.fun)) < 1e-10:
            step = fixed.copy()
            step[free] = found.x
            return step
    return None


def slope_left(tick, step, low, high):
    """What no multipliers of path and active bounds explain of the slope of phi, of its largest part."""
    free = tick.free
    gradient = tick.gradient(step)[free]
    rows = tick.chain.slope(tick.q + step, tick.target)[:, free]
    size = np.abs(step)[free] + 1e-6
    at_low, at_high = (step - low)[free] <= 1e-9 * size, (high - step)[free] <= 1e-9 * size
    sides = np.eye(free.sum())
    # gradient = rows' k + pushes: up (positive) from a lower bound, down from an upper one.
    columns = np.column_stack([rows.T, -rows.T, sides[:, at_low], -sides[:, at_high]])
    # A slope that 1e-7 (rad, m) of the way make counts as the least.
    scale = max(np.max(np.abs(gradient)), 1e-7 * np.max(tick.weights))
    _, left = nnls(columns, gradient / scale, maxiter=1000)
    return left


def condition(tick, step):
    rows = tick.chain.slope(tick.q + step, tick.target)[:, tick.free]
    return float(np.linalg.cond(rows))


def judged(seed):
    """How the tick of a seed ends, and what differs."""
    tick = drawn(seed)
    solution, bounds = by_irlx(tick)
    low, high = tick.bounds()
    told = bounds_differ(bounds, low, high)
    if solution.status is TickStatus.BOUNDS_CONFLICT:
        if not np.any(low > high + 1e-13):
            told.append("bounds that do not contradict each other count as such")
        return "conflict", told
    if np.any(low > high + 1e-11):
        return "conflict", [*told, "bounds contradict each other, and nobody says so"]
    low, high = np.minimum(low, bounds.lower), np.maximum(high, bounds.upper)
    if solution.solved:
        return solved_ends(seed, tick, solution, low, high, told)
    narrow = np.minimum(low + BRINK, high), np.maximum(high - BRINK, low)
    if np.any(narrow[0] > narrow[1]):
        return "narrow", told
    found = reachable(tick, *narrow)
    if found is None:
        return "no step", told
    moves = tick.free & (high - low > BRINK)
    rows = tick.chain.slope(tick.q + found, tick.target)[:, moves]
    if np.count_nonzero(moves) < len(rows) or np.linalg.cond(rows) > SINGULAR:
        # More rows than joints that may move: once they are rounded they no longer fit together.
        return "singular", told
    return "missed", [*told, f"{solution.status.name}, but {found} meets the pose"]


def bounds_differ(bounds, low, high):
    for found, own in ((bounds.lower, low), (bounds.upper, high)):
        both = np.isfinite(own)
        if np.any(np.isfinite(found) != both):
            return ["a bound that one has and the other has not"]
        if np.any(np.abs(found - own)[both] > 1e-12 + 1e-12 * np.abs(own[both])):
            return [f"bounds {found}, by the table {own}"]
    return []


def solved_ends(seed, tick, solution, low, high, told):
    step = np.where(tick.free, solution.q - tick.q, 0.0)
    if solution.q[~tick.free].tobytes() != tick.q[~tick.free].tobytes():
        told.append("a frozen joint moved")
    rounding = 4 * np.spacing(np.abs(tick.q) + np.abs(step))
    if np.any((step < low - rounding)[tick.free]) or np.any((step > high + rounding)[tick.free]):
        told.append(f"outside the bounds: {step}")
    p_low, p_high = tick.limits[:2]
    if np.any((solution.q < p_low)[tick.free]) or np.any((solution.q > p_high)[tick.free]):
        told.append("outside the position limits")
    off = np.max(np.abs(tick.chain.left(solution.q, tick.target)))
    if off > PATH:
        told.append(f"{off:.3g} off the path")
    if condition(tick, step) > SINGULAR:
        return "singular", told
    left = slope_left(tick, step, low, high)
    if left > OPTIMAL:
        told.append(f"slope left: {left:.3g} of the largest")
    others = [by_daqp(tick, low, high)]
    if seed % 10 == 0:
        others.append(by_slsqp(tick, low, high))
    for name, other in zip(("DAQP", "SLSQP"), others, strict=False):
        if other is None:
            continue
        apart = np.max(np.abs(other - step))
        better = tick.phi(step) - tick.phi(other)
        if apart > (SAME if name == "DAQP" else 1e-5) and better > 1e-9 * abs(tick.phi(step)):
            told.append(f"{name} finds a step {apart:.3g} away that is better by {better:.3g}")
    active = bool(np.any((step - low <= 1e-12)[tick.free]) or np.any((high - step <= 1e-12)[tick.free]))
    return ("solved at bounds" if active else "solved"), told
