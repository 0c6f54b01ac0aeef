"""How far a blend reaches, by C_PASS and where less room is than was asked for."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import Blend, MoveKind
from irlx.motion.blended_corner import blended_corner
from irlx.motion.corner import LEAST_PASS, Corner, Lost, _speed, corner_between
from irlx.motion.edges import edges_of

pytestmark = pytest.mark.req("MOT-06")


def bent(path, law, speed: float) -> float:
    """Accelerations that a path needs at a steady speed over those allowed; half of ACC_ORI for the turn."""
    s = np.linspace(0.0, path.length, 2001)
    along, turning = path.second_derivatives(s)
    across = speed**2 * np.max(np.linalg.norm(along, axis=1)) / law.acc
    return max(across, 2.0 * speed**2 * np.max(np.linalg.norm(turning, axis=1)) / law.acc_ori)


@pytest.mark.parametrize("turned", [0.0, 1.2], ids=["by the curve", "by the turn"])
@pytest.mark.parametrize("speed", [0.5, 1.4])
def test_c_pass_keeps_the_speed_and_no_more(kit, turned: float, speed: float) -> None:
    """Next to straight lines all that bends is in inverse proportion to the distance."""
    law = kit.law(speed=speed, acc_ori=1.5)
    turn = Rotation.from_rotvec([turned, 0.0, 0.0]).as_quat()
    back = Rotation.from_rotvec([turned, -0.5 * turned, 0.0]).as_quat()
    first = kit.leg(kit.block((4.0, 0.0, 0.0), turn, law), Blend())
    second = kit.leg(kit.block((4.0, 4.0, 0.0), back, law))
    (before,) = edges_of(first, 0, np.eye(3), np.zeros(3))
    (after,) = edges_of(second, 1, before.path.end_rotation, before.path.end_position)
    corner = corner_between(before, after)
    assert isinstance(corner, Corner)
    assert not corner.cut
    assert bent(corner.blend.path, law, speed) == pytest.approx(1.0, abs=0.03)
    closer = blended_corner(before.path, after.path, 0.9 * corner.distance)
    assert bent(closer.path, law, speed) == pytest.approx(1.0 / 0.9, rel=0.03)


def test_a_blend_behind_a_spline_takes_half_of_its_last_piece(kit) -> None:
    points = [(0.1, 0.1, 0.0), (0.3, 0.0, 0.0)]
    spline = kit.leg(kit.path(MoveKind.SPLINE, points), Blend(5.0))
    (edge,) = edges_of(spline, 0, np.eye(3), np.zeros(3))
    fine = edge.path.poses(np.linspace(0.0, edge.path.length, 4001)).position
    steps = np.linalg.norm(np.diff(fine, axis=0), axis=1)
    via = int(np.argmin(np.linalg.norm(fine - points[0], axis=1)))
    assert edge.room == pytest.approx((0.5 * np.sum(steps[:via]), 0.5 * np.sum(steps[via:])), rel=2e-3)
    assert edge.marks == pytest.approx((np.sum(steps[:via]), edge.path.length), rel=2e-3)


@pytest.mark.parametrize("line_first", [True, False])
@pytest.mark.parametrize("speed", [0.2, 0.3])
def test_c_pass_beside_a_circle_keeps_the_speed_and_no_more(kit, line_first: bool, speed: float) -> None:
    """Of what bends there a part is that of the circle, however far the blend reaches."""
    law = kit.law(speed=speed)
    points = [(0.4, 0.0, 0.0), (0.4, 0.1, 0.1), (0.4, 0.0, 0.2)]
    if line_first:
        blocks = [kit.block(points[0], law=law), kit.circle(points[1], points[2], law)]
    else:
        blocks = [kit.circle((0.1, 0.0, 0.1), points[0], law), kit.block((0.6, 0.5, 0.0), law=law)]
    (before,) = edges_of(kit.leg(blocks[0], Blend()), 0, np.eye(3), np.zeros(3))
    (after,) = edges_of(kit.leg(blocks[1]), 1, before.path.end_rotation, before.path.end_position)
    corner = corner_between(before, after)
    assert isinstance(corner, Corner)
    assert LEAST_PASS < corner.distance < 0.9 * min(before.room[1], after.room[0])
    assert bent(corner.blend.path, law, speed) == pytest.approx(1.0, abs=0.03)
    closer = blended_corner(before.path, after.path, 0.9 * corner.distance)
    assert bent(closer.path, law, speed) > 1.04


def rounds(kit, turns: float, blend: Blend):
    """A circle of 30 mm that is run twice, so many turns each time, as edges."""
    law = kit.law(speed=0.1)
    block = kit.circle((0.03, 0.03, 0.0), (0.06, 0.0, 0.0), law, angle=2.0 * np.pi * turns)
    (before,) = edges_of(kit.leg(block, blend), 0, np.eye(3), np.zeros(3))
    (after,) = edges_of(kit.leg(block), 1, before.path.end_rotation, before.path.end_position)
    return before, after


@pytest.mark.parametrize("turns", [1.0, -1.0, 2.0, 1.0 + 1e-9])
def test_half_a_round_on_both_sides_of_a_corner_leads_back_to_where_it_begins(kit, turns: float) -> None:
    """No curve leads there: the move stops. Less of it is a blend, and C_PASS takes the least."""
    lost = corner_between(*rounds(kit, turns, Blend(1.0)))
    assert isinstance(lost, Lost)
    assert "lead back to where they begin" in lost.reason
    for blend, distance in ((Blend(0.04), 0.04), (Blend(), LEAST_PASS)):
        found = corner_between(*rounds(kit, turns, blend))
        assert isinstance(found, Corner)
        assert found.distance == distance
        assert found.blend.miss < 0.06


@pytest.mark.parametrize("blend", [Blend(1.0), Blend()])
def test_circles_that_meet_half_way_before_and_behind_a_corner_stop_there(kit, blend: Blend) -> None:
    """Each the other one's mirror image, with a corner of 66 degrees where they meet once more."""
    radius, half = 0.05, 1.0
    inner, outer = (radius * np.array([-np.sin(half), sign * np.cos(half), 0.0]) for sign in (1.0, -1.0))

    def on(centre: np.ndarray, angle: float) -> np.ndarray:
        turn = Rotation.from_rotvec([0.0, 0.0, angle])
        return centre - turn.apply(centre)

    law = kit.law(speed=0.5)
    start, via = on(inner, -4.0 * half), on(inner, -2.0 * half)
    first = kit.circle(via, np.zeros(3), law)
    second = kit.circle(on(outer, 2.0 * half), on(outer, 4.0 * half), law)
    (before,) = edges_of(kit.leg(first, blend), 0, np.eye(3), start)
    (after,) = edges_of(kit.leg(second), 1, np.eye(3), before.path.end_position)
    assert before.room[1] == pytest.approx(2.0 * half * radius)
    lost = corner_between(before, after)
    assert isinstance(lost, Lost)
    assert lost.reason == "100 mm beside the corner lead back to where they begin"


