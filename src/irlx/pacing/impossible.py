"""Says why a move cannot go on: where on the path, which joints hold it back, what is missing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from irlx.blocks import LimitKind
from irlx.diagnostics import Diagnostic, Place, report, told_apart
from irlx.motion.plan_path import PlannedPath
from irlx.motion.pose_path import PosePath
from irlx.pacing.demand import Demand
from irlx.pacing.freed import Freed
from irlx.pacing.path_motion import Failure
from irlx.pacing.row_check import BrokenBound
from irlx.pacing.slowdown.clock_bounds import Governor
from irlx.pacing.slowdown.ladder import TimedCurve
from irlx.pacing.slowdown.planned import Refusal
from irlx.pacing.target_words import target_words
from irlx.pacing.too_near import told
from irlx.pacing.walk import Halt
from irlx.promises import FOLLOWED_TURN, PATH_ORIENTATION, PATH_POSITION
from irlx.robot.description import RobotDescription
from irlx.robot.kinematics import Kinematics, Sizes
from irlx.robot.limits import JointLimits
from irlx.transform.clearance import Clearance, TooNear
from irlx.transform.nearest import Nearest, scaled_singular_values
from irlx.transform.posture_search import closest, nearest_approach
from irlx.transform.step_bounds import BoundSource, StepBounds
from irlx.transform.tick import TickStatus

Array = NDArray[np.float64]

_AT_BOUND = 1e-6
_NOISE = 1e-9
_PLANNED_AT = 3e-4
_HARDLY_CLEAR = 1e-3
_LIMIT_NAMES = {
    BoundSource.POSITION: "position",
    BoundSource.SPEED: "speed",
    BoundSource.ACCELERATION: "acceleration",
    BoundSource.BRAKING: "position (braking before it)",
}


@dataclass(frozen=True)
class Surroundings:
    """What the diagnosis needs to know of the move: robot, limits in force, free joints, and the clause or
    switch of the program that narrowed a kind of limit, in words; what is kept clear, and the posture (n,)
    that the move starts in; which joints are bands of WITH TOLERANCE, that no switch narrows."""

    kinematics: Kinematics
    limits: JointLimits
    free: NDArray[np.bool_]
    asked_by: Mapping[LimitKind, str] = field(default_factory=dict)
    clearance: Clearance | None = None
    start: Array | None = None
    freed: Freed | None = None

    def narrowed_by(self, joint: int, kind: str) -> str | None:
        """The clause or switch that narrowed a kind of limit of a joint, in words."""
        if self.freed is not None and joint not in self.freed.joints:
            return None
        return self.asked_by.get(LimitKind(kind.upper()))


def joint_value(robot: RobotDescription, joint: int, value: float, per: str = "") -> str:
    """Joint value in people's units: rad -> deg, m -> mm; `per` is '', '/s' or '/s2'."""
    prismatic = robot.axes[joint].is_prismatic
    return f"{value * 1000.0:.6g} mm{per}" if prismatic else f"{np.degrees(value):.6g} deg{per}"


def joint_values(robot: RobotDescription, joint: int, *values: float, per: str = "") -> list[str]:
    """Values of a joint that a message compares, in people's units, with the digits that tell them apart."""
    prismatic = robot.axes[joint].is_prismatic
    unit = f"{'mm' if prismatic else 'deg'}{per}"
    told = told_apart(*(1e3 * value if prismatic else float(np.degrees(value)) for value in values))
    return [f"{value} {unit}" for value in told]


def outside_words(robot: RobotDescription, joint: int, value: float, limits: JointLimits) -> dict[str, Any]:
    """Words of a message on a joint's value outside its position limits: joint, value, lower, upper."""
    lower, upper = (float(side[joint]) for side in limits.pair("position"))
    names = "value", "lower", "upper"
    told = dict(zip(names, joint_values(robot, joint, float(value), lower, upper), strict=True))
    return {"joint": robot.axes[joint].name, **told}


def explain_halt(
    halt: Halt, around: Surroundings, path: PosePath, goal: Nearest | None, place: Place
) -> Diagnostic:
    """Diagnostic of a tick that no joint step can do (IRL520: bounds, IRL521: out of reach)."""
    solution = halt.solution
    kinematics = around.kinematics
    _, jacobian = kinematics.difference(
        solution.q, kinematics.target(halt.demand.rotation, halt.demand.position)
    )
    sigma = float(scaled_singular_values(jacobian[:, around.free], kinematics.row_scale)[-1])
    unit, scale = _way_unit(path)
    held = _held_joints(halt, around)
    data: dict[str, Any] = {
        "tick": halt.demand.tick,
        "target": target_words(path.end_position),
        "way": f"{halt.demand.s * scale:.6g}",
        "length": f"{path.length * scale:.6g} {unit}",
        "held": "; ".join(held) if held else _nearest_to_limit(solution.q, around),
        "sigma": f"{sigma:.2g}",
        "missing": _missing(kinematics.sizes(solution.twist), goal),
    }
    return report("IRL520" if held else "IRL521", place, **data)


