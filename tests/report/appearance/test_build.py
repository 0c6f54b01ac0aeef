"""What a cell looks like: the tree agrees with the robot's motion, and something is always drawn."""

import numpy as np
import pinocchio as pin
import pytest

from irlx.cell.packaged import packaged_names
from irlx.cell.robot_data import robot_data_folder
from irlx.report.appearance.build import appearance_of
from irlx.robot.kinematics import Kinematics
from irlx.solids.shape import Box, Cylinder, Sphere
from irlx.solids.triangles import Triangles
from mesh_files import CUBE, TRIANGLES, stl

pytestmark = pytest.mark.req("REP-04")
needs_robot_data = pytest.mark.skipif(robot_data_folder() is None, reason="the data package is missing")


def se3(placement):
    x, y, z, w = placement.orientation
    return pin.SE3(pin.Quaternion(w, x, y, z).toRotationMatrix(), np.array(placement.position))


def link_poses(robot, q):
    """Where the drawn tree puts every link at q, by Pinocchio's exponentials."""
    found = []
    for link in robot.links:
        if link.joint is None:
            found.append(pin.SE3.Identity())
            continue
        joint = link.joint
        value = (
            joint.offset
            if joint.axis_number is None
            else joint.multiplier * q[joint.axis_number] + joint.offset
        )
        axis = np.array(joint.axis)
        motion = {
            "fixed": pin.SE3.Identity(),
            "revolute": pin.SE3(pin.exp3(axis * value), np.zeros(3)),
            "prismatic": pin.SE3(np.eye(3), axis * value),
        }[joint.kind]
        found.append(found[link.parent] * se3(joint.placement) * motion)
    return found


def parts_by_link(appearance):
    return {link.name: link.parts for link in appearance.robot.links}


EXTERNAL = [pytest.param(name, marks=needs_robot_data) for name in ("panda", "talos_left")]
NAMES = [*packaged_names(), *EXTERNAL]


@pytest.mark.parametrize("name", NAMES)
def test_the_tree_moves_as_the_robot_does(cell, name):
    loaded = cell(f'[robot]\nmodel = "{name}"\n')
    appearance = appearance_of(loaded)
    kinematics = Kinematics(loaded.robot)
    rng = np.random.default_rng(1)
    for _ in range(3):
        q = rng.uniform(-1.0, 1.0, kinematics.joints)
        rotation, position = kinematics.tool_pose(q)
        found = link_poses(appearance.robot, q)[appearance.robot.tip]
        np.testing.assert_allclose(found.translation, position, atol=1e-12)
        np.testing.assert_allclose(found.rotation, rotation, atol=1e-12)
    assert all(
        link.parent is None or link.parent < number for number, link in enumerate(appearance.robot.links)
    )
    assert sum(len(link.parts) for link in appearance.robot.links) >= kinematics.joints
    assert appearance.diagnostics == ()


@needs_robot_data
def test_meshes_are_cut_down_to_the_budget(cell):
    loaded = cell('[robot]\nmodel = "panda"\n')
    surfaces = [
        part.shape
        for link in appearance_of(loaded, 20_000).robot.links
        for part in link.parts
        if isinstance(part.shape, Triangles)
    ]
    assert 15_000 < sum(len(surface.faces) for surface in surfaces) < 21_000
    colours = {part.colour.code for link in appearance_of(loaded).robot.links for part in link.parts}
    assert {"#ffffff", "#404040"} <= colours


LINK = "<{0}><geometry>{1}</geometry></{0}>"


def arm(first="", second="", joint="revolute"):
    limit = '<limit lower="-0.5" upper="1.5" velocity="1"/>'
    return (
        f'<robot name="arm"><link name="base">{first}</link>'
        f'<link name="hand">{second}</link><link name="tcp"/>'
        f'<joint name="j1" type="{joint}"><parent link="base"/><child link="hand"/><origin xyz="0 0 2"/>'
        f'<axis xyz="1 0 0"/>{limit}</joint>'
        '<joint name="end" type="fixed"><parent link="hand"/><child link="tcp"/>'
        '<origin xyz="0 3 4"/></joint></robot>'
    )


PLANAR = '[robot]\nmodel = "arm.urdf"\ntip = "hand"\ntask = ["{0}"]\n'


