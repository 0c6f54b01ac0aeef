"""RECONFIGURATION as a motion: along the posture flow, on the fastest clock that the joints allow."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import ReconfigureBlock
from irlx.diagnostics import Place, report
from irlx.motion.plan_joint_line import RAMP_TIME
from irlx.motion.whole_ticks import ticks_of_move
from irlx.pacing.clock import Clock
from irlx.pacing.demand import Demand, Demands
from irlx.pacing.errors import PacingError
from irlx.pacing.impossible import explain_broken_row
from irlx.pacing.resolution import EVERY_TICK, Resolution
from irlx.pacing.rows import MotionRows
from irlx.pacing.slowdown.clock import plan_clock
from irlx.pacing.slowdown.clock_bounds import clock_bounds
from irlx.pacing.slowdown.curve import JointCurve
from irlx.pacing.slowdown.ladder import TimedCurve
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.planned import PlannedMotion, Refusal, Ticking, rows_on_clock
from irlx.pacing.snap import SAME_VALUE
from irlx.pacing.too_near import told
from irlx.pacing.touching import touching
from irlx.robot.limits import JointLimits
from irlx.transform.posture_flow import PostureFlow, posture_flow
from irlx.transform.qp.solver import QpSolver

Array = NDArray[np.float64]

_WIDENINGS = (4.0, 16.0, 64.0)
_NO_WAY = 1e-10


@dataclass(frozen=True)
class Reconfigured:
    """What a RECONFIGURATION becomes: its flow, its rows (None where nothing moves), and which joints were
    `held` (n,), frozen or with a limit of 0."""

    flow: PostureFlow
    rows: MotionRows | None
    held: NDArray[np.bool_]


def reconfigured(
    model: Model,
    block: ReconfigureBlock,
    q: Array,
    konf: Array,
    dt: float,
    first_tick: int,
    place: Place,
    qp: QpSolver,
    resolution: Resolution = EVERY_TICK,
) -> Reconfigured:
    """Motion from rest at posture q (n,) along the fibre of its tool pose to konf (n,) or the nearest to it.

    Joints without a speed limit move with the block's `speed_ori` (turns) or `speed` (slides), as far as its
    override lets them, those without an acceleration limit reach their speed in 0.2 s; a joint with a limit
    of 0 stays. Raises MotionError, IRL425, where it would take too long.
    """
    limits = working_limits(model, block)
    free = model.free & (_either_way(limits, "speed") > 0.0) & (_either_way(limits, "acceleration") > 0.0)
    mobile = replace(model, limits=limits, free=free)
    flow = posture_flow(model.kinematics, q, konf, model.weights, limits, free, qp, resolution.is_coarse)
    if float(np.sum(np.abs(np.diff(flow.points, axis=0)))) <= _NO_WAY:
        return Reconfigured(flow, None, ~free)
    found = _planned(mobile, flow, _ticking(mobile, q, dt, place, resolution), first_tick, place)
    return Reconfigured(flow, _motion_rows(model, block, q, found, dt, first_tick), ~free)


def working_limits(model: Model, block: ReconfigureBlock) -> JointLimits:
    """The limits in force, with a speed and an acceleration also for joints that have none."""
    axes = model.kinematics.description.axes
    law = block.law
    usual = law.override * np.array([law.speed if axis.is_prismatic else law.speed_ori for axis in axes])
    limits = model.limits
    lower, upper = limits.pair("speed")
    limits = limits.with_pair("speed", *_known(lower, upper, usual))
    lower, upper = limits.pair("acceleration")
    return limits.with_pair("acceleration", *_known(lower, upper, _either_way(limits, "speed") / RAMP_TIME))


def _known(lower: Array, upper: Array, usual: Array) -> tuple[Array, Array]:
    return np.where(np.isfinite(lower), lower, -usual), np.where(np.isfinite(upper), upper, usual)


def _either_way(limits: JointLimits, kind: str) -> Array:
    """What each joint may use in both directions, shape (n,)."""
    lower, upper = limits.pair(kind)
    return np.asarray(np.minimum(-lower, upper))


def _ticking(model: Model, q: Array, dt: float, place: Place, resolution: Resolution) -> Ticking:
    """Ticks at which the tool keeps the pose of posture q (n,)."""
    rotation, position = model.kinematics.tool_pose(q)

    def demands_of(clock: Clock) -> Demands:
        ticks = (round((k + 1) * clock.ticks_a_row) for k in range(len(clock)))
        return Demands.of(
            Demand(tick, float(s), position, rotation, np.zeros(6))
            for tick, s in zip(ticks, clock.s, strict=True)
        )

    return Ticking(dt, lambda duration: ticks_of_move(duration, dt, place), demands_of, resolution)


def _planned(
    model: Model, flow: PostureFlow, ticking: Ticking, first_tick: int, place: Place
) -> PlannedMotion:
    """Rows at ticks 1 .. N along the way of a flow.

    A curve that swings beyond a position limit between its points is laid further inside and tried again.
    """
    found = _on_curve(model, flow.points, ticking)
    for widening in _WIDENINGS:
        if not isinstance(found, Refusal) or found.near is not None:
            break
        found = _on_curve(model, flow.further_inside(widening), ticking)
    if isinstance(found, Refusal):
        if found.near is not None and model.clearance is not None:
            words, tick = told(model.clearance, found.near), first_tick + found.tick
            raise PacingError(report("IRL561", place, word="RECONFIGURATION", tick=tick, **words))
        if found.broken is None:
            raise ArithmeticError("a posture curve was refused without a reason: the planner is at fault")
        raise PacingError(explain_broken_row(found.broken, first_tick, model.kinematics.description, place))
    return found


def _on_curve(model: Model, points: Array, ticking: Ticking) -> PlannedMotion | Refusal:
    """Rows along the curve through points (K, n) on its fastest clock."""
    curve = _curve_through(points)
    clock = plan_clock(clock_bounds(curve, model.limits, np.full(curve.s.size, inf), inf))
    if clock is None:
        raise ArithmeticError("a curve has no clock from rest to rest: the clock planner is at fault")
    return rows_on_clock(model, TimedCurve(curve, clock), ticking, 0.0)


def _curve_through(points: Array) -> JointCurve:
    """The curve through points (K, n) by their way.

    On a way of some 1e-9 rad a flow stands still at most of its points: then it is straight and has as many.
    """
    way = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))))
    onward = np.concatenate(([True], np.diff(way) > 0.0))
    if onward.all():
        return JointCurve(way, points)
    share = np.linspace(0.0, 1.0, len(points))
    straight = points[0] + share[:, None] * (points[-1] - points[0])
    straight[-1] = points[-1]
    return JointCurve(share * float(np.linalg.norm(points[-1] - points[0])), straight)


def _motion_rows(
    model: Model, block: ReconfigureBlock, q: Array, found: PlannedMotion, dt: float, first_tick: int
) -> MotionRows:
    """Rows with their hold tick, the tool measured against its pose at the start."""
    kinematics, rows, ticks = model.kinematics, found.q, int(found.demands.tick[-1])
    way = found.demands.s
    held = np.vstack([rows, rows[-1:]])
    touched = touching(q, rows, model.limits, dt * ticks / len(rows))
    start_rotation, start_position = kinematics.tool_pose(q)
    rotation, position = kinematics.tool_poses(held)
    wanted = np.tile(start_rotation, (len(held), 1, 1)), np.tile(start_position, (len(held), 1))
    distance, angle = kinematics.errors(held, wanted, (rotation, position))
    if kinematics.world is not kinematics:
        rotation, position = kinematics.world.tool_poses(held)
    return MotionRows(
        block,
        first_tick,
        held,
        position,
        rotation,
        distance,
        angle,
        np.vstack([touched, np.zeros_like(touched[:1])]),
        np.append(way, way[-1]),
        float(way[-1]),
        0,
        span=ticks + 1,
    )


def settled_konf(konf: Array, q: Array, limits: JointLimits) -> Array:
    """The posture konf (n,) with values that mean the present ones, or a limit, exactly on them."""
    konf = np.where(np.abs(konf - q) <= SAME_VALUE, q, konf)
    inside = limits.into_positions(konf)
    return np.where(np.abs(konf - inside) <= SAME_VALUE, inside, konf)
