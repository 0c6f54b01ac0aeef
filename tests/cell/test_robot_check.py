"""What `irlx.check_robot` finds: each finding by the page of its code, none on robots that are in order."""

import re
import struct
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.cell.external import external_names, external_section
from irlx.cell.robot_check.check import check_robot
from irlx.cell.robot_data import robot_data_folder
from irlx.diagnostics.codes.robot_model import ROBOT_MODEL

PAGES = Path(__file__).parents[2] / "docs" / "diagnostics"
ROBOTS = files("irlx.cell") / "robots"
SHOWN = [code.id for code in ROBOT_MODEL if "```xml" in (PAGES / f"{code.id}.md").read_text(encoding="utf-8")]
NOTES = {"IRL653"}
COMPANIONS = {"IRL665": {"IRL612", "IRL668", "IRL667"}}
"""What else the bad text of a page gives: a mimic joint is no axis."""
SOUND = """<inertial><mass value="2"/>
<inertia ixx="0.017" ixy="0" ixz="0" iyy="0.017" iyz="0" izz="0.0033"/></inertial>
<collision><geometry><box size="0.1 0.1 0.3"/></geometry></collision>"""
WRIST = "".join(
    f'<link name="l{k}">{SOUND}</link><joint name="j{k}" type="revolute"><parent link="l{k - 1}"/>'
    f'<child link="l{k}"/><origin xyz="0 0 0.2"/><axis xyz="{axis}"/>'
    '<limit lower="-2" upper="2" velocity="2" effort="9"/></joint>'
    for k, axis in enumerate(("0 0 1", "0 1 0", "1 0 0", "0 1 0", "0 0 1"), 1)
)
"""Five sound joints from l0 on, so that there are six in all."""


def box_mesh(size):
    """Binary STL of an axis-aligned cube of an edge, as bytes."""
    corners = size * np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    rows = [
        struct.pack("<12fH", 0, 0, 0, *(float(v) for corner in f for v in corners[corner]), 0) for f in faces
    ]
    return bytes(80) + struct.pack("<I", len(rows)) + b"".join(rows)


def whole(fragment):
    """A robot of six axes around the elements of a page."""
    elbow = ""
    if 'name="elbow"' not in fragment:
        elbow = """<joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
<origin xyz="0 0 0.3"/><axis xyz="0 1 0"/><limit lower="-2" upper="2" velocity="2" effort="9"/></joint>"""
    named = set(re.findall(r'(?:parent|child) link="(\w+)"', fragment + elbow)) | {"lower"}
    links = [f'<link name="{n}">{SOUND}</link>' for n in sorted(named) if f'<link name="{n}"' not in fragment]
    foot = '<joint name="foot" type="fixed"><parent link="l5"/><child link="upper"/></joint>'
    chain = f'<link name="l0"/>{WRIST}{foot}'
    return f'<robot name="r">{chain}{"".join(links)}{elbow}{fragment}</robot>'


@pytest.fixture
def found(tmp_path):
    """Findings on a text."""

    def look(text, tip=None):
        path = tmp_path / "r.urdf"
        path.write_text(text, encoding="utf-8")
        return check_robot(path, tip)

    return look


def shown(code, title):
    page = (PAGES / f"{code}.md").read_text(encoding="utf-8")
    return re.search(rf"^## {title}\n\n```xml\n(.*?)```", page, re.MULTILINE | re.DOTALL)[1]


@pytest.mark.req("LANG-70")
@pytest.mark.parametrize("code", SHOWN)
def test_bad_of_a_page_is_found_and_repaired_is_sound(found, tmp_path, code):
    (tmp_path / "part.stl").write_bytes(box_mesh(300.0))
    bad = found(whole(shown(code, "Bad")))
    assert {one.code for one in bad} - COMPANIONS.get(code, set()) == {code, *NOTES}
    (told,) = [one for one in bad if one.code == code]
    assert told.help
    if code != "IRL666":
        assert told.place.key in ("joint 'elbow'", "link 'lower'", "")
    assert {one.code for one in found(whole(shown(code, "Repaired")))} == NOTES


def test_every_code_is_shown_or_has_a_test_here():
    assert set(SHOWN) | {"IRL653", "IRL655", "IRL664", "IRL668", "IRL669"} == {
        code.id for code in ROBOT_MODEL
    }


def test_several_ends_are_told_with_their_axes(found):
    text = whole(shown("IRL666", "Bad"))
    (told,) = [one for one in found(text) if one.code == "IRL666"]
    assert told.data["ends"] == "camera (5 axes), lower (6 axes)"
    assert {one.code for one in found(text, "lower")} == NOTES
    assert {one.code for one in found(text, "camera")} == NOTES | {"IRL668"}


