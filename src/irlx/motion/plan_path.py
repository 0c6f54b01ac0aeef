"""Pre-interpolator of one LIN or CIRCLE: path and programmed time from stop to stop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import degrees, inf, sqrt

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MotionLaw, MoveBlock, MoveKind, Profile
from irlx.diagnostics import Place, report, told_apart
from irlx.motion.errors import MotionError
from irlx.motion.fastest_law import fastest_s_curves
from irlx.motion.line import Line
from irlx.motion.plan_circle import circle_path
from irlx.motion.pose_path import PosePath
from irlx.motion.sections import Sections, rise_time
from irlx.motion.swept_path import SweptPath
from irlx.motion.target_pose import target_pose
from irlx.motion.time_law import LEAST_RATE, TimeLaw
from irlx.motion.trapezoid import Trapezoid
from irlx.motion.whole_ticks import ticks_of_move

Array = NDArray[np.float64]

_TIME_SLACK = 1e-9


@dataclass(frozen=True)
class PlannedPath:
    """A path with its time law, stretched to `ticks` whole ticks (0 where nothing moves).

    `programmed` is the law before that stretch: what the program asks for.
    """

    path: PosePath
    law: TimeLaw
    ticks: int
    programmed: TimeLaw


def plan_path(
    block: MoveBlock, start_rotation: Array, start_position: Array, dt: float, place: Place
) -> PlannedPath:
    """Plan a LIN or CIRCLE from the actual pose (rotation (3, 3), position (3,) m, world).

    The targets of the block must be poses. Raises MotionError: IRL421 where TIME is too short, IRL422 for
    half a turn without an axis, IRL425 where the move would take too long, IRL427 to IRL429 for a circle
    that is none.
    """
    path = _path(block, start_rotation, start_position, place)
    # A way of more than 1E154 m has no length in numbers: infinite, and IRL425 without further words.
    with np.errstate(over="ignore"):
        nothing = path.is_nothing
    if nothing:
        return standing(path)
    if not path.axis_is_defined:
        raise MotionError(report("IRL422", place, angle=f"{degrees(path.widest_turn):.6g}"))
    return in_whole_ticks(path, path_law(path, block.law, place), dt, place)


def standing(path: PosePath) -> PlannedPath:
    """The plan of a path that is nothing."""
    still = Trapezoid(0.0, 0.0, 0.0, 0.0)
    return PlannedPath(path, still, 0, still)


def in_whole_ticks(path: PosePath, law: TimeLaw, dt: float, place: Place) -> PlannedPath:
    """The plan of a path whose law is stretched to whole ticks. Raises MotionError, IRL425, for too many."""
    ticks = ticks_of_move(law.duration, dt, place)
    return PlannedPath(path, law.stretched(ticks * dt), ticks, law)


def _path(block: MoveBlock, rotation: Array, position: Array, place: Place) -> SweptPath:
    if block.kind is MoveKind.CIRCLE:
        return circle_path(block, rotation, position, place)
    end_rotation, end_position = target_pose(block.target, rotation)
    return Line(position, rotation, end_position, end_rotation)


def path_law(path: PosePath, law: MotionLaw, place: Place) -> TimeLaw:
    """Fastest law of one line or arc that keeps the speeds and accelerations of path and turn.

    The slower of the two rules, see `_along` and `_turning`. TIME stretches it, then OVERRIDE.
    """
    (way_speed, way_acc), (turn_speed, turn_acc) = _along(path, law), _turning(path, law)
    speed, acc = min(way_speed, turn_speed), min(way_acc, turn_acc)
    if min(speed, acc) < LEAST_RATE:
        return Trapezoid(path.length, 0.0, inf, 0.0)
    fastest: TimeLaw = Trapezoid.fastest(path.length, speed, acc)
    if law.profile is Profile.S_CURVE:
        bounds = (path.length, speed, acc, acc / rise_time(law))
        fastest = fastest_s_curves(Sections(*(np.array([value]) for value in bounds)), path.length)
    timed = with_time(fastest, law, place, lambda: _governor(path, law))
    return timed if law.override == 1.0 else timed.stretched(timed.duration / law.override)


def with_time(fastest: TimeLaw, law: MotionLaw, place: Place, governor: Callable[[], str]) -> TimeLaw:
    """The law stretched to TIME where it is given. Raises MotionError, IRL421, where that is too short."""
    if law.duration is None:
        return fastest
    if law.duration < fastest.duration * (1.0 - _TIME_SLACK):
        asked, least = told_apart(law.duration, fastest.duration)
        raise MotionError(report("IRL421", place, asked=asked, least=least, governor=governor()))
    return fastest.stretched(law.duration)


def _along(path: PosePath, law: MotionLaw) -> tuple[float, float]:
    """Largest s' and s'' by SPEED and ACC; ACC bounds s'' and, by itself, the normal s'^2 curvature."""
    if path.is_pure_turn:
        return inf, inf
    return min(law.speed, _curve_speed(law.acc, path.curvature)), law.acc


def _turning(path: PosePath, law: MotionLaw) -> tuple[float, float]:
    """Largest s' and s'' by SPEED_ORI and ACC_ORI, through the turn's rate and the change of that rate."""
    rate = path.turn_rate
    if not rate > 0.0:
        return inf, inf
    return min(law.speed_ori / rate, _curve_speed(law.acc_ori, path.turn_bend)), law.acc_ori / rate


def _curve_speed(acc: float, bend: float) -> float:
    """Speed s' at which a second derivative by s alone uses up the acceleration: s'^2 bend = acc."""
    return sqrt(acc / bend) if bend > 0.0 else inf


def _governor(path: PosePath, law: MotionLaw) -> str:
    """The parameters that cost a move its time: those of the turn, or those of the path."""
    along, turning = (
        Trapezoid.fastest(path.length, *bounds).duration if min(bounds) < inf else 0.0
        for bounds in (_along(path, law), _turning(path, law))
    )
    return "SPEED_ORI and ACC_ORI" if turning >= along else "SPEED and ACC"
