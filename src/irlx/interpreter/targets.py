"""Where blocks and questions come from in the text, and poses in the units of blocks."""

from __future__ import annotations

from pathlib import PurePath

from irlx.blocks import Origin, PoseTarget
from irlx.diagnostics import SourceText
from irlx.interpreter.functions import parts_of, pose, vector_of
from irlx.interpreter.quaternion import Vector
from irlx.interpreter.types import POSE, POSITION
from irlx.interpreter.values import RecordValue
from irlx.language import tree


def origin_of(source: SourceText, node: tree.Node, last: tree.Node | None = None) -> Origin:
    """Place of a node, or of all from it to the end of a later one."""
    line, _ = source.line_and_column(node.span.start)
    return Origin(PurePath(source.name).name, node.span.start, (last or node).span.end, line)


def pose_target(value: RecordValue) -> PoseTarget:
    """Target of a POSE (mm, quaternion scalar first), or of a POSITION, which keeps the orientation.

    That of a ROBTARGET is its pose.
    """
    if value.type == POSITION:
        return PoseTarget(_metres(vector_of(value)), None)
    first = value.values[0]
    if isinstance(first, RecordValue) and first.type == POSE:
        value = first
    at, (w, x, y, z) = parts_of(value)
    return PoseTarget(_metres(at), (x, y, z, w))


def pose_of_answer(answer: tuple[float, ...]) -> RecordValue:
    """POSE (mm) of a position, m, and a quaternion x, y, z, w."""
    x, y, z, qx, qy, qz, qw = answer
    return pose((x * 1e3, y * 1e3, z * 1e3), (qw, qx, qy, qz))


def _metres(vector: Vector) -> Vector:
    return (vector[0] * 1e-3, vector[1] * 1e-3, vector[2] * 1e-3)
