"""All that decided one tick, for people who ask why a joint does what it does."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MoveBlock, PauseBlock, WaitBlock
from irlx.pacing.demand import Demand
from irlx.pacing.freed import Freed
from irlx.pacing.rows import MotionRows, PathPart
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.clearance import SideRows, TickClearance
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.criteria.least_motion import LeastMotion
from irlx.transform.step_bounds import BoundSource, StepBounds, StepLimiter
from irlx.transform.tick_problem import TickProblem, build_tick

Array = NDArray[np.float64]


@dataclass(frozen=True)
class JointTick:
    """One joint in one tick: `value` at its end, its `step`, the bounds of that step and where each comes
    from (position, speed, acceleration, braking; '' for none), and which of them holds it ('' for none).
    rad or m."""

    name: str
    prismatic: bool
    value: float
    step: float
    lower: float
    lower_source: str
    upper: float
    upper_source: str
    held: str


@dataclass(frozen=True)
class CriterionValue:
    """Value of a criterion at the step of the tick; `chosen` for the one in force."""

    name: str
    value: float
    chosen: bool


@dataclass(frozen=True)
class PathTick:
    """What the path asked for at a tick.

    `way` of `length` (m, or rad where the tool only `turns`), the `rate` there and the programmed one
    (per s), tool pose (m, unit quaternion x y z w) and twist (m/s, rad/s) in the world.
    """

    way: float
    length: float
    turns: bool
    rate: float
    programmed_rate: float
    position: tuple[float, ...]
    orientation: tuple[float, ...]
    twist: tuple[float, ...]


@dataclass(frozen=True)
class NearRow:
    """A pair that is kept apart: a link, an obstacle or another link, their distance (m) as the tick begins.

    Row of the problem: coefficients @ d >= least, in m.
    """

    link: str
    other: str
    distance: float
    coefficients: tuple[float, ...]
    least: float


@dataclass(frozen=True)
class QuadraticTick:
    """The quadratic problem of the tick's first Newton step, as `build_tick` gives it; rad and m.

        min g'd + 1/2 d'Hd    subject to  J d = e,  lower <= d <= upper

    `joints`: names of the n free joints; `rows`: what the m rows are. `left` e (m,), `jacobian` J (m, n),
    `gradient` g (n,), `hessian` H: its diagonal (n,), or whole (n, n). The bounds are those of the joints;
    `near` are rows of a further kind, by which pairs of solids are kept apart.
    """

    joints: tuple[str, ...]
    rows: tuple[str, ...]
    left: tuple[float, ...]
    jacobian: tuple[tuple[float, ...], ...]
    gradient: tuple[float, ...]
    hessian: tuple[float, ...] | tuple[tuple[float, ...], ...]
    near: tuple[NearRow, ...] = ()

    @property
    def unknowns(self) -> int:
        """Unknowns of the compact problem: joints more than rows."""
        return max(len(self.joints) - len(self.rows), 0)


@dataclass(frozen=True)
class TickExplanation:
    """What a tick was asked for and what it did.

    `motion` in the program's words, its `line`; `way_of_pacing`: how its row was found; `path`: what was
    asked for, None where that was no path (PTP, RECONFIGURATION, a hold), and so is `problem`; `path_error` m
    and rad.
    """

    tick: int
    time: float
    line: int
    motion: str
    way_of_pacing: str
    path: PathTick | None
    path_error: tuple[float, float]
    joints: tuple[JointTick, ...]
    criteria: tuple[CriterionValue, ...]
    problem: QuadraticTick | None = None

    def to_plain(self) -> dict[str, object]:
        """The explanation as JSON-able data."""
        return asdict(self)


def explain_tick(
    rows: MotionRows,
    rows_before: Array,
    tick: int,
    limits: JointLimits,
    weights: Array,
    kinematics: Kinematics,
    dt: float,
) -> TickExplanation:
    """Explanation of a tick of a motion.

    `rows_before` (2, n): the two rows before it, the same twice where it starts at rest; `limits` in force;
    `weights` (n,) of least motion.
    """
    row = tick - rows.first_tick
    if rows.freed is not None:
        return _explain_freed(rows, rows.freed, tick, dt)
    robot = kinematics.description
    names, prismatic = robot.joint_names, tuple(axis.is_prismatic for axis in robot.axes)
    before = np.vstack([rows_before, rows.q])
    step, last_step = before[row + 2] - before[row + 1], before[row + 1] - before[row]
    asked = rows.path.demands if rows.path is not None and not rows.passes_corner(row) else ()
    demand = asked[row] if row < len(asked) else None
    limiter, speed = StepLimiter(limits, dt), last_step / dt
    joints = _joints(rows, row, limiter, step, speed, names, prismatic)
    bounds = limiter.bounds(before[row + 1], speed)
    return TickExplanation(
        tick,
        tick * dt,
        rows.block.origin.line,
        _motion(rows),
        _way_of_pacing(rows, row),
        _path_tick(rows.path, demand, rows.length) if rows.path is not None and demand is not None else None,
        (float(rows.path_position_error[row]), float(rows.path_orientation_error[row])),
        joints,
        _criteria(rows, row, demand, before[row + 1], step, weights),
        _problem(rows, row, demand, before[row + 1], bounds, kinematics, dt),
    )


def _explain_freed(rows: MotionRows, freed: Freed, tick: int, dt: float) -> TickExplanation:
    """Explanation of a tick in which virtual joints stand among the robot's own."""
    active = np.zeros((len(rows), freed.q.shape[1]), dtype=np.int8)
    active[:, freed.joints] = rows.active
    wide = replace(rows, q=freed.q[1:], active=active, freed=None)
    before = np.vstack([freed.q[:1], freed.q[:1]])
    return explain_tick(wide, before, tick, freed.limits, freed.weights, freed.kinematics, dt)


