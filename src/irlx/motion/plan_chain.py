"""Pre-interpolator of moves that blend into each other: the first stop-to-stop motion of a chain."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import PathCourse
from irlx.diagnostics import Diagnostic, Place, Related, report
from irlx.motion.chain_law import Stage, chain_law
from irlx.motion.chain_path import ChainPath, Piece
from irlx.motion.corner import Corner, Lost, corner_between
from irlx.motion.curved_path import CurvedPath
from irlx.motion.edges import Edge, Leg, edges_of
from irlx.motion.errors import MotionError
from irlx.motion.path_part import PathPart
from irlx.motion.plan_path import PlannedPath, in_whole_ticks, path_law, standing
from irlx.motion.sections import Shape, bounds_of

__all__ = ["Join", "Leg", "PlannedChain", "lost_blend", "plan_chain"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Join:
    """A blended corner at the end of leg number `leg`, or at the PATH point `point` (from 1) inside it.

    `s`: path parameter of the blend's point nearest to the corner, where the next move takes over. `asked`
    is the distance of the program (m; None with C_PASS), `used` that of the blend on both sides. The path
    passes the corner at a distance of `miss` m, turned by `miss_angle` rad from its orientation.
    """

    leg: int
    s: float
    asked: float | None
    used: float
    miss: float
    miss_angle: float
    point: int = 0


@dataclass(frozen=True)
class PlannedChain(PlannedPath):
    """The first stop-to-stop motion of a chain of legs; `path`, `law`, `ticks` as those of one move.

    `legs` of them, from the first, are carried out to their end; where the motion stops inside a leg along a
    PATH, `points` of that leg's points are done, else 0. `ends` (one for each leg touched): path parameter at
    which the leg hands over to the next, the last one `path.length`. `marks`: for each leg touched the path
    parameters next to its targets (via point, PATH points, the end). `joins` are the blended corners, `notes`
    blends lost or cut. `time_left`: what is left of the TIME of a leg that is not done, s. `rooms`: how far
    another corner may reach into the motion from its start and from its end, in the unit of s.
    """

    legs: int
    points: int
    ends: tuple[float, ...]
    marks: tuple[tuple[float, ...], ...]
    joins: tuple[Join, ...]
    notes: tuple[Diagnostic, ...]
    time_left: float | None = None
    rooms: tuple[float, float] = (0.0, 0.0)

    def rest(self, legs: Sequence[Leg]) -> tuple[Leg, ...]:
        """What is left to do of the legs that this motion was planned from, for the next `plan_chain`."""
        left = tuple(legs[self.legs :])
        if not self.points:
            return left
        block = left[0].block
        course = block.path
        if course is None:
            raise TypeError("a motion stops inside a leg only along a PATH")
        reconfigurations = course.reconfigurations[self.points :]
        following = PathCourse(course.points[self.points :], reconfigurations)
        law = replace(block.law, duration=self.time_left)
        shortened = replace(block, law=law, course=following if following.points else None)
        return (replace(left[0], block=shortened), *left[1:])


def plan_chain(legs: Sequence[Leg], start_rotation: Array, start_position: Array, dt: float) -> PlannedChain:
    """Plan as many legs as blend into each other, from rest at the actual pose to the next stop.

    At least one leg; start rotation (3, 3) and position (3,) m in the world, `dt` the tick in s. Raises
    MotionError at the place of the first leg as `plan_path` does, also IRL434 and IRL435 for a PATH that is
    none. A later leg that cannot be planned ends the motion before it; planning it alone then says why.
    """
    run = _first_run(legs, start_rotation, start_position)
    chained = _chained(run)
    run, time_left = _with_part_of_time(legs, run, chained, dt)
    plan = _timed(chained, run, dt)
    last = run.edges[-1]
    whole = last.point == 0
    return PlannedChain(
        plan.path,
        plan.law,
        plan.ticks,
        plan.programmed,
        last.leg + 1 if whole else last.leg,
        last.point,
        _ends(run, chained, plan.path.length),
        _marks(run, chained, plan.path.length),
        tuple(_joins(run, chained)),
        tuple(run.notes),
        time_left,
        (run.edges[0].room[0], last.room[1]),
    )


def lost_blend(
    place: Place,
    reason: str,
    next_place: Place | None = None,
    where: str = "its target",
    what: str = "the next move",
) -> Diagnostic:
    """The note, IRL432, that a move at `place` stops, and `what` stops it at `next_place`."""
    related = () if next_place is None else (Related(what, next_place),)
    return report("IRL432", place, related=related, where=where, reason=reason)


@dataclass(frozen=True)
class _Run:
    """Edges from stop to stop, the blended corners between them, and the notes on the way."""

    edges: list[Edge]
    corners: list[Corner]
    notes: list[Diagnostic]


@dataclass(frozen=True)
class _Chained:
    """Pieces of a run: of each edge what the blends leave, None for nothing; `starts` of the edges in s."""

    parts: list[PathPart | None]
    starts: list[float]
    corners: list[float]


def _first_run(legs: Sequence[Leg], rotation: Array, position: Array) -> _Run:
    waiting = edges_of(legs[0], 0, rotation, position)
    run = _Run([waiting.pop(0)], [], [])
    while True:
        last = run.edges[-1]
        if not waiting:
            waiting = _next_edges(legs, last)
        if not waiting:
            return run
        following = waiting.pop(0)
        found = corner_between(last, following)
        if isinstance(found, Lost):
            if found.reason:
                behind = _next_place(last, following)
                run.notes.append(lost_blend(last.place, found.reason, behind, last.where))
            return run
        if found.cut:
            run.notes.append(_cut_note(last, following, found))
        run.edges.append(following)
        run.corners.append(found)


def _next_edges(legs: Sequence[Leg], last: Edge) -> list[Edge]:
    """Edges of the leg behind an edge; none where it does not blend, or cannot be planned."""
    if last.leg + 1 >= len(legs) or last.blend is None:
        return []
    try:
        return edges_of(legs[last.leg + 1], last.leg + 1, last.path.end_rotation, last.path.end_position)
    except MotionError:
        return []


def _cut_note(before: Edge, after: Edge, corner: Corner) -> Diagnostic:
    asked = before.blend.distance if before.blend is not None else None
    data = {"asked": f"{(asked or 0.0) * 1000.0:.6g}", "used": f"{corner.distance * 1000.0:.6g}"}
    following = _next_place(before, after)
    related = () if following is None else (Related("the next move", following),)
    return report("IRL433", before.place, related=related, where=before.where, **data)


def _next_place(before: Edge, after: Edge) -> Place | None:
    """Place of the move that follows, None where it is the same one."""
    return None if after.leg == before.leg else after.place


def _chained(run: _Run) -> _Chained:
    """Where the pieces of a run lie on the path."""
    found = _Chained([], [], [])
    s = 0.0
    for k, edge in enumerate(run.edges):
        first = run.corners[k - 1].distance if k else 0.0
        last = edge.path.length - (run.corners[k].distance if k < len(run.corners) else 0.0)
        part = None
        if last > first:
            part = PathPart(edge.path, first, last, _shape_of(edge, first, last))
        found.parts.append(part)
        found.starts.append(s - first)
        s += 0.0 if part is None else part.length
        if k < len(run.corners):
            blend = run.corners[k].blend
            found.corners.append(s + blend.corner)
            s += blend.path.length
    return found


def _shape_of(edge: Edge, first: float, last: float) -> Shape:
    """Sections of an edge between two of its parameters."""
    shape = edge.shape
    ends = np.clip(np.concatenate([[0.0], np.cumsum(shape.lengths)]), first, last)
    lengths = np.diff(ends) if isinstance(edge.path, CurvedPath) else np.array([last - first])
    kept = np.flatnonzero(lengths > 0.0)
    varying = np.full(len(kept), isinstance(edge.path, CurvedPath))
    return Shape(lengths[kept], shape.curvature[kept], shape.turn_rate[kept], shape.turn_bend[kept], varying)


def _with_part_of_time(
    legs: Sequence[Leg], run: _Run, chained: _Chained, dt: float
) -> tuple[_Run, float | None]:
    """Give a leg with TIME that stops at a point of its PATH its part of that time; also what is left of it.

    All parts of the leg are slower than they could be by the same factor.
    """
    last = run.edges[-1]
    time = last.law.duration
    if time is None or not last.point:
        return run, None
    free = _with_duration(run, last.leg, None)
    plan = _timed(chained, free, dt)
    start = _ends(run, chained, plan.path.length)[-2:-1] or (0.0,)
    part = plan.programmed.duration - float(plan.programmed.times_at(np.array(start))[0])
    whole = part
    block = replace(legs[last.leg].block, law=replace(last.law, duration=None), blend=last.blend)
    left: tuple[Leg, ...] = (replace(legs[last.leg], block=block),)
    done = PlannedChain(plan.path, plan.law, plan.ticks, plan.programmed, 0, last.point, (), (), (), ())
    while left := done.rest(left):
        done = plan_chain(left, done.path.end_rotation, done.path.end_position, dt)
        whole += done.programmed.duration
    return _with_duration(run, last.leg, time * part / whole), time * (1.0 - part / whole)


def _with_duration(run: _Run, leg: int, duration: float | None) -> _Run:
    """The run with another TIME for one leg."""
    edges = [
        replace(edge, law=replace(edge.law, duration=duration)) if edge.leg == leg else edge
        for edge in run.edges
    ]
    return replace(run, edges=edges)


def _timed(chained: _Chained, run: _Run, dt: float) -> PlannedPath:
    first = run.edges[0]
    if not run.corners and not isinstance(first.path, CurvedPath):
        if first.path.is_nothing:
            return standing(first.path)
        return in_whole_ticks(first.path, path_law(first.path, first.law, first.place), dt, first.place)
    path = first.path if not run.corners else _path_of(chained, run)
    return in_whole_ticks(path, chain_law(_stages(chained, run), path.length), dt, first.place)


def _path_of(chained: _Chained, run: _Run) -> ChainPath:
    pieces: list[Piece] = []
    for k, part in enumerate(chained.parts):
        if part is not None:
            pieces.append(part)
        if k < len(run.corners):
            pieces.append(run.corners[k].blend.path)
    end = run.edges[-1].path
    widest = max(edge.path.widest_turn for edge in run.edges)
    return ChainPath(tuple(pieces), end.end_position, end.end_rotation, widest)


def _stages(chained: _Chained, run: _Run) -> list[Stage]:
    """Sections of every leg: its edges, the halves of blends at its ends, the blends inside it."""
    shapes: list[list[Shape]] = []
    for k, (edge, part) in enumerate(zip(run.edges, chained.parts, strict=True)):
        if len(shapes) <= edge.leg:
            shapes.append([])
        if k:
            shapes[-1].append(run.corners[k - 1].blend.halves[1])
        if part is not None:
            shapes[-1].append(part.shape)
        if k < len(run.corners):
            shapes[-1].append(run.corners[k].blend.halves[0])
    found = []
    for leg, parts in enumerate(shapes):
        edge = next(edge for edge in run.edges if edge.leg == leg)
        found.append(Stage(bounds_of(Shape.joined(parts), edge.law), edge.law, edge.place))
    return found


def _ends(run: _Run, chained: _Chained, length: float) -> tuple[float, ...]:
    ends = [
        s
        for edge, following, s in zip(run.edges[:-1], run.edges[1:], chained.corners, strict=True)
        if edge.leg != following.leg
    ]
    return (*ends, length)


def _marks(run: _Run, chained: _Chained, length: float) -> tuple[tuple[float, ...], ...]:
    marks: list[list[float]] = []
    for k, edge in enumerate(run.edges):
        if edge.leg == len(marks):
            marks.append([])
        low = chained.corners[k - 1] if k else 0.0
        high = chained.corners[k] if k < len(chained.corners) else length
        placed = [min(max(chained.starts[k] + mark, low), high) for mark in edge.marks]
        marks[-1] += [*placed[:-1], high]
    return tuple(tuple(places) for places in marks)


def _joins(run: _Run, chained: _Chained) -> list[Join]:
    return [
        Join(
            edge.leg,
            s,
            edge.blend.distance if edge.blend is not None else None,
            corner.distance,
            corner.blend.miss,
            corner.blend.miss_angle,
            edge.point,
        )
        for edge, corner, s in zip(run.edges[:-1], run.corners, chained.corners, strict=True)
    ]
