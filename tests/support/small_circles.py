"""Chains of moves of the gantry that lead into circles of a millimetre and less, in few rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from irlx.blocks import ArcCourse, Blend, JointTarget, MotionLaw, MoveBlock, MoveKind, PoseTarget
from made_chains import DT, LAW, START, lin, lines, pose_at, run, start_of, target
from passing_moves import Curve, Way, arc, postures, trapezoid, way_of

FAST = replace(LAW, speed=1.0, acc=600.0, speed_ori=100.0, acc_ori=1e5)


def into_a_circle(kit, radius: float, angle: float, distance: float) -> tuple[object, Way, list[Curve]]:
    """A line of 5 mm, a blend, and a circle by an angle that does not turn the tool."""
    maker = kit.Maker(START.copy())
    at, turned = start_of(kit)
    (first,) = lines((at, turned), [(0.005, 0.0, 0.0)], [(0.0, 0.02, 0.0)])
    here, turned = pose_at(first, first.length)
    way = radius * np.array([0.28, 0.96, 0.0])
    round_ = arc(here, here + way, [0, 0, 1], angle, turned, (0.0, 0.0, 0.0))
    return maker, way_of([first, round_], [distance]), [first, round_]


def circle(curve: Curve, angle: float, law: MotionLaw) -> dict:
    """The move along an arc, whose points are at a third and two thirds of a turn."""
    third = curve.length / angle * 2.0 * np.pi / 3.0
    via, (end, turned) = pose_at(curve, third)[0], pose_at(curve, 2.0 * third)
    course = ArcCourse(PoseTarget(tuple(via.tolist()), None), angle=angle)
    return {"kind": MoveKind.CIRCLE, "target": target(end, turned), "course": course, "law": law}


def round_in_two_ticks(kit, angle: float = 4.0 * np.pi) -> object:
    """Twice round a circle of half a millimetre, in steps of 4 rad; `angle` is what the program asks for."""
    maker, way, (first, round_) = into_a_circle(kit, 0.0005, 4.0 * np.pi, 0.001)
    s = np.append(np.arange(0.002, way.length - 1e-4, 0.002), way.length)
    told = circle(round_, 4.0 * np.pi, FAST)
    told["course"] = replace(told["course"], angle=angle)
    run(maker, way, [lin(first, Blend(distance=0.001), law=FAST), told], s)
    return maker


def onto_the_second_half(kit) -> object:
    """By a blend that nobody gives a length onto a circle of a twentieth of a millimetre: its first row lies
    on the second half, where places before its start are as well."""
    radius, angle, law = 5e-5, 5.84, replace(FAST, acc=100.0)
    maker, way, (first, round_) = into_a_circle(kit, radius, angle, 0.35 * radius * angle)
    slow = np.arange(0.0002, way.length - 4.6 * radius, 2e-5)
    s = np.concatenate([slow, way.length - radius * np.array([1.6, 0.0])])
    run(maker, way, [lin(first, Blend(), law=law), circle(round_, angle, law)], s)
    return maker


ROUND = 2.0 * np.pi


def all_but_one(maker, curve: Curve, blocks: list[dict], s: np.ndarray) -> None:
    """Rows at ways `s` on a curve, the last one under the last block, all others under the first."""
    rows = postures(*way_of([curve], []).poses(s))
    for block in blocks:
        identity = maker.record(MoveBlock, **{"law": LAW, **block})
        if block is blocks[0]:
            maker.emit(identity, rows[:-1], holds=0)
    maker.emit(identity, rows[-1:])


def stands_where_it_begins(kit) -> object:
    """A line that passes into a circle of half a millimetre, of which nothing is run."""
    maker, _, (first, round_) = into_a_circle(kit, 0.0005, ROUND, 0.001)
    s = np.append(np.arange(0.001, first.length - 1e-4, 0.001), first.length)
    all_but_one(maker, first, [lin(first, Blend(), law=FAST), circle(round_, ROUND, FAST)], s)
    return maker


def there_and_back(kit) -> object:
    """A line, and three sides of a triangle of a hundredth of a millimetre, which a tick is enough for."""
    maker = kit.Maker(START.copy())
    sides = 1e-5 * np.array([(0.0, 1.0, 0.0), (np.sqrt(0.75), -0.5, 0.0), (-np.sqrt(0.75), -0.5, 0.0)])
    curves = lines(start_of(kit), [(0.1, 0.0, 0.0), *sides], [(0.0, 0.02, 0.0), *[(0.0, 0.0, 0.0)] * 3])
    blocks = [*(lin(curve, Blend()) for curve in curves[:-1]), lin(curves[-1])]
    all_but_one(maker, curves[0], blocks, trapezoid(curves[0].length, 0.1, 0.4, DT))
    return maker


def round_before_a_line(kit, angle: float = 2.0 * ROUND) -> object:
    """Twice round a circle of half a millimetre and on by a line; `angle` is what the program asks for."""
    maker, _, (first, round_) = into_a_circle(kit, 0.0005, 2.0 * ROUND, 0.001)
    (last,) = lines(pose_at(round_, round_.length), [(0.002, 0.005, 0.0)], [(0.0, 0.0, 0.0)])
    way = way_of([first, round_, last], [0.0002, 0.0001])
    told = {**circle(round_, 2.0 * ROUND, FAST), "blend": Blend(distance=0.0001)}
    told["course"] = replace(told["course"], angle=angle)
    blocks = [lin(first, Blend(distance=0.0002), law=FAST), told, lin(last, law=FAST)]
    run(maker, way, blocks, trapezoid(way.length, 0.15, 50.0, DT))
    return maker


def round_before_a_ptp(kit, angle: float = 2.0 * ROUND) -> object:
    """Twice round a circle, of which the blend before takes most of a round, and on by a PTP; the last row of
    the circle lies beside it, in the corner."""
    taken = 0.0024
    maker, way, (first, round_) = into_a_circle(kit, 0.0005, 2.0 * ROUND, taken)
    told = {**circle(round_, 2.0 * ROUND, FAST), "blend": Blend(distance=0.0001)}
    told["course"] = replace(told["course"], angle=angle)
    s = np.append(np.arange(0.0006, way.length - 0.0002, 0.0006), way.length - 0.00005)
    run(maker, way, [lin(first, Blend(distance=taken), law=FAST), told], s)
    # No hold row: it does not stop, and the last one lies in the corner.
    maker.rows.pop()
    maker.blocks.pop()
    maker.rows[-1] = maker.rows[-1] + np.array([0.0, 0.0, 0.0, 2e-5, 0.0, 0.0, 0.0])
    begin = postures(*way.poses(np.array([way.length])))[0]
    goal = begin + np.array([0.0, 0.0, -0.02, 0.03, 0.0, 0.0, 0.0])
    fast = replace(LAW, speed=30.0, acc=300.0, speed_ori=30.0, acc_ori=500.0)
    ptp = maker.record(MoveBlock, kind=MoveKind.PTP, target=JointTarget(tuple(goal.tolist())), law=fast)
    share = 1.0 - (1.0 - np.linspace(0.0, 1.0, 41)[1:, None]) ** 2
    rows = begin + share * (goal - begin)
    rows[-1] = goal
    maker.emit(ptp, rows)
    return maker


def nothing_left(kit) -> object:
    """Onto a circle of a third of a millimetre by a blend that takes one half of it, and from it by one that
    takes the other."""
    radius, angle = 3e-4, 5.0
    half = 0.5 * radius * angle
    maker, _, (first, round_) = into_a_circle(kit, radius, angle, half)
    (last,) = lines(pose_at(round_, round_.length), [(0.004, 0.003, 0.0)], [(0.0, 0.0, 0.0)])
    way = way_of([first, round_, last], [half, half])
    told = circle(round_, angle, FAST)
    blocks = [lin(first, Blend(), law=FAST), {**told, "blend": Blend()}, lin(last, law=FAST)]
    run(maker, way, blocks, trapezoid(way.length, 0.1, 20.0, DT))
    return maker
