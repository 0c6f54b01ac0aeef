"""Pre-interpolator of LIN: path and programmed time of one move from stop to stop."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, inf

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import MotionLaw, MoveBlock, PoseTarget
from irlx.diagnostics import Place, report
from irlx.motion.errors import MotionError
from irlx.motion.line import Line
from irlx.motion.trapezoid import Trapezoid
from irlx.motion.whole_ticks import ticks_of_move

Array = NDArray[np.float64]

_TIME_SLACK = 1e-9

_LEAST_RATE = 1e-100
"""A speed or acceleration below is standstill: the products of a time law with it would round to 0."""


@dataclass(frozen=True)
class PlannedLine:
    """A line with its time law, stretched to `ticks` whole ticks (0 where nothing moves)."""

    path: Line
    law: Trapezoid
    ticks: int


def plan_line(
    block: MoveBlock,
    target: PoseTarget,
    start_rotation: Array,
    start_position: Array,
    dt: float,
    place: Place,
) -> PlannedLine:
    """Plan the line from the actual pose (rotation (3, 3), position (3,) m, world) to the target.

    Raises MotionError: IRL421 where TIME is too short, IRL422 for half a turn without an axis,
    IRL425 where the move would take too long.
    """
    end_rotation = start_rotation
    if target.orientation is not None:
        end_rotation = np.asarray(Rotation.from_quat(target.orientation).as_matrix())
    path = Line(start_position, start_rotation, np.array(target.position), end_rotation)
    # A way of more than 1E154 m has no length in numbers: infinite, and IRL425 without further words.
    with np.errstate(over="ignore"):
        nothing = path.is_nothing
    if nothing:
        return PlannedLine(path, Trapezoid(0.0, 0.0, 0.0, 0.0), 0)
    if not path.axis_is_defined:
        raise MotionError(report("IRL422", place, angle=f"{degrees(path.angle):.6g}"))
    law = line_law(path, block.law, place)
    ticks = ticks_of_move(law.duration, dt, place)
    return PlannedLine(path, law.stretched(ticks * dt), ticks)


def line_law(path: Line, law: MotionLaw, place: Place) -> Trapezoid:
    """Fastest trapezoid that keeps the speeds and accelerations of path and turn; TIME stretches it.

    The slower of the two rules: s' <= min(SPEED, SPEED_ORI / turn rate), and likewise s''.
    """
    rate = path.turn_rate
    turn_speed, turn_acc = (law.speed_ori / rate, law.acc_ori / rate) if rate > 0.0 else (inf, inf)
    speed = turn_speed if path.is_pure_turn else min(law.speed, turn_speed)
    acc = turn_acc if path.is_pure_turn else min(law.acc, turn_acc)
    if min(speed, acc) < _LEAST_RATE:
        return Trapezoid(path.length, 0.0, inf, 0.0)
    fastest = Trapezoid.fastest(path.length, speed, acc)
    if law.duration is None:
        return fastest
    if law.duration < fastest.duration * (1.0 - _TIME_SLACK):
        governor = _governor(path, law, turn_speed, turn_acc)
        asked, least = f"{law.duration:.6g}", f"{fastest.duration:.6g}"
        raise MotionError(report("IRL421", place, asked=asked, least=least, governor=governor))
    return fastest.stretched(law.duration)


def _governor(path: Line, law: MotionLaw, turn_speed: float, turn_acc: float) -> str:
    """The parameters that cost a move its time: those of the turn, or those of the path."""
    along = 0.0 if path.is_pure_turn else Trapezoid.fastest(path.length, law.speed, law.acc).duration
    turning = Trapezoid.fastest(path.length, turn_speed, turn_acc).duration if path.turn_rate > 0.0 else 0.0
    return "SPEED_ORI and ACC_ORI" if turning >= along else "SPEED and ACC"
