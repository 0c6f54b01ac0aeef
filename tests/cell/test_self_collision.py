"""Which links a cell keeps off each other: by default, as asked, and for every robot by name."""

import numpy as np
import pytest

from irlx.cell.link_meshes import resolved_solids
from irlx.cell.named import robot_names
from irlx.cell.packaged import packaged_names
from irlx.cell.robot_data import robot_data_folder
from link_contacts import NEAR, cell_of, distances_of, drawn_postures

needs_robot_data = pytest.mark.skipif(robot_data_folder() is None, reason="the data package is missing")
WITHOUT = {"kinova", "tiago", "ur10", "z1"}
"""Robots of the data package without an SRDF: nothing tells which of their links may touch."""
BOX = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
ARM = '[robot]\nmodel = "arm.urdf"\n'


@pytest.fixture
def arm(chain):
    """A chain of seven joints whose links, and base, are boxes."""
    text = chain(7)
    for name in ("base", *(f"link{k}" for k in range(1, 8))):
        text = text.replace(f'<link name="{name}"/>', f'<link name="{name}">{BOX}</link>')
    return text


@pytest.mark.parametrize("name", robot_names())
def test_every_robot_starts_clear_of_itself(name):
    if name not in packaged_names() and robot_data_folder() is None:
        pytest.skip("the data package is missing")
    found = cell_of(name)
    if name in WITHOUT:
        assert found.scene.links is None
        return
    links = found.scene.links
    assert (links.margin, links.influence) == (0.005, 0.03)
    assert len(links.pairs) > 2
    assert np.min(distances_of(found, links.pairs, found.start[None])) > links.margin
    assert resolved_solids(found.robot, found.model, found.file) is found.robot.solids
    assert not [d for d in found.warnings if d.code != "IRL621"]


@pytest.mark.parametrize("name", packaged_names())
def test_what_is_watched_is_apart_somewhere_and_is_no_neighbour(name):
    """No pair that touches in every posture is watched: none could ever be kept."""
    found = cell_of(name)
    postures = np.vstack([found.start, drawn_postures(found, 60)])
    distances = distances_of(found, found.scene.links.pairs, postures)
    assert np.min(np.max(distances, axis=1)) > NEAR
    neighbours = {frozenset((joint.parent, joint.child)) for joint in found.robot.joints}
    assert not neighbours & {frozenset(pair) for pair in found.scene.links.pairs}


@pytest.mark.parametrize("name", ["arm7", "rail6", "mobile8"])
def test_what_may_touch_in_packaged_arms_only_grazes(name):
    """Flange and forearm overlap by less than 7 mm, beside the limit of the wrist."""
    pair = {"arm7": ("forearm_2", "flange")}.get(name, ("forearm", "flange"))
    found = cell_of(name)
    assert pair not in found.scene.links.pairs
    distances = distances_of(found, (pair,), drawn_postures(found, 300, seed=1))
    assert -0.007 < np.min(distances) < NEAR


def test_koch11_watches_its_booms_and_not_its_hand():
    watched = {frozenset(pair) for pair in cell_of("koch11").scene.links.pairs}
    hand = {"arm_8", "arm_9", "arm_10", "arm_11", "end_effector"}
    assert not [pair for pair in watched if pair <= hand]
    assert frozenset(("arm_3", "arm_5")) in watched
    assert frozenset(("base_link", "end_effector")) in watched


def test_a_urdf_by_path_is_not_watched_unless_asked(cell, arm):
    assert cell(ARM, arm=arm).scene.links is None
    assert cell(ARM + "[robot.self_collision]\nactive = false\nmargin = 3\n", arm=arm).scene.links is None
    links = cell(ARM + "[robot.self_collision]\nactive = true\n", arm=arm).scene.links
    assert len(links.pairs) == 8 * 7 // 2 - 7
    assert ("base", "link2") in links.pairs
    assert ("base", "link1") not in links.pairs


def test_pairs_margin_and_influence_as_asked(cell, arm):
    text = ARM + '[robot.self_collision]\nmay_touch = [["link3", "base"]]\nmargin = 0\ninfluence = 12.5\n'
    links = cell(text, arm=arm).scene.links
    assert ("base", "link3") not in links.pairs
    assert len(links.pairs) == 20
    assert (links.margin, links.influence) == (0.0, 0.0125)


