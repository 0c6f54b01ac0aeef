"""SRDF texts: which pairs may touch."""

import pytest

from irlx.robot.srdf import pairs_that_may_touch
from irlx.robot.urdf_values import RobotModelError

LINKS = ("base", "arm", "hand", "tool")
TEXT = """<?xml version="1.0"?><robot name="r">
<group name="arm"><joint name="j"/></group><!-- <disable_collisions link1="arm" link2="tool"/> -->
<disable_collisions link1="base" link2="arm" reason="Adjacent"/>
<disable_collisions link1="hand" link2="arm"/>
<disable_collisions link1="hand" link2="camera"/>
<disable_collisions link1="hand" link2="hand"/>
<disable_collisions link1="hand"/>
{more}</robot>"""


def pairs(*found):
    return frozenset(frozenset(pair) for pair in found)


def test_pairs_of_known_links():
    found = pairs_that_may_touch(TEXT.format(more=""), LINKS)
    assert found == pairs(("arm", "base"), ("arm", "hand"))


def test_a_link_with_all_others_and_pairs_taken_back():
    more = '<disable_default_collisions link="tool"/><enable_collisions link1="base" link2="tool"/>'
    more += '<enable_collisions link1="arm" link2="base"/>'
    found = pairs_that_may_touch(TEXT.format(more=more), LINKS)
    assert found == pairs(("arm", "hand"), ("tool", "arm"), ("tool", "hand"))


@pytest.mark.parametrize(
    ("text", "words"),
    [("<robot", "not well-formed"), ("<srdf/>", "outermost element is <srdf>"), ("", "not well-formed")],
)
def test_texts_that_are_no_srdf(text, words):
    with pytest.raises(RobotModelError, match=words):
        pairs_that_may_touch(text, LINKS)