@pytest.mark.parametrize(("missing", "back"), [(1e-7, True), (1e-3, True), (3.1e-3, True), (3.3e-3, False)])
def test_half_a_round_but_for_a_hair_turns_back(kit, missing: float, back: bool) -> None:
    """The end of the blend lies behind its start, off its tangents by half of the angle that is missing."""
    found = corner_between(*rounds(kit, 1.0 - missing, Blend(1.0)))
    assert isinstance(found, Lost) is back
    assert not back or found.reason == "the path turns back on itself"
    assert isinstance(corner_between(*rounds(kit, 1.0 - missing, Blend())), Corner)


def test_half_a_round_and_a_hair_are_blended(kit) -> None:
    """The ends of the blend are 1e-7 m apart."""
    found = corner_between(*rounds(kit, 1.0 + 1e-7 / (2.0 * np.pi * 0.03), Blend(1.0)))
    assert isinstance(found, Corner)
    assert found.blend.path.length == pytest.approx(1e-7, rel=1e-6)


@pytest.mark.parametrize(
    ("curvature", "turn_rate", "expected"),
    [
        ([0.0, 0.0], [0.0, 0.0], 1.5),
        ([0.1, 7.0], [0.0, 0.0], np.sqrt(0.7 * 2.0 / 7.0)),
        ([0.0, 0.0], [4.0, 0.5], 0.8 / 4.0),
        ([7.0, 0.1], [0.0, 4.0], 0.8 / 4.0),
    ],
)
def test_the_speed_beside_a_corner_is_that_of_the_narrowest_place(
    kit, curvature, turn_rate, expected: float
) -> None:
    """0.7 of the acceleration is there for a path's own curve."""
    shape = SimpleNamespace(curvature=np.array(curvature), turn_rate=np.array(turn_rate))
    edge = SimpleNamespace(law=kit.law(speed=1.5, acc=2.0, speed_ori=0.8), shape=shape)
    assert _speed(edge) == pytest.approx(expected, rel=1e-12)
