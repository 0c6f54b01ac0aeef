"""Names of joints read from a cell without loading it are those of the cell that is loaded."""

from pathlib import Path

import pytest

from irlx.cell.errors import CellError
from irlx.cell.joint_names import joint_names
from irlx.cell.known import known_of, known_of_file
from irlx.cell.load import load_cell
from irlx.cell.named import robot_names

PROGRAMS = Path(__file__).parents[2] / "programs"
URDF = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="one" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
<joint name="two" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
<joint name="three" type="fixed"><parent link="c"/><child link="d"/></joint></robot>"""

pytestmark = pytest.mark.req("LANG-10")


@pytest.mark.parametrize("path", sorted(PROGRAMS.rglob("*.toml")), ids=lambda path: path.name)
def test_shipped_cells(path):
    cell = load_cell(path)
    assert joint_names(path) == cell.robot.joint_names
    # Else a program that was loaded would be looked at twice.
    assert known_of_file(path).tells_the_same(known_of(cell))


@pytest.mark.parametrize("name", robot_names())
def test_named_robots(name, tmp_path):
    path = tmp_path / "c.toml"
    path.write_text(f'[robot]\nmodel = "{name}"\n', encoding="utf-8")
    try:
        expected = load_cell(path).robot.joint_names
    except CellError as error:
        if error.reason.code != "IRL614":
            raise
        expected = ()
    assert joint_names(path) == expected


CELLS = {
    'model = "koch11"\n[robot.locked]\njoint_3 = 10\njoint_10 = 0': 9,
    'model = "koch11"\ntip = "nothing"': 0,
    'model = "r.urdf"': 2,
    'model = "r.urdf"\ntip = "b"': 1,
    'model = "./r.urdf"\n[robot.locked]\ntwo = 5': 1,
    'model = "r.urdf"\n[robot.locked]\nfour = 5': 0,
    'model = "q.urdf"': 0,
    'model = "nobody"': 0,
    "model = 5": 0,
    'tip = "a"': 0,
    'model = "r.urdf"\nlocked = 7': 0,
    'model = "r.urdf"\ntip = [7]': 0,
    'model = "r.urdf': 0,
}


@pytest.mark.parametrize("robot", CELLS)
def test_locked_joints_tips_and_faults(robot, tmp_path):
    """Without a fault the number is that of the cell; with one there is none, and nothing is raised."""
    (tmp_path / "r.urdf").write_text(URDF, encoding="utf-8")
    path = tmp_path / "c.toml"
    path.write_text(f"[robot]\n{robot}\n", encoding="utf-8")
    found = joint_names(path)
    assert len(found) == CELLS[robot]
    if "koch11" in robot and found:
        assert found == load_cell(path).robot.joint_names


@pytest.mark.parametrize(
    "content", [b"\xff", b"robot = 3", b"", b"[frames]\n", "\ufeff[robot]\nmodel='arm7'".encode()]
)
def test_files_that_are_no_cell(content, tmp_path):
    path = tmp_path / "c.toml"
    path.write_bytes(content)
    assert len(joint_names(path)) == (7 if b"arm7" in content else 0)
    assert joint_names(tmp_path / "none.toml") == ()
    assert joint_names(tmp_path) == ()
