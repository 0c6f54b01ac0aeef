"""Targets as postures and poses: increments count from where the robot stands."""

from __future__ import annotations

import numpy as np

from irlx.blocks import JointIncrement, JointTarget, PoseTarget
from irlx.pacing.posed import posture_target


def test_postures_are_given_counted_or_none(kit) -> None:
    way = np.arange(7.0) / 8.0
    given = JointTarget((1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0))
    assert posture_target(given, kit.start) is given
    counted = posture_target(JointIncrement(tuple(way.tolist())), kit.start)
    assert counted == JointTarget(tuple((kit.start + way).tolist()))
    assert posture_target(PoseTarget((0.0, 0.0, 0.0), None), kit.start) is None
