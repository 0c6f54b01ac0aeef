"""What links look like: shapes, places and materials of <visual> elements."""

import pytest

from irlx.robot.link_visuals import Visual, link_visuals
from irlx.robot.urdf import read_urdf
from irlx.solids.colour import Colour
from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Mesh, Solid, Sphere

pytestmark = pytest.mark.req("REP-04")

ARM = """<robot name="arm">
  <material name="steel"><color rgba="0.5 0.25 0 1"/></material>
  <link name="base">
    <visual><origin xyz="1 2 3" rpy="0 0 1.5"/><geometry><box size="1 2 3"/></geometry>
      <material name="steel"/></visual>
    <visual><geometry><sphere radius="0.5"/></geometry>
      <material name="glass"><color rgba="0 1 0 0.25"/></material></visual>
    <collision><geometry><sphere radius="9"/></geometry></collision>
  </link>
  <link name="hand">
    <visual><geometry><mesh filename="hand.dae" scale="2 2 2"/></geometry><material name="glass"/></visual>
    <visual><geometry><mesh filename="nail.dae"/></geometry><material name="unheard of"/></visual>
  </link>
  <link name="bare"/>
  <joint name="j1" type="revolute"><parent link="base"/><child link="hand"/></joint>
  <joint name="j2" type="fixed"><parent link="hand"/><child link="bare"/></joint>
</robot>"""
GLASS = Colour(0.0, 1.0, 0.0, 0.25)


def test_shapes_places_and_materials():
    found = link_visuals(ARM)
    turned = Placement.from_rpy((1.0, 2.0, 3.0), (0.0, 0.0, 1.5))
    assert found.by_link == {
        "base": (
            Visual(Solid(Box((1.0, 2.0, 3.0)), turned), Colour(0.5, 0.25, 0.0, 1.0)),
            Visual(Solid(Sphere(0.5)), GLASS),
        ),
        "hand": (
            Visual(Solid(Mesh("hand.dae", (2.0, 2.0, 2.0))), GLASS),
            Visual(Solid(Mesh("nail.dae")), None),
        ),
    }
    assert found.faults == ()


def test_codes_of_colours():
    assert GLASS.code == "#00ff00"
    assert Colour(0.5, 0.25, 0.0).code == "#804000"


@pytest.mark.parametrize("rgba", ["1 0", "red", "", "1 2 nan 1"])
def test_a_colour_that_cannot_be_read_is_none(rgba):
    text = ARM.replace("0 1 0 0.25", rgba)
    assert link_visuals(text).by_link["base"][1].colour is None


def test_a_visual_that_cannot_be_drawn_costs_its_link_alone():
    found = link_visuals(ARM.replace('<sphere radius="0.5"/>', '<torus radius="0.5"/>'))
    assert [link for link, _ in found.faults] == ["base"]
    assert "torus" in found.faults[0][1]
    assert set(found.by_link) == {"hand"}


def test_looks_are_no_part_of_what_a_robot_is():
    plain = ARM.replace("<visual>", "<ignored>").replace("</visual>", "</ignored>")
    assert read_urdf(ARM) == read_urdf(plain)
    assert read_urdf(ARM).fingerprint == read_urdf(plain).fingerprint
