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
from irlx.motion.whole_ticks import whole_ticks

Array = NDArray[np.float64]

_TIME_SLACK = 1e-9


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

    Raises MotionError: IRL421 where TIME is too short, IRL422 for half a turn without an axis.
    """
    end_rotation = start_rotation
    if target.orientation is not None:
        end_rotation = np.asarray(Rotation.from_quat(target.orientation).as_matrix())
    path = Line(start_position, start_rotation, np.array(target.position), end_rotation)
    if path.is_nothing:
        return PlannedLine(path, Trapezoid(0.0, 0.0, 0.0, 0.0), 0)
    if not path.axis_is_defined:
        raise MotionError(report("IRL422", place, angle=f"{degrees(path.angle):.6g}"))
    law = line_law(path, block.law, place)
    ticks = whole_ticks(law.duration, dt)
    return PlannedLine(path, law.stretched(ticks * dt), ticks)


def line_law(path: Line, law: MotionLaw, place: Place) -> Trapezoid:
    """Fastest trapezoid that keeps the speeds and accelerations of path and turn; TIME stretches it.

    The slower of the two rules: s' <= min(SPEED, SPEED_ORI / turn rate), and likewise s''.
    """
    rate = path.turn_rate
    turn_speed, turn_acc = (law.speed_ori / rate, law.acc_ori / rate) if rate > 0.0 else (inf, inf)
    speed = turn_speed if path.is_pure_turn else min(law.speed, turn_speed)
    acc = turn_acc if path.is_pure_turn else min(law.acc, turn_acc)
    fastest = Trapezoid.fastest(path.length, speed, acc)
    if law.duration is None:
        return fastest
    if law.duration < fastest.duration * (1.0 - _TIME_SLACK):
        governor = "SPEED_ORI and ACC_ORI" if speed == turn_speed or acc == turn_acc else "SPEED and ACC"
        asked, least = f"{law.duration:.6g}", f"{fastest.duration:.6g}"
        raise MotionError(report("IRL421", place, asked=asked, least=least, governor=governor))
    return fastest.stretched(law.duration)