def _problem(
    rows: MotionRows,
    row: int,
    demand: Demand | None,
    q: Array,
    bounds: StepBounds,
    kinematics: Kinematics,
    dt: float,
) -> QuadraticTick | None:
    if demand is None or rows.path is None:
        return None
    target = kinematics.target(demand.rotation, demand.position)
    free = rows.path.free
    chosen, keeping = _chosen(rows.path, row, demand), _kept_clear(rows.path, row, q, dt)
    built = build_tick(kinematics, TickProblem(target, q, bounds, chosen, free, keeping))
    names = kinematics.description.joint_names
    hessian = built.hessian.tolist()
    return QuadraticTick(
        tuple(name for name, moves in zip(names, free, strict=True) if moves),
        kinematics.row_names,
        tuple(built.twist.tolist()),
        tuple(tuple(line) for line in built.jacobian.tolist()),
        tuple(built.gradient.tolist()),
        tuple(tuple(line) for line in hessian) if built.hessian.ndim == 2 else tuple(hessian),
        _near_rows(rows.path, keeping, built.sides),
    )


def _kept_clear(path: PathPart, row: int, q: Array, dt: float) -> TickClearance | None:
    """What the tick of a row, which begins at posture q (n,), keeps clear."""
    if path.clearance is None:
        return None
    elapsed = (path.demands[row].tick - path.first_tick) * dt
    return path.clearance.tick(q, dt, elapsed)


def _near_rows(path: PathPart, keeping: TickClearance | None, sides: SideRows | None) -> tuple[NearRow, ...]:
    if path.clearance is None or keeping is None or sides is None:
        return ()
    pairs = [path.clearance.distances.pairs[number] for number in keeping.near.pairs.tolist()]
    return tuple(
        NearRow(pair.link, pair.other, distance, tuple(line), least)
        for pair, distance, line, least in zip(
            pairs, keeping.near.distance.tolist(), sides.matrix.tolist(), sides.lower.tolist(), strict=True
        )
    )


def _chosen(path: PathPart, row: int, demand: Demand) -> Criterion:
    """Criterion in force at a row."""
    return path.term.at(demand.s, demand.s - (path.demands[row - 1].s if row > 0 else path.s_before))


def _motion(rows: MotionRows) -> str:
    """The motion in the program's words."""
    if isinstance(rows.block, MoveBlock):
        return f"MOVE {rows.block.kind.value}"
    if isinstance(rows.block, PauseBlock):
        return "PAUSE"
    return "WAIT" if isinstance(rows.block, WaitBlock) else "RECONFIGURATION"


def _way_of_pacing(rows: MotionRows, row: int) -> str:
    if isinstance(rows.block, WaitBlock | PauseBlock):
        return "the robot stands"
    if rows.stops and row == len(rows) - 1:
        return "hold tick of a stop"
    if rows.passes_corner(row):
        return "row of a corner between a move of the joints and one along a path"
    if rows.path is None:
        return "row of a motion of the joints"
    return "row of a motion planned as a whole" if rows.path.planned else "ordinary tick"


def _path_tick(path: PathPart, demand: Demand, length: float) -> PathTick:
    from scipy.spatial.transform import Rotation

    scale = path.angle_per_s if path.is_turn else 1.0
    part = demand.twist[3:] if path.is_turn else demand.twist[:3]
    return PathTick(
        (demand.s - path.begin) * scale,
        length * scale,
        path.is_turn,
        float(np.linalg.norm(part)),
        scale * float(path.law.rates_at(np.array([demand.s]))[0]),
        tuple(float(x) for x in demand.position),
        tuple(float(x) for x in Rotation.from_matrix(demand.rotation).as_quat()),
        tuple(float(x) for x in demand.twist),
    )


def _joints(
    rows: MotionRows,
    row: int,
    limiter: StepLimiter,
    step: Array,
    speed: Array,
    names: tuple[str, ...],
    prismatic: tuple[bool, ...],
) -> tuple[JointTick, ...]:
    start = rows.q[row] - step
    bounds = limiter.bounds(start, speed)

    def source(number: int, bound: float) -> str:
        return BoundSource(number).name.lower() if np.isfinite(bound) else ""

    found = []
    for joint, name in enumerate(names):
        flag = int(rows.active[row, joint])
        held = f"{'upper' if flag > 0 else 'lower'} {BoundSource(abs(flag) - 1).name.lower()}" if flag else ""
        lower, upper = float(bounds.lower[joint]), float(bounds.upper[joint])
        found.append(
            JointTick(
                name,
                prismatic[joint],
                float(rows.q[row, joint]),
                float(step[joint]),
                lower,
                source(int(bounds.lower_source[joint]), lower),
                upper,
                source(int(bounds.upper_source[joint]), upper),
                held,
            )
        )
    return tuple(found)


def _criteria(
    rows: MotionRows, row: int, demand: Demand | None, q: Array, step: Array, weights: Array
) -> tuple[CriterionValue, ...]:
    least = LeastMotion(weights)
    if demand is None or rows.path is None:
        return (CriterionValue(least.name, least.value(q, step), False),)
    chosen = _chosen(rows.path, row, demand).begun(q)
    values = [CriterionValue(chosen.name, chosen.value(q, step), True)]
    if chosen.name != least.name:
        values.append(CriterionValue(least.name, least.value(q, step), False))
    return tuple(values)
