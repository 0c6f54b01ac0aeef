"""Random time laws, and what integration, closed forms and Ruckig say of them.

`phases`: laws through sections with bounds of their own; each is integrated from the accelerations and jerks
that it states, and compared with the fastest motion on a fine grid. `line`, `joints`: LIN and PTP with random
parameters, compared with the rules of docs/reference/motion.md and with Ruckig, between the ticks as well.
`slowed`: lines of a robot of three slides whose joints are too slow for it: there the fastest motion is a
closed form.
"""

from __future__ import annotations

import math
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from ruckig import InputParameter, Ruckig, Trajectory
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import irlx
from irlx.blocks import MotionLaw, MoveBlock, MoveKind, Origin, PoseTarget, Profile
from irlx.diagnostics import Place
from irlx.motion.errors import MotionError
from irlx.motion.fastest_law import fastest_s_curves, fastest_trapezoids
from irlx.motion.plan_joint_line import plan_joint_line
from irlx.motion.plan_path import plan_path
from irlx.motion.sections import Sections
from irlx.robot.limits import JointLimits

KINDS = ("phases", "line", "joints")
SLOWED_EVERY = 12
"""Seeds that are whole runs of slowed lines: these take a second and more."""
EXCESS, CLOSE = 1e-9, 1e-9
RISE = 0.05
"""Time in which an S curve reaches its acceleration where no JERK is given, s."""
RESERVE = 1e-6
"""Part of the joints' limits that a PTP leaves unused."""
SLOWER = 2.5e-3
"""Part of its time that a slowed motion may take beyond the fastest, beside 2 ticks."""


@dataclass(frozen=True)
class Fastest:
    """The fastest motion over a way from rest to rest, by Ruckig; without a jerk by the closed form."""

    way: float
    speed: float
    acc: float
    jerk: float | None

    def trajectory(self):
        wanted, found = InputParameter(1), Trajectory(1)
        wanted.current_position, wanted.target_position = [0.0], [self.way]
        wanted.max_velocity, wanted.max_acceleration = [self.speed], [self.acc]
        if self.jerk is not None:
            wanted.max_jerk = [self.jerk]
        Ruckig(1).calculate(wanted, found)
        return found

    @property
    def duration(self):
        if self.jerk is not None:
            return float(self.trajectory().duration)
        if self.speed**2 >= self.way * self.acc:
            return 2.0 * math.sqrt(self.way / self.acc)
        return self.way / self.speed + self.speed / self.acc

    def at(self, shares):
        """Ways at shares of the duration."""
        found = self.trajectory()
        return np.array([found.at_time(float(share) * found.duration)[0][0] for share in shares])


def integrated(law, t):
    """Way and rate at times t, integrated from the accelerations and jerks that the phases of a law state."""
    state, found = np.zeros(2), np.zeros((len(t), 2))
    for k, jerk in enumerate(law.jerks):
        begin, end, first = law.times[k], law.times[k + 1], law.starts[k]
        inside = (t >= begin) & (t < end)
        if end == begin:
            continue
        # Times count from the start of the phase: short ones would drown in the rounding of long motions.
        solved = solve_ivp(
            lambda x, y, first=first, jerk=jerk: [y[1], first + jerk * x],
            (0.0, end - begin),
            state,
            method="DOP853",
            t_eval=np.append(t[inside] - begin, end - begin),
            rtol=1e-12,
            atol=1e-14,
        )
        found[inside] = solved.y.T[:-1]
        state = solved.y[:, -1]
    found[t >= law.times[-1]] = state
    return found[:, 0], found[:, 1], state