def explain_failure(
    failure: Failure,
    around: Surroundings,
    plan: PlannedPath,
    first_tick: int,
    goal: Nearest | None,
    place: Place,
) -> Diagnostic:
    """Diagnostic of a motion that no clock leads through.

    IRL560: what would come too near; IRL520 and IRL521: a place that no posture within the position limits
    reaches; IRL524: the clock would stand still for a bound; IRL523: rows that pass a bound however slow.
    """
    refusal, path = failure.refusal, plan.path
    tick = first_tick + int(
        plan.programmed.times_at(np.array([refusal.s]))[0] / plan.programmed.duration * plan.ticks
    )
    near = _too_near(refusal, around)
    if near is not None and around.clearance is not None:
        unit, scale = _way_unit(path)
        way, length = f"{refusal.s * scale:.6g}", f"{path.length * scale:.6g} {unit}"
        near_words = told(around.clearance, near)
        return report("IRL560", place, tick=tick, way=way, length=length, **near_words)
    if refusal.solution is not None:
        nowhere = np.full(refusal.solution.q.size, np.inf)
        source = np.full(nowhere.size, BoundSource.POSITION, dtype=np.int8)
        poses = path.poses(np.array([refusal.s]))
        demand = Demand(tick, refusal.s, poses.position[0], poses.rotation[0], np.zeros(6))
        bounds = StepBounds(-nowhere, nowhere, source, source)
        solution = refusal.solution._replace(active=_near_limits(refusal.solution.q, around.limits))
        return explain_halt(Halt(demand, bounds, solution), around, path, goal, place)
    if refusal.timed is not None:
        return _explain_standing(refusal.timed, refusal.knot, around, path, place)
    broken = refusal.broken or failure.broken
    if broken is None:
        raise ArithmeticError("a motion was refused without a reason: the planner is at fault")
    return explain_broken_row(broken, first_tick, around.kinematics.description, place)


def _too_near(refusal: Refusal, around: Surroundings) -> TooNear | None:
    """The pair for which a motion is refused: that which is nearest where limits alone would let it go on."""
    if refusal.near is not None:
        return refusal.near
    solution = refusal.solution
    if solution is None or around.clearance is None:
        return None
    start = solution.q if around.start is None else around.start
    found = around.clearance.nearest(solution.q, start, elapsed=refusal.elapsed)
    if found is not None and found.distance >= found.floor:
        # The margin alone would let it go on; plans keep more.
        found = around.clearance.nearest(solution.q, start, refusal.reserve, refusal.elapsed)
    if found is None or solution.status is TickStatus.TOO_NEAR:
        return found
    return found if found.distance <= found.floor + _HARDLY_CLEAR else None


def _explain_standing(
    timed: TimedCurve, knot: int, around: Surroundings, path: PosePath, place: Place
) -> Diagnostic:
    """IRL524: at some place the clock stands, or nearly so, because of a joint's speed or acceleration."""
    kinematics, clock = around.kinematics, timed.clock
    robot = kinematics.description
    joint, kind = int(clock.joint[knot]), Governor(int(clock.governor[knot]))
    unit, scale = _way_unit(path)
    bound = "the limits together"
    if joint >= 0 and kind is not Governor.PROGRAM:
        name = kind.name.lower()
        value = float(np.min(np.abs([side[joint] for side in around.limits.pair(name)])))
        per = "/s" if kind is Governor.SPEED else "/s2"
        bound = f"{robot.axes[joint].name} and its {name} limit {joint_value(robot, joint, value, per)}"
    q = timed.curve.q[knot]
    _, jacobian = kinematics.here(q)
    sigma = float(scaled_singular_values(jacobian[:, around.free], kinematics.row_scale)[-1])
    way = f"{float(clock.s[knot]) * scale:.6g}"
    return report(
        "IRL524",
        place,
        way=way,
        length=f"{path.length * scale:.6g} {unit}",
        bound=bound,
        sigma=f"{sigma:.2g}",
    )


def _near_limits(q: Array, limits: JointLimits) -> NDArray[np.int8]:
    """+1 / -1 for joints (n,) at their upper / lower position limit, as near as a plan goes to it."""
    upper, lower = limits.position_upper - q <= _PLANNED_AT, q - limits.position_lower <= _PLANNED_AT
    return np.where(upper, 1, np.where(lower, -1, 0)).astype(np.int8)


def _may_not_move(joint: int, around: Surroundings) -> str:
    """Which limit of 0 keeps a joint where it is, or ''."""
    low, high = around.limits.pair("speed")
    if low[joint] == 0.0 and high[joint] == 0.0:
        return "speed"
    low, high = around.limits.pair("acceleration")
    return "acceleration" if low[joint] == 0.0 or high[joint] == 0.0 else ""


def _way_unit(path: PosePath) -> tuple[str, float]:
    return ("deg", float(np.degrees(1.0))) if path.is_pure_turn else ("mm", 1000.0)


def _missing(left: Sizes, goal: Nearest | None) -> str:
    if goal is not None and (goal.distance > _AT_BOUND or goal.angle > _AT_BOUND):
        return (
            "the target itself is out of reach: the nearest posture found within the limits leaves "
            f"{_millimetres(goal.distance)} and {_degrees(goal.angle)}"
        )
    here = f"{_millimetres(left.distance)} and {_degrees(left.angle)} are missing"
    if max(left.distance, left.angle) <= _NOISE:
        here = "nothing is missing, but the search for the best posture does not settle"
    return f"at this tick {here}; the target itself can be reached in some posture"


