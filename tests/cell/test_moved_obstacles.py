"""Obstacles that are moved: the cell that comes of it, and the text that a cell file takes for it."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.cell.load import load_cell, own_cell
from irlx.cell.moved_obstacles import MovableObstacles
from irlx.solids.placement import Placement

ROBOT = '[robot]\nmodel = "arm7"\n[frames]\nbench = { xyz = [400, -300, 120], rpy = [10, 20, 90] }\n'
OBSTACLES = """\
[[obstacle]]
name = "ściana_1"
shape = "box"
size = [1000, 20.5, 2000]
frame = "bench"
xyz = [900, 0, 500]
rpy = [0, 30, 0]
margin = 20

[[obstacle]]
name = "ball"
shape = "sphere"
radius = 30

[[obstacle]]
name = "cart"
shape = "capsule"
radius = 50
length = 200
trajectory = [{ time = 0, xyz = [2000, 0, 0] }, { time = 2.5, xyz = [2000, 500, 0], rpy = [0, 0, 45] }]

[[obstacle]]
name = "all"
shape = "group"
members = ["ściana_1", "ball"]
"""


@pytest.fixture
def cell(tmp_path):
    path = tmp_path / "c.toml"
    path.write_text(ROBOT + OBSTACLES, encoding="utf-8")
    return load_cell(path)


def turned(*degrees):
    return tuple(Rotation.from_euler("xyz", degrees, degrees=True).as_quat().tolist())


def test_what_stands_still_can_be_moved(cell):
    assert MovableObstacles(cell).names == ("ściana_1", "ball")


def test_an_obstacle_is_where_it_was_put_to_a_tenth_of_a_millimetre(cell):
    wanted = Placement((0.7123456, -0.1, 0.35), turned(5, -8, 33))
    moved = MovableObstacles(cell).moved({"ściana_1": wanted}).scene.obstacles
    found = moved["ściana_1"].placement
    assert np.allclose(found.position, wanted.position, atol=1e-4)
    turn = Rotation.from_quat(found.orientation) * Rotation.from_quat(wanted.orientation).inv()
    assert turn.magnitude() < np.radians(0.02)
    assert moved["ball"] == cell.scene.obstacles["ball"]
    assert moved["cart"] == cell.scene.obstacles["cart"]


@pytest.mark.parametrize(
    "poses",
    [
        {},
        {"ball": Placement((0.123456, 0.2, -0.3), turned(0, 0, 0))},
        {"ściana_1": Placement((1.0, 0.0, 0.5), turned(1, 2, 3)), "ball": Placement((0.0, 0.0, 2.0))},
        {"ball": Placement((0.5, 0.5, 0.5), turned(0, 90, 0))},
    ],
)
def test_the_text_makes_the_very_cell_that_runs(cell, tmp_path, poses):
    movable = MovableObstacles(cell)
    again = tmp_path / "again.toml"
    again.write_text(ROBOT + movable.text(poses), encoding="utf-8")
    assert load_cell(again).scene == movable.moved(poses).scene


def test_what_is_not_moved_stays_as_the_file_has_it(cell):
    assert MovableObstacles(cell).text({}) == OBSTACLES
    text = MovableObstacles(cell).text({"ball": Placement((0.1, 0.0, -0.02))})
    assert text == OBSTACLES.replace("radius = 30\n", "radius = 30\nxyz = [100, 0, -20]\nrpy = [0, 0, 0]\n")


@pytest.mark.parametrize("name", ["cart", "all", "nobody"])
def test_what_cannot_be_moved(cell, name):
    with pytest.raises(KeyError, match=name):
        MovableObstacles(cell).moved({name: Placement()})


def test_a_cell_that_is_no_file_has_nothing_to_move():
    movable = MovableObstacles(own_cell("arm7"))
    assert movable.names == ()
    assert movable.text({}) == ""
