"""Chains of moves of the gantry, made by hand from `passing_moves`: streams that keep what they promise."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from irlx.blocks import (
    ArcCourse,
    Blend,
    JointTarget,
    MotionLaw,
    MoveBlock,
    MoveKind,
    PathCourse,
    Port,
    PoseTarget,
    SignalBlock,
    SignalKind,
)
from passing_moves import Curve, Way, arc, line, postures, spline, trapezoid, way_of

START = np.array([0.0, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1])
DT = 0.004
CORNER = Blend(distance=0.05)
LAW = MotionLaw(speed=0.25, acc=2.0, speed_ori=3.0, acc_ori=20.0)


def start_of(kit, maker=None) -> tuple[np.ndarray, Rotation]:
    return kit.pose_of(START if maker is None else maker.rows[-1])


def target(position, rotation: Rotation) -> PoseTarget:
    return PoseTarget(tuple(float(x) for x in position), tuple(rotation.as_quat().tolist()))


def pose_at(curve: Curve, s: float) -> tuple[np.ndarray, Rotation]:
    return curve.point(np.array([s]))[0], curve.rotation(np.array([s]))[0]


def lines(pose, steps, turns) -> list[Curve]:
    """Lines by steps (m) with turns (rotation vectors in the tool's frame)."""
    found = []
    for step, turn in zip(steps, turns, strict=True):
        found.append(line(pose[0], pose[0] + np.array(step), pose[1], turn))
        pose = pose_at(found[-1], found[-1].length)
    return found


def run(maker, way: Way, blocks: list[dict], s: np.ndarray, last_of: list[int] | None = None) -> None:
    """Emit rows at ways `s` of a chain of moves, each row under the block that it is nearest to in time.

    `last_of`: of each move the number of its last curve.
    """
    points, turns = way.poses(s)
    rows = postures(points, turns)
    last_of = list(range(len(blocks))) if last_of is None else last_of
    ticks = np.interp([way.ends[k] for k in last_of[:-1]], s, np.arange(1, len(s) + 1))
    ends = [*np.rint(ticks).astype(int).tolist(), len(s)]
    begin = 0
    for number, (block, end) in enumerate(zip(blocks, ends, strict=True)):
        between = block.pop("between", None)
        if between is not None:
            maker.record(SignalBlock, **between)
        identity = maker.record(MoveBlock, **{"law": LAW, **block})
        hold = number == len(blocks) - 1
        part = rows[begin:end]
        if len(part):
            maker.emit(identity, part, holds=int(hold))
        begin = end


def led_in(kit):
    """A stream of a PTP of 50 ticks that leads from 0.02 before `START` round it: it goes on from 0.002."""
    maker = kit.Maker(START - 0.02)
    data = {"target": JointTarget(tuple(START.tolist())), "law": kit.LAW, "blend": Blend(share=1.0)}
    number = maker.record(MoveBlock, kind=MoveKind.PTP, **data)
    maker.emit(number, START - 0.02 + 0.018 * kit.smooth(100)[:50, None], holds=0)
    return maker


def lin(curve: Curve, blend: Blend | None = None, **more) -> dict:
    return {"kind": MoveKind.LIN, "target": target(*pose_at(curve, curve.length)), "blend": blend, **more}


def path(kind: MoveKind, poses, blend: Blend | None = None, **more) -> dict:
    *inner, last = [target(*pose) for pose in poses]
    return {"kind": kind, "target": last, "course": PathCourse(tuple(inner)), "blend": blend, **more}


STEPS = [(0.3, 0.0, 0.0), (0.0, 0.2, 0.1), (-0.2, 0.1, 0.0)]
TURNS = [(0.2, 0.1, 0.0), (0.0, 0.0, 0.5), (0.0, -0.3, 0.1)]


def three_lines(
    kit, distances=(0.05, 0.05), blends=(CORNER, CORNER), speed=0.1, tangent=None, laws=(LAW,) * 3
):
    maker = kit.Maker(START.copy())
    curves = lines(start_of(kit), STEPS, TURNS)
    way = way_of(curves, list(distances), tangent)
    blocks = [
        lin(curve, blend, law=law) for curve, blend, law in zip(curves, (*blends, None), laws, strict=True)
    ]
    run(maker, way, blocks, trapezoid(way.length, speed, 0.4, DT))
    return maker


def with_an_arc(kit) -> object:
    """A line, an arc by an angle beyond its end point, a line; a signal at the second corner."""
    maker = kit.Maker(START.copy())
    at, turned = start_of(kit)
    (first,) = lines((at, turned), [(0.2, 0.0, 0.0)], [(0.2, 0.0, 0.1)])
    here, turned = pose_at(first, first.length)
    round_ = arc(here, here + np.array([0.02, 0.15, 0.0]), [0, 0, 1], 2.0, turned, (0.0, 0.3, -0.2))
    end = pose_at(round_, round_.length)
    (last,) = lines(end, [(0.0, 0.0, 0.2)], [(0.0, 0.1, 0.0)])
    way = way_of([first, round_, last], [0.04, 0.03])
    via, some = pose_at(round_, 0.4 * round_.length)[0], pose_at(round_, 0.8 * round_.length)[0]
    circle = {
        "kind": MoveKind.CIRCLE,
        "target": target(some, end[1]),
        "course": ArcCourse(PoseTarget(tuple(via.tolist()), None), angle=2.0),
        "blend": Blend(distance=0.03),
    }
    port = Port("OUT_1", SignalKind.BOOL)
    signal = {"port": port, "value": 1.0}
    blocks = [lin(first, Blend(distance=0.04)), circle, {**lin(last), "between": signal}]
    run(maker, way, blocks, trapezoid(way.length, 0.1, 0.4, DT))
    return maker


def polyline(kit, blend=CORNER, distances=(0.04, 0.04, 0.05), stops=False) -> object:
    """Three pieces and a line that the last one runs into; the second piece is short."""
    maker = kit.Maker(START.copy())
    steps = [(0.2, 0.0, 0.0), (0.0, 0.08, 0.0), (0.0, 0.1, 0.15), (0.2, 0.0, 0.0)]
    turns = [(0.2, 0.1, 0.0), (0.0, 0.0, 0.0), (0.0, -0.3, 0.1), (0.1, 0.0, 0.0)]
    curves = lines(start_of(kit), steps, turns)
    way = way_of(curves, list(distances))
    points = path(MoveKind.LIN, [pose_at(curve, curve.length) for curve in curves[:3]], blend)
    s = trapezoid(way.length, 0.1, 0.4, DT)
    if stops:
        s = with_stops(np.concatenate([[0.0], way.ends[:2], [way.length]]))
    run(maker, way, [points, lin(curves[3])], s, [2, 3])
    return maker


def with_stops(places: np.ndarray) -> np.ndarray:
    """Ways that come to rest at each place, with a row more there."""
    found = []
    for begin, end in pairwise(places):
        ways = begin + trapezoid(end - begin, 0.1, 0.4, DT)
        ways[-1] = end
        found += [ways, [end]]
    return np.concatenate(found)


def stopping_polyline(kit) -> object:
    """A polyline without a blend stops at its points."""
    maker = kit.Maker(START.copy())
    curves = lines(start_of(kit), STEPS, TURNS)
    way = way_of(curves, [0.0, 0.0])
    s = with_stops(np.concatenate([[0.0], way.ends]))
    run(maker, way, [path(MoveKind.LIN, [pose_at(curve, curve.length) for curve in curves])], s)
    return maker


def smooth_path(kit) -> object:
    """A spline that a line runs into, and a line that it runs into."""
    maker = kit.Maker(START.copy())
    at, turned = start_of(kit)
    steps = np.array([(0.15, 0.05, 0.0), (0.1, 0.15, 0.05), (-0.05, 0.15, 0.1), (-0.1, 0.02, 0.05)])
    (first,) = lines((at, turned), [(0.1, -0.1, 0.0)], [(0.1, 0.0, 0.0)])
    poses = [pose_at(first, first.length)]
    turn = [(0.1, 0.0, 0.2), (0.0, 0.2, 0.1), (-0.2, -0.1, -0.2), (0.1, 0.0, 0.0)]
    for step, by in zip(steps, turn, strict=True):
        poses.append((poses[-1][0] + step, poses[-1][1] * Rotation.from_rotvec(by)))
    curve, _ = spline(poses)
    lead = way_of([first], [])
    way = Way([*lead.pieces, curve], [first.length, first.length + curve.length])
    # The line stops: what the spline does at its ends is judged by itself.
    s = with_stops(np.array([0.0, first.length]))
    run(maker, lead, [lin(first)], s)
    s = first.length + trapezoid(curve.length, 0.1, 0.2, DT)
    run(maker, way, [path(MoveKind.SPLINE, poses[1:])], s, [1])
    return maker


def passed_anyhow(kit, distances=(0.031, 0.012)) -> object:
    """C_PASS: any distance up to half of the shorter neighbour."""
    return three_lines(kit, distances, (Blend(), Blend()))


def straight_on(kit) -> object:
    """C_PASS between lines in one direction: only the turn tells where the blend is."""
    maker = kit.Maker(START.copy())
    curves = lines(start_of(kit), [(0.2, 0.0, 0.0), (0.3, 0.0, 0.0)], [(0.2, 0.0, 0.0), (0.0, 0.4, 0.0)])
    way = way_of(curves, [0.07])
    run(maker, way, [lin(curves[0], Blend()), lin(curves[1])], trapezoid(way.length, 0.1, 0.4, DT))
    return maker


def tiny_steps(kit) -> object:
    """Forty moves of half a millimetre, several of which go by between two ticks; at their speed the bends of
    the blends ask for 3.6 m/s2 across."""
    law = replace(LAW, acc=4.0)
    maker = kit.Maker(START.copy())
    angles = np.linspace(0.0, 1.5, 40)
    steps = 0.0005 * np.column_stack([np.cos(angles), np.sin(angles), 0.0 * angles])
    curves = lines(start_of(kit), steps, [(0.0, 0.0, 0.002)] * 40)
    distance = Blend(distance=0.01)
    way = way_of(curves, [0.00025] * 39)
    blocks = [lin(curve, distance, law=law) for curve in curves[:-1]] + [lin(curves[-1], law=law)]
    run(maker, way, blocks, trapezoid(way.length, 0.2, 2.0, DT))
    assert len(maker.rows) < 60
    return maker


def stopping_anyway(kit) -> object:
    """Moves that may pass their targets and do not."""
    maker = kit.Maker(START.copy())
    for curve in lines(start_of(kit), STEPS, TURNS):
        way = way_of([curve], [])
        run(maker, way, [lin(curve, CORNER)], trapezoid(way.length, 0.1, 0.4, DT))
    return maker


def reversal(kit) -> object:
    """A PATH with a blend that turns back on itself: there it stops."""
    maker = kit.Maker(START.copy())
    curves = lines(start_of(kit), [(0.2, 0, 0), (-0.1, 0, 0), (0, 0.2, 0)], [(0, 0, 0)] * 3)
    way = way_of(curves, [0.0, 0.05])
    s = with_stops(np.array([0.0, 0.2, way.length]))
    run(maker, way, [path(MoveKind.LIN, [pose_at(curve, curve.length) for curve in curves], CORNER)], s)
    return maker


def slow_then_fast(kit) -> object:
    """The second move is faster; from its corner on its speed holds."""
    fast = replace(LAW, speed=0.4)
    maker = kit.Maker(START.copy())
    curves = lines(start_of(kit), [(0.3, 0.0, 0.0), (0.3, 0.05, 0.0)], [(0.0, 0.0, 0.0)] * 2)
    way = way_of(curves, [0.1])
    corner = way.ends[0]
    # To the corner at the speed of the first, from there on faster.
    s = trapezoid(2 * corner, 0.25, 2.0, DT)
    s = s[: int(np.argmax(s > corner))]
    v, more = 0.25, []
    at = s[-1]
    while at < way.length - 0.1:
        v = min(v + 1.9 * DT, 0.4)
        at += v * DT
        more.append(at)
    # A quarter of a sine: its largest deceleration is v^2 / way.
    left = way.length - at
    ticks = int(np.ceil(left * np.pi / 2 / (v * DT)))
    end = at + left * np.sin(np.linspace(0, np.pi / 2, ticks + 1))[1:]
    run(
        maker,
        way,
        [lin(curves[0], Blend(distance=0.1)), lin(curves[1], law=fast)],
        np.concatenate([s, more, end]),
    )
    return maker
