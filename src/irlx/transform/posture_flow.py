"""The posture flow: from one posture along the fibre of its tool pose to the nearest one to a posture konf.

The way is the gradient flow of the weighted distance, dq/dt = -(part of W^-1 g along the fibre), followed by
implicit Euler steps: in the tangent basis B each step solves (C + sigma) y = -B'g, C the curvature of
the distance along the fibre, sigma the damping that keeps every joint's step within `STRIDE`. Far away this
goes along the gradient, in a narrow valley along its floor without zigzag, and near the rest point, where
sigma becomes 0, it is Newton's method.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.fibre import AT_LIMIT, Fibre, Tangent
from irlx.transform.nearest import scaled_singular_values
from irlx.transform.posture_curve import even_curve
from irlx.transform.precision import SINGULAR_RATIO
from irlx.transform.qp.solver import QpSolver
from irlx.transform.step_bounds import braking_speed

Array = NDArray[np.float64]

STRIDE = 0.03
"""Largest change of a joint (rad or m) in one step of the flow."""

MAX_STEPS = 3000
"""Steps after which the flow ends where it is: about 90 rad or m of one joint."""

AT_REST = 1e-10
"""Projected gradient (weight times rad or m) at which the flow has arrived."""

ALMOST_AT_REST = 1e-8
"""Projected gradient that counts as arrived where rounding keeps the flow from less."""

REACHED = 1e-6
"""Distance of a joint (rad or m) from konf that counts as reached."""

SAME_POSE = 1e-9
"""Difference of the tool poses (m, rad) up to which konf itself is the end of a flow that comes to it."""

_SAME_VALUE = 1e-12
_FARTHEST = 1e4
_ROUNDING = 1e-15
_HALVINGS = 30
_FINE_STEP = 1e-5
_FALLING = -1e-6
_CORRECTION = 0.25
_BRAKING_STEPS = 12.0
_SEARCH = 10
_LEAST_DAMPING = 1e-9
_STRETCHES = 6
_LONG_ENOUGH = 0.6
_ONE_STRETCH = 0.1
_MOST_STRETCH = 0.01


class FlowEnd(Enum):
    """Why a flow ended."""

    KONF = "the posture is reached"
    NEAREST = "no posture near this one that keeps the tool pose is nearer"
    SINGULAR = "the arm is singular there, no step is nearer"
    STALLED = "no step is nearer"
    STEPS = "the way is too long"


@dataclass(frozen=True)
class PostureFlow:
    """A way along the fibre of a tool pose.

    `points` (K, n) rad or m: evenly spaced, the first one the start, the last one the end, all on the pose
    and within the limits; one point where nothing moves. `reached`: no joint is further than 1e-6 from konf.
    `remaining` (n,): konf - end, frozen joints included. `projected_gradient` at the end, see
    `projected_gradient`; `steps` of the flow; `end` says why it ended. `iterates` (M, n): postures of the
    `fibre` that the flow went through.
    """

    points: Array
    fibre: Fibre
    iterates: Array
    reached: bool
    remaining: Array
    projected_gradient: float
    steps: int
    end: FlowEnd

    def further_inside(self, widening: float) -> Array:
        """Points of the same way that keep `widening` times as far away from position limits."""
        return even_curve(self.fibre, self.iterates, STRIDE, widening)


def posture_flow(
    kinematics: Kinematics,
    q: Array,
    konf: Array,
    weights: Array,
    limits: JointLimits,
    free: NDArray[np.bool_],
    qp: QpSolver,
    coarse: bool = False,
) -> PostureFlow:
    """Follow the fibre of the tool pose at q (n,) down to the nearest posture to konf (n,), rad or m.

    Position `limits` hold throughout, q must keep them; joints that are not `free` (n,) stay bit by bit and
    do not count in the distance. Ends at a local minimum of it, at konf's very values where konf has the tool
    pose within 1e-9 and the flow comes to it; values of konf within 1e-12 of q's mean q's. Never raises for
    postures: `end` says where it could not go on. `coarse`, for a dry run: the same
    points to some 1e-7, for less.
    """
    meant = np.where(np.abs(konf - q) <= _SAME_VALUE, q, konf)
    # Squares of what a program may write overflow; so far away only the direction counts.
    konf_near = np.clip(meant, q - _FARTHEST, q + _FARTHEST)
    fibre = _fibre(kinematics, q, konf_near, weights, limits, free, coarse)
    iterates, end = _descend(fibre, q, qp)
    iterates = _onto_konf(fibre, iterates)
    last = iterates[-1]
    remaining = meant - last
    reached = bool(np.max(np.abs(remaining), initial=0.0) <= REACHED)
    points = (
        even_curve(fibre, np.array(iterates), STRIDE, all_at_once=coarse)
        if len(iterates) > 1
        else np.array([q])
    )
    return PostureFlow(
        points,
        fibre,
        np.array(iterates),
        reached,
        remaining,
        fibre.tangent(last).projected,
        len(iterates) - 1,
        FlowEnd.KONF if reached else end,
    )


def projected_gradient(
    kinematics: Kinematics,
    q: Array,
    konf: Array,
    weights: Array,
    limits: JointLimits,
    free: NDArray[np.bool_],
) -> float:
    """Largest component of N N' W (q - konf): 0 where no posture nearby on the tool pose is nearer to konf.

    N (n, r) is an orthonormal basis of the null space of the tool Jacobian over the joints that are free
    and not pressed against a position limit.
    """
    return _fibre(kinematics, q, konf, weights, limits, free).tangent(q).projected


def _fibre(
    kinematics: Kinematics,
    q: Array,
    konf: Array,
    weights: Array,
    limits: JointLimits,
    free: NDArray[np.bool_],
    coarse: bool = False,
) -> Fibre:
    target = kinematics.target(*kinematics.tool_pose(q))
    bounds = limits.position_lower, limits.position_upper
    return Fibre(kinematics, target, konf, weights, bounds, free, coarse)


def _descend(fibre: Fibre, q: Array, qp: QpSolver) -> tuple[list[Array], FlowEnd]:
    """Iterates from q on, each nearer to konf than the one before, and why there are no more."""
    iterates = [q]
    tangent = fibre.tangent(q)
    for _ in range(MAX_STEPS):
        step = _step(fibre, iterates[-1], tangent, qp)
        found = None if step is None else _shortened(fibre, iterates[-1], tangent, step)
        if found is None:
            return iterates, _why(fibre, iterates[-1], tangent)
        new, tangent = found
        iterates.append(new)
    return iterates, FlowEnd.STEPS


def _step(fibre: Fibre, q: Array, tangent: Tangent, qp: QpSolver) -> Array | None:
    """Step (n,) of the flow at q, or None at a rest point."""
    if tangent.basis.shape[1] == 0:
        return None
    bends, ways = np.linalg.eigh(fibre.curvature(q, tangent))
    basis = tangent.basis @ ways
    slope = basis.T @ tangent.gradient
    if tangent.projected <= max(AT_REST, _ROUNDING * _steepness(tangent)):
        return _off_the_ridge(fibre, q, basis[:, 0]) if bends[0] < _FALLING else None
    # Where the distance falls ever faster the flow needs no brake of its own; the damping bounds the step.
    stiff = np.maximum(bends, 0.0)
    damping = _damping(basis, slope, stiff)
    least = _MOST_STRETCH * damping
    for _ in range(_STRETCHES):
        step, held = _bounded(fibre, q, tangent, basis, slope, stiff + damping, qp)
        longest = float(np.max(np.abs(step), initial=0.0))
        if not held or longest >= _LONG_ENOUGH * STRIDE or damping <= least:
            break
        # A joint that brakes for its limit shall turn the way, not shorten it: the others go on.
        damping = max(least, damping * max(longest / STRIDE, _ONE_STRETCH))
    return step * min(1.0, STRIDE / max(longest, 1e-300))


def _damping(basis: Array, slope: Array, stiff: Array) -> float:
    """Least sigma >= 0 with which no joint steps further than `STRIDE`."""

    def longest(sigma: float) -> float:
        return float(np.max(np.abs(basis @ (slope / (stiff + sigma)))))

    least = _LEAST_DAMPING * max(1.0, float(stiff[-1]))
    if stiff[0] > least and longest(0.0) <= STRIDE:
        return 0.0
    if longest(least) <= STRIDE:
        return least
    low, high = least, least
    while longest(high) > STRIDE:
        low, high = high, 10.0 * high
    for _ in range(_SEARCH):
        middle = float(np.sqrt(low * high))
        low, high = (middle, high) if longest(middle) > STRIDE else (low, middle)
    return high


def _bounded(
    fibre: Fibre, q: Array, tangent: Tangent, basis: Array, slope: Array, stiff: Array, qp: QpSolver
) -> tuple[Array, bool]:
    """Minimiser of slope'y + 1/2 y' stiff y over the steps basis y within the room of the joints.

    Second result: whether the room holds a joint back.
    """
    movable = tangent.movable
    step = -basis @ (slope / stiff)
    lower, upper = _room(q, fibre)
    if not np.any((step < lower) | (step > upper)):
        return step, False
    rows = (basis / np.sqrt(stiff))[movable]
    solution = qp.solve(rows, (lower - step)[movable], (upper - step)[movable])
    if solution.z is not None:
        step[movable] += rows @ solution.z
    return step, True


def _room(q: Array, fibre: Fibre) -> tuple[Array, Array]:
    """Largest step of each joint either way: towards a limit no faster than evenly shorter steps stop on it.

    A joint that ran into its limit would kink the way of all the others.
    """
    deceleration = np.full(q.size, STRIDE / _BRAKING_STEPS)
    down, up = q - fibre.lower, fibre.upper - q
    return -braking_speed(down, deceleration, 1.0), braking_speed(up, deceleration, 1.0)


def _off_the_ridge(fibre: Fibre, q: Array, way: Array) -> Array | None:
    """Step from a posture where the distance has a ridge or saddle, to the lower of its two sides."""
    step = way * (0.1 * STRIDE / float(np.max(np.abs(way))))
    found = [(fibre.onto_pose(q + side * step), side) for side in (1.0, -1.0)]
    falls = [(fibre.decrease(q, new), side) for new, side in found if new is not None]
    fall, side = max(falls, default=(0.0, 1.0))
    return side * step if fall > 0.0 else None


def _shortened(fibre: Fibre, q: Array, tangent: Tangent, step: Array) -> tuple[Array, Tangent] | None:
    """The step, halved until the posture it leads to, back on the pose, is nearer to konf; None if never."""
    for _ in range(_HALVINGS):
        new = _back_on_pose(fibre, q + step, tangent)
        if new is not None and _follows(q, step, new):
            after = fibre.tangent(new)
            # So near to rest that rounding hides the decrease, the gradient must fall instead.
            fine = float(np.max(np.abs(step))) <= _FINE_STEP and after.projected <= 0.5 * tangent.projected
            if fine or fibre.decrease(q, new) > _resolution(fibre, q):
                return new, after
        step = 0.5 * step
        if float(np.max(np.abs(step), initial=0.0)) <= 1e-15:
            return None
    return None


def _follows(q: Array, step: Array, new: Array) -> bool:
    """Whether the way back onto the pose is a correction of the step and not another way.

    Near a singular posture the fibre bends within a step, and beyond the bend lies another part of it.
    """
    off, length = float(np.max(np.abs(new - q - step))), float(np.max(np.abs(step)))
    return off <= max(_CORRECTION * length, _FINE_STEP)


def _back_on_pose(fibre: Fibre, q: Array, tangent: Tangent) -> Array | None:
    """Posture on the pose near q; joints that are pressed against a limit, or come to one here, stay on it.

    Led off their limits by the correction, they would tremble there.
    """
    on_limit = (q - fibre.lower <= AT_LIMIT) | (fibre.upper - q <= AT_LIMIT)
    movable = tangent.movable & ~on_limit
    if fibre.leads_back(q, movable):
        found = fibre.onto_pose(q, movable)
        if found is not None:
            return found
    return fibre.onto_pose(q)


def _resolution(fibre: Fibre, q: Array) -> float:
    """Decrease of the distance that rounding of q alone can pretend."""
    return 1e-14 * float(np.max(fibre.weights * np.abs(q - fibre.konf), initial=0.0))


def _steepness(tangent: Tangent) -> float:
    return float(np.max(np.abs(tangent.gradient), initial=0.0))


def _why(fibre: Fibre, q: Array, tangent: Tangent) -> FlowEnd:
    if tangent.projected <= max(ALMOST_AT_REST, 1e3 * _ROUNDING * _steepness(tangent)):
        return FlowEnd.NEAREST
    columns = tangent.jacobian[:, tangent.movable]
    values = scaled_singular_values(columns, fibre.kinematics.row_scale)
    least = values[fibre.rank(q, tangent.movable) - 1]
    return FlowEnd.SINGULAR if least < SINGULAR_RATIO * values[0] else FlowEnd.STALLED


def _onto_konf(fibre: Fibre, iterates: list[Array]) -> list[Array]:
    """The iterates, ending at konf's values where konf has the pose and the flow came to it."""
    last = iterates[-1]
    end = np.where(fibre.free, fibre.konf, last)
    near = float(np.max(np.abs(end - last), initial=0.0)) <= REACHED
    inside = bool(np.all((end >= fibre.lower) & (end <= fibre.upper)))
    if not near or not inside or np.array_equal(end, last):
        return iterates
    twist = fibre.kinematics.difference(end, fibre.target)[0]
    if float(np.max(np.abs(twist))) > SAME_POSE:
        return iterates
    return [*iterates[:-1], end] if len(iterates) > 1 else [last, end]
