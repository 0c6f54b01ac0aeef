"""Robot models that cannot be used: every message names the element and what is wrong with it."""

from __future__ import annotations

from math import inf

import pytest

from irlx.robot.description import JointKind
from irlx.robot.urdf import read_urdf
from irlx.robot.urdf_values import RobotModelError

pytestmark = pytest.mark.req("TRF-20")

LIMIT = '<limit lower="-1" upper="1" velocity="2"/>'


def joint(name: str = "j", parent: str = "a", child: str = "b", kind: str = "revolute", inside: str = LIMIT):
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>{inside}</joint>'
    )


def robot(*parts: str, links: str = "ab") -> str:
    return f"<robot name='r'>{''.join(f'<link name={link!r}/>' for link in links)}{''.join(parts)}</robot>"


BROKEN = {
    "xml": ("<robot", "it is not well-formed XML: unclosed token"),
    "empty": ("", "it is not well-formed XML: no element found"),
    "element": ("<sdf/>", "its outermost element is <sdf>, a URDF has <robot>"),
    "no link": ("<robot name='r'/>", "it has no <link>"),
    "twin links": (robot(links="aab"), "two links are called 'a'"),
    "twin joints": (robot(joint(), joint(child="c"), links="abc"), "two joints are called 'j'"),
    "lost link": (robot(joint(child="x")), "joint 'j' names a link 'x' that does not exist"),
    "two parents": (
        robot(joint(), joint("k", "c", "b"), links="abc"),
        "link 'b' is the child of two joints",
    ),
    "two roots": (robot(), "one link must have no parent; found a, b"),
    "all in a ring": (
        robot(joint(), joint("k", "b", "a")),
        "one link must have no parent; found none (the joints form a ring)",
    ),
    "ring apart": (
        robot(joint(), joint("k", "c", "d"), joint("l", "d", "c"), links="abcd"),
        "link 'c' hangs in a ring of joints",
    ),
    "two leaves": (
        robot(joint(), joint("k", "a", "c"), links="abc"),
        "it has 2 links at an end (b, c); say which one is the tip",
    ),
    "no name": (robot(joint(name="")), "a <joint> has no name"),
    "floating": (
        robot(joint(kind="floating")),
        "joint 'j' is of type 'floating'; irlx moves revolute, continuous, prismatic, fixed",
    ),
    "mimic": (
        robot(joint(inside='<mimic joint="k"/>')),
        "joint 'j' moves the tool and mimics 'k', which does not exist; lock it",
    ),
    "mimic of itself": (robot(joint(inside='<mimic joint="j"/>')), "joint 'j' follows itself"),
    "mimic of nobody": (robot(joint(inside="<mimic/>")), "joint 'j', mimic: it names no joint"),
    "mimic by no number": (
        robot(joint(inside='<mimic joint="k" multiplier="x"/>')),
        "joint 'j', mimic: multiplier holds 'x', which is no number",
    ),
    "no child": (
        "<robot name='r'><link name='a'/><joint name='j' type='fixed'><parent link='a'/></joint></robot>",
        "joint 'j' has no <child link=\"...\">",
    ),
    "two numbers": (
        robot(joint(inside='<origin xyz="1 2"/>')),
        "joint 'j': xyz needs three numbers, found 2",
    ),
    "no number": (
        robot(joint(inside='<origin rpy="0 x 0"/>')),
        "joint 'j': rpy holds 'x', which is no number",
    ),
    "nan": (
        robot(joint(inside='<origin xyz="0 nan 0"/>')),
        "joint 'j': xyz holds 'nan', which is not finite",
    ),
    "no direction": (robot(joint(inside='<axis xyz="0 0 0"/>')), "the axis of joint 'j' has no direction"),
    "negative speed": (
        robot(joint(inside='<limit velocity="-1"/>')),
        "joint 'j', limit: velocity is negative",
    ),
    "crossed limits": (
        robot(joint(inside='<limit lower="2" upper="1"/>')),
        "joint 'j', limit: lower 2.0 is above upper 1.0",
    ),
    "limit word": (
        robot(joint(inside='<limit lower="low"/>')),
        "joint 'j', limit: lower holds 'low', which is no number",
    ),
    "mass": (
        "<robot name='r'><link name='a'><inertial><mass value='heavy'/></inertial></link></robot>",
        "link 'a', inertial: mass holds 'heavy', which is no number",
    ),
    "inertia": (
        "<robot name='r'><link name='a'><inertial><inertia ixy='inf'/></inertial></link></robot>",
        "link 'a', inertial: ixy holds 'inf', which is not finite",
    ),
}


@pytest.mark.parametrize(("text", "message"), BROKEN.values(), ids=BROKEN.keys())
def test_message_names_the_element_and_the_fault(text: str, message: str) -> None:
    with pytest.raises(RobotModelError) as caught:
        read_urdf(text)
    assert str(caught.value).startswith(message)


def test_unknown_tip_lists_the_links() -> None:
    with pytest.raises(RobotModelError, match="no link is called 'tool'") as caught:
        read_urdf(robot(joint()), tip="tool")
    assert caught.value.subject == "tool"
    assert caught.value.known == ("a", "b")


def test_unknown_locked_joint_lists_the_joints() -> None:
    with pytest.raises(RobotModelError, match="no joint is called 'J'") as caught:
        read_urdf(robot(joint()), locked={"J": 0.0})
    assert caught.value.known == ("j",)


def test_unknown_link_lists_the_links_and_names_the_joint() -> None:
    with pytest.raises(RobotModelError) as caught:
        read_urdf(robot(joint(parent="x")))
    assert (caught.value.subject, caught.value.known) == ("j", ("a", "b"))


def test_tip_inside_the_tree_cuts_the_chain_there() -> None:
    text = robot(joint(), joint("k", "b", "c"), links="abc")
    assert read_urdf(text, tip="b").joint_names == ("j",)
    assert read_urdf(text).joint_names == ("j", "k")


@pytest.mark.parametrize(
    ("kind", "inside", "limits"),
    [
        ("revolute", LIMIT, (-1.0, 1.0, 2.0)),
        ("revolute", "", (-inf, inf, inf)),
        ("prismatic", '<limit upper="0.5"/>', (-inf, 0.5, inf)),
        ("continuous", LIMIT, (-inf, inf, 2.0)),
    ],
)
def test_limits_that_are_not_given_are_infinite(kind: str, inside: str, limits: tuple) -> None:
    (found,) = read_urdf(robot(joint(kind=kind, inside=inside))).axes
    assert (found.lower, found.upper, found.speed) == limits
    assert found.kind is JointKind(kind)
    assert found.is_prismatic == (kind == "prismatic")


def test_axis_is_normalised_and_defaults_to_x() -> None:
    (skew,) = read_urdf(robot(joint(inside='<axis xyz="0 -3 4"/>'))).axes
    assert skew.axis == pytest.approx((0.0, -0.6, 0.8), abs=1e-15)
    (plain,) = read_urdf(robot(joint())).axes
    assert plain.axis == (1.0, 0.0, 0.0)
