"""Joints that follow others: the same robot with all its joints led by hand moves, weighs and fits alike."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from irlx.cell.packaged import packaged_urdf
from irlx.robot.axis_constraint import AxisConstraint
from irlx.robot.axis_direction import AxisDirection
from irlx.robot.kinematics import Kinematics
from irlx.robot.link_pairs import pairs_that_could_meet
from irlx.robot.link_path import LinkPath
from irlx.robot.path_constraint import PathConstraint
from irlx.robot.urdf import read_urdf
from irlx.robot.urdf_values import RobotModelError
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle
from irlx.scene.watched_pair import watched_pairs
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere
from irlx.transform.measures.dynamic_manipulability import DynamicManipulability
from irlx.transform.measures.gravity_torque import GravityTorque
from irlx.transform.measures.inertia import inertia_derivative, inertia_matrix
from irlx.transform.measures.manipulability import Manipulability
from irlx.transform.measures.smallest_singular_value import SmallestSingularValue
from irlx.verifier.geometry.forward import forward
from irlx.verifier.geometry.link_poses import link_poses, moved_links
from led_joints import CASES, coupled

pytestmark = pytest.mark.req("TRF-20")


@pytest.fixture(params=sorted(CASES))
def pair(request):
    tip = "tcp" if request.param == "koch11" else "tool"
    plain = read_urdf(packaged_urdf(request.param), tip)
    return plain, *coupled(plain, request.param)


def slope(function, q, h=1e-4):
    """Derivative by q, joint last: central differences of fourth order."""
    columns = []
    for step in h * np.eye(q.size):
        one = np.asarray(function(q + step)) - np.asarray(function(q - step))
        two = np.asarray(function(q + 2 * step)) - np.asarray(function(q - 2 * step))
        columns.append((8.0 * one - two) / (12.0 * h))
    return np.stack(columns, axis=-1)


def postures(robot, seed, count=3):
    q = np.random.default_rng(seed).uniform(-1.0, 1.0, (count, len(robot.axes)))
    q[0] = 0.0
    return q


def test_axes_are_those_that_lead(pair) -> None:
    plain, robot, matrix, _ = pair
    assert robot.joint_names == tuple(j.name for j in plain.axes if j.name in robot.joint_names)
    assert len(robot.axes) == matrix.shape[1] < len(plain.axes)
    assert robot.moving == tuple(j for j in robot.chain if j.name in plain.joint_names)
    assert robot.fingerprint != plain.fingerprint
    assert moved_links(robot) == moved_links(plain)
    assert set(pairs_that_could_meet(robot)) == set(pairs_that_could_meet(plain))


def test_poses_and_jacobians(pair) -> None:
    plain, robot, matrix, offsets = pair
    one, other = Kinematics(plain), Kinematics(robot)
    for q in postures(robot, 1):
        full = matrix @ q + offsets
        np.testing.assert_allclose(other.expanded(q), full, atol=1e-15)
        for mine, theirs in zip(other.tool_pose(q), one.tool_pose(full), strict=True):
            np.testing.assert_allclose(mine, theirs, atol=1e-14)
        target = pin.SE3(pin.exp3(np.array([0.2, 0.1, -0.3])), np.array([0.3, 0.2, 0.5]))
        left, jacobian = other.difference(q, target)
        due, rows = one.difference(full, target)
        np.testing.assert_allclose(left, due, atol=1e-12)
        np.testing.assert_allclose(jacobian, rows @ matrix, atol=1e-12)
        exact = other.difference_derivative(q, target)[1]
        np.testing.assert_allclose(exact, one.difference_derivative(full, target)[1] @ matrix, atol=1e-12)
        np.testing.assert_allclose(other.rows_here(q), one.rows_here(full) @ matrix, atol=1e-12)
    many = postures(robot, 2, 5)
    for mine, theirs in zip(other.tool_poses(many), one.tool_poses(many @ matrix.T + offsets), strict=True):
        np.testing.assert_allclose(mine, theirs, atol=1e-14)


def test_the_verifiers_own_poses(pair) -> None:
    plain, robot, matrix, offsets = pair
    q = postures(robot, 3, 6)
    for mine, theirs in zip(forward(robot, q), forward(plain, q @ matrix.T + offsets), strict=True):
        np.testing.assert_allclose(mine, theirs, atol=1e-15)
    position, rotation = forward(robot, q)
    found = Kinematics(robot).tool_poses(q)
    np.testing.assert_allclose(found[0], rotation, atol=1e-13)
    np.testing.assert_allclose(found[1], position, atol=1e-13)
    links = [joint.child for joint in robot.joints]
    mine, theirs = link_poses(robot, q, links), link_poses(plain, q @ matrix.T + offsets, links)
    for link in links:
        for one, other in zip(mine[link], theirs[link], strict=True):
            np.testing.assert_allclose(one, other, atol=1e-15)


def test_masses(pair) -> None:
    plain, robot, matrix, offsets = pair
    one, other = Kinematics(plain), Kinematics(robot)
    for q in postures(robot, 4):
        mass = matrix.T @ inertia_matrix(one, matrix @ q + offsets) @ matrix
        np.testing.assert_allclose(inertia_matrix(other, q), mass, rtol=1e-12, atol=1e-12 * np.max(mass))
        due = slope(lambda q: inertia_matrix(other, q), q)
        np.testing.assert_allclose(inertia_derivative(other, q), due, atol=1e-8 * np.max(mass))


@pytest.mark.parametrize(
    "kind", [Manipulability, SmallestSingularValue, DynamicManipulability, GravityTorque]
)
def test_gradients_of_measures(pair, kind) -> None:
    measure = kind(Kinematics(pair[1]))
    for q in postures(pair[1], 5)[1:]:
        due = slope(measure.value, q)
        np.testing.assert_allclose(measure.gradient(q), due, atol=1e-7 * max(1.0, np.max(np.abs(due))))


def test_distances_and_their_rates(pair) -> None:
    plain, robot, matrix, offsets = pair
    ball = Obstacle("ball", (Solid(Sphere(0.1)),), Placement((0.6, 0.4, 0.5)), 0.01, 5.0)
    one, other = Kinematics(plain), Kinematics(robot)
    theirs, mine = (Distances(k, watched_pairs(k, [ball], None)) for k in (one, other))
    every = np.arange(len(mine.pairs))
    for q in postures(robot, 6):
        near, due = mine.of(q, every), theirs.of(matrix @ q + offsets, every)
        np.testing.assert_allclose(near.distance, due.distance, atol=1e-9)
        rates = theirs.rates(matrix @ q + offsets, due) @ matrix
        np.testing.assert_allclose(mine.rates(q, near), rates, atol=1e-6)
    # What pairs come nearer by from one posture to another stays below the bound.
    levers = mine._levers
    for before, after in zip(postures(robot, 7, 12)[:-1], postures(robot, 7, 12)[1:], strict=True):
        here, there = (mine.of(q, every).distance.copy() for q in (before, after))
        assert np.all(here - there <= levers.moved(before, after) + 1e-9)


def text_of(name: str, **mimics: str) -> str:
    text = packaged_urdf(name)
    for joint, element in mimics.items():
        start = text.index(f'<joint name="{joint}"')
        at = text.index("</joint>", start)
        text = text[:at] + element + text[at:]
    return text


def test_followers_are_read_and_narrow_the_limits_of_their_leader() -> None:
    plain = read_urdf(packaged_urdf("rail6"), "tool")
    robot = read_urdf(
        text_of("rail6", joint_3='<mimic joint="joint_2" multiplier="-2" offset="0.1"/>'), "tool"
    )
    assert robot.joint_names == tuple(name for name in plain.joint_names if name != "joint_3")
    two, three = plain.axes[2], plain.axes[3]
    leader = next(joint for joint in robot.axes if joint.name == "joint_2")
    # -2 x + 0.1 within the limits of joint_3.
    assert leader.lower == pytest.approx(max(two.lower, (0.1 - three.upper) / 2))
    assert leader.upper == pytest.approx(min(two.upper, (0.1 - three.lower) / 2))
    assert leader.speed == pytest.approx(min(two.speed, three.speed / 2))
    held = read_urdf(text_of("rail6", joint_3='<mimic joint="joint_2"/>'), "tool", {"joint_3": 0.4})
    assert held.joint_names == robot.joint_names
    assert held.coupling == tuple((k, 1.0, 0.0) for k in range(6))


@pytest.mark.parametrize(
    ("mimics", "locked", "words"),
    [
        ({"joint_3": '<mimic joint="joint_2"/>'}, {"joint_2": 0.1}, "which is locked; lock it"),
        ({"joint_3": '<mimic joint="tool_joint"/>'}, {}, "which is fixed; lock it"),
        ({"joint_3": '<mimic joint="elbow"/>'}, {}, "which does not exist; lock it"),
        ({"joint_3": '<mimic joint="joint_2" offset="9"/>'}, {}, "no value of that keeps both limits"),
        (
            {"joint_3": '<mimic joint="joint_2"/>', "joint_2": '<mimic joint="joint_3"/>'},
            {},
            "follows itself",
        ),
    ],
)
def test_followers_without_a_leader(mimics, locked, words) -> None:
    with pytest.raises(RobotModelError, match=words):
        read_urdf(text_of("rail6", **mimics), "tool", locked)


def test_constraints_of_links(pair) -> None:
    plain, robot, matrix, offsets = pair
    one, other = Kinematics(plain), Kinematics(robot)
    link = plain.moving[-2].child
    path = LinkPath("path", link, ((0.0, 0.0), (1.0, 0.2), (2.0, 1.0)), heading=True)
    axis = AxisDirection("axis", link, (0.0, 0.6, 0.8), (0.0, 0.0, 1.0))
    for make, relation in ((PathConstraint, path), (AxisConstraint, axis)):
        mine, theirs = make(relation, other), make(relation, one)
        for q in postures(robot, 9):
            full = matrix @ q + offsets
            (left, slopes), (due, by_joints) = mine.rows(q), theirs.rows(full)
            np.testing.assert_allclose(left, due, atol=1e-12)
            np.testing.assert_allclose(mine.residual(q), due, atol=1e-12)
            np.testing.assert_allclose(slopes, by_joints @ matrix, atol=1e-11)
