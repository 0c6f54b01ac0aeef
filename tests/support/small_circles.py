"""Chains of moves of the gantry that lead into circles of a millimetre and less, in few rows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from irlx.blocks import ArcCourse, Blend, MotionLaw, MoveKind, PoseTarget
from made_chains import LAW, START, lin, lines, pose_at, run, start_of, target
from passing_moves import Curve, Way, arc, way_of

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
