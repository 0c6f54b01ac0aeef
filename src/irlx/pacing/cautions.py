"""What a dry run has to say of moves that can be done: slowed by limits, near a singular posture."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.digits import plain
from irlx.pacing.impossible import joint_value
from irlx.pacing.rows import MotionRows, PathPart
from irlx.pacing.slowdown.clock_bounds import Governor
from irlx.pacing.slowing import Slowing
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.pose_targets import PoseTargets
from irlx.transform.row_rank import usual_rank

Array = NDArray[np.float64]

LEAST_LOSS = 0.01
"""Part of its programmed time that a move must lose to be warned of: less is hardly seen, and within what
a dry run knows."""

NEAR_SINGULAR = 0.02
"""Smallest over largest singular value of the scaled Jacobian from which on a posture is near a singular one:
some direction of the tool costs the joints fifty times the motion of another."""


_THIS = "this move"


@dataclass(frozen=True)
class Caution:
    """A finding on a move, and how bad it is: the larger the worse, comparable within a code."""

    finding: Diagnostic
    weight: float


def slowed(
    rows: MotionRows, kinematics: Kinematics, own: JointLimits, dt: float, place: Place
) -> Caution | None:
    """IRL445 where limits cost a move a part of its time worth mentioning; `own` are the robot's limits."""
    path = rows.path
    if path is None or not path.slowings:
        return None
    lost = sum(slowing.lost for slowing in path.slowings)
    share = lost / max(_programmed(rows, path), dt)
    if share < LEAST_LOSS:
        return None
    costliest = max(path.slowings, key=lambda slowing: slowing.lost)
    (unit, scale), what = _unit(path), _what(path)
    data: dict[str, Any] = {
        "what": what,
        "lost": plain(lost, 2),
        "share": plain(100.0 * share, 2),
        "achieved": plain(costliest.achieved * scale, 4),
        "requested": f"{plain(costliest.requested * scale, 4)} {unit}/s",
        "held": _held(costliest, rows.limits or own, kinematics),
        "of": "" if what == _THIS else " of this one",
        **_at(costliest.s, rows, path),
    }
    return Caution(report("IRL445", place, **data), share)


def _programmed(rows: MotionRows, path: PathPart) -> float:
    """Time, s, that a move should take, with its neighbours as far as its slow stretches reach."""
    spans = [slowing.span for slowing in path.slowings]
    first = min([path.begin, *(first for first, _ in spans)])
    last = max([path.begin + rows.length, *(last for _, last in spans)])
    begin, end = path.law.times_at(np.array([first, last]))
    return float(end - begin)


def _what(path: PathPart) -> str:
    """What is slow: the move, or those of some lines that are joined."""
    lines = [slowing.lines for slowing in path.slowings if slowing.lines is not None]
    if not lines:
        return _THIS
    first, last = min(first for first, _ in lines), max(last for _, last in lines)
    return _THIS if first == last else f"the joined moves (lines {first} to {last})"


def near_singular(rows: MotionRows, kinematics: Kinematics, place: Place) -> Caution | None:
    """IRL446 where a move along a path comes near a posture in which the tool loses a direction.

    Joints that are too few for the pose in any posture are not what the finding is about.
    """
    path = rows.path
    if path is None:
        return None
    postures = rows.q
    if rows.freed is not None:
        postures, kinematics = rows.freed.q[1:], rows.freed.kinematics
    values = _singular_values(postures, path, kinematics)
    if values.size == 0:
        return None
    shares = values[:, -1] / np.maximum(values[:, 0], np.finfo(float).tiny)
    worst = int(np.argmin(shares))
    if shares[worst] >= NEAR_SINGULAR:
        return None
    if usual_rank(kinematics, postures[worst], path.free) < kinematics.rows:
        return None
    data: dict[str, Any] = {
        "sigma": f"{values[worst, -1]:.2g}",
        "share": plain(100.0 * float(shares[worst]), 2),
        **_at(path.demands[worst].s, rows, path),
    }
    return Caution(report("IRL446", place, **data), -float(shares[worst]))


def _singular_values(q: Array, path: PathPart, kinematics: Kinematics) -> Array:
    """Singular values (N, k) of the scaled Jacobians of the first N postures of q (M, n), largest first.

    N is the number of the path's demands, whose poses are those of the postures.
    """
    if len(path.demands) == 0 or not np.any(path.free):
        return np.empty((0, 0))
    rows = min(len(q), len(path.demands))
    targets = PoseTargets(path.demands.rotation[:rows], path.demands.position[:rows])
    found = kinematics.differences(q[:rows], targets)
    jacobians = found[1][:, :, path.free]
    return np.asarray(np.linalg.svd(jacobians * kinematics.row_scale[:, None], compute_uv=False))


def _held(slowing: Slowing, limits: JointLimits, kinematics: Kinematics) -> str:
    """The limit that makes a stretch slow, in words."""
    if slowing.joint < 0 or slowing.governor is Governor.PROGRAM:
        return "the limits together"
    kind = slowing.governor.name.lower()
    # Of a limit that differs by direction the narrower side is told.
    value = float(min(abs(side[slowing.joint]) for side in limits.pair(kind)))
    robot, per = kinematics.description, "/s" if slowing.governor is Governor.SPEED else "/s2"
    bound = joint_value(robot, slowing.joint, value, per)
    return f"{robot.axes[slowing.joint].name} and its {kind} limit {bound}"


def _at(s: float, rows: MotionRows, path: PathPart) -> dict[str, str]:
    """Where on its own way a move is at a path parameter, and how long that is."""
    unit, scale = _unit(path)
    way = min(max(s - path.begin, 0.0), rows.length)
    return {"way": f"{way * scale:.4g}", "length": f"{rows.length * scale:.4g} {unit}"}


def _unit(path: PathPart) -> tuple[str, float]:
    """Unit of a way, and what one of the path parameter is in it."""
    if path.is_turn:
        return "deg", float(np.degrees(path.angle_per_s))
    return "mm", 1000.0
