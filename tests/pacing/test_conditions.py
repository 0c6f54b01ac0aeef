"""Targets that are off where no joint moves the tool."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import PoseTarget
from irlx.diagnostics import Place
from irlx.pacing.conditions import check_can_move
from irlx.pacing.errors import PacingError
from irlx.promises import PATH_ORIENTATION, PATH_POSITION
from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.robot.kinematics import Kinematics

Q = np.array([0.3, 0.4, -0.6])


def planar() -> Kinematics:
    """Three turns about z, half a metre apart: the task is x, y and the turn about z."""
    z, out = (0.0, 0.0, 1.0), (0.5, 0.0, 0.0)
    joints = [Joint(f"j{i}", JointKind.REVOLUTE, f"l{i}", f"l{i + 1}", out, axis=z) for i in range(3)]
    joints.append(Joint("hand", JointKind.FIXED, "l3", "tool", out))
    return Kinematics(RobotDescription("planar", "l0", "tool", tuple(joints), coordinates=("x", "y", "rz")))


@pytest.mark.parametrize("share", [0.9, -0.9, 1.1, -1.1])
@pytest.mark.parametrize("coordinate", ["z", "rx", "ry"])
def test_one_coordinate_that_is_off_is_enough_and_is_named(coordinate: str, share: float) -> None:
    """By more than a path may be off: anything less is no mistake of the program."""
    kinematics = planar()
    assert kinematics.immovable.coordinates == ("z", "rx", "ry")
    rotation, position = kinematics.tool_pose(Q)
    turn = np.zeros(3)
    if coordinate == "z":
        position = position + np.array([0.0, 0.0, share * PATH_POSITION])
    else:
        turn[("rx", "ry").index(coordinate)] = share * PATH_ORIENTATION
    turned = Rotation.from_matrix(rotation) * Rotation.from_rotvec(turn)
    target = PoseTarget(tuple(position.tolist()), tuple(turned.as_quat().tolist()))
    if abs(share) < 1.0:
        check_can_move(target, kinematics, Q, Place("t.irl"))
        return
    with pytest.raises(PacingError) as caught:
        check_can_move(target, kinematics, Q, Place("t.irl"))
    told = caught.value.diagnostics[0]
    assert told.code == "IRL430"
    assert told.data["off"].startswith(f"{coordinate} by ")
    assert "," not in told.data["off"]


def test_where_all_coordinates_can_be_moved_nothing_is_off(kit) -> None:
    target = PoseTarget((9.0, 9.0, 9.0), (1.0, 0.0, 0.0, 0.0))
    check_can_move(target, Kinematics(kit.gantry()), kit.start, Place("t.irl"))