def phases(rng):
    count = int(rng.integers(1, 9))
    lengths = 10.0 ** rng.uniform(-3.0, 0.5, count)
    lengths[rng.random(count) < 0.1] = 1e-7
    speed, acc = 10.0 ** rng.uniform(-1.5, 0.5, count), 10.0 ** rng.uniform(-0.5, 1.0, count)
    jerk = acc * 10.0 ** rng.uniform(0.0, 2.0, count)
    bounds, whole = Sections(lengths, speed, acc, jerk), float(np.sum(lengths))
    curved = rng.random() < 0.5
    law = (fastest_s_curves if curved else fastest_trapezoids)(bounds, whole)
    told = []
    t = np.unique(np.concatenate([rng.uniform(0.0, law.duration, 400), law.times]))
    s, rate, last = integrated(law, t)
    there, there_rate = law.evaluate(t)
    if np.max(np.abs(s - there)) > 1e-10 * whole or np.max(np.abs(rate - there_rate)) > 1e-9 * law.speed:
        told.append("not the integral of what it states")
    if abs(last[0] - whole) > 1e-10 * whole or abs(last[1]) > 1e-7 * law.speed:
        told.append(f"ends at {last}, the way being {whole}")
    if there[-1] != whole or there_rate[-1] != 0.0 or there[0] != 0.0 or there_rate[0] != 0.0:
        told.append("does not begin and end at rest, exactly")
    if curved:
        ends = np.append(0.0, law.starts + law.jerks * np.diff(law.times))
        jumps = np.abs(np.append(law.starts, 0.0) - ends)
        if np.max(jumps) > 1e-9 * law.acc:
            told.append(f"the acceleration of an S curve jumps by {np.max(jumps):.3g}")
    told += beyond_sections(law, bounds, t, there, there_rate, curved)
    least = fastest_on_grid(bounds)
    if not curved and not abs(law.duration / least - 1.0) < 5e-3:
        told.append(f"takes {law.duration} s, the fastest on a grid {least} s")
    if curved and count == 1:
        own = Fastest(whole, float(speed[0]), float(acc[0]), float(jerk[0])).duration
        if abs(law.duration / own - 1.0) > CLOSE:
            told.append(f"takes {law.duration} s, Ruckig {own} s")
    return told


def beyond_sections(law, bounds, t, s, rate, curved):
    ends = np.concatenate([[0.0], np.cumsum(bounds.lengths)])
    k = np.clip(np.searchsorted(ends, s, side="right") - 1, 0, len(bounds.lengths) - 1)
    away = (np.abs(s - ends[k]) > 1e-6 * ends[-1]) & (np.abs(s - ends[k + 1]) > 1e-6 * ends[-1])
    phase = np.clip(np.searchsorted(law.times, t, side="right") - 1, 0, len(law.jerks) - 1)
    acc = law.starts[phase] + law.jerks[phase] * (t - law.times[phase])
    told = []
    if np.any((rate > bounds.speed[k] * (1 + EXCESS))[away]):
        told.append("faster than a section allows")
    if np.any((np.abs(acc) > bounds.acc[k] * (1 + 1e-6))[away]):
        told.append("accelerates more than a section allows")
    if curved and np.any((np.abs(law.jerks[phase]) > bounds.jerk[k] * (1 + EXCESS))[away]):
        told.append("jerks more than a section allows")
    return told


def fastest_on_grid(bounds, each=400):
    """Duration of the fastest motion with bounded acceleration, from squares of rates on a grid."""
    steps = np.repeat(bounds.lengths / each, each)
    acc, cap = np.repeat(bounds.acc, each), np.repeat(bounds.speed**2, each)
    square = np.minimum(np.append(cap, np.inf), np.append(np.inf, cap))
    square[0] = square[-1] = 0.0
    for i in range(len(steps)):
        square[i + 1] = min(square[i + 1], square[i] + 2.0 * acc[i] * steps[i])
    for i in range(len(steps) - 1, -1, -1):
        square[i] = min(square[i], square[i + 1] + 2.0 * acc[i] * steps[i])
    rate = np.sqrt(square)
    # Between two knots the rate may rise above both, which matters where both are small.
    mean = 0.5 * (rate[1:] + rate[:-1])
    return float(np.sum(steps / mean))


