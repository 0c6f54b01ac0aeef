"""Where blocks and questions come from in the text, and poses in the units of blocks."""

from __future__ import annotations

from pathlib import PurePath

from irlx.blocks import JointIncrement, JointTarget, Origin, PoseIncrement, PoseTarget, Target
from irlx.diagnostics import SourceText
from irlx.interpreter.base import Base
from irlx.interpreter.functions import parts_of, pose, vector_of
from irlx.interpreter.joints import si_values
from irlx.interpreter.quaternion import Vector
from irlx.interpreter.setting import Setting
from irlx.interpreter.types import POSE, POSITION
from irlx.interpreter.values import RecordValue
from irlx.language import tree


def origin_of(source: SourceText, node: tree.Node, last: tree.Node | None = None) -> Origin:
    """Place of a node, or of all from it to the end of a later one."""
    line, _ = source.line_and_column(node.span.start)
    return Origin(PurePath(source.name).name, node.span.start, (last or node).span.end, line)


def target_of(value: RecordValue, base: Base, setting: Setting) -> PoseTarget | JointTarget:
    """Target of a POSE, POSITION or ROBTARGET in the base frame, or of a posture."""
    if value.type in (POSITION, POSE) or _holds_a_pose(value):
        return pose_target(value, base)
    return JointTarget(si_values(value, setting))


def increment_of(value: RecordValue, base: Base, setting: Setting) -> Target:
    """What a POSITION, a POSE or a posture says of how far a MOVE_INC goes."""
    if value.type == POSITION:
        return PoseIncrement(_metres(base.shift(value)), None)
    if value.type == POSE:
        at, (w, x, y, z) = parts_of(value)
        return PoseIncrement(_metres(at), (x, y, z, w))
    return JointIncrement(si_values(value, setting))


def pose_target(value: RecordValue, base: Base) -> PoseTarget:
    """Target of a POSE (mm, quaternion scalar first), or of a POSITION, which keeps the orientation.

    That of a ROBTARGET is its pose. Poses count in `base`, targets in the root frame of the robot.
    """
    found = base.in_root(value)
    if found.type == POSITION:
        return PoseTarget(_metres(vector_of(found)), None)
    at, (w, x, y, z) = parts_of(found)
    return PoseTarget(_metres(at), (x, y, z, w))


def pose_of_answer(answer: tuple[float, ...], base: Base) -> RecordValue:
    """POSE (mm) in the base frame of a position, m, and a quaternion x, y, z, w in the root frame."""
    x, y, z, qx, qy, qz, qw = answer
    return base.in_base(pose((x * 1e3, y * 1e3, z * 1e3), (qw, qx, qy, qz)))


def _holds_a_pose(value: RecordValue) -> bool:
    first = value.values[0] if value.values else None
    return isinstance(first, RecordValue) and first.type == POSE


def _metres(vector: Vector) -> Vector:
    return (vector[0] * 1e-3, vector[1] * 1e-3, vector[2] * 1e-3)
