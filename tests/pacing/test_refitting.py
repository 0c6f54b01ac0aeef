"""Tools and weights that a program changes, and answers about the last move and the bounds of joints."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import (
    AskJointBounds,
    AskLastMove,
    AskPose,
    Blend,
    LimitKind,
    MoveBlock,
    MoveKind,
    PoseIncrement,
    PoseTarget,
    ToolBlock,
    WeightsBlock,
)
from irlx.pacing.answers import answer_of_bounds, answer_of_last_move, way_of

STEP = np.array([0.1, 0.0, 0.0])


def tool(shop, position, orientation=(0.0, 0.0, 0.0, 1.0)):
    return shop.execute(ToolBlock(**shop._data(), position=position, orientation=orientation))


def weights(shop, *values):
    return shop.execute(WeightsBlock(**shop._data(), weights=values))


def asked(shop, kind, **data):
    return shop.pacer.answer(kind(shop.origin(1), **data))


@pytest.mark.req("LANG-50")
def test_a_tool_moves_nothing_and_counts_from_then_on(kit):
    shop = kit.shop()
    before, turned = kit.position(kit.start), kit.rotation(kit.start)
    assert tool(shop, (0.0, 0.0, 0.2)) is None
    assert np.array_equal(shop.pacer.q, kit.start)
    assert shop.pacer.tick == 0
    offset = turned.apply((0.0, 0.0, 0.2))
    assert asked(shop, AskPose, posture=tuple(kit.start))[:3] == pytest.approx(before + offset, abs=1e-15)
    rows = shop.line(before + offset + STEP)
    # The flange, whose pose is closed form, has gone the same way.
    assert kit.position(rows.q[-1]) == pytest.approx(before + STEP, abs=1e-9)
    assert rows.tool_position[-1] == pytest.approx(before + offset + STEP, abs=1e-9)
    assert shop.pacer.setup.kinematics.tool_pose(kit.start)[1] == pytest.approx(before + offset, abs=1e-15)


@pytest.mark.req("LANG-50")
def test_a_turn_about_the_tool_swings_the_flange(kit):
    shop = kit.shop()
    tool(shop, (0.0, 0.0, 0.2))
    point = kit.position(kit.start) + kit.rotation(kit.start).apply((0.0, 0.0, 0.2))
    block = {"kind": MoveKind.LIN, "law": shop.law()}
    turn = PoseIncrement((0.0, 0.0, 0.0), tuple(Rotation.from_rotvec((0.3, 0.0, 0.0)).as_quat().tolist()))
    rows = shop.execute(MoveBlock(**shop._data(), target=turn, **block))
    for q in rows.q:
        assert kit.position(q) + kit.rotation(q).apply((0.0, 0.0, 0.2)) == pytest.approx(point, abs=1e-6)
    assert np.linalg.norm(kit.position(rows.q[-1]) - kit.position(kit.start)) > 0.05


@pytest.mark.req("LANG-52")
def test_weights_decide_which_joints_move(kit):
    """Rail and slide share a way in x by the inverse of their weights."""
    for own in ((3.0, 1.0), (1.0, 1.0), (1.0, 4.0)):
        shop = kit.shop()
        assert weights(shop, *own, 1.0, 1.0, 1.0, 1.0, 1.0) is None
        rows = shop.line(kit.beyond(0.2, 0.0, 0.0))
        rail, slide = rows.q[-1][:2] - kit.start[:2]
        assert rail / slide == pytest.approx(own[1] / own[0], rel=1e-6)


@pytest.mark.req("LANG-52")
def test_the_last_move(kit):
    shop = kit.shop()
    assert asked(shop, AskLastMove) == (0.0, 0.0, 0.0)
    rows = shop.line(kit.beyond(0.0, 0.12, 0.05))
    duration, back, forward = asked(shop, AskLastMove)
    assert duration == pytest.approx((len(rows) - 1) * 0.01)
    assert (back, forward) == (pytest.approx(0.13, abs=1e-9), 0.0)
    # A switch is no move; a move of no length is.
    shop.cyclic()
    assert asked(shop, AskLastMove)[1] == back
    shop.line(kit.position(shop.pacer.q))
    assert asked(shop, AskLastMove) == (0.0, 0.0, 0.0)
    shop.to(shop.pacer.q + np.array([0.0, 0.03, 0.04, 0.0, 0.0, 0.0, 0.0]), duration=0.5)
    assert asked(shop, AskLastMove)[1] == pytest.approx(0.05, abs=1e-9)


@pytest.mark.req("LANG-52")
def test_a_pure_turn_has_no_length(kit):
    shop = kit.shop()
    rows = shop.line(kit.position(kit.start), kit.rotation(kit.start) * Rotation.from_rotvec((0, 0, 0.4)))
    duration, back, _ = asked(shop, AskLastMove)
    assert duration > 0.3
    assert back == pytest.approx(0.0, abs=1e-6)
    assert way_of(rows, kit.position(kit.start), 0.01) == (duration, back)


@pytest.mark.req("LANG-52")
def test_bounds_are_those_in_force(kit):
    shop = kit.shop(limits=kit.limits(position=[5.0, np.inf, 5.0, 5.0, 2.0, 2.0, 2.0]))
    plain = asked(shop, AskJointBounds)
    assert plain == (-5.0, -np.inf, -5.0, -5.0, -2.0, -2.0, -2.0, 5.0, np.inf, 5.0, 5.0, 2.0, 2.0, 2.0)
    shop.switch(LimitKind.POSITION, kit.range([1.0, 1.0, 9.0, 1.0, 1.0, 1.0, 1.0]))
    narrowed = asked(shop, AskJointBounds)
    assert narrowed[7:] == (1.0, 1.0, 5.0, 1.0, 1.0, 1.0, 1.0)
    shop.switch(LimitKind.POSITION, None)
    assert asked(shop, AskJointBounds) == plain


def test_answers_of_plain_data(kit):
    assert answer_of_last_move(1.5, 0.25) == (1.5, 0.25, 0.0)
    assert answer_of_bounds(kit.limits(position=2.0)) == (-2.0,) * 7 + (2.0,) * 7
    assert way_of(None, np.zeros(3), 0.01) == (0.0, 0.0)


@pytest.mark.req("LANG-52")
def test_the_last_move_of_a_group(kit):
    """Of moves that are carried out together it is the last one, with its own time and way."""
    shop = kit.shop()
    asked_for = ((kit.beyond(0.0, 0.12, 0.0), Blend(0.0)), (kit.beyond(0.0, 0.12, 0.3), None))
    blocks = [
        MoveBlock(
            **shop._data(),
            kind=MoveKind.LIN,
            target=PoseTarget(tuple(goal), None),
            law=shop.law(),
            blend=blend,
        )
        for goal, blend in asked_for
    ]
    done = list(shop.pacer.carry_out(blocks))
    duration, way, _ = asked(shop, AskLastMove)
    assert duration == pytest.approx((len(done[1].rows) - 1) * shop.dt)
    assert way == pytest.approx(0.3, abs=1e-9)