def drawn_law(rng):
    """Parameters of a move: SI units."""
    jerk = float(10.0 ** rng.uniform(0.5, 2.0)) if rng.random() < 0.5 else None
    return MotionLaw(
        speed=float(10.0 ** rng.uniform(-2.0, 0.5)),
        acc=float(10.0 ** rng.uniform(-1.0, 1.0)),
        speed_ori=float(10.0 ** rng.uniform(-1.0, 0.7)),
        acc_ori=float(10.0 ** rng.uniform(-0.5, 1.0)),
        speed_ptp=float(rng.choice([1.0, 0.5, 0.01])),
        acc_ptp=float(rng.choice([1.0, 0.3])),
        profile=Profile.S_CURVE if rng.random() < 0.5 else Profile.TRAPEZOID,
        jerk=jerk,
        override=float(rng.choice([1.0, 1.0, 0.7, 0.05])),
    )


def whole(duration, dt):
    return max(1, math.ceil(duration / dt - 1e-6))


def line(rng):
    law = drawn_law(rng)
    start = Rotation.random(random_state=int(rng.integers(1 << 30)))
    way = rng.normal(size=3)
    way *= float(rng.choice([1e-6, 1e-3, 0.1, 1.0, 5.0])) / np.linalg.norm(way)
    axis = rng.normal(size=3)
    turn = axis / np.linalg.norm(axis) * float(rng.choice([0.0, 0.0, 1e-4, 0.5, 3.0]))
    if rng.random() < 0.1 and np.any(turn):
        way = np.zeros(3)
    begin, end = rng.normal(size=3), start * Rotation.from_rotvec(turn)
    goal = begin + way
    x, y, z, w = end.as_quat()
    target = PoseTarget(tuple(map(float, goal)), (float(x), float(y), float(z), float(w)))
    dt = float(rng.choice([0.001, 0.004, 0.01, 0.05]))
    block = MoveBlock(id=1, origin=Origin("t.irl", 0, 1, 1), kind=MoveKind.LIN, target=target, law=law)
    plan = plan_path(block, start.as_matrix(), begin, dt, Place("t.irl"))
    length, angle = float(np.linalg.norm(goal - begin)), float(np.linalg.norm(turn))
    return by_rules(rng, plan, length, angle, law, dt) + between_ticks(plan, start, begin, goal, law, dt)


def by_rules(rng, plan, length, angle, law, dt):
    """The time of a line by the rules: the slower of way and turn, JERK in the share of the acceleration."""
    if length == 0.0:
        own, speed, acc = angle, law.speed_ori, law.acc_ori
    else:
        rate = angle / length
        own = length
        speed = min(law.speed, law.speed_ori / rate) if rate else law.speed
        acc = min(law.acc, law.acc_ori / rate) if rate else law.acc
    rise = RISE if law.jerk is None else law.acc / law.jerk
    fastest = Fastest(own, speed, acc, acc / rise if law.profile is Profile.S_CURVE else None)
    duration = fastest.duration / law.override
    told = []
    if abs(plan.programmed.duration / duration - 1.0) > 1e-8:
        told.append(f"LIN takes {plan.programmed.duration} s, by the rules {duration} s")
    if plan.ticks != whole(duration, dt) and plan.ticks != whole(plan.programmed.duration, dt):
        told.append(f"{plan.ticks} ticks for {duration} s")
    shares = np.sort(rng.random(50))
    found = plan.law.evaluate(shares * plan.law.duration)[0] / plan.law.length
    if np.max(np.abs(found - fastest.at(shares) / own)) > 1e-8:
        told.append(
            f"not the way of Ruckig: {np.max(np.abs(found - fastest.at(shares) / own)):.3g} of it off"
        )
    return told


