"""What a robot's task leaves out of a target, although its joints move the tool that way.

Turns that follow from the task's own coordinates (`Kinematics.following`) come out as they do. On the way
nobody minds; at a target that gives an orientation they must be those of the target, or the target is none of
this robot's.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import MoveBlock, PoseTarget
from irlx.diagnostics import Place, report
from irlx.pacing.demand import Demands
from irlx.pacing.errors import PacingError
from irlx.pacing.situation import Situation
from irlx.promises import FOLLOWED_TURN, PATH_ORIENTATION, PATH_POSITION
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.transform.nearest import nearest_in_bounds
from irlx.transform.posture_search import nearest_posture, posture_near

Array = NDArray[np.float64]

_SAME = 1e-9


class AskedPose(NamedTuple):
    """A target of a move that gives an orientation: rotation (3, 3), position (3,) m, and its place."""

    rotation: Array
    position: Array
    place: Place


def asked_poses(
    block: MoveBlock, end: tuple[Array, Array], place: Place, points: int | None = None
) -> list[AskedPose]:
    """The poses that a move, its targets being poses already, is led to: it ends at `end`.

    Of a move along a PATH that stops on its way so many `points`.

    A target without an orientation keeps that of its start as far as the joints can; the orientation of a
    via point counts where the tool is turned through it.
    """
    if block.arc is not None:
        inner = [block.arc.via] if block.arc.turns_through_via else []
    else:
        inner = [] if block.path is None else list(block.path.points)[:points]
    found = [
        AskedPose(_rotation(point.orientation), np.array(point.position), place)
        for point in inner
        if isinstance(point, PoseTarget) and point.orientation is not None
    ]
    if points is None and isinstance(block.target, PoseTarget) and block.target.orientation is not None:
        found.append(AskedPose(*end, place))
    return found


def _rotation(quaternion: tuple[float, float, float, float]) -> Array:
    return np.asarray(Rotation.from_quat(quaternion).as_matrix())


def check_on_path(
    asked: Sequence[AskedPose],
    q: Array,
    demands: Demands,
    around: tuple[Kinematics, JointLimits, NDArray[np.bool_]],
) -> None:
    """Raise PacingError, IRL437, for a target that the rows q (N, n) of a motion do not meet in all.

    Of a target between rows, or beside a rounded corner, the posture counts that leads on to it from the
    nearest row.
    """
    kinematics, limits, free = around
    if not kinematics.following.size or not asked:
        return
    for pose in asked:
        turns = np.linalg.norm(demands.rotation - pose.rotation, axis=(1, 2))
        away = np.linalg.norm(demands.position - pose.position, axis=1) / kinematics.description.reach + turns
        row = int(np.argmin(away))
        posture = q[row]
        if away[row] > _SAME:
            lower, upper = limits.pair("position")
            target = kinematics.target(pose.rotation, pose.position)
            near = nearest_in_bounds(kinematics, target, posture, lower, upper, free)
            if near.distance > PATH_POSITION or near.angle > PATH_ORIENTATION:
                # It is passed where the joints could not go: nothing follows there.
                continue
            posture = near.q
        check_followed(posture, pose, kinematics)


def check_points(asked: Sequence[AskedPose], situation: Situation, limits: JointLimits) -> None:
    """Raise PacingError, IRL437, for a point of a PATH that no posture meets in all.

    Looked at before the first of its pieces: a PATH that stops at its points is carried out piece by piece.
    Postures are sought one after another, from the present one on.
    """
    kinematics, weights, free = situation.kinematics, situation.setup.weights, situation.free
    posture = situation.q
    for pose in asked if kinematics.following.size else ():
        sought = kinematics, situation.qp, pose.rotation, pose.position, posture, weights, limits, free
        near = posture_near(*sought)
        if near is None:
            search = nearest_posture(*sought)
            if search.q is None and search.misses is not None:
                check_followed(search.misses, pose, kinematics)
            near = search.q
        posture = posture if near is None else near


def check_standing(asked: Sequence[AskedPose], situation: Situation) -> None:
    """Raise PacingError, IRL437, for a target of a motion that stays where it is, and does not meet it."""
    for pose in asked if situation.kinematics.following.size else ():
        check_followed(situation.q, pose, situation.kinematics)


def turns_off(q: Array, pose: AskedPose, kinematics: Kinematics) -> Array:
    """Turns (F,) rad by which posture q is off a pose in the coordinates that follow from the task's own."""
    target = kinematics.target(pose.rotation, pose.position)
    return kinematics.left_of(kinematics.following, q, target)


def check_followed(q: Array, pose: AskedPose, kinematics: Kinematics) -> None:
    """Raise PacingError, IRL437, where posture q, which meets a pose in the task's coordinates, is off it."""
    off = turns_off(q, pose, kinematics)
    if np.all(np.abs(off) <= FOLLOWED_TURN):
        return
    words = " and ".join(
        f"a turn of {np.degrees(value):.6g} deg about {name[1]}"
        for name, value in zip(kinematics.following.coordinates, off, strict=True)
        if abs(value) > FOLLOWED_TURN
    )
    data: dict[str, Any] = {"robot": kinematics.description.name, "frame": frame_words(kinematics)}
    nearest = _literal(*kinematics.tool_pose(q))
    raise PacingError(report("IRL437", pose.place, off=words, pose=nearest, **data))


def frame_words(kinematics: Kinematics) -> str:
    """The frame of a robot's task in words."""
    link = kinematics.description.task_frame
    return "the tool frame" if link is None else f"the frame of the link '{link}'"


def _literal(rotation: Array, position: Array) -> str:
    """A pose as a program writes it."""
    with warnings.catch_warnings():
        # Of a tool that points along z only the sum of two angles counts: then one of them is 0.
        warnings.simplefilter("ignore", UserWarning)
        angles = Rotation.from_matrix(rotation).as_euler("ZYX", degrees=True)
    numbers = [f"{value:.4f}".rstrip("0").rstrip(".") for value in (*1e3 * position, *angles)]
    x, y, z, a, b, c = ("0" if number == "-0" else number for number in numbers)
    return f"(({x}, {y}, {z}), ORIZYX({a}, {b}, {c}))"
