"""Moves to plan, and an own quaternion algebra to compare with."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import ArcCourse, Blend, MotionLaw, MoveBlock, MoveKind, Origin, PathCourse, PoseTarget
from irlx.diagnostics import Place
from irlx.motion.plan_chain import Leg


def multiply(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Hamilton product of quaternions (w, x, y, z)."""
    w = a[0] * b[0] - a[1:] @ b[1:]
    return np.concatenate([[w], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])])


def matrix(q: np.ndarray) -> np.ndarray:
    """Rotation matrix of a unit quaternion (w, x, y, z), column by column from q v q*."""
    conjugate = q * np.array([1.0, -1.0, -1.0, -1.0])
    columns = [multiply(multiply(q, np.concatenate([[0.0], e])), conjugate)[1:] for e in np.eye(3)]
    return np.column_stack(columns)


def slerp(a: np.ndarray, b: np.ndarray, share: float) -> np.ndarray:
    """Shoemake's slerp of unit quaternions (w, x, y, z), the short way."""
    cosine = float(a @ b)
    b, cosine = (b, cosine) if cosine >= 0.0 else (-b, -cosine)
    sine = float(np.linalg.norm(b - cosine * a))
    angle = np.arctan2(sine, cosine)
    if angle < 1e-12:
        return a
    return (np.sin((1.0 - share) * angle) * a + np.sin(share * angle) * b) / np.sin(angle)


@dataclass(frozen=True)
class Kit:
    """What the tests of paths build with."""

    place: Place

    multiply = staticmethod(multiply)
    matrix = staticmethod(matrix)
    slerp = staticmethod(slerp)

    @staticmethod
    def law(**changes: object) -> MotionLaw:
        return MotionLaw(**{"speed": 1.0, "acc": 2.0, "speed_ori": 1.5, "acc_ori": 3.0, **changes})

    @staticmethod
    def block(position, orientation=None, law: MotionLaw | None = None) -> MoveBlock:
        quaternion = None if orientation is None else tuple(float(c) for c in orientation)
        target = PoseTarget(tuple(float(c) for c in position), quaternion)
        origin = Origin("line.irl", 0, 8, 1)
        return MoveBlock(id=1, origin=origin, kind=MoveKind.LIN, target=target, law=law or Kit.law())

    @staticmethod
    def circle(via, end, law: MotionLaw | None = None, turns=(None, None), **course: object) -> MoveBlock:
        """CIRCLE block; `turns` are orientations (x, y, z, w) of via and end, or None."""
        points = [
            PoseTarget(
                tuple(float(c) for c in point), None if turn is None else tuple(float(c) for c in turn)
            )
            for point, turn in zip((via, end), turns, strict=True)
        ]
        origin = Origin("line.irl", 0, 8, 1)
        data = {"target": points[1], "law": law or Kit.law(), "course": ArcCourse(points[0], **course)}
        return MoveBlock(id=1, origin=origin, kind=MoveKind.CIRCLE, **data)

    @staticmethod
    def leg(block: MoveBlock, blend: Blend | None = None) -> Leg:
        """A block as a leg that passes its target with a blend."""
        return Leg(replace(block, blend=blend), Place("line.irl"))

    @staticmethod
    def path(kind: MoveKind, points, turns=None, law: MotionLaw | None = None) -> MoveBlock:
        """LIN or SPLINE along a PATH; `turns` orientations (x, y, z, w) of all points, or None."""
        turns = turns or [None] * len(points)
        targets = [
            PoseTarget(
                tuple(float(c) for c in point), None if turn is None else tuple(float(c) for c in turn)
            )
            for point, turn in zip(points, turns, strict=True)
        ]
        data = {"target": targets[-1], "law": law or Kit.law(), "course": PathCourse(tuple(targets[:-1]))}
        return MoveBlock(id=1, origin=Origin("line.irl", 0, 8, 1), kind=kind, **data)

    @staticmethod
    def quaternion(rng: np.random.Generator) -> np.ndarray:
        q = rng.normal(size=4)
        return q / np.linalg.norm(q)

    @staticmethod
    def turned(rotation: np.ndarray, vector) -> np.ndarray:
        return rotation @ Rotation.from_rotvec(vector).as_matrix()


@pytest.fixture
def kit() -> Kit:
    return Kit(Place("line.irl"))
