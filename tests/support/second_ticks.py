"""Random ticks of the inverse transform, and what independent mathematics says of them.

A robot is a chain of plain numbers. It goes to irlx as a URDF; here its forward kinematics are products of
matrices, its Jacobian is made of differences of them, the bounds of a step are those of the table in
docs/reference/inverse-transform.md, and the tick is the nonlinear problem itself:

    min phi(S)     subject to  F(q + S) = 0,  lower <= S <= upper.

It is solved by sequential quadratic programming over DAQP, and by SLSQP of SciPy where the seed says so.
Whether any step meets the pose is asked of SciPy's bounded least squares.
"""

from __future__ import annotations

import daqp
import numpy as np
from scipy.optimize import least_squares, minimize, nnls

from drawn_ticks import drawn, joint_limits, robot
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import StepLimiter
from irlx.transform.tick import TickSolver, TickStatus
from irlx.transform.tick_problem import TickProblem

PATH, SAME, OPTIMAL = 1e-9, 1e-7, 1e-6
"""Pose error (m, rad), difference of steps (rad, m), and what may be left of the conditions of an optimum, as
a share of the largest slope."""
BRINK = 1e-9
"""Bounds (rad, m) narrower by this that leave no step: then both answers are right."""
SINGULAR = 1e3
"""Condition of the rows from which on two solvers need not agree to the last digits."""


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
    # What is left of the pose may be more than the bounds leave room for: it is met to the last digit.
    for _ in range(3):
        left = tick.chain.left(tick.q + found, tick.target)
        found[moves] -= np.linalg.pinv(rows) @ left
    if np.any(found < low) or np.any(found > high):
        return "narrow", told
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