def test_an_end_that_mimics_is_no_fault(found):
    """Of a gripper whose second finger follows the first one; the fingers are ends before the tool."""
    fingers = "".join(
        f'<link name="f{k}"/><joint name="finger{k}" type="prismatic"><parent link="l4"/><child link="f{k}"/>'
        f'<axis xyz="0 1 0"/><limit lower="0" upper="0.04" velocity="0.1" effort="9"/>{mimic}</joint>'
        for k, mimic in ((2, '<mimic joint="finger1"/>'), (1, ""))
    )
    text = whole("").replace('<link name="l0"/>', f'{fingers}<link name="l0"/>')
    told = found(text)
    assert not [one for one in told if one.is_error]
    assert {"IRL665", "IRL666"} <= {one.code for one in told}


def elbow(kind="revolute", axis='<axis xyz="0 1 0"/>', limit="", origin="0 0 0.3"):
    limit = limit or '<limit lower="-2" upper="2" velocity="2" effort="9"/>'
    return (
        f'<joint name="elbow" type="{kind}"><parent link="upper"/><child link="lower"/>'
        f'<origin xyz="{origin}"/>{axis}{limit}</joint>'
    )


def lower(mass="2", inertia='ixx="0.017" iyy="0.017" izz="0.0033"', centre="0 0 0"):
    return (
        f'<link name="lower"><inertial><origin xyz="{centre}"/><mass value="{mass}"/><inertia {inertia}/>'
        '</inertial><collision><geometry><box size="0.1 0.1 0.3"/></geometry></collision></link>'
    )


SLOW = "velocity='0.5' effort='9'"


@pytest.mark.parametrize(
    ("fragment", "code", "told"),
    [
        (elbow(limit=f"<limit lower='-2' {SLOW}/>"), "IRL650", "its <limit> has no upper"),
        (elbow(limit=f"<limit {SLOW}/>"), "IRL650", "its <limit> has no lower and no upper"),
        (elbow("continuous"), "IRL650", "without end"),
        (elbow(limit="<limit lower='1' upper='1' velocity='1'/>"), "IRL651", "are both 1"),
        (elbow(limit="<limit lower='-1' upper='1' velocity='0'/>"), "IRL651", "speed limit (velocity) is 0"),
        (elbow(limit=f"<limit lower='-13' upper='13' {SLOW}/>"), "IRL658", "13 rad, 2.07 turns"),
        (
            elbow("prismatic", limit=f"<limit lower='0' upper='800' {SLOW}/>"),
            "IRL658",
            "800 m: are these milli",
        ),
        (elbow("prismatic", limit="<limit lower='0' upper='1' velocity='250'/>"), "IRL659", "250 m/s"),
        (elbow(axis=""), "IRL663", "none is given, and x counts"),
        (elbow(axis="<axis xyz='0 0.7 0.7'/>"), "IRL663", "its length is 0.989949"),
        (lower("-2"), "IRL654", "its mass is -2 kg"),
        (lower("0"), "IRL654", "its mass is 0 kg"),
        (lower(centre="0 0 120"), "IRL660", "the centre of mass of 'lower' lies 120 m"),
        (lower(inertia='ixx="0" iyy="0" izz="0"'), "IRL656", "as a point"),
        (lower(inertia='ixx="-0.1" iyy="0.1" izz="0.1"'), "IRL656", "none may be negative"),
        (lower(inertia='ixx="0.1" iyy="0.1" izz="0.1" ixy="0.3"'), "IRL656", "none may be negative"),
        (lower(inertia='ixx="1e-8" iyy="1e-8" izz="1e-8"'), "IRL657", "too small for 2 kg"),
        (lower(inertia='ixx="17" iyy="17" izz="17"'), "IRL657", "too large for 2 kg"),
    ],
)
def test_what_is_told_of_a_joint_or_a_link(found, fragment, code, told):
    alike = [one for one in found(whole(fragment)) if one.code == code]
    assert any(told in one.message for one in alike), [one.message for one in alike]
    assert {one.place.key for one in alike} <= {"joint 'elbow'", "link 'lower'"}


@pytest.mark.parametrize(
    "fragment",
    [
        elbow(limit="<limit lower='-12.5' upper='12.5' velocity='49'/>"),
        elbow("prismatic", limit="<limit lower='-40' upper='40' velocity='15'/>"),
        elbow(axis="<axis xyz='0 0.70711 0.70711'/>"),
        elbow(origin="0 0 5"),
        lower(inertia='ixx="0.0002" iyy="0.0002" izz="0.0002"'),
    ],
)
def test_what_is_unusual_but_in_order(found, fragment):
    assert {one.code for one in found(whole(fragment))} == NOTES


def test_a_chain_of_no_size(found):
    text = re.sub(r'xyz="0 0 0\.[23]"', 'xyz="0 0 0.0002"', whole(elbow()))
    (told,) = [one for one in found(text) if one.code == "IRL660"]
    assert "the whole chain of joints is 1.2 mm long" in told.message


def test_macros_are_told(found):
    text = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="arm.xacro"/></robot>'
    assert "it has macros of xacro" in found(text)[0].message


