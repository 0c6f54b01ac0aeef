"""How a robot is seen from the world, from a link of its own, and from one that it does not have."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import (
    JointTarget,
    LinkFrame,
    MotionLaw,
    MoveBlock,
    MoveKind,
    Origin,
    PoseTarget,
    ReconfigureBlock,
    WaitBlock,
)
from irlx.diagnostics import Place
from irlx.pacing.errors import PacingError
from irlx.pacing.frames import frame_of, seen_from
from irlx.robot.kinematics import Kinematics

PLACE, ORIGIN = Place("t.irl"), Origin("t.irl", 0, 4, 1)
TURN = Rotation.from_euler("xyz", [0.2, -0.5, 0.7])
ON_CART = LinkFrame("cart", "l1", (0.1, -0.2, 0.3), tuple(TURN.as_quat().tolist()))
"""A frame on the slide that the rail carries: it moves along x with joint 1 alone."""


@pytest.mark.req("MOT-07")
def test_from_the_world_the_robot_is_itself(kit) -> None:
    robot = Kinematics(kit.gantry())
    assert seen_from(robot, None, PLACE) is robot.of_pose


@pytest.mark.req("MOT-07")
def test_from_a_link_poses_are_told_in_its_frame(kit) -> None:
    robot = Kinematics(kit.gantry())
    seen = seen_from(robot, ON_CART, PLACE)
    for seed in range(4):
        q = kit.start + 0.3 * np.random.default_rng(seed).normal(size=7)
        rotation, position = seen.tool_pose(q)
        origin = np.array([q[0], 0.0, 0.0]) + np.array(ON_CART.position)
        np.testing.assert_allclose(position, TURN.inv().apply(kit.position(q) - origin), rtol=0, atol=1e-12)
        wanted = (TURN.inv() * kit.rotation(q)).as_matrix()
        np.testing.assert_allclose(rotation, wanted, rtol=0, atol=1e-12)


@pytest.mark.req("MOT-07")
def test_a_link_that_it_does_not_have(kit) -> None:
    robot = Kinematics(kit.gantry())
    with pytest.raises(PacingError) as caught:
        seen_from(robot, LinkFrame("cart", "l12", (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)), PLACE)
    told = caught.value.reason
    assert (told.code, told.data["name"], told.data["link"], told.data["robot"]) == (
        "IRL515",
        "cart",
        "l12",
        "gantry",
    )


@pytest.mark.req("MOT-07")
@pytest.mark.parametrize(("kind", "leads"), [(MoveKind.LIN, True), (MoveKind.PTP, False)])
def test_a_frame_counts_for_what_leads_the_tool(kind: MoveKind, leads: bool) -> None:
    law = MotionLaw(speed=1.0, acc=1.0, speed_ori=1.0, acc_ori=1.0)
    target = PoseTarget((0.0, 0.0, 0.0), None)
    move = MoveBlock(id=1, origin=ORIGIN, kind=kind, target=target, law=law, frame=ON_CART)
    assert frame_of(move) is (ON_CART if leads else None)
    assert frame_of(WaitBlock(id=2, origin=ORIGIN, duration=1.0)) is None
    change = ReconfigureBlock(id=3, origin=ORIGIN, target=JointTarget((0.0,) * 7), law=law, frame=ON_CART)
    assert frame_of(change) is ON_CART
