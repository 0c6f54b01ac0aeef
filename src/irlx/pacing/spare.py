"""Whether a motion has the joints that it needs beside the frozen ones."""

from __future__ import annotations

from collections.abc import Callable

from irlx.blocks import Origin, ToleranceClause
from irlx.diagnostics import Place, report
from irlx.pacing.errors import PacingError
from irlx.pacing.options import Options
from irlx.pacing.tolerance import freed_coordinates
from irlx.robot.kinematics import Kinematics


def check_spare(
    options: Options,
    kinematics: Kinematics,
    clause: ToleranceClause | None,
    locate: Callable[[Origin], Place],
) -> None:
    """Raise PacingError, IRL347, at FREEZESTART, where more joints are frozen than a motion can spare.

    Of the equations that every tick has to meet, those of the tool pose and of constraints, the coordinates
    that WITH TOLERANCE frees take none: where the program has any, that is only known at the motion.
    """
    switch = options.frozen_by
    if switch is None:
        return
    joints = kinematics.joints
    rows = kinematics.rows - len(freed_coordinates(clause, kinematics))
    frozen, spare = len(set(options.frozen)), joints - rows
    if frozen > spare:
        place = locate(switch.origin)
        raise PacingError(report("IRL347", place, frozen=frozen, joints=joints, spare=spare, rows=rows))
