"""Checks of what a cell asks of its robot beside the tool pose: its task, and conditions between joints."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import MoveBlock, PoseTarget
from irlx.diagnostics import Place, report
from irlx.pacing.errors import PacingError
from irlx.pacing.left_out import frame_words
from irlx.promises import CONDITION, PATH_ORIENTATION, PATH_POSITION
from irlx.robot.equality import Constraint
from irlx.robot.kinematics import Kinematics

Array = NDArray[np.float64]


def check_targets(block: MoveBlock, kinematics: Kinematics, q: Array, place: Place) -> None:
    """`check_can_move` for all targets of a move along a path."""
    for target in block.targets:
        if isinstance(target, PoseTarget):
            check_can_move(target, kinematics, q, place)


def check_can_move(target: PoseTarget, kinematics: Kinematics, q: Array, place: Place) -> None:
    """Raise PacingError, IRL430, for a target that is off in a coordinate in which no joint moves the tool.

    The task of a planar arm leaves those coordinates out; that a target differs there would go unseen.
    """
    fixed = kinematics.immovable
    if not fixed.size:
        return
    wanted, _ = kinematics.tool_pose(q)
    if target.orientation is not None:
        wanted = np.asarray(Rotation.from_quat(target.orientation).as_matrix())
    left = kinematics.left_of(fixed, q, kinematics.target(wanted, np.array(target.position)))
    allowed = np.array([PATH_POSITION if row < 3 else PATH_ORIENTATION for row in fixed.rows])
    if np.any(np.abs(left) > allowed):
        words = ", ".join(
            f"{name} by {value * 1e3:.6g} mm" if row < 3 else f"{name} by {np.degrees(value):.6g} deg"
            for name, row, value, most in zip(fixed.coordinates, fixed.rows, left, allowed, strict=True)
            if abs(value) > most
        )
        data: dict[str, Any] = {"robot": kinematics.description.name, "frame": frame_words(kinematics)}
        raise PacingError(report("IRL430", place, off=words, **data))


def broken_condition(q: Array, kinematics: Kinematics) -> tuple[int, Constraint, float] | None:
    """A row of q (N, n) that breaks a constraint by more than `CONDITION`, the constraint, and how much."""
    for constraint in kinematics.constraints:
        for row, posture in enumerate(q):
            broken = float(np.linalg.norm(constraint.residual(posture)))
            if not broken <= CONDITION:
                return row, constraint, broken
    return None


def check_implied(q: Array, kinematics: Kinematics, place: Place) -> None:
    """Raise PacingError, IRL441, where rows (N, n) led along poses break a constraint that these imply."""
    for constraint in kinematics.implied:
        broken = max(float(np.linalg.norm(constraint.residual(posture))) for posture in q)
        if not broken <= CONDITION:
            raise PacingError(report("IRL441", place, name=constraint.name, broken=f"{broken:.3g}"))


def check_conditions(q: Array, kinematics: Kinematics, place: Place) -> None:
    """Raise PacingError, IRL351, where rows (N, n) of a motion of the joints break a constraint."""
    found = broken_condition(q, kinematics)
    if found is not None:
        _, constraint, broken = found
        raise PacingError(report("IRL351", place, name=constraint.name, broken=f"{broken:.3g}"))
