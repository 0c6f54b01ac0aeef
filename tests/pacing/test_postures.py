"""Postures of poses, by what a run and a dry run find."""

from __future__ import annotations

import numpy as np
import pytest

from irlx.blocks import PoseTarget
from irlx.diagnostics import Place
from irlx.pacing.errors import PacingError
from irlx.pacing.pacer import Pacer
from irlx.pacing.postures import posture_of_pose
from irlx.pacing.resolution import EVERY_TICK, Resolution
from irlx.pacing.situation import PacingSetup, Situation
from irlx.robot.kinematics import Kinematics

PLACE = Place("t.irl")
resolutions = pytest.mark.parametrize("resolution", [EVERY_TICK, Resolution(8)], ids=["run", "dry run"])


def situation(kit, resolution: Resolution) -> Situation:
    weights = np.array([3.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    kinematics = Kinematics(kit.gantry())
    setup = PacingSetup(kinematics, kit.limits(), weights, kit.start, 0.01, resolution=resolution)
    return Pacer(setup, lambda origin: PLACE)._situation


@resolutions
def test_the_posture_of_a_pose_is_the_nearest_one_to_the_present_or_to_a_given_one(kit, resolution) -> None:
    """rail + x is asked for: what is missing of it falls to the two against their weights, 1 to 3."""
    here = situation(kit, resolution)
    target = PoseTarget(tuple(kit.beyond(0.4, 0.2, -0.1).tolist()), None)
    found = posture_of_pose(target, None, here, here.in_force(), PLACE)
    np.testing.assert_allclose(found, kit.moved(0.1, 0.3, 0.2, -0.1, 0, 0, 0), atol=1e-6)
    near = kit.moved(1.0, -0.2, 0.0, 0.0, 0.1, 0.0, 0.0)
    found = posture_of_pose(target, near, here, here.in_force(), PLACE)
    np.testing.assert_allclose(found, kit.moved(0.9, -0.5, 0.2, -0.1, 0, 0, 0), atol=1e-6)


@resolutions
def test_a_pose_out_of_reach_has_none(kit, resolution) -> None:
    here = situation(kit, resolution)
    with pytest.raises(PacingError) as caught:
        posture_of_pose(PoseTarget((0.0, 7.0, 0.0), None), None, here, here.in_force(), PLACE)
    assert caught.value.diagnostics[0].code == "IRL522"
    assert float(caught.value.diagnostics[0].data["distance"]) == pytest.approx(2000.0)
