"""The variants of each experiment and what is told of their runs. Degrees; joint 10 in mm, others as said."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

import irlx

Array = NDArray[np.float64]
Facts = dict[str, str]
Ranges = tuple[tuple[float, float], ...]

SLIDE, LAST = 9, 10
"""Columns of the prismatic joint 10 and of joint 11."""

BASIC: Ranges = ((-180, 180), (-150, 0), (-180, 0), (0, 180), (-180, 0), (-180, 0), (-180, 180), (-60, 60))
BASIC += ((-180, 180), (-500, 500), (-20, 60))
RAISED: Ranges = (*BASIC[:LAST], (0, 60))
WIDE: Ranges = ((-180, 180), (-150, 90), (-180, 60), (0, 240), (-240, 0), (-240, 60), (-240, 240), (-90, 90))
WIDE += ((-180, 180), (-700, 700), (-90, 90))
SPEEDS: Ranges = (*((-50, 50),) * 9, (-500, 500), (-25, 25))
ACCELERATIONS: Ranges = (*((-350, 350),) * 9, (-50_000, 50_000), (-350, 350))


@dataclass(frozen=True)
class Variant:
    """A program of this folder with its cell, and the limits in force: deg or mm, per s, per s²."""

    label: str
    program: str
    cell: str = "square.toml"
    position: Ranges = BASIC
    speed: Ranges | None = None
    acceleration: Ranges | None = None


@dataclass(frozen=True)
class Experiment:
    """Variants that are set side by side; `facts` takes their runs, in this order."""

    title: str
    variants: tuple[Variant, ...]
    facts: Callable[..., Facts]
    distance: Callable[[irlx.Run], Array] | None = None
    """Of a run the distance (N,) mm that is drawn below the joints, if any."""
    kept: float = 0.0
    """The distance that is to be kept, mm."""


def values(rows: Array) -> Array:
    """Joint rows (N, 11) in deg and mm, or these per s, per s²."""
    shown = np.degrees(rows)
    shown[:, SLIDE] = 1000.0 * rows[:, SLIDE]
    return shown


def span(column: Array) -> str:
    """Smallest and largest value."""
    return f"{column.min():.2f}..{column.max():.2f}"


def peaks(rows: Array) -> Array:
    """Of each joint the value of largest amount, shape (11,)."""
    return rows[np.argmax(np.abs(rows), axis=0), np.arange(rows.shape[1])]


def met(run: irlx.Run) -> str:
    """Limits that held a joint, and for how many ticks: '11+ 42' is joint 11 at its upper position."""
    ticks: dict[str, int] = {}
    for event in run.summary.active:
        side = "+" if event.side == "upper" else "-"
        kind = "" if event.kind == "position" else f" {event.kind} "
        name = event.joint.removeprefix("joint_") + kind + side
        ticks[name] = ticks.get(name, 0) + event.last_tick - event.first_tick + 1
    return ", ".join(f"{name} {count}" for name, count in sorted(ticks.items()))


def ranked(amounts: Array, count: int, form: str = ".2f", but: tuple[int, ...] = ()) -> str:
    """The joints of largest amount with it, those of the columns `but` left out."""
    order = [joint for joint in np.argsort(-np.abs(amounts)) if joint not in but]
    return ", ".join(f"{joint + 1}: {amounts[joint]:{form}}" for joint in order[:count])


def changes(run: irlx.Run, other: irlx.Run) -> str:
    """The four joints, joint 10 (mm) aside, that are furthest apart at the same ticks, deg."""
    return ranked(np.max(np.abs(values(run.q) - values(other.q)), axis=0), 4, but=(SLIDE,))


def square_facts(run: irlx.Run) -> Facts:
    """Times, speed and accuracy of the motion itself (the square with least motion)."""
    dt = float(run.t[1] - run.t[0])
    steps = np.linalg.norm(np.diff(run.tool[:, :3], axis=0), axis=1)
    summary = run.summary
    return {
        "duration without the five hold ticks, s": f"{summary.duration - 5 * dt:.2f}",
        "fastest tool, m/s": f"{steps.max() / dt:.4f}",
        "Newton steps a tick": f"{summary.iterations_per_tick:.2f}",
        "path error, m and rad": f"{summary.path_position_error:.0e}, {summary.path_orientation_error:.0e}",
    }


def facts_6_1(basic: irlx.Run, raised: irlx.Run) -> Facts:
    """Position limits: joint 11 at 60°, then between 0° and 60°."""
    held = basic.t[basic.q[:, LAST] == basic.q[:, LAST].max()]
    return {
        **square_facts(basic),
        "limits met (ticks), basic": met(basic),
        "limits met (ticks), raised": met(raised),
        "joint 11, basic": span(values(basic.q)[:, LAST]),
        "joint 11, raised": span(values(raised.q)[:, LAST]),
        "joint 11 at 60 in the basic run, s": f"{held[0]:.2f}..{held[-1]:.2f}",
        "largest changes": changes(raised, basic),
    }


def facts_6_2(free: irlx.Run, limited: irlx.Run) -> Facts:
    """Speed limits: joint 11 not faster than 25 deg/s."""
    return {
        "speed of joint 11, free": span(values(free.qd)[:, LAST]),
        "speed of joint 11, limited": span(values(limited.qd)[:, LAST]),
        "limits met (ticks), free": met(free),
        "limits met (ticks), limited": met(limited),
        "fastest others, limited": ranked(peaks(values(limited.qd)), 3, ".1f", (SLIDE, LAST)),
        "fastest joint 10, limited, mm/s": f"{np.abs(values(limited.qd)[:, SLIDE]).max():.1f}",
        "largest changes": changes(limited, free),
        "planned moves, slowed stretches, least speed": slowing(limited),
    }


def facts_6_3(free: irlx.Run, limited: irlx.Run, heavy: irlx.Run) -> Facts:
    """Acceleration limits of joints 1 to 9 and 11, then with four times the weight on joint 10."""
    at_free, at_limited, at_heavy = (peaks(values(run.qdd)) for run in (free, limited, heavy))
    tops = np.abs([at_free, at_limited, at_heavy])
    growth, more = tops[1] / tops[0], tops[1] - tops[0]
    heavier = np.where(tops[2] > tops[1] * (1 + 1e-5), tops[2] - tops[1], 0.0)
    factor = tops[1, SLIDE] / tops[2, SLIDE]
    return {
        "joint 7, free": f"{at_free[6]:.1f}",
        "highest others, free": ranked(at_free, 2, ".1f", (6, SLIDE)),
        "joint 7, limited": f"{at_limited[6]:.4f}",
        "joint 7, limited, weight x 4": f"{at_heavy[6]:.4f}",
        "largest of all joints but 10, both limited": f"{np.delete(tops[1:], SLIDE, axis=1).max():.5f}",
        "limits met (ticks), limited": met(limited),
        "growth by the limit, ratio": ranked(growth, 4),
        "growth by the limit, deg/s²": ranked(more, 3, ".0f", (SLIDE,)),
        "joint 10: free, limited, weight x 4, mm/s²": ", ".join(f"{top:.0f}" for top in tops[:, SLIDE]),
        "joint 10: fourfold weight divides by": f"{factor:.2f}",
        "higher with weight x 4, deg/s²": ranked(heavier, np.count_nonzero(heavier), ".1f"),
        "planned moves, slowed stretches, least speed": slowing(limited),
        "the same, weight x 4": slowing(heavy),
    }


def slowing(run: irlx.Run) -> str:
    """Moves that were planned as a whole, slowed stretches, and the least share of the programmed speed."""
    least = min((event.achieved / event.requested for event in run.summary.slowed), default=1.0)
    return f"{run.summary.planned}, {len(run.summary.slowed)}, {100.0 * least:.1f} %"


def facts_6_4(free: irlx.Run, cyclic: irlx.Run) -> Facts:
    """Closed path: where the posture ends without and with the cyclic option."""
    return {
        "end against start, least motion": ranked(values(free.q[-1:] - free.q[:1])[0], 6, ".1f", (SLIDE,)),
        "end against start, cyclic, worst, rad or m": f"{np.max(np.abs(cyclic.q[-1] - cyclic.q[0])):.1e}",
        "limits met (ticks), cyclic": met(cyclic),
        "joint 10, cyclic, mm": span(values(cyclic.q)[:, SLIDE]),
    }


def facts_6_5(speed: irlx.Run, frozen: irlx.Run) -> Facts:
    """Joints 2 and 3 frozen, speed limits, 0° to 60° for joint 11; against 6.2."""
    q, rates = values(frozen.q), values(frozen.qd)
    wider = np.ptp(q, axis=0), np.ptp(values(speed.q), axis=0)
    return {
        "limits met (ticks), frozen": met(frozen),
        "joint 11, frozen": span(q[:, LAST]),
        "lowest joint 10, frozen, mm": f"{q[:, SLIDE].min():.2f}",
        "speed of joint 11, frozen": span(rates[:, LAST]),
        "different values of joints 2, 3": ", ".join(str(len(np.unique(frozen.q[:, j]))) for j in (1, 2)),
        **{
            f"range of joint {j + 1}, 6.2 and frozen": f"{wider[1][j]:.1f}, {wider[0][j]:.1f}"
            for j in (3, 4, 5, 6, 8, 10)
        },
        **{f"joint {j + 1}, frozen": span(q[:, j]) for j in (0, 3, 4, 5)},
    }


POINT, BOOM_RADIUS = np.array([5.4, 0.0, 6.6]), 0.13
"""The obstacle of experiment 6.6 and the radius of arm 4, m in the world."""
BOOM = ((0.0, 0.0, 1.3), (-0.2, 0.0, 0.6), (6.0, 0.0, -0.3), (-4.0, 0.0, -0.3))
"""Arms 1 to 4 of the arm table, m. Each ends at the joint of its number: 1 about z, 2 and 3 about y."""


def boom(q: Array) -> tuple[Array, Array]:
    """Where the axis of arm 4 begins and ends at postures (N, 11): (N, 3) m in the world each."""
    turn, lean = q[:, 0], np.zeros(len(q))
    at = np.zeros((len(q), 3)) + BOOM[0]
    for arm, joint in zip(BOOM[1:], (None, 1, 2), strict=True):
        lean = lean if joint is None else lean + q[:, joint]
        along = np.cos(lean) * arm[0] + np.sin(lean) * arm[2]
        up = np.cos(lean) * arm[2] - np.sin(lean) * arm[0]
        begin, at = at, at + np.column_stack([np.cos(turn) * along, np.sin(turn) * along, up])
    return begin, at


def from_axis(run: irlx.Run) -> Array:
    """Distance (N,) m of the point from the axis of arm 4."""
    begin, end = boom(run.q)
    axis, there = end - begin, POINT - begin
    share = np.clip(np.sum(axis * there, axis=1) / np.sum(axis * axis, axis=1), 0.0, 1.0)
    return np.asarray(np.linalg.norm(there - share[:, None] * axis, axis=1))


def from_shape(run: irlx.Run) -> Array:
    """Distance (N,) m of the point from the cylinder of arm 4, below 0 as deep as it is inside."""
    begin, end = boom(run.q)
    length = np.linalg.norm(end - begin, axis=1)
    along = np.sum((end - begin) * (POINT - begin), axis=1) / length
    aside = np.linalg.norm(POINT - begin - along[:, None] * (end - begin) / length[:, None], axis=1)
    beyond_end, beyond_side = np.abs(along - 0.5 * length) - 0.5 * length, aside - BOOM_RADIUS
    outside = np.hypot(np.maximum(beyond_end, 0.0), np.maximum(beyond_side, 0.0))
    return np.asarray(outside + np.minimum(np.maximum(beyond_end, beyond_side), 0.0))


def facts_6_6(plain: irlx.Run, clear: irlx.Run) -> Facts:
    """A line past a point: without and with OBSTACLE."""
    near, kept = from_shape(plain), from_shape(clear)
    contact = plain.t[near <= 0.0]
    hold = float(clear.t[1] - clear.t[0])
    return {
        "duration without the hold tick, s": f"{clear.summary.duration - hold:.2f}",
        "path error, clear, m and rad": (
            f"{clear.summary.path_position_error:.0e}, {clear.summary.path_orientation_error:.0e}"
        ),
        "nearest shape, plain, mm": f"{1000.0 * near.min():.1f}",
        "nearest axis, plain, mm": f"{1000.0 * from_axis(plain).min():.1f}",
        "contact, plain, s": f"{contact[0]:.2f}..{contact[-1]:.2f}",
        "shape at the start, mm": f"{1000.0 * kept[0]:.3f}",
        "nearest shape, clear, mm": f"{1000.0 * kept.min():.3f}",
        "axis at the start and nearest, clear, mm": (
            f"{1000.0 * from_axis(clear)[0]:.1f}, {1000.0 * from_axis(clear).min():.1f}"
        ),
        "limits met (ticks), plain": met(plain),
        "limits met (ticks), clear": met(clear),
        "joint 10, plain, mm": span(values(plain.q)[:, SLIDE]),
        "joint 10, clear, mm": span(values(clear.q)[:, SLIDE]),
        "end against plain": ranked(values(clear.q[-1:] - plain.q[-1:])[0], 6, ".1f", (SLIDE,)),
        "posture at the end, clear": ", ".join(f"{value:.1f}" for value in values(clear.q[-1:])[0]),
    }


FAST = Variant("speed limits", "square_speed.irl", speed=SPEEDS)
SOFT = Variant("with the limit", "square_accel.irl", acceleration=ACCELERATIONS)
EXPERIMENTS = {
    "6.1": Experiment(
        "position limits: basic, and joint 11 kept between 0° and 60° (raised)",
        (
            Variant("basic limits", "square.irl"),
            Variant("0° to 60° for joint 11", "square_limits.irl", position=RAISED),
        ),
        facts_6_1,
    ),
    "6.2": Experiment(
        "speed limits: without (free) and with (limited)",
        (Variant("no speed limits", "square.irl"), FAST),
        facts_6_2,
    ),
    "6.3": Experiment(
        "acceleration limit: without (free), with (limited), and with weight x 4 on joint 10",
        (
            Variant("no acceleration limit", "square.irl"),
            SOFT,
            replace(SOFT, label="the same, joint 10 with weight x 4", cell="square_weight.toml"),
        ),
        facts_6_3,
    ),
    "6.4": Experiment(
        "closed path: least motion and the cyclic option",
        (Variant("least motion", "square.irl"), Variant("cyclic option", "square_cyclic.irl")),
        facts_6_4,
    ),
    "6.5": Experiment(
        "joints 2 and 3 frozen with speed limits and 0° to 60° for joint 11 (frozen), against 6.2",
        (FAST, Variant("2 and 3 frozen", "square_frozen.irl", position=RAISED, speed=SPEEDS)),
        facts_6_5,
    ),
    "6.6": Experiment(
        "a line past a point: without (plain) and with OBSTACLE (clear)",
        (
            Variant("least motion", "line.irl", "line.toml", position=WIDE),
            Variant("with OBSTACLE", "obstacle.irl", "line.toml", position=WIDE),
        ),
        facts_6_6,
        lambda run: 1000.0 * from_shape(run),
        972.193,
    ),
}