def between_ticks(plan, start, begin, goal, law, dt):
    """Limits of way and turn by differences of poses between the ticks, and the end."""
    count = 2000
    t = np.linspace(0.0, plan.law.duration, count + 1)
    h = t[1]
    poses = plan.path.poses(plan.law.evaluate(t)[0])
    told = []
    way = np.diff(poses.position, axis=0) / h
    turned = poses.rotation[:-1].transpose(0, 2, 1) @ poses.rotation[1:]
    turn = Rotation.from_matrix(turned).as_rotvec() / h
    size = np.max(np.abs(poses.position)) + 1.0
    for name, rate, most, acc, room in (
        ("way", way, law.speed, law.acc, 4e-16 * size / h),
        ("turn", turn, law.speed_ori, law.acc_ori, 1e-15 / h),
    ):
        speeds = np.linalg.norm(rate, axis=1)
        if np.max(speeds) > most * law.override * (1.0 + 1e-9) + room:
            told.append(f"{name}: {np.max(speeds)} is faster than {most * law.override}")
        changes = np.linalg.norm(np.diff(rate, axis=0), axis=1) / h
        if np.max(changes) > acc * law.override**2 * (1.0 + 1e-6) + 8 * room / h:
            told.append(f"{name}: accelerates by {np.max(changes)}, allowed {acc * law.override**2}")
    last = plan.path.poses(plan.law.evaluate(np.array([plan.ticks * dt, 1e9]))[0])
    if np.any(last.position != last.position[0]) or np.max(np.abs(last.position[0] - goal)) > 1e-15 * size:
        told.append(f"ends {last.position[0] - goal} off its target")
    return told


def joints(rng):
    n = int(rng.integers(1, 13))
    law = drawn_law(rng)
    start = rng.normal(size=n)
    way = rng.normal(size=n) * rng.choice([0.0, 1e-16, 1e-3, 1.0], n, p=[0.2, 0.1, 0.2, 0.5])
    way[rng.integers(n)] = rng.choice([1e-6, 1.0])
    end = start + way
    way = end - start
    up, down = (10.0 ** rng.uniform(-1.0, 1.0, n) for _ in "ab")
    a, b = (10.0 ** rng.uniform(-0.5, 1.5, n) for _ in "ab")
    limits = JointLimits(np.full(n, -99.0), np.full(n, 99.0), -down, up, -b, a)
    dt = float(rng.choice([0.001, 0.004, 0.01]))
    plan = plan_joint_line(start, end, law, limits, tuple(f"j{i}" for i in range(n)), dt, Place("t.irl"))
    moving = way != 0.0
    if not np.any(moving):
        return ["plans a way of nothing"] if plan.ticks else []
    size = np.abs(way[moving])
    most = np.where(way > 0.0, up, down)[moving] * law.speed_ptp * (1.0 - RESERVE)
    change = np.minimum(a, b)[moving] * law.acc_ptp * (1.0 - RESERVE)
    speed, acc = float(np.min(most / size)), float(np.min(change / size))
    fastest = Fastest(1.0, speed, acc, acc / RISE if law.profile is Profile.S_CURVE else None)
    duration = fastest.duration / law.override
    told = []
    if plan.ticks != whole(duration, dt) and abs(duration / dt - round(duration / dt)) > 2e-6:
        told.append(f"PTP takes {plan.ticks} ticks, by Ruckig {duration / dt}")
    rows = plan.postures(dt)
    share = np.arange(1, plan.ticks + 1) / plan.ticks
    own = start + fastest.at(share)[:, None] * way
    if np.max(np.abs(rows - own)) > 1e-8:
        told.append(f"PTP: {np.max(np.abs(rows - own)):.3g} off the way of Ruckig")
    return told + rows_of_joints(rows, start, end, limits, dt, law)


def rows_of_joints(rows, start, end, limits, dt, law):
    """Limits by differences of rows, rest before and behind, the end and what does not move to the bit."""
    told = []
    q = np.concatenate([[start, start], rows, rows[-1:]])
    v = np.diff(q, axis=0) / dt
    a = np.diff(v, axis=0) / dt
    unit = np.spacing(np.max(np.abs(q)))
    if np.any(v > limits.speed_upper * law.speed_ptp + 2 * unit / dt) or np.any(
        v < limits.speed_lower * law.speed_ptp - 2 * unit / dt
    ):
        told.append("PTP faster than its joints")
    most = np.minimum(limits.acceleration_upper, -limits.acceleration_lower) * law.acc_ptp
    if np.any(np.abs(a) > most + 4 * unit / dt**2):
        told.append("PTP accelerates more than its joints")
    if rows[-1].tobytes() != end.tobytes():
        told.append("PTP does not end where it is told")
    still = start == end
    if rows[:, still].tobytes() != np.broadcast_to(start[still], rows[:, still].shape).tobytes():
        told.append("a joint that does not move changes its bits")
    return told


