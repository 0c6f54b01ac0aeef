"""Blocks that nobody could carry out: what of them is wrong; those that programs give have sense."""

from dataclasses import replace
from math import inf, nan

import pytest

from irlx.blocks import (
    ArcCourse,
    Blend,
    FreezeBlock,
    JointRange,
    JointTarget,
    LimitClause,
    LimitKind,
    MotionLaw,
    MoveBlock,
    MoveKind,
    Origin,
    PoseTarget,
    ToolBlock,
    WaitBlock,
    WeightsBlock,
)
from irlx.blocks.codec import BlockFormError, block_from_plain, block_to_plain
from irlx.blocks.sense import senseless

pytestmark = pytest.mark.req("STR-02")

ORIGIN = Origin("p.irl", 3, 9, 1)
LAW = MotionLaw(1.0, 2.0, 3.0, 4.0)
POSE = PoseTarget((1.0, 2.0, 3.0), (0.0, 0.0, 0.0, 1.0))
MOVE = MoveBlock(id=1, origin=ORIGIN, kind=MoveKind.CIRCLE, target=POSE, law=LAW, course=ArcCourse(POSE, 1.0))
RANGE = JointRange((-1.0, -1.0), (1.0, inf))
CROSSED = JointRange((1.0, 0.0), (0.0, 1.0))
LIMITED = replace(MOVE, limits=(LimitClause(LimitKind.SPEED, RANGE, ORIGIN),))
POSTURE = replace(MOVE, kind=MoveKind.PTP, target=JointTarget((1.0, 2.0)), course=None)


@pytest.mark.parametrize("block", [MOVE, LIMITED, POSTURE, replace(MOVE, law=replace(LAW, speed=inf))])
def test_blocks_that_have_sense(block):
    assert senseless(block, 2) == ""


def law(**values):
    return replace(MOVE, law=replace(LAW, **values))


@pytest.mark.parametrize(
    ("block", "words"),
    [
        (law(speed=0.0), "law.speed: needs a number above 0"),
        (law(acc_ori=nan), "law.acc_ori: needs a number above 0"),
        (law(override=1.5), "law.override: needs a number above 0, at most 1"),
        (law(duration=0.0), "law.duration: needs a number above 0"),
        (law(jerk=-1.0), "law.jerk: needs a number above 0"),
        (replace(MOVE, target=replace(POSE, position=(nan, 0.0, 0.0))), "target.position: needs lengths"),
        (
            replace(MOVE, target=replace(POSE, orientation=(0.0, 0.0, 0.0, 2.0))),
            "target.orientation: needs a unit quaternion",
        ),
        (replace(MOVE, course=ArcCourse(POSE, 0.0)), "course.angle: needs an angle other than 0"),
        (replace(MOVE, blend=Blend(share=2.0)), "blend.share: needs a number from 0 to 1"),
        (replace(MOVE, blend=Blend(distance=-1.0)), "blend.distance: needs a length from 0 on"),
        (replace(POSTURE, target=JointTarget((1.0,))), "target.values: needs 2 joint values"),
        (
            replace(
                LIMITED, limits=(LimitClause(LimitKind.SPEED, JointRange((1.0, 0.0), (0.0, 1.0)), ORIGIN),)
            ),
            "limits.1.range.lower: needs bounds that are not above those in upper",
        ),
        (FreezeBlock(id=1, origin=ORIGIN, joints=(0,)), "joints: needs numbers from 1 to 2"),
        (WaitBlock(id=1, origin=ORIGIN, duration=-1.0), "duration: needs a time from 0 on"),
        (WeightsBlock(id=1, origin=ORIGIN, weights=(1.0, 0.0)), "weights: needs 2 numbers above 0"),
        (
            ToolBlock(id=1, origin=ORIGIN, position=(0.0, inf, 0.0), orientation=(0.0, 0.0, 0.0, 1.0)),
            "position: needs lengths",
        ),
    ],
)
def test_what_is_wrong(block, words):
    assert senseless(block, 2) == words


@pytest.mark.parametrize(("start", "end"), [(9, 3), (-1, 3)])
def test_an_origin_that_is_no_place(start, end):
    plain = block_to_plain(MOVE)
    plain["origin"] |= {"start": start, "end": end}
    with pytest.raises(BlockFormError, match="origin: needs 0 <= start <= end, found"):
        block_from_plain(plain)
