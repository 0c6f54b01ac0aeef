"""Postures that a program asks for: those of RECONFIGURATION, and the nearest ones of poses."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import JointTarget, PoseTarget
from irlx.diagnostics import Place, report
from irlx.pacing.conditions import check_can_move
from irlx.pacing.errors import PacingError
from irlx.pacing.left_out import AskedPose, check_followed
from irlx.pacing.options import LimitsInForce
from irlx.pacing.posture_left import beyond_limits
from irlx.pacing.reconfigure import settled_konf
from irlx.pacing.situation import Situation
from irlx.pacing.target_words import target_words
from irlx.transform.posture_search import nearest_posture, posture_near

Array = NDArray[np.float64]

FARTHEST_TARGET = 1e9
"""Coordinate (m) beyond which a target is out of reach of any robot, and of squares in float64."""


def asked_posture(target: JointTarget, situation: Situation, in_force: LimitsInForce, place: Place) -> Array:
    """Posture (n,) that RECONFIGURATION asks for; warns where it lies outside the limits."""
    konf = settled_konf(np.array(target.values), situation.q, in_force.limits)
    situation.warnings.extend(beyond_limits(konf, in_force.limits, situation.free, situation.robot, place))
    return konf


def posture_of_pose(
    target: PoseTarget,
    near: Array | None,
    situation: Situation,
    in_force: LimitsInForce,
    place: Place,
) -> Array:
    """The posture of a pose nearest to `near` (n,), else to CYCLICSTART's, else to the present one.

    Raises PacingError: IRL522 where there is none, IRL437 where none meets all of the pose.
    """
    q, kinematics = situation.q, situation.kinematics
    check_can_move(target, kinematics, q, place)
    rotation, _ = situation.pose
    if target.orientation is not None:
        rotation = np.asarray(Rotation.from_quat(target.orientation).as_matrix())
    position = np.array(target.position)
    farthest = float(np.max(np.abs(position)))
    if farthest > FARTHEST_TARGET:
        told = target_words(position)
        raise PacingError(
            report("IRL522", place, target=told, distance=f"{farthest * 1000.0:.6g}", angle="0")
        )
    cyclic = situation.options.cyclic_posture
    drawn_to = next(posture for posture in (near, cyclic, q) if posture is not None)
    start = np.where(situation.free, drawn_to, q)
    weights, free = situation.setup.weights, situation.free
    # Who gives no orientation keeps what the joints can keep of it.
    whole = target.orientation is not None
    asked = kinematics, situation.qp, rotation, position, start, weights, in_force.limits, free, whole
    if situation.setup.resolution.is_coarse:
        found = posture_near(*asked)
        if found is not None:
            return found
    search = nearest_posture(*asked)
    if search.q is None and search.misses is not None:
        check_followed(search.misses, AskedPose(rotation, position, place), kinematics)
    if search.q is None:
        distance, angle = search.nearest.distance * 1000.0, np.degrees(search.nearest.angle)
        told = target_words(position)
        raise PacingError(
            report("IRL522", place, target=told, distance=f"{distance:.6g}", angle=f"{angle:.4g}")
        )
    return search.q
