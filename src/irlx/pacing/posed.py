"""Targets of moves as poses of the tool: postures by the kinematics, increments from the start."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.blocks import ArcCourse, JointIncrement, JointTarget, MoveBlock, PoseIncrement, PoseTarget, Target
from irlx.robot.kinematics import Kinematics

Array = NDArray[np.float64]
Pose = tuple[Array, Array]
"""Rotation (3, 3) and position (3,) m of the tool in the world."""


def posed(block: MoveBlock, kinematics: Kinematics, start: Pose, q: Array) -> MoveBlock:
    """The block of a move along a path with poses for all that it runs through.

    The move starts at the pose `start`, the robot in posture `q` (n,). Points of a PATH count their
    increments from the point before, a CIRCLE both from where it starts.
    """
    if block.path is not None:
        points, last = [], start
        for target in block.targets:
            pose = _as_pose(target, kinematics, last, q)
            points.append(pose)
            last = pose_of(pose, last)
        course = replace(block.path, points=tuple(points[:-1]))
        return replace(block, target=points[-1], course=course)
    target = _as_pose(block.target, kinematics, start, q)
    if isinstance(block.course, ArcCourse):
        course_with_pose = replace(block.course, via=_as_pose(block.course.via, kinematics, start, q))
        return replace(block, target=target, course=course_with_pose)
    return replace(block, target=target)


def posture_target(target: Target, q: Array) -> JointTarget | None:
    """The posture that a target gives, counted from `q` (n,) where it is an increment; None for a pose."""
    if isinstance(target, JointTarget):
        return target
    if isinstance(target, JointIncrement):
        return JointTarget(tuple(float(value) for value in q + np.array(target.values)))
    return None


def pose_target(target: Target, start: Pose) -> PoseTarget | None:
    """The pose that a target gives, counted from `start` where it is an increment; None for a posture."""
    if isinstance(target, PoseTarget):
        return target
    return _moved(target, start) if isinstance(target, PoseIncrement) else None


def _as_pose(target: Target, kinematics: Kinematics, start: Pose, q: Array) -> PoseTarget:
    given = pose_target(target, start)
    if given is not None:
        return given
    posture = posture_target(target, q)
    assert posture is not None
    rotation, position = kinematics.tool_pose(np.array(posture.values))
    return PoseTarget(_floats3(position), _quaternion(rotation))


def _moved(target: PoseIncrement, start: Pose) -> PoseTarget:
    rotation, position = start
    shift = np.array(target.position)
    if target.orientation is None:
        return PoseTarget(_floats3(position + shift), None, target.frame)
    turned = rotation @ Rotation.from_quat(target.orientation).as_matrix()
    return PoseTarget(_floats3(position + rotation @ shift), _quaternion(turned))


def end_pose(move: MoveBlock, start: Pose) -> Pose:
    """Pose of the last target of a move that `posed` has been given; one without orientation keeps it."""
    last = start
    for target in move.targets:
        if not isinstance(target, PoseTarget):
            raise TypeError("the targets of the move are not poses yet")
        last = pose_of(target, last if move.path is not None else start)
    return last


def pose_of(target: PoseTarget, before: Pose) -> Pose:
    """Rotation and position of a target; one without orientation keeps that of the pose before."""
    rotation = before[0]
    if target.orientation is not None:
        rotation = np.asarray(Rotation.from_quat(target.orientation).as_matrix())
    return rotation, np.array(target.position)


def _floats3(vector: Array) -> tuple[float, float, float]:
    return float(vector[0]), float(vector[1]), float(vector[2])


def _quaternion(rotation: Array) -> tuple[float, float, float, float]:
    x, y, z, w = Rotation.from_matrix(rotation).as_quat()
    return float(x), float(y), float(z), float(w)
