"""What a move along a path is before and after it is paced: where it ends, and what its rows tell."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import ArcCourse, MotionLaw, MoveBlock, MoveKind, Origin, PathCourse, PoseTarget
from irlx.diagnostics import Place
from irlx.pacing import path_moves
from irlx.pacing.demand import Demands
from irlx.pacing.path_motion import PacedPath
from irlx.pacing.path_moves import _legs, _tool, end_of_move
from irlx.pacing.posture_term import PostureTerm
from irlx.pacing.resolution import Resolution
from irlx.transform.criteria.least_motion import LeastMotion

PLACE = Place("t.irl")
LAW = MotionLaw(speed=0.5, acc=2.0, speed_ori=1.0, acc_ori=4.0)
OFF = 1e-3


def move(kind: MoveKind = MoveKind.LIN, to=(-0.1, 0.0, 0.0), **more) -> MoveBlock:
    target = PoseTarget(tuple(to), None)
    return MoveBlock(id=7, origin=Origin("cell.irl", 0, 4, 1), kind=kind, target=target, law=LAW, **more)


@pytest.mark.parametrize("angle", [0.5, np.pi / 2, -2.0, 7.0])
def test_a_circle_with_an_angle_ends_on_it(angle: float) -> None:
    """From (r, 0, h) through (0, r, h) about the z axis: the angle counts from the start, also backwards."""
    radius, height = 0.1, 0.4
    course = ArcCourse(PoseTarget((0.0, radius, height), None), angle)
    circle = move(MoveKind.CIRCLE, (-radius, 0.0, height), course=course)
    start = Rotation.from_rotvec([0.1, 0.2, -0.3]).as_matrix(), np.array([radius, 0.0, height])
    rotation, position = end_of_move(circle, start, PLACE)
    wanted = [radius * np.cos(angle), radius * np.sin(angle), height]
    np.testing.assert_allclose(position, wanted, rtol=0, atol=1e-12)
    np.testing.assert_allclose(rotation, start[0], rtol=0, atol=1e-12)


def test_every_other_move_ends_at_its_target() -> None:
    course = ArcCourse(PoseTarget((0.0, 0.1, 0.4), None))
    start = np.eye(3), np.array([0.1, 0.0, 0.4])
    for block in (move(to=(-0.1, 0.0, 0.4)), move(MoveKind.CIRCLE, (-0.1, 0.0, 0.4), course=course)):
        rotation, position = end_of_move(block, start, PLACE)
        assert position.tolist() == [-0.1, 0.0, 0.4]
        assert np.all(rotation == np.eye(3))


@pytest.mark.parametrize("coarse", [False, True])
def test_rows_tell_where_the_joints_lead_the_tool_and_a_dry_run_what_was_asked_for(
    kit, shop, coarse: bool
) -> None:
    """The demands are 1 mm off in z; nobody gets the rows of a dry run, which looks no closer."""
    situation = shop.pacer._situation
    if coarse:
        situation = replace(situation, setup=replace(situation.setup, resolution=Resolution(20)))
    assert situation.setup.resolution.is_coarse is coarse
    q = kit.start + np.outer(np.linspace(0.0, 0.1, 5), np.eye(7)[2])
    position = np.array([kit.position(row) for row in q])
    rotation = np.array([kit.rotation(row).as_matrix() for row in q])
    off = position + np.array([0.0, 0.0, OFF])
    asked = Demands(np.arange(1, 6), np.linspace(0.0, 0.1, 5), off, rotation, np.zeros((5, 6)))
    least = LeastMotion(np.ones(7))
    paced = PacedPath(q, np.zeros((5, 7), np.int8), asked, 0, PostureTerm(lambda s, _: least, False))
    distance, angle, tool, turned = _tool(situation, paced)
    np.testing.assert_allclose(distance, 0.0 if coarse else OFF, rtol=0, atol=1e-12)
    np.testing.assert_allclose(angle, 0.0, rtol=0, atol=1e-7)
    np.testing.assert_allclose(tool, off if coarse else position, rtol=0, atol=1e-12)
    np.testing.assert_allclose(turned, rotation, rtol=0, atol=1e-12)


def test_points_of_a_path_are_looked_at_once_and_of_no_other_move(kit, shop, monkeypatch) -> None:
    """A PATH that stops on its way comes back for each of its pieces."""
    looks: list[int] = []
    monkeypatch.setattr(path_moves, "check_points", lambda asked, *_: looks.append(len(asked)))
    situation, goal = shop.pacer._situation, kit.beyond(0.2, 0.0, 0.0)
    start, facing = situation.pose, tuple(kit.rotation(kit.start).as_quat().tolist())
    via = PoseTarget(tuple(kit.beyond(0.1, 0.1, 0.0).tolist()), facing)
    plain = replace(move(to=goal), id=8)
    course = move(to=goal, course=PathCourse((via,), ()))
    legs = _legs(situation, [plain], start, shop.limits)
    assert looks == []
    assert [leg.block.id for leg in legs] == [8]
    for _ in range(2):
        _legs(situation, [course], start, shop.limits)
        assert looks == [1]