def test_collision_solids_stand_in_for_visuals(cell):
    ball, box = '<sphere radius="1"/>', '<box size="1 1 1"/>'
    both = LINK.format("visual", ball) + LINK.format("collision", box)
    found = parts_by_link(
        appearance_of(cell(PLANAR.format("rx"), arm=arm(both, LINK.format("collision", box))))
    )
    assert [part.shape for part in found["base"]] == [Sphere(1.0)]
    assert [part.shape for part in found["hand"]] == [Box((1.0, 1.0, 1.0))]
    assert found["tcp"] == ()


@pytest.mark.parametrize("mesh", ["no.stl", "broken.stl", "odd.xyz"])
def test_a_mesh_that_cannot_be_drawn_is_told(cell, tmp_path, mesh):
    (tmp_path / "broken.stl").write_bytes(b"solid nothing")
    (tmp_path / "odd.xyz").write_bytes(b"1 2 3")
    links = LINK.format("visual", f'<mesh filename="{mesh}"/>') + LINK.format(
        "collision", '<sphere radius="1"/>'
    )
    appearance = appearance_of(cell(PLANAR.format("rx"), arm=arm(links)))
    assert [part.shape for part in parts_by_link(appearance)["base"]] == [Sphere(1.0)]
    (told,) = appearance.diagnostics
    assert (told.code, told.is_error) == ("IRL721", False)
    assert "link 'base'" in told.message


def test_a_mesh_beside_the_model(cell, tmp_path):
    (tmp_path / "cube.stl").write_bytes(stl(CUBE, TRIANGLES))
    links = LINK.format("visual", '<mesh filename="cube.stl" scale="1 1 2"/>')
    (part,) = parts_by_link(appearance_of(cell(PLANAR.format("rx"), arm=arm(links))))["base"]
    assert part.shape.volume == pytest.approx(2.0)


def ends_of(part):
    """Both ends of a cylinder in its link's frame."""
    pose = se3(part.placement)
    return sorted(pose.act(np.array([0.0, 0.0, side * part.shape.length / 2])).tolist() for side in (-1, 1))


def test_a_robot_without_shapes_is_a_stick_figure(cell):
    found = parts_by_link(appearance_of(cell(PLANAR.format("rx"), arm=arm())))
    (upright,), (ball, lower_arm) = found["base"], found["hand"]
    np.testing.assert_allclose(ends_of(upright), [[0, 0, 0], [0, 0, 2]], atol=1e-12)
    np.testing.assert_allclose(ends_of(lower_arm), [[0, 0, 0], [0, 3, 4]], atol=1e-12)
    assert isinstance(ball.shape, Sphere)
    assert lower_arm.shape.radius < ball.shape.radius < 0.5


def test_a_slide_of_a_stick_figure_has_its_way(cell):
    found = parts_by_link(appearance_of(cell(PLANAR.format("x"), arm=arm(joint="prismatic"))))
    rail = found["base"][1]
    np.testing.assert_allclose(ends_of(rail), [[-0.5, 0, 2], [1.5, 0, 2]], atol=1e-12)


def test_a_stick_leads_to_a_joint_that_the_cell_has_moved(cell):
    text = PLANAR.format("rx") + "origins = { j1 = { xyz = [0, 0, 2500] } }\n"
    found = parts_by_link(appearance_of(cell(text, arm=arm(LINK.format("visual", '<sphere radius="1"/>')))))
    ball, stick = found["base"]
    assert isinstance(ball.shape, Sphere)
    assert isinstance(stick.shape, Cylinder)
    np.testing.assert_allclose(ends_of(stick), [[0, 0, 2], [0, 0, 2.5]], atol=1e-12)


def test_obstacles(cell, tmp_path):
    (tmp_path / "cube.stl").write_bytes(stl(CUBE, TRIANGLES))
    text = '[robot]\nmodel = "koch11"\n'
    text += '[[obstacle]]\nname = "wall"\nshape = "box"\nsize = [1000, 20, 2000]\nxyz = [900, 0, 500]\n'
    text += '[[obstacle]]\nname = "part"\nshape = "mesh"\nfile = "cube.stl"\nxyz = [0, 5000, 0]\n'
    wall, part = appearance_of(cell(text)).obstacles
    assert (wall.obstacle.name, wall.parts[0].shape) == ("wall", Box((1.0, 0.02, 2.0)))
    assert isinstance(part.parts[0].shape, Triangles)
