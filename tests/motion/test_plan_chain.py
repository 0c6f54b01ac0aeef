"""Moves that blend: geometry of the corners, who carries out what, and the time they take."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import Blend, MoveKind, Profile
from irlx.motion.arc import Arc
from irlx.motion.chain_path import ChainPath
from irlx.motion.errors import MotionError
from irlx.motion.line import Line
from irlx.motion.plan_chain import PlannedChain, plan_chain
from irlx.motion.plan_path import plan_path
from irlx.motion.trapezoid import Trapezoid
from long_run import chequered

ROTATION = Rotation.from_rotvec([0.2, -0.4, 1.1])
START = np.array([0.5, -0.25, 1.0])
DT = 0.004


def plan(legs, dt: float = DT) -> PlannedChain:
    return plan_chain(legs, ROTATION.as_matrix(), START, dt)


def moved(point, *way: float) -> np.ndarray:
    return point + np.array(way)


def turned(vector) -> np.ndarray:
    return (ROTATION * Rotation.from_rotvec(vector)).as_quat()


def lines(kit, ways, blend=None, turns=None, laws=None):
    """Legs that go on by the ways, one after another, the last one to a stop."""
    points = START + np.cumsum(np.array(ways, dtype=float), axis=0)
    turns = turns or [None] * len(points)
    laws = laws or [kit.law()] * len(points)
    legs = [
        kit.leg(kit.block(point, None if turn is None else turned(turn), law), blend)
        for point, turn, law in zip(points, turns, laws, strict=True)
    ]
    return [*legs[:-1], replace(legs[-1], block=replace(legs[-1].block, blend=None))]


def all_motions(legs, dt: float = DT) -> list[PlannedChain]:
    rotation, position, plans = ROTATION.as_matrix(), START, []
    while legs:
        plans.append(plan_chain(legs, rotation, position, dt))
        legs, path = plans[-1].rest(legs), plans[-1].path
        rotation, position = path.end_rotation, path.end_position
    return plans


CIRCLE = ((0.1, 0.05, 0.02), (0.2, 0.0, 0.0))


def chains(kit) -> dict:
    """Chains with every pair of kinds, the orientation turning on both sides of every corner."""
    turns = [(0.3, 0.1, 0.0), (-0.2, 0.4, 0.5), (0.0, 0.0, 0.9), (0.5, 0.0, 0.0)]
    along = lines(kit, [(0.2, 0, 0), (0.05, 0.2, 0), (0, 0.1, -0.2), (0.1, 0, 0.1)], Blend(0.03), turns)
    end = START + np.array([0.2, 0.0, 0.0])
    arc = kit.leg(kit.circle(START + CIRCLE[0], end, turns=(None, turned((0.2, 0.3, 0)))), Blend(0.04))
    via = kit.circle(
        START + CIRCLE[0], end, turns=(turned((0.4, 0, 0)), turned((0.2, 0.3, 0))), turns_through_via=True
    )
    second = kit.leg(kit.circle(moved(end, 0.1, -0.1, 0), moved(end, 0.2, 0.05, 0.1)), Blend(0.04))
    away = kit.leg(kit.block(moved(end, 0.1, 0.1, 0.2), turned((0.0, -0.5, 0.2))))
    points = [START + p for p in ([0.1, 0.1, 0], [0.15, 0.0, 0.1], [0.2, 0.0, 0.0])]
    spline = kit.path(MoveKind.SPLINE, points, [turned(t) for t in turns[:3]])
    return {
        "lines": along,
        "line, arc": [*along[:1], replace(second, block=replace(second.block, blend=None))],
        "arc, line": [arc, away],
        "arc, arc": [arc, second, away],
        "arc through via": [kit.leg(via, Blend(0.5)), away],
        "spline, line": [kit.leg(spline, Blend(0.04)), away],
        "line, spline": [kit.leg(kit.block(moved(START, 0, 0.1, 0)), Blend()), kit.leg(spline)],
        "polyline": [kit.leg(kit.path(MoveKind.LIN, points, [turned(t) for t in turns[:3]]), Blend(0.03))],
        "passing": lines(kit, [(0.2, 0, 0), (0.05, 0.2, 0), (0, 0.1, -0.2)], Blend(), turns[:3]),
        "whole": lines(kit, [(0.2, 0, 0), (0.05, 0.2, 0), (0, 0.1, -0.2)], Blend(9.0), turns[:3]),
    }


NAMES = [
    "lines",
    "line, arc",
    "arc, line",
    "arc, arc",
    "arc through via",
    "spline, line",
    "line, spline",
    "polyline",
    "passing",
    "whole",
]


@pytest.mark.req("MOT-06")
@pytest.mark.parametrize("name", NAMES)
def test_derivatives_are_those_of_the_poses(kit, name: str) -> None:
    """Differences by s converge to the derivatives with the square of the step, across all pieces."""
    path = plan(chains(kit)[name]).path
    errors = []
    for step in (4e-6, 2e-6):
        s = np.linspace(2e-4, path.length - 2e-4, 3001)
        poses = [path.poses(s + k * step) for k in (-1, 1)]
        along, turning = path.derivatives(s)
        way = (poses[1].position - poses[0].position) / (2 * step)
        turn = Rotation.from_matrix(poses[1].rotation @ np.transpose(poses[0].rotation, (0, 2, 1)))
        errors.append([np.max(np.abs(way - along)), np.max(np.abs(turn.as_rotvec() / (2 * step) - turning))])
        assert np.max(np.abs(np.linalg.norm(along, axis=1) - 1.0)) < 1e-14
    first, second = np.array(errors)
    assert np.all(second < 2e-6)
    # A quarter, or the rounding of the poses by the step.
    assert np.all((second < 0.4 * first) | (second < 1e-9))


@pytest.mark.req("MOT-06")
@pytest.mark.parametrize("name", NAMES)
def test_second_derivatives_are_continuous_and_those_of_the_first(kit, name: str) -> None:
    path = plan(chains(kit)[name]).path
    for order, step in enumerate((2e-6, 1e-6)):
        s = np.linspace(1e-4, path.length - 1e-4, 4001)
        before, behind = path.derivatives(s - step), path.derivatives(s + step)
        second = path.second_derivatives(s)
        for number, (low, high, found) in enumerate(zip(before, behind, second, strict=True)):
            # The turn through a via orientation changes its rate in steps: C1 there.
            off = np.max(np.abs((high - low) / (2 * step) - found), axis=1)
            if name == "arc through via" and number == 1:
                off = np.sort(off)[:-20]
            scale = float(np.max(np.abs(found))) + 1.0
            assert np.max(off) < 2e-3 * scale / (order + 1), f"part {number}"


@pytest.mark.req("MOT-06")
@pytest.mark.parametrize("angle", [1e-6, 0.1, 1.0, np.pi / 2, 2.5, 3.1])
def test_the_bend_of_a_blend_is_near_that_of_a_circle(kit, angle: float) -> None:
    """A circle that touches both lines at the same distance bends least of all: the blend by a fifth more."""
    way = 0.3 * np.array([np.cos(angle), np.sin(angle), 0.0])
    planned = plan(lines(kit, [(0.3, 0, 0), way], Blend(0.05)))
    circle = np.tan(angle / 2) / 0.05
    assert planned.path.curvature < 1.25 * circle
    (join,) = planned.joins
    assert join.used == join.asked == 0.05
    # Never farther from the corner than the chord between the ends.
    assert 0.0 < join.miss < 0.05 * np.cos((np.pi - angle) / 2) + 1e-12
    distances = np.linalg.norm(
        planned.path.poses(np.linspace(0, planned.path.length, 20001)).position - moved(START, 0.3, 0, 0),
        axis=1,
    )
    assert join.miss == pytest.approx(np.min(distances), abs=1e-8)
    position = planned.path.poses(np.array([join.s])).position[0]
    assert np.linalg.norm(position - moved(START, 0.3, 0, 0)) == pytest.approx(join.miss, abs=1e-12)


@pytest.mark.req("MOT-11")
def test_what_blends_leave_is_straight_and_the_ends_are_the_targets(kit) -> None:
    legs = lines(kit, [(0.2, 0, 0), (0, 0.3, 0), (0, 0, 0.4)], Blend(0.02))
    planned = plan(legs)
    s = np.linspace(0.0, planned.path.length, 5001)
    position = planned.path.poses(s).position - START
    corner = 0.02
    for axis, low, high, others in (
        (0, 0, 0.18, (0, 0)),
        (1, 0.02, 0.28, (0.2, 0)),
        (2, 0.02, 0.4, (0.2, 0.3)),
    ):
        rest = [k for k in range(3) if k != axis]
        on = (position[:, axis] > low) & (position[:, axis] < high)
        on &= np.all(np.abs(position[:, rest] - others) < corner / 100, axis=1)
        assert np.count_nonzero(on) > 500
        assert np.max(np.abs(position[on][:, rest] - others)) < 1e-12
    end = planned.path.poses(np.array([planned.path.length]))
    assert end.position[0].tolist() == list(legs[-1].block.target.position)


@pytest.mark.req("MOT-06")
def test_distances_are_cut_to_half_of_the_shorter_way(kit) -> None:
    planned = plan(lines(kit, [(0.3, 0, 0), (0, 0.1, 0), (0.2, 0, 0)], Blend(0.08)))
    assert [join.used for join in planned.joins] == pytest.approx([0.05, 0.05])
    assert [note.code for note in planned.notes] == ["IRL433", "IRL433"]
    assert planned.notes[0].data["used"] == "50"
    assert [related.message for related in planned.notes[0].related] == ["the next move"]
    assert not plan(lines(kit, [(0.3, 0, 0), (0, 0.1, 0)], Blend(0.05))).notes


@pytest.mark.req("MOT-06")
def test_c_pass_takes_what_the_speed_needs(kit) -> None:
    """At a right angle the blend bends 1.1722 / distance: just as much as ACC allows at the speed."""
    planned = plan(lines(kit, [(3, 0, 0), (0, 3, 0)], Blend()))
    (join,) = planned.joins
    assert join.asked is None
    assert join.used == pytest.approx(1.1722 * 1.0**2 / 2.0, rel=1e-2)
    s = np.linspace(0.5, planned.path.length - 0.5, 500)
    assert np.min(planned.programmed.rates_at(s)) > 0.995
    slower = plan(lines(kit, [(3, 0, 0), (0, 3, 0)], Blend(), laws=[kit.law(override=0.3)] * 2))
    assert slower.joins[0].used == join.used
    assert slower.programmed.duration == pytest.approx(planned.programmed.duration / 0.3, rel=1e-12)
    assert not planned.notes


@pytest.mark.req("MOT-06")
def test_the_speed_of_the_second_move_takes_over_at_the_corner(kit) -> None:
    laws = [kit.law(speed=0.1), kit.law(speed=0.02), kit.law(speed=0.1)]
    planned = plan(lines(kit, [(0.2, 0, 0), (0, 0.2, 0), (0.2, 0, 0)], Blend(0.02), laws=laws))
    law = planned.programmed
    before, behind = planned.ends[0], planned.ends[1]
    eps = 1e-6
    assert law.rates_at(np.array([before - 0.05, behind + 0.05])) == pytest.approx([0.1, 0.1])
    assert law.rates_at(np.array([before + eps, 0.2, behind - eps])) == pytest.approx([0.02] * 3)
    assert np.all(law.rates_at(np.array([before - 1e-3, behind + 1e-3])) > 0.021)


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize(
    ("name", "profile"), chequered([pytest.param(name, id=name) for name in NAMES], Profile)
)
def test_bounds_hold_by_differences(kit, name: str, profile: Profile) -> None:
    legs = [
        replace(leg, block=replace(leg.block, law=replace(leg.block.law, profile=profile)))
        for leg in chains(kit)[name]
    ]
    planned = plan(legs)
    t = np.linspace(0.0, planned.law.duration, 20001)
    h = t[1]
    s, rate = planned.law.evaluate(t)
    poses = planned.path.poses(s)
    along, turning = planned.path.derivatives(s)
    velocity = np.diff(poses.position, axis=0) / h
    acceleration = np.diff(velocity, axis=0) / h
    tangent = along[1:-1]
    tangential = np.abs(np.sum(acceleration * tangent, axis=1))
    normal = np.linalg.norm(acceleration - np.sum(acceleration * tangent, axis=1)[:, None] * tangent, axis=1)
    assert np.max(np.linalg.norm(velocity, axis=1)) < 1.0 + 1e-6
    assert np.max(tangential) < 2.0 * (1 + 2e-3)
    assert np.max(normal) < 2.0 * (1 + 2e-3)
    turn = turning * rate[:, None]
    assert np.max(np.linalg.norm(turn, axis=1)) < 1.5 * (1 + 1e-9)
    bend = np.linalg.norm(np.diff(turn, axis=0), axis=1) / h
    if isinstance(planned.path, ChainPath):
        assert np.max(bend) < 3.0 * (1 + 1e-3)
    assert np.max(np.abs(np.diff(rate)) / h) > 0.2


@pytest.mark.req("MOT-04")
def test_single_moves_are_what_they_were(kit) -> None:
    """A line, an arc, a turn and nothing: the very path and trapezoid of `plan_path`."""
    blocks = [
        kit.block(moved(START, 0.1, 0.2, 0.3), turned((0.1, 0, 0))),
        kit.circle(START + CIRCLE[0], START + CIRCLE[1]),
        kit.block(START, turned((0.3, 0.0, 0.1))),
        kit.block(START),
    ]
    for block in blocks:
        alone = plan_path(block, ROTATION.as_matrix(), START, DT, kit.place)
        chain = plan([kit.leg(block)])
        assert isinstance(chain.law, Trapezoid)
        assert (chain.law, chain.programmed, chain.ticks) == (alone.law, alone.programmed, alone.ticks)
        assert isinstance(chain.path, Line | Arc)
        s = np.linspace(0.0, chain.path.length, 50)
        assert chain.path.poses(s).position.tolist() == alone.path.poses(s).position.tolist()
        assert (chain.legs, chain.points, chain.joins, chain.notes) == (1, 0, (), ())
        assert chain.ends == (chain.path.length,)


@pytest.mark.req("MOT-06")
def test_legs_ends_and_marks(kit) -> None:
    legs = chains(kit)["arc, arc"]
    planned = plan(legs)
    assert planned.legs == 3
    assert len(planned.ends) == 3
    assert planned.ends[-1] == planned.path.length
    assert [join.s for join in planned.joins] == list(planned.ends[:2])
    via, end = planned.marks[0]
    assert end == planned.ends[0]
    at_via = planned.path.poses(np.array([via])).position[0]
    assert at_via == pytest.approx(START + np.array(CIRCLE[0]), abs=1e-12)
    poly = plan(chains(kit)["polyline"])
    assert [join.point for join in poly.joins] == [1, 2]
    assert [join.leg for join in poly.joins] == [0, 0]
    assert poly.marks == ((*(join.s for join in poly.joins), poly.path.length),)
    assert poly.ends == (poly.path.length,)


STOPS = {
    "not asked for": ([(0.1, 0, 0), (0, 0.1, 0)], None, 1, ""),
    "distance 0": ([(0.1, 0, 0), (0, 0.1, 0)], Blend(0.0), 1, ""),
    "reversal": ([(0.1, 0, 0), (-0.1, 0, 0)], Blend(0.02), 1, "turns back"),
    "nearly a reversal": ([(0.1, 0, 0), (-0.1, 0.0009, 0)], Blend(), 1, "turns back"),
    "nothing next": ([(0.1, 0, 0), (0, 0, 0), (0.1, 0, 0)], Blend(0.02), 1, "the next move has no length"),
    "nothing first": ([(0, 0, 0), (0.1, 0, 0)], Blend(0.02), 1, "this move has no length"),
    "short next": ([(0.1, 0, 0), (0, 1e-8, 0), (0.1, 0, 0)], Blend(0.02), 1, "next to nothing"),
    "next to no distance": ([(0.1, 0, 0), (0, 0.1, 0)], Blend(1e-8), 1, "next to nothing"),
}


@pytest.mark.req("MOT-06")
@pytest.mark.parametrize(("ways", "blend", "done", "reason"), STOPS.values(), ids=STOPS)
def test_corners_that_stop(kit, ways, blend, done: int, reason: str) -> None:
    legs = lines(kit, ways, blend)
    planned = plan(legs)
    assert planned.legs == done
    assert planned.path.end_position.tolist() == list(legs[done - 1].block.target.position)
    assert [note.code for note in planned.notes] == (["IRL432"] if reason else [])
    if reason:
        assert reason in planned.notes[0].message
        assert planned.notes[0].related[0].message == "the next move"
    motions = all_motions(legs)
    assert sum(motion.legs for motion in motions) == len(legs)
    assert motions[-1].path.end_position.tolist() == list(legs[-1].block.target.position)


@pytest.mark.req("MOT-06")
def test_a_turn_on_the_spot_is_no_neighbour(kit) -> None:
    legs = lines(kit, [(0.1, 0, 0), (0, 0, 0), (0, 0.1, 0)], Blend(0.01), [None, (0.5, 0, 0), None])
    motions = all_motions(legs)
    assert [motion.legs for motion in motions] == [1, 1, 1]
    assert "the next move turns the tool on the spot" in motions[0].notes[0].message
    assert "this move turns the tool on the spot" in motions[1].notes[0].message


def test_straight_on_is_one_line(kit) -> None:
    for blend in (Blend(0.03), Blend()):
        planned = plan(lines(kit, [(0.1, 0, 0), (0.2, 0, 0)], blend))
        assert planned.legs == 2
        assert planned.path.length == pytest.approx(0.3, abs=1e-14)
        assert planned.path.curvature < 1e-9
        assert planned.programmed.duration == pytest.approx(
            Trapezoid.fastest(0.3, 1.0, 2.0).duration, rel=1e-9
        )


@pytest.mark.req("MOT-01")
def test_polyline_stops_where_it_does_not_blend(kit) -> None:
    points = START + np.array([[0.1, 0, 0], [0.1, 0.1, 0], [0.1, 0.05, 0], [0.2, 0.05, 0]])
    leg = kit.leg(kit.path(MoveKind.LIN, points), Blend(0.02))
    after = kit.leg(kit.block(moved(points[-1], 0, 0.2, 0)))
    motions = all_motions([leg, after])
    assert [(motion.legs, motion.points) for motion in motions] == [(0, 2), (2, 0)]
    assert "stops at point 2 of its PATH" in motions[0].notes[0].message
    assert not motions[0].notes[0].related
    assert [
        motion.points for motion in all_motions([replace(leg, block=replace(leg.block, blend=None))])
    ] == [
        1,
        1,
        1,
        0,
    ]


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize("profile", list(Profile))
def test_time_from_hand_over_to_hand_over(kit, profile: Profile) -> None:
    laws = [kit.law(), kit.law(duration=2.0), kit.law(), kit.law(duration=4.0, override=0.5), kit.law()]
    laws = [replace(law, profile=profile) for law in laws]
    ways = [(0.2, 0, 0), (0, 0.2, 0), (0.1, 0, 0.2), (0, 0.3, 0), (0.3, 0, 0)]
    planned = plan(lines(kit, ways, Blend(0.03), laws=laws))
    assert planned.legs == 5
    times = planned.programmed.times_at(np.array([0.0, *planned.ends]))
    taken = np.diff(times)
    assert taken[[1, 3]] == pytest.approx([2.0, 8.0], rel=1e-8)
    assert np.all(taken[[0, 2, 4]] < 1.5)
    with pytest.raises(MotionError) as caught:
        plan(lines(kit, ways, Blend(0.03), laws=[kit.law(), kit.law(duration=0.1), *laws[2:]]))
    assert caught.value.diagnostics[0].code == "IRL421"


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize("blend", [None, Blend(0.02)])
def test_time_of_a_path_with_stops(kit, blend) -> None:
    points = START + np.array([[0.1, 0, 0], [0.1, 0.2, 0], [0.1, 0.1, 0], [0.4, 0.1, 0]])
    free = all_motions([kit.leg(kit.path(MoveKind.LIN, points), blend)])
    timed = all_motions([kit.leg(kit.path(MoveKind.LIN, points, law=kit.law(duration=5.0)), blend)])
    durations = np.array([[m.programmed.duration for m in motions] for motions in (free, timed)])
    assert np.sum(durations[1]) == pytest.approx(5.0, rel=1e-9)
    assert durations[1] / durations[0] == pytest.approx(5.0 / np.sum(durations[0]), rel=1e-8)
    with pytest.raises(MotionError) as caught:
        all_motions([kit.leg(kit.path(MoveKind.LIN, points, law=kit.law(duration=0.5)), blend)])
    assert caught.value.diagnostics[0].code == "IRL421"


@pytest.mark.req("MOT-03")
@pytest.mark.parametrize("profile", list(Profile))
def test_override_scales_time_alone(kit, profile: Profile) -> None:
    ways = [(0.2, 0, 0), (0, 0.2, 0), (0.1, 0, 0.2)]
    full, half = (
        plan(lines(kit, ways, Blend(0.03), laws=[kit.law(profile=profile, override=share)] * 3))
        for share in (1.0, 0.5)
    )
    assert half.path.length == full.path.length
    assert half.programmed.duration == pytest.approx(2.0 * full.programmed.duration, rel=1e-12)
    s = np.linspace(0.0, full.path.length, 100)
    assert 2.0 * half.programmed.rates_at(s) == pytest.approx(full.programmed.rates_at(s), abs=1e-9)
    single = [
        plan([kit.leg(kit.block(moved(START, 0.3, 0, 0), law=kit.law(profile=profile, override=o)))])
        for o in (1, 0.5)
    ]
    assert single[1].programmed.duration == pytest.approx(2.0 * single[0].programmed.duration, rel=1e-14)


@pytest.mark.req("MOT-01")
def test_a_later_leg_that_is_none_ends_the_motion_before_it(kit) -> None:
    bad = kit.leg(kit.circle(moved(START, 0.3, 0, 0), moved(START, 0.3, 0, 0)))
    legs = [*lines(kit, [(0.1, 0, 0), (0, 0.1, 0)], Blend(0.01))]
    legs = [legs[0], replace(legs[1], block=replace(legs[1].block, blend=Blend(0.01))), bad]
    planned = plan(legs)
    assert planned.legs == 2
    with pytest.raises(MotionError):
        plan(planned.rest(legs))


def test_far_and_near(kit) -> None:
    """10 km and 1 mm, and what has no measure."""
    far = plan(lines(kit, [(1e4, 0, 0), (0, 1e4, 0)], Blend(0.01), laws=[kit.law(speed=100.0)] * 2), 0.1)
    assert far.legs == 2
    near = plan(lines(kit, [(1e-3, 0, 0), (0, 1e-3, 0)], Blend(1e-4)))
    assert near.legs == 2
    s = np.linspace(0.0, near.path.length, 1001)
    steps = np.linalg.norm(np.diff(near.path.poses(s).position, axis=0), axis=1)
    assert np.max(np.abs(steps / s[1] - 1.0)) < 1e-3
    for far_away in (1e200, 1e12):
        with pytest.raises(MotionError) as caught:
            all_motions(lines(kit, [(far_away, 0, 0), (0, far_away, 0)], Blend(0.01)))
        assert caught.value.diagnostics[0].code == "IRL425"
