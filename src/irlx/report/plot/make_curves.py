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
from irlx.report.plot.curves import Bounds, Curves, LimitSpan, MoveMark, Track
from irlx.report.plot.quantity import JOINT_QUANTITIES, Quantity
from irlx.report.programmed_pace import ProgrammedPace, programmed_pace
from irlx.robot.description import RobotDescription
from irlx.scene.scene import Scene
from irlx.streams.joint_stream import JointStream
from irlx.verifier.limits import LimitsInForce
from irlx.verifier.outline import Outline

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

AT_POSITION = 1e-3
"""Distance from a position limit, rad or m, up to which a joint counts as at it."""

AT_RATE, AT_RATE_SLOWED = 0.98, 0.9
"""Part of a speed or acceleration limit from which on a joint counts as at it; and where the tool is slower
than programmed, since a plan keeps a reserve."""

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
        name=subject.name,
        title=header.program_name or subject.name,
        robot=header.robot_name,
        complete=stream.complete,
        t=stream.t[inside],
        joint_names=header.joint_names,
        units=tuple("mm" if unit == "m" else "deg" for unit in header.joint_units),
        values={q: _drawable(joint_rows[q.value][inside] * scale) for q in quantities},
        bounds={quantity: _bounds(stream, limits, quantity, scale, window) for quantity in quantities},
        limit_spans=tuple(
            span
            for quantity in quantities
            for span in _limit_spans(stream, limits, quantity, joint_rows[quantity.value], inside, pace)
        ),
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


def _limit_spans(
    stream: JointStream,
    limits: LimitsInForce,
    quantity: Quantity,
    values: Array,
    inside: Integers,
    pace: ProgrammedPace,
) -> Iterator[LimitSpan]:
    """Spans in which joints are at limits. A limit that leaves a joint no room is none that it comes to."""
    if not inside.size:
        return
    first = int(inside[0])
    lower, upper = limits.bounds(quantity.value, first, len(inside))
    here = values[inside]
    if quantity is Quantity.POSITION:
        at = (here <= lower + AT_POSITION) | (here >= upper - AT_POSITION)
    else:
        part = np.full((len(inside), 1), AT_RATE)
        for begin, end in pace.slowed:
            part[(inside >= begin) & (inside <= end)] = AT_RATE_SLOWED
        at = ((here <= part * lower) & (lower < 0.0)) | ((here >= part * upper) & (upper > 0.0))
    at &= lower < upper
    for joint in range(here.shape[1]):
        for begin, end in _runs(at[:, joint]):
            yield LimitSpan(quantity, joint, _time(stream, first + begin - 1), _time(stream, first + end))


def _time(stream: JointStream, row: int) -> float:
    return float(stream.t[max(row, 0)])


def _runs(mask: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """First and last index of every run of True."""
    edges = np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8))
    for first, beyond in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
        yield int(first), int(beyond) - 1


def _times(
    stream: JointStream, spans: tuple[tuple[int, int], ...], window: tuple[float, float]
) -> Iterator[tuple[float, float]]:
    """Spans of rows as times within a window; what a row tells holds in the tick before it."""
    for first, last in spans:
        begin, end = max(_time(stream, first - 1), window[0]), min(_time(stream, last), window[1])
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