def test_pairs_of_an_srdf_beside_the_cell(cell, arm, tmp_path):
    pair = '<disable_collisions link1="base" link2="link2"/>'
    (tmp_path / "arm.srdf").write_text(f'<robot name="r">{pair}</robot>')
    text = ARM + '[robot.self_collision]\nsrdf = "arm.srdf"\nmay_touch = [["link1", "link3"]]\n'
    links = cell(text, arm=arm).scene.links
    assert len(links.pairs) == 19
    assert ("base", "link2") not in links.pairs


def test_pairs_of_the_cell_add_to_those_of_a_named_robot(cell, koch):
    own = cell(koch).scene.links
    more = cell(koch + '[robot.self_collision]\nmay_touch = [["arm_5", "arm_3"]]\nmargin = 20\n').scene.links
    assert set(own.pairs) - set(more.pairs) == {("arm_3", "arm_5")}
    assert (more.margin, more.influence) == (0.02, 0.03)
    assert cell(koch + "[robot.self_collision]\nactive = false\n").scene.links is None


@needs_robot_data
def test_the_pairs_of_the_panda_are_those_of_its_srdf(cell):
    """Counted by hand in panda.srdf: what it leaves to check between links that are no neighbours."""
    found = cell('[robot]\nmodel = "panda"\n').scene.links.pairs
    assert ("panda_link0", "panda_hand") in found
    assert ("panda_link5", "panda_hand") not in found
    assert ("panda_link3", "panda_hand") not in found
    more = cell(
        '[robot]\nmodel = "panda"\n[robot.self_collision]\nmay_touch = [["panda_link0", "panda_hand"]]\n'
    )
    assert set(found) - set(more.scene.links.pairs) == {("panda_link0", "panda_hand")}


def test_robots_without_links_to_keep_off_have_none(cell, chain):
    assert (
        cell('[robot]\nmodel = "c.urdf"\n[robot.self_collision]\nactive = true\n', c=chain()).scene.links
        is None
    )


FAULTS = [
    ('may_touch = [["link1", "lnk3"]]', "IRL643", "may_touch[1]", "no link 'lnk3'; did you mean"),
    ("margin = 31", "IRL633", "margin", "a margin of 31 mm is above the influence of 30 mm"),
    ('srdf = "no.srdf"', "IRL644", "srdf", "no.srdf does not tell which links may touch: there is no "),
    ('srdf = "arm.urdf.txt"', "IRL644", "srdf", "there is no "),
    ('srdf = "cell.toml"', "IRL644", "srdf", "not well-formed XML"),
    ('srdf = "."', "IRL644", "srdf", "does not tell which links may touch"),
    ('may_touch = ["link1"]', "IRL603", "may_touch[1]", "expected the names of two links, found 'link1'"),
    ('may_touch = [["link1", "link2", "link3"]]', "IRL603", "may_touch[1]", "the names of two links"),
    ("margin = -1", "IRL603", "margin", "a number of at least 0"),
    ("active = 1", "IRL603", "active", "found 1"),
    ("may_tuch = []", "IRL602", "may_tuch", "did you mean 'may_touch'?"),
]


@pytest.mark.req("CELL-01")
@pytest.mark.parametrize(("written", "code", "key", "words"), FAULTS)
def test_faults(faults, arm, written, code, key, words):
    ((found, where, message),) = faults(f"{ARM}[robot.self_collision]\n{written}\n", arm=arm)
    assert (found, where) == (code, f"robot.self_collision.{key}")
    assert words in message


def test_a_named_robot_without_its_srdf_runs_with_a_warning(cell, monkeypatch, tmp_path):
    if robot_data_folder() is None:
        pytest.skip("the data package is missing")
    real = robot_data_folder()
    monkeypatch.setattr("irlx.cell.model.robot_data_folder", lambda: tmp_path)
    found = cell('[robot]\nmodel = "xarm7"\n')
    assert found.scene.links is None
    assert [d.code for d in found.warnings] == ["IRL645", "IRL621"]
    assert "xarm7.srdf" in found.warnings[0].message
    assert real != tmp_path
