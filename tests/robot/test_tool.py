"""A tool on the tip: it moves rigidly with it, and everything of the kinematics follows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

from irlx.cell.load import load_cell
from irlx.robot.equality import LinearConstraint
from irlx.robot.kinematics import Kinematics
from irlx.robot.relation import JointRelation

IDENTITY = (0.0, 0.0, 0.0, 1.0)


def kinematics_of(tmp_path: Path, model: str, constraints=()) -> Kinematics:
    path = tmp_path / "cell.toml"
    path.write_text(f'[robot]\nmodel = "{model}"\n', encoding="utf-8")
    return Kinematics(load_cell(path).robot, constraints)


def tools(rng: np.random.Generator):
    """Poses of tools on the tip: none, shifted, turned by half a turn, anywhere."""
    yield (0.0, 0.0, 0.0), IDENTITY
    yield (0.0, 0.0, 0.1), IDENTITY
    yield (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)
    for _ in range(3):
        x, y, z, w = Rotation.random(random_state=int(rng.integers(1 << 30))).as_quat()
        yield tuple(rng.normal(size=3).tolist()), (float(x), float(y), float(z), float(w))


def matrix(position, orientation) -> np.ndarray:
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = Rotation.from_quat(orientation).as_matrix(), position
    return found


def homogeneous(rotation: np.ndarray, position: np.ndarray) -> np.ndarray:
    found = np.eye(4)
    found[:3, :3], found[:3, 3] = rotation, position
    return found


@pytest.mark.req("LANG-50")
@pytest.mark.parametrize("model", ["arm7", "rail6", "planar4"])
def test_the_tool_moves_rigidly_with_the_tip(tmp_path, model):
    plain, rng = kinematics_of(tmp_path, model), np.random.default_rng(11)
    postures = rng.uniform(-1.5, 1.5, (5, plain.joints))
    for tool in tools(rng):
        changed = plain.with_tool(*tool)
        rotations, positions = changed.tool_poses(postures)
        for q, rotation, position in zip(postures, rotations, positions, strict=True):
            expected = homogeneous(*plain.tool_pose(q)) @ matrix(*tool)
            assert homogeneous(rotation, position) == pytest.approx(expected, abs=1e-12)
            assert homogeneous(*changed.tool_pose(q)) == pytest.approx(expected, abs=1e-12)


@pytest.mark.req("LANG-50")
def test_the_jacobian_is_that_of_the_tool(tmp_path):
    """By central differences of the tool pose."""
    plain, rng, step = kinematics_of(tmp_path, "arm7"), np.random.default_rng(3), 1e-6
    for tool in tools(rng):
        changed, q = plain.with_tool(*tool), rng.uniform(-1.5, 1.5, 7)
        here = changed.target(*changed.tool_pose(q))
        _, jacobian = changed.difference(q, here)
        for joint in range(7):
            ends = [
                changed.target(*changed.tool_pose(q + sign * step * np.eye(7)[joint])) for sign in (1, -1)
            ]
            moved = [pin.log6(here.actInv(end)).vector for end in ends]
            assert (moved[0] - moved[1]) / (2 * step) == pytest.approx(jacobian[:, joint], abs=1e-8)


@pytest.mark.req("LANG-50")
def test_a_second_tool_replaces_the_first(tmp_path):
    plain, q = kinematics_of(tmp_path, "arm7"), np.linspace(0.1, 0.7, 7)
    twice = plain.with_tool((0.0, 0.0, 0.3), (0.0, 1.0, 0.0, 0.0)).with_tool((0.1, 0.0, 0.0), IDENTITY)
    once = plain.with_tool((0.1, 0.0, 0.0), IDENTITY)
    assert np.array_equal(twice.tool_pose(q)[1], once.tool_pose(q)[1])
    back = twice.with_tool((0.0, 0.0, 0.0), IDENTITY)
    assert np.array_equal(back.tool_pose(q)[1], plain.tool_pose(q)[1])


@pytest.mark.req("LANG-50")
def test_conditions_between_joints_stay(tmp_path):
    names = kinematics_of(tmp_path, "arm7").description.joint_names
    level = LinearConstraint(JointRelation("level", ((names[1], 1.0), (names[3], 2.0)), 0.25), names)
    plain = kinematics_of(tmp_path, "arm7", (level,))
    changed, q = plain.with_tool((0.0, 0.1, 0.3), (0.0, 1.0, 0.0, 0.0)), np.linspace(0.1, 0.7, 7)
    assert changed.rows == plain.rows == 7
    assert changed.constraints == plain.constraints
    assert changed.here(q)[0][-1] == plain.here(q)[0][-1]
    assert changed.constrained(()).tool_pose(q)[1] == pytest.approx(changed.tool_pose(q)[1], abs=0.0)


@pytest.mark.req("LANG-50")
def test_what_a_planar_arm_does_not_move_depends_on_the_tool(tmp_path):
    plain = kinematics_of(tmp_path, "planar3")
    assert plain.immovable.coordinates == ("z", "rx", "ry")
    assert plain.with_tool((0.1, 0.2, 0.3), (0.0, 0.0, 0.6, 0.8)).immovable.coordinates == ("z", "rx", "ry")
    assert plain.with_tool((0.1, 0.2, 0.3), (0.6, 0.0, 0.0, 0.8)).immovable.coordinates != ("z", "rx", "ry")
