"""The moves of a chain as edges: what lies between two corners or stops."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Blend, MotionLaw, MoveBlock, MoveKind
from irlx.diagnostics import Place, report
from irlx.motion.arc import NEAREST_POINTS, Arc
from irlx.motion.curved_path import CurvedPath
from irlx.motion.errors import MotionError
from irlx.motion.line import Line
from irlx.motion.plan_circle import circle_path
from irlx.motion.sections import Shape
from irlx.motion.spline_path import spline_path
from irlx.motion.target_pose import target_pose

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Leg:
    """A LIN, CIRCLE or SPLINE whose targets are poses in the world, with the place of the move."""

    block: MoveBlock
    place: Place


@dataclass(frozen=True)
class Edge:
    """A line, an arc or a spline of the leg number `leg`, between two places where the tool may stop.

    `marks`: path parameters of the leg's targets on it, the last its end. `room`: how far a blend may reach
    from its start, and from its end (m). `point`: number (from 1) of the PATH point at its end, 0 for the
    target of the leg.
    """

    path: Line | Arc | CurvedPath
    leg: int
    law: MotionLaw
    blend: Blend | None
    place: Place
    marks: tuple[float, ...]
    room: tuple[float, float]
    point: int = 0

    @property
    def where(self) -> str:
        """What is at its end, in words."""
        return f"point {self.point} of its PATH" if self.point else "its target"

    @property
    def shape(self) -> Shape:
        """Sections that the time law sees: one, or those of a spline."""
        path = self.path
        if isinstance(path, CurvedPath):
            return path.shape
        values = (path.length, path.curvature, path.turn_rate, path.turn_bend)
        return Shape(*(np.array([value]) for value in values))


def edges_of(leg: Leg, number: int, rotation: Array, position: Array) -> list[Edge]:
    """Edges of a leg that starts at a pose (rotation (3, 3), position (3,) m, world).

    Raises MotionError: IRL422, IRL427 to IRL429, IRL434 and IRL435 for geometry that is none.
    """
    block = leg.block
    with np.errstate(over="ignore"):
        if block.kind is MoveKind.CIRCLE:
            return [_edge(leg, number, circle_path(block, rotation, position, leg.place))]
        rotations, positions = _poses(block, rotation, position)
        _check_points(positions, rotations, block, leg.place)
        if block.kind is MoveKind.SPLINE and len(positions) > 2:
            return [_spline_edge(leg, number, positions, rotations)]
        lines = [
            Line(positions[k], rotations[k], positions[k + 1], rotations[k + 1])
            for k in range(len(positions) - 1)
        ]
        count = len(block.targets)
        skipped = count - len(lines)
        return [_edge(leg, number, line, (k + skipped) % count) for k, line in enumerate(lines, start=1)]


def _edge(leg: Leg, number: int, path: Line | Arc, point: int = 0) -> Edge:
    if not path.is_nothing and not path.axis_is_defined:
        raise MotionError(report("IRL422", leg.place, angle=f"{degrees(path.widest_turn):.6g}"))
    length, half = path.length, 0.5 * path.length
    marks: tuple[float, ...] = (length,)
    room = half, half
    if isinstance(path, Arc):
        share = path.share_at_via
        marks = (min(path.circle.via_angle * path.circle.radius, length), length)
        block = leg.block
        if share is not None and block.arc is not None and block.arc.turns_through_via:
            # A blend that reached beyond the via orientation would take it away.
            room = (min(half, share * length), min(half, (1.0 - share) * length))
    return Edge(path, number, leg.block.law, leg.block.blend, leg.place, marks, room, point)


def _spline_edge(leg: Leg, number: int, positions: Array, rotations: Array) -> Edge:
    path, at = spline_path(positions, rotations, leg.place)
    room = (0.5 * float(at[1]), 0.5 * float(at[-1] - at[-2]))
    skipped = len(leg.block.targets) - (len(at) - 1)
    marks = (*([0.0] * skipped), *at[1:].tolist())
    return Edge(path, number, leg.block.law, leg.block.blend, leg.place, marks, room)


def _poses(block: MoveBlock, rotation: Array, position: Array) -> tuple[Array, Array]:
    """Rotations and positions of the start and all targets; a PATH that begins at the start begins there."""
    rotations, positions = [rotation], [position]
    for target in block.targets:
        turned, point = target_pose(target, rotations[-1])
        rotations.append(turned)
        positions.append(point)
    if len(positions) > 2 and Line(position, rotation, positions[1], rotations[1]).is_nothing:
        del rotations[1], positions[1]
    return np.array(rotations), np.array(positions)


def _check_points(positions: Array, rotations: Array, block: MoveBlock, place: Place) -> None:
    """Neighbours on a PATH must differ; those of a SPLINE in position."""
    if len(positions) <= 2:
        return
    skipped = len(block.targets) + 1 - len(positions)
    for k in range(len(positions) - 1):
        distance = float(np.linalg.norm(positions[k + 1] - positions[k]))
        line = Line(positions[k], rotations[k], positions[k + 1], rotations[k + 1])
        if line.is_nothing or (block.kind is MoveKind.SPLINE and distance < NEAREST_POINTS):
            first, last = (_name(number, skipped) for number in (k, k + 1))
            raise MotionError(
                report("IRL434", place, first=first, last=last, distance=f"{distance * 1000.0:.3g}")
            )


def _name(number: int, skipped: int) -> str:
    return "the start" if number == 0 else f"point {number + skipped}"