@pytest.mark.parametrize(
    ("broken", "told"),
    [
        ("", "not well-formed XML"),
        ("<robot", "not well-formed XML"),
        ("<sdf/>", "outermost element"),
        ("<robot/>", "it has no <link>"),
        ('<robot name="r"><link name="a"/><link name="a"/></robot>', "two links are called 'a'"),
        ('<robot name="r"><link name="a"/><joint name="j" type="revolute"/></robot>', "no <parent"),
        (
            '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute">'
            '<parent link="a"/><child link="b"/><axis xyz="0 0 0"/></joint></robot>',
            "has no direction",
        ),
        (
            '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute">'
            '<parent link="a"/><child link="b"/></joint><joint name="k" type="revolute">'
            '<parent link="b"/><child link="a"/></joint></robot>',
            "ring",
        ),
        (
            '<robot name="r"><link name="a"><inertial><mass value="much"/></inertial></link></robot>',
            "which is no number",
        ),
    ],
)
def test_what_cannot_be_used_comes_first(found, broken, told):
    first = found(broken)[0]
    assert (first.code, first.is_error) == ("IRL612", True)
    assert told in first.message


def test_broken_in_one_place_odd_in_another(found):
    text = whole(shown("IRL659", "Bad")).replace('<box size="0.1 0.1 0.3"/>', '<box size="0.1 x 0.3"/>', 1)
    assert [one.code for one in found(text)] == ["IRL612", "IRL659", "IRL653"]


def test_texts_with_holes_are_told_never_raised(found):
    """Elements and attributes taken away one after the other."""
    text = whole(shown("IRL661", "Repaired"))
    pieces = re.findall(r'<[^>]*/>|\w+="[^"]*"', text)
    assert len(pieces) > 70
    for number, piece in enumerate(pieces[-70:]):
        holed = text.replace(piece, "" if number % 2 else piece.replace('"', '"x', 1), 1)
        assert all(one.message and one.place.file for one in found(holed))


def test_an_unknown_tip_is_told_with_names_like_it(found):
    (told,) = [one for one in found(whole(""), "lowr") if one.is_error]
    assert told.code == "IRL612"
    assert "did you mean 'lower'?" in told.message


def test_a_foot_beside_the_root_frame(found):
    raised = whole("").replace(
        '<link name="l0"/>',
        '<link name="l0"/><link name="world"/><joint name="stand" type="fixed">'
        '<parent link="world"/><child link="l0"/><origin xyz="0 0.1 0.62"/></joint>',
    )
    (told,) = [one for one in found(raised) if one.code == "IRL655"]
    assert "stand leads to (0, 100, 620) mm" in told.message
    assert told.severity.value == "info"


@pytest.mark.parametrize("moments", [(1, 1, 2.0005), (0.1, 0.2, 0.3), (1e-9, 1e-9, 1e-9), (1, 1, 1)])
def test_moments_of_real_bodies_are_none_that_no_body_has(found, moments):
    """Discs, rods and balls, seen from any side: rotated moments stay those of a body."""
    random = np.random.default_rng(3)
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    matrix = turn @ np.diag(moments) @ turn.T
    names = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    written = " ".join(f'{name}="{float(matrix[at])!r}"' for name, at in names.items())
    link = (
        f'<link name="lower"><inertial><mass value="2"/><inertia {written}/></inertial>{SOUND[-70:]}</link>'
    )
    assert "IRL656" not in {one.code for one in found(whole(link))}
    shrunk = link.replace(f'izz="{float(matrix[2, 2])!r}"', f'izz="{-abs(float(matrix[2, 2]))!r}"')
    assert "IRL656" in {one.code for one in found(whole(shrunk))}


@pytest.mark.parametrize("name", sorted(one.name for one in ROBOTS.iterdir() if one.name.endswith(".urdf")))
def test_packaged_robots_are_in_order(name):
    told = check_robot(str(ROBOTS / name))
    assert not [one for one in told if one.is_error]
    # koch11 has speeds that stand for none; first slides of platforms carry no shape; planar arms; two hands.
    expected = {"IRL653", "IRL655", "IRL659", "IRL665", "IRL666", "IRL667", "IRL668"}
    assert {one.code for one in told} <= expected


@pytest.mark.skipif(robot_data_folder() is None, reason='pip install "irlx[robots]"')
@pytest.mark.parametrize("name", ["panda", "ur5", "baxter_left", "ur10"])
def test_known_faults_of_published_models(name):
    """Moments of link 1 of the Panda and of the wrists of the UR5 are larger than their bodies can have."""
    section = external_section(name)
    told = check_robot(robot_data_folder() / section.model, section.tip)
    assert not [one for one in told if one.is_error]
    odd = {one.place.key for one in told if one.code == "IRL657"}
    expected = {
        "panda": {"link 'panda_link1'"},
        "ur5": {"link 'wrist_1_link'", "link 'wrist_2_link'", "link 'wrist_3_link'"},
        "ur10": set(),
    }
    assert odd == expected.get(name, odd)
    assert external_names()


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(irlx.CellError) as caught:
        irlx.check_robot(tmp_path / "none.urdf")
    assert [one.code for one in caught.value.diagnostics] == ["IRL001"]
    with pytest.raises(irlx.CellError) as caught:
        irlx.check_robot(tmp_path)
    assert [one.code for one in caught.value.diagnostics] == ["IRL007"]