def _millimetres(distance: float) -> str:
    return f"{distance * 1000.0:.6g} mm" if distance > _NOISE else "0 mm"


def _degrees(angle: float) -> str:
    return f"{np.degrees(angle):.4g} deg" if angle > _NOISE else "0 deg"


def _held_joints(halt: Halt, around: Surroundings) -> list[str]:
    """Words for every joint that stands on a bound of its step, its limit named."""
    robot, bounds, solution = around.kinematics.description, halt.bounds, halt.solution
    words = []
    for joint in range(len(robot.axes)):
        name = robot.axes[joint].name
        if not around.free[joint]:
            continue
        kind = _may_not_move(joint, around)
        if kind:
            words.append(f"{name} may not move (its {kind} limit is 0)")
            continue
        if bounds.lower[joint] > bounds.upper[joint]:
            low, high = (
                _LIMIT_NAMES[BoundSource(s[joint])] for s in (bounds.lower_source, bounds.upper_source)
            )
            words.append(f"{name} cannot keep its {low} and its {high} limit at once")
        elif solution.active[joint]:
            upper = bool(solution.active[joint] > 0)
            source = BoundSource((bounds.upper_source if upper else bounds.lower_source)[joint])
            words.append(f"{name} is at its {_limit(joint, source, upper, around)}")
    return words


def _limit(joint: int, source: BoundSource, upper: bool, around: Surroundings) -> str:
    side = "upper" if upper else "lower"
    kind = {BoundSource.SPEED: "speed", BoundSource.ACCELERATION: "acceleration"}.get(source, "position")
    per = {"speed": "/s", "acceleration": "/s2"}.get(kind, "")
    value = around.limits.pair(kind)[1 if upper else 0][joint]
    asked = around.narrowed_by(joint, kind)
    origin = f" ({asked})" if asked is not None else ""
    words = joint_value(around.kinematics.description, joint, value, per)
    return f"{side} {_LIMIT_NAMES[source]} limit {words}{origin}"


def _nearest_to_limit(q: Array, around: Surroundings) -> str:
    """Words for a posture in which no joint stands on a limit: the one that is nearest to one."""
    robot = around.kinematics.description
    room = np.minimum(q - around.limits.position_lower, around.limits.position_upper - q)
    room = np.where(around.free, room, np.inf)
    joint = int(np.argmin(room))
    if not np.isfinite(room[joint]):
        return "no joint stands on a limit"
    left = joint_value(robot, joint, float(room[joint]))
    return f"no joint stands on a limit; nearest to one is {robot.axes[joint].name} with {left} left"


def explain_broken_row(
    broken: BrokenBound, first_tick: int, robot: RobotDescription, place: Place
) -> Diagnostic:
    """Diagnostic of rows that would break a bound by differences (IRL523)."""
    per = {"SPEED": "/s", "ACCELERATION": "/s2"}.get(broken.kind.value, "")
    value, bound = joint_values(robot, broken.joint, broken.value, broken.bound, per=per)
    return report(
        "IRL523",
        place,
        joint=robot.axes[broken.joint].name,
        kind=broken.kind.value.lower(),
        value=value,
        bound=bound,
        tick=first_tick + broken.row,
    )


def slower_than_allowed(duration: float, programmed: float, longest: float, place: Place) -> Diagnostic:
    """IRL525: a move slowed more than the caller allows; all in s."""
    lasts, asked = told_apart(duration, programmed, digits=4)
    factor, allowed = told_apart(duration / programmed, longest / programmed, digits=3)
    return report("IRL525", place, duration=lasts, programmed=asked, factor=factor, allowed=allowed)


def goal_shortfall(around: Surroundings, rotation: Array, position: Array, q: Array, whole: bool) -> Nearest:
    """How near the tool can come to a goal pose within the limits, from any of several starts.

    `whole`: what follows from the task's coordinates counts as well.
    """
    kinematics = around.kinematics
    target, approaches = kinematics.target(rotation, position), list[Nearest]()
    for found in nearest_approach(kinematics, rotation, position, q, around.limits, around.free):
        approaches.append(
            _in_all(found, kinematics, target) if whole and kinematics.following.size else found
        )
        if approaches[-1].distance <= PATH_POSITION and approaches[-1].angle <= PATH_ORIENTATION:
            # Nearer than there nothing can come.
            break
    return closest(approaches, kinematics.description.reach)


def _in_all(found: Nearest, kinematics: Kinematics, target: pin.SE3) -> Nearest:
    """What is left of a pose, turns that follow from the task's coordinates included."""
    turns = kinematics.left_of(kinematics.following, found.q, target)
    turns = np.where(np.abs(turns) <= FOLLOWED_TURN, 0.0, turns)
    angle = float(np.hypot(found.angle, np.linalg.norm(turns)))
    return replace(found, sizes=found.sizes._replace(angle=angle))
