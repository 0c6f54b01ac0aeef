"""From a stream, and its robot and scene where they are known, to the curves that are drawn."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MoveBlock, ReconfigureBlock
from irlx.diagnostics import Diagnostic, Place, report
from irlx.report.clearances import Clearances
from irlx.report.curves import limits_over, outline_of_stream, tool_rates
from irlx.report.legible import legible
from irlx.report.plot.curves import Bounds, Curves, MoveMark, Track
from irlx.report.plot.limit_spans import limit_spans, time_of
from irlx.report.plot.quantity import JOINT_QUANTITIES, Quantity
from irlx.report.programmed_pace import programmed_pace
from irlx.robot.description import RobotDescription
from irlx.scene.scene import Scene
from irlx.streams.joint_stream import JointStream
from irlx.verifier.limits import LimitsInForce
from irlx.verifier.outline import Outline

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

MOST_ROWS = 3000
"""Rows in which singular values and clearances are worked out; of longer streams every k-th."""

_LARGEST = 1e100
"""Largest number that is drawn: with greater ones ranges of diagrams are no numbers any more."""

_TURNING = np.radians(0.1)
"""Speed of turn, rad/s, below which a tool counts as not turning at all."""


@dataclass(frozen=True, eq=False)
class Subject:
    """What is to be drawn: a stream under a `name`; its `robot` and the `scene` around that, None where not
    known, and `why_unknown`; `clearances` of all its rows, where the run itself has told them."""

    stream: JointStream
    name: str
    robot: RobotDescription | None = None
    scene: Scene | None = None
    clearances: Clearances | None = None
    why_unknown: str = "its robot is not known; --cell names its cell"


def curves_of(
    subject: Subject, show: Collection[Quantity], window: tuple[float, float] = (0.0, np.inf)
) -> tuple[Curves, list[Diagnostic]]:
    """Curves of what is to be shown, within a window of time, s; and notes on what cannot be.

    Rates are backward differences, from rest before the first row, whatever the window.
    """
    # A file may hold any numbers; differences of the largest ones are infinite.
    with np.errstate(over="ignore", invalid="ignore"):
        return _curves_of(subject, show, window)


def _curves_of(
    subject: Subject, show: Collection[Quantity], window: tuple[float, float]
) -> tuple[Curves, list[Diagnostic]]:
    stream, outline = subject.stream, outline_of_stream(subject.stream)
    inside = np.flatnonzero((stream.t >= window[0]) & (stream.t <= window[1]))
    header = stream.header
    scale = np.array([1e3 if unit == "m" else np.degrees(1.0) for unit in header.joint_units])
    limits = limits_over(outline)
    joint_rows = {"position": stream.q, "speed": stream.qd, "acceleration": stream.qdd}
    quantities = [quantity for quantity in JOINT_QUANTITIES if quantity in show]
    pace = programmed_pace(stream, outline)
    tracks, notes = _tracks(subject, outline, show, inside)
    if Quantity.PATH_SPEED in show:
        tracks[Quantity.PATH_SPEED] = _tool_tracks(stream, pace.speed, pace.turn, inside)
    curves = Curves(
        name=legible(subject.name),
        title=legible(header.program_name or subject.name),
        robot=header.robot_name,
        complete=stream.complete,
        t=stream.t[inside],
        joint_names=header.joint_names,
        units=tuple("mm" if unit == "m" else "deg" for unit in header.joint_units),
        values={q: _drawable(joint_rows[q.value][inside] * scale) for q in quantities},
        bounds={quantity: _bounds(stream, limits, quantity, scale, window) for quantity in quantities},
        limit_spans=tuple(limit_spans(stream, limits, quantities, inside, pace.slowed)),
        moves=_moves(stream, window),
        slowed=tuple(_times(stream, pace.slowed, window)),
        tracks=tracks,
    )
    return curves, notes


def _drawable(values: Array) -> Array:
    """Values that diagrams have room for."""
    return np.clip(np.nan_to_num(values), -_LARGEST, _LARGEST)


def _bounds(
    stream: JointStream, limits: LimitsInForce, quantity: Quantity, scale: Array, window: tuple[float, float]
) -> Bounds:
    """Limits in force in spans of time; those of a row hold in the tick before it."""
    last = float(stream.t[-1]) if len(stream.t) else 0.0
    starts = [max(float(start - 1), 0.0) * stream.dt for start in limits.starts.tolist()]
    ends = [*starts[1:], last]
    sides = [limits_set.pair(quantity.value) for limits_set in limits.sets]
    spans = [
        (max(begin, window[0]), min(end, window[1]), *(side * scale for side in pair))
        for begin, end, pair in zip(starts, ends, sides, strict=True)
        if min(end, window[1]) > max(begin, window[0])
    ]
    if not spans:
        nothing = np.zeros((0, len(scale)))
        return Bounds(np.zeros(0), np.zeros(0), nothing, nothing)
    begin, end, lower, upper = (np.array(part) for part in zip(*spans, strict=True))
    return Bounds(begin, end, lower, upper)


def _times(
    stream: JointStream, spans: tuple[tuple[int, int], ...], window: tuple[float, float]
) -> Iterator[tuple[float, float]]:
    """Spans of rows as times within a window; what a row tells holds in the tick before it."""
    for first, last in spans:
        begin, end = max(time_of(stream, first - 1), window[0]), min(time_of(stream, last), window[1])
        if end > begin:
            yield begin, end


def _moves(stream: JointStream, window: tuple[float, float]) -> tuple[MoveMark, ...]:
    """Marks of the motions that begin within a window."""
    marks = [
        MoveMark(record.tick * stream.dt, record.block.origin.line)
        for record in stream.records
        if isinstance(record.block, MoveBlock | ReconfigureBlock)
    ]
    return tuple(mark for mark in marks if window[0] <= mark.time <= window[1])


def _tool_tracks(stream: JointStream, speed: Array, turn: Array, inside: Integers) -> tuple[Track, ...]:
    """Speed of the tool, and that of its turn where it turns, each with what was programmed."""
    way, turned = (_drawable(rate) for rate in tool_rates(stream.tool, stream.dt))
    t, name = stream.t[inside], "programmed"
    found = [Track("tool speed", "mm/s", t, way[inside] * 1e3, speed[inside] * 1e3, name, stepped=True)]
    if np.any(turned[inside] > _TURNING):
        angles = np.degrees(turned[inside]), np.degrees(turn[inside])
        found.append(Track("tool turning", "deg/s", t, *angles, name, stepped=True))
    return tuple(found)


def _tracks(
    subject: Subject, outline: Outline, show: Collection[Quantity], inside: Integers
) -> tuple[dict[Quantity, tuple[Track, ...]], list[Diagnostic]]:
    """Singular value and clearance, as far as robot and scene are known; and what is left out and why."""
    stream, robot = subject.stream, subject.robot
    rows = inside[:: max(1, -(-len(inside) // MOST_ROWS))]
    tracks: dict[Quantity, tuple[Track, ...]] = {}
    notes: list[Diagnostic] = []
    for quantity in (Quantity.SINGULAR, Quantity.CLEARANCE):
        if quantity not in show:
            continue
        if quantity is Quantity.CLEARANCE and subject.clearances is not None:
            found: Track | None = _clearance_track(stream, subject.clearances, inside)
        elif robot is None:
            notes.append(left_out(subject.name, quantity, subject.why_unknown))
            continue
        elif quantity is Quantity.SINGULAR:
            from irlx.report.singularity import smallest_singular_values

            values = smallest_singular_values(robot, outline.records, stream.ticks[rows], stream.q[rows])
            found = Track("smallest singular value", "", stream.t[rows], values)
        else:
            found = _measured_clearance(subject, robot, outline, rows, notes)
        if found is not None:
            tracks[quantity] = (found,)
    return tracks, notes


def left_out(name: str, quantity: Quantity, cause: str) -> Diagnostic:
    """IRL019: something asked for is not in the picture."""
    return report("IRL019", Place(name), what=quantity.value, cause=cause)


def _measured_clearance(
    subject: Subject, robot: RobotDescription, outline: Outline, rows: Integers, notes: list[Diagnostic]
) -> Track | None:
    """The clearance in some rows; None where there is nothing to keep clear of."""
    if subject.scene is None:
        cause = "the obstacles of its cell are not known; --cell names its cell"
        notes.append(left_out(subject.name, Quantity.CLEARANCE, cause))
        return None
    from irlx.report.clearance_curve import clearances_over

    try:
        found = clearances_over(outline, robot, subject.scene, subject.stream.q[rows], rows)
    except ValueError as cause:
        notes.append(left_out(subject.name, Quantity.CLEARANCE, str(cause)))
        return None
    return None if found is None else _clearance_track(subject.stream, found, rows, picked=True)


def _clearance_track(
    stream: JointStream, found: Clearances, rows: Integers, *, picked: bool = False
) -> Track | None:
    """Least distances as a curve, and the margin of what is nearest; None where nothing ever came near."""
    if not picked and len(found.pair) != len(stream.ticks):
        return None
    pair, distance = (found.pair, found.distance) if picked else (found.pair[rows], found.distance[rows])
    near = pair >= 0
    if not near.any():
        return None
    values = np.where(near, distance * 1e3, np.nan)
    margin = np.where(near, found.margin[pair] * 1e3, np.nan)
    return Track("clearance", "mm", stream.t[rows], values, margin, "margin")
