"""Measures of a robot with two arms: seen from the world, and from a frame in its other hand."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from irlx.blocks import LinkFrame
from irlx.cell.named import named_section, named_urdf
from irlx.diagnostics import Place
from irlx.robot.description import Inertial
from irlx.robot.kinematics import Kinematics
from irlx.robot.urdf import read_urdf
from irlx.transform.measures.dynamic_manipulability import DynamicManipulability
from irlx.transform.measures.gravity_torque import GravityTorque
from irlx.transform.measures.inertia import inertia_derivative, inertia_matrix
from irlx.transform.measures.manipulability import Manipulability
from irlx.transform.measures.smallest_singular_value import SmallestSingularValue

pytestmark = pytest.mark.req("TRF-10")

STEP = 1e-6
PIPE = LinkFrame("pipe", "left_hand", (0.1, -0.05, 0.2), (0.5, 0.5, -0.5, 0.5))


@pytest.fixture(scope="module")
def twins() -> Kinematics:
    section = named_section("dual14")
    text = named_urdf("dual14", Place("dual14"))
    robot = read_urdf(text, section.tip, {}, tuple(section.hands or ()))
    masses = {
        joint.child: Inertial(
            1.0 + 0.1 * number,
            (0.02, 0.01 * number, 0.03),
            (0.0, 0.0, 0.0),
            (0.01, 0.0, 0.0, 0.02, 0.001, 0.03),
        )
        for number, joint in enumerate(robot.joints)
    }
    return Kinematics(replace(robot, inertials=masses))


def differences(function, q: np.ndarray) -> np.ndarray:
    return np.stack(
        [(function(q + s) - function(q - s)) / (2.0 * STEP) for s in STEP * np.eye(q.size)], axis=-1
    )


@pytest.mark.parametrize("frame", [None, PIPE])
@pytest.mark.parametrize("measure", [Manipulability, SmallestSingularValue, DynamicManipulability])
def test_gradients_against_differences(twins: Kinematics, frame: LinkFrame | None, measure) -> None:
    seen = twins if frame is None else twins.relative_to(frame)
    found = measure(seen)
    for q in np.random.default_rng(3).uniform(-1.2, 1.2, (3, seen.joints)):
        expected = differences(found.value, q)
        assert np.abs(found.gradient(q) - expected).max() < 1e-6 * max(1.0, np.abs(expected).max())
        assert np.any(expected[:7] != 0.0) is np.bool_(frame is not None)


def test_arms_do_not_change_each_others_inertia(twins: Kinematics) -> None:
    q = np.random.default_rng(4).uniform(-1.2, 1.2, 14)
    found, expected = inertia_derivative(twins, q), differences(lambda q: inertia_matrix(twins, q), q)
    assert np.abs(found - expected).max() < 1e-7
    assert np.all(found[:7, 7:] == 0.0)
    measure = GravityTorque(twins)
    slope = differences(measure.value, q)
    assert np.abs(measure.gradient(q) - slope).max() < 1e-6 * np.abs(slope).max()