CELL = """[robot]
model = "slides.urdf"
task = ["x", "y", "z"]
start = [0, 0, 0]
[robot.limits]
speed = {speed}
acceleration = {acc}
[motion]
tick_ms = {tick}
"""


def slides_urdf():
    joints = "".join(
        f'<joint name="{name}" type="prismatic"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<axis xyz="{axis}"/><limit lower="-9" upper="9" velocity="9" effort="1"/></joint>'
        for i, (name, axis) in enumerate((("x", "1 0 0"), ("y", "0 1 0"), ("z", "0 0 1")))
    )
    links = "".join(f'<link name="l{i}"/>' for i in range(4))
    return f'<robot name="slides">{links}{joints}</robot>'


def slowed(rng):
    """A line of three slides: its fastest motion is a trapezoid by the strictest of tool and joints."""
    speed, acc = float(rng.uniform(100, 1000)), float(rng.uniform(500, 3000))
    v, a = rng.uniform(30.0, 600.0, 3), rng.uniform(200.0, 3000.0, 3)
    goal = rng.normal(size=3) * rng.choice([0.0, 1.0, 1.0], 3)
    goal[rng.integers(3)] = 1.0
    goal = np.round(goal * float(rng.choice([20.0, 300.0, 900.0])), 3)
    tick = int(rng.choice([4, 10]))
    with tempfile.TemporaryDirectory() as folder:
        at = Path(folder)
        (at / "slides.urdf").write_text(slides_urdf())
        cell = CELL.format(speed=v.round(3).tolist(), acc=a.round(3).tolist(), tick=tick)
        (at / "p.toml").write_text(cell)
        point = ", ".join(map(str, goal.tolist()))
        text = f"MOVE LIN POSITION({point}) SPEED := {speed:.3f}, ACC := {acc:.3f};"
        (at / "p.irl").write_text(f"PROGRAM p;\nBEGIN\n  {text}\nENDPROGRAM\n")
        run = irlx.run(at / "p.irl")
    length = float(np.linalg.norm(goal))
    share = np.abs(goal) / length
    with np.errstate(divide="ignore"):
        fastest = Fastest(
            length, min(round(speed, 3), np.min(v.round(3) / share)),
            min(round(acc, 3), np.min(a.round(3) / share)), None,
        )  # fmt: skip
    told, dt = [], tick * 1e-3
    # One hold tick behind every motion.
    taken, least = run.t[-1] - dt, fastest.duration
    if not least - 1e-6 * dt <= taken <= least * (1.0 + SLOWER) + 2 * dt:
        told.append(f"takes {taken:.4f} s, the fastest {least:.4f} s, tick {dt}")
    if np.max(np.abs(run.q[-1] - goal * 1e-3)) > 1e-12:
        told.append("does not end at its target")
    off = np.linalg.norm(run.q - np.outer(run.q @ goal / length, goal / length), axis=1)
    if np.max(off) > 1e-12:
        told.append(f"{np.max(off):.3g} off the line")
    return told


def judged(seed):
    """Kind of the law of a seed, and what differs."""
    rng = np.random.default_rng([77, seed])
    if seed % SLOWED_EVERY == SLOWED_EVERY - 1:
        return "slowed", slowed(rng)
    kind = KINDS[seed % len(KINDS)]
    try:
        return kind, {"phases": phases, "line": line, "joints": joints}[kind](rng)
    except MotionError as error:
        # Two million ticks are too many for a move.
        return "refused", [] if error.reason.code == "IRL425" else [str(error)]
