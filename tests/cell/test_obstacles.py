"""Obstacles of a cell: what the file gives, in m and in the world, and all that can be wrong with it."""

import sys
from math import cos, pi, radians, sin, sqrt
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.cell.errors import CellError
from irlx.cell.obstacle_names import obstacle_names
from irlx.cell.obstacle_shape import SIZES as SIZES_OF_SHAPES
from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Mesh, Point, Sphere
from mesh_files import CUBE, TRIANGLES, obj, stl

pytestmark = pytest.mark.req("CELL-01")


def obstacle(name="a", shape='shape = "point"', more=""):
    return f'[[obstacle]]\nname = "{name}"\n{shape}\n{more}\n'


SHAPES = {
    'shape = "point"': Point(),
    'shape = "sphere"\nradius = 30': Sphere(0.03),
    'shape = "box"\nsize = [1000, 20, 2000.5]': Box((1.0, 0.02, 2.0005)),
    'shape = "cylinder"\nradius = 1\nlength = 2': Cylinder(0.001, 0.002),
    'shape = "capsule"\nradius = 1\nlength = 2': Capsule(0.001, 0.002),
    'shape = "cone"\nlength = 200\nradius = 10': Cone(0.01, 0.2),
    'shape = "halfspace"': Halfspace(),
}


@pytest.mark.parametrize("written", SHAPES)
def test_shapes(cell, koch, written):
    scene = cell(koch + obstacle("ściana_1", written, "xyz = [900, 0, -500]")).scene
    found = scene.obstacles["ściana_1"]
    (solid,) = found.solids
    expected = SHAPES[written]
    assert type(solid.shape) is type(expected)
    for key, value in vars(expected).items():
        assert getattr(solid.shape, key) == pytest.approx(value)
    assert solid.placement == Placement()
    assert found.placement.position == pytest.approx((0.9, 0.0, -0.5))
    assert (found.margin, found.influence, found.trajectory) == (0.01, 0.2, ())


def test_margins_and_names(cell, koch):
    text = obstacle("Wand", more="margin = 0\ninfluence = 0") + obstacle("s\u0301", more="margin = 20")
    scene = cell(koch + text).scene
    assert scene.names == ("Wand", "ś")
    assert (scene.obstacles["wand"].margin, scene.obstacles["wand"].influence) == (0.0, 0.0)
    assert scene.obstacles["ś"].margin == pytest.approx(0.02)


def test_a_cell_without_obstacles_has_none(cell, koch):
    scene = cell(koch).scene
    assert (scene.obstacles, scene.groups, scene.names) == ({}, {}, ())


def test_groups(cell, koch):
    text = (
        obstacle("Left")
        + obstacle("right")
        + obstacle("Both", 'shape = "group"\nmembers = ["left", "RIGHT"]')
    )
    scene = cell(koch + text).scene
    assert scene.groups == {"both": ("left", "right")}
    assert [member.name for member in scene.members("BOTH")] == ["Left", "right"]
    assert [member.name for member in scene.members("left")] == ["Left"]


@pytest.mark.parametrize("seed", range(5))
def test_places_in_frames_and_their_turns(cell, koch, seed):
    """The truth is scipy's: turns about the fixed axes x, y, z, in this order."""
    random = np.random.default_rng(seed)
    frame, own = random.uniform(-500.0, 500.0, (2, 3)), random.uniform(-180.0, 180.0, (2, 3))
    own[seed % 2, seed % 3] = 0.0
    text = f"[frames]\nTable = {{ xyz = {frame[0].tolist()}, rpy = {own[0].tolist()} }}\n"
    text += obstacle(more=f'frame = "table"\nxyz = {frame[1].tolist()}\nrpy = {own[1].tolist()}')
    found = cell(koch + text).scene.obstacles["a"].placement
    outer, inner = (Rotation.from_euler("xyz", turns, degrees=True) for turns in own)
    assert found.position == pytest.approx((frame[0] + outer.apply(frame[1])) * 1e-3, abs=1e-12)
    turned = Rotation.from_quat(found.orientation).inv() * outer * inner
    assert turned.magnitude() < 1e-12, seed


def test_the_frame_world_is_that_of_the_robot(cell, koch):
    plain = cell(koch + obstacle(more="xyz = [1, 2, 3]")).scene
    assert cell(koch + obstacle(more='xyz = [1, 2, 3]\nframe = "world"')).scene == plain
    own = "[frames]\nworld = { xyz = [1000, 0, 0] }\n"
    moved = cell(koch + own + obstacle(more='xyz = [1, 2, 3]\nframe = "world"')).scene
    assert moved.obstacles["a"].placement.position == pytest.approx((1.001, 0.002, 0.003))


def test_obstacles_that_move(cell, koch):
    text = """[frames]
belt = { xyz = [0, 1000, 0], rpy = [0, 0, 90] }
[[obstacle]]
name = "part"
shape = "box"
size = [100, 100, 100]
frame = "belt"
trajectory = [
  { time = 0, xyz = [0, 0, 0] },
  { time = 2.5, xyz = [200, 0, 0], rpy = [0, 0, 90] },
]
"""
    found = cell(koch + text).scene.obstacles["part"]
    assert [waypoint.time for waypoint in found.trajectory] == [0.0, 2.5]
    first, last = (waypoint.placement for waypoint in found.trajectory)
    assert found.placement == first
    assert first.position == pytest.approx((0.0, 1.0, 0.0))
    assert first.orientation == pytest.approx((0.0, 0.0, sin(pi / 4), cos(pi / 4)))
    assert last.position == pytest.approx((0.0, 1.2, 0.0))
    assert last.orientation == pytest.approx((0.0, 0.0, 1.0, 0.0), abs=1e-15)


@pytest.mark.req("CELL-06")
def test_meshes(cell, koch, tmp_path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "Jig.STL").write_bytes(stl(CUBE * 500.0, TRIANGLES))
    (tmp_path / "b.obj").write_bytes(obj(CUBE, TRIANGLES))
    text = obstacle("jig", 'shape = "mesh"\nfile = "parts/Jig.STL"\nscale = 0.001')
    text += obstacle("b", 'shape = "mesh"\nfile = "b.obj"\nscale = [1, -2, 0.5]')
    text += obstacle("c", f'shape = "mesh"\nfile = "{tmp_path / "b.obj"}"')
    found = cell(koch + text)
    shapes = [one.solids[0].shape for one in found.scene.obstacles.values()]
    assert shapes == [
        Mesh(str(tmp_path / "parts" / "Jig.STL"), (0.001, 0.001, 0.001)),
        Mesh(str(tmp_path / "b.obj"), (1.0, -2.0, 0.5)),
        Mesh(str(tmp_path / "b.obj")),
    ]
    assert [d.code for d in found.warnings] == ["IRL621"]


@pytest.mark.parametrize(("scale", "words"), [(0.0005, "is 0.5 mm large"), (101, "is 1.01e+05 mm large")])
def test_a_mesh_of_an_unlikely_size_is_told(cell, koch, tmp_path, scale, words):
    (tmp_path / "b.obj").write_bytes(obj(CUBE, TRIANGLES))
    found = cell(koch + obstacle("b", f'shape = "mesh"\nfile = "b.obj"\nscale = {scale}')).warnings[0]
    assert (found.code, found.place.key) == ("IRL642", "obstacle[1].file")
    assert words in found.message


SIZES = "a number greater than 0"
FAULTS = [
    ('shape = "bx"\nsize = [1, 1, 1]', "IRL630", ".shape", "no shape 'bx'; did you mean 'box'"),
    ('shape = "tetrahedron"', "IRL630", ".shape", "no shape 'tetrahedron'"),
    ('shape = "box"', "IRL631", "", "a box needs size"),
    ('shape = "cone"', "IRL631", "", "a cone needs radius and length"),
    ('shape = "capsule"\nradius = 3', "IRL631", "", "a capsule needs length"),
    ('shape = "mesh"', "IRL631", "", "a mesh needs file"),
    ('shape = "group"\nmembers = []', "IRL631", "", "a group needs members"),
    ('shape = "point"\nradius = 3', "IRL632", ".radius", "a point has no radius"),
    ('shape = "box"\nsize = [1, 1, 1]\nscale = 2', "IRL632", ".scale", "a box has no scale"),
    (
        'shape = "point"\nxyz = [0, 0, 0]\ntrajectory = [{ time = 0, xyz = [0, 0, 0] }]',
        "IRL632",
        ".xyz",
        "an obstacle with trajectory has no xyz",
    ),
    (
        'shape = "point"\nmargin = 201',
        "IRL633",
        ".margin",
        "201 mm is above the influence of 200 mm",
    ),
    (
        'shape = "point"\nframe = "tabel"',
        "IRL636",
        ".frame",
        "no frame 'tabel'; did you mean 'Table'",
    ),
    (
        'shape = "group"\nmembers = ["fenc"]',
        "IRL637",
        ".members[1]",
        "'fenc' is no obstacle of the cell",
    ),
    ('shape = "group"\nmembers = ["a"]', "IRL637", ".members[1]", "'a' is a group itself"),
    (
        'shape = "group"\nmembers = ["fence", "FENCE"]',
        "IRL637",
        ".members[2]",
        "'FENCE' is named twice",
    ),
    (
        'shape = "point"\ntrajectory = [{ time = 1, xyz = [0, 0, 0] }, { time = 1, xyz = [0, 0, 0] }]',
        "IRL638",
        ".trajectory[2].time",
        "1 s does not come after 1 s",
    ),
    ('shape = "mesh"\nfile = "wal.obj"', "IRL639", ".file", "wal.obj; did you mean 'wall.obj'?"),
    ('shape = "mesh"\nfile = "."', "IRL639", ".file", "no mesh file '.'"),
    ('shape = "mesh"\nfile = "open.obj"', "IRL640", ".file", "is not closed: 3 edges"),
    ('shape = "mesh"\nfile = "empty.stl"', "IRL640", ".file", "cannot be used: it is empty"),
    ('shape = "mesh"\nfile = "cell.toml"', "IRL640", ".file", "'.toml' is no format"),
    ('shape = "sphere"\nradius = 0', "IRL603", ".radius", f"expected {SIZES}, found 0"),
    ('shape = "box"\nsize = [1, -1, 1]', "IRL603", ".size[2]", f"expected {SIZES}, found -1"),
    ('shape = "box"\nsize = [1, 1]', "IRL603", ".size", "expected three numbers, found [1, 1]"),
    ('shape = "point"\nmargin = -1', "IRL603", ".margin", "expected a number of at least 0"),
    ('shape = "mesh"\nscale = 0', "IRL603", ".scale", "a number other than 0, or three of them"),
    ('shape = "mesh"\nscale = [1, 2]', "IRL603", ".scale", "a number other than 0"),
    ('shape = "mesh"\nscale = true', "IRL603", ".scale", "a number other than 0"),
    (f'shape = "mesh"\nscale = 1{"0" * 400}', "IRL603", ".scale", "a number other than 0"),
    ('shape = "point"\ntrajectory = []', "IRL603", ".trajectory", "at least one table with time"),
    (
        'shape = "point"\ntrajectory = [{ time = -1, xyz = [0, 0, 0] }]',
        "IRL603",
        ".trajectory[1].time",
        "0",
    ),
    ("", "IRL603", "", "expected a table with shape, found a table"),
    ('shape = "point"\nheight = 3', "IRL602", ".height", "no such key"),
    (
        'shape = "point"\ntrajectory = [{ tme = 0, time = 0, xyz = [0, 0, 0] }]',
        "IRL602",
        ".trajectory[1].tme",
        "'time'",
    ),
]


@pytest.mark.parametrize(("written", "code", "key", "words"), FAULTS)
def test_faults(faults, koch, tmp_path, written, code, key, words):
    (tmp_path / "wall.obj").write_bytes(obj(CUBE, TRIANGLES))
    (tmp_path / "open.obj").write_bytes(obj(CUBE, TRIANGLES[1:]))
    (tmp_path / "empty.stl").write_bytes(b"")
    frames = "[frames]\nTable = { xyz = [0, 0, 0] }\n"
    ((found, where, message),) = faults(koch + frames + obstacle("a", written) + obstacle("fence"))
    assert (found, where) == (code, f"obstacle[1]{key}")
    assert words in message


@pytest.mark.parametrize("name", ["", "1a", "a b", "a-b", "_a", "while", "OBSTACLE", "a.b", "ä\n"])
def test_names_that_no_program_can_write(faults, koch, name):
    ((code, key, _),) = faults(koch + obstacle(name.replace("\n", "\\n")))
    assert (code, key) == ("IRL635", "obstacle[1].name")


@pytest.mark.parametrize("name", ["a", "ściana_1", "Ä9", "to", "壁", "R_TOOL"])
def test_names_that_a_program_can_write(cell, koch, name):
    assert cell(koch + obstacle(name)).scene.names == (name,)


@pytest.mark.parametrize(
    ("one", "other"), [("wall", "Wall"), ("a", "a"), ("\u015b", "s\u0301"), ("straße", "STRASSE")]
)
def test_names_that_differ_only_in_case(faults, koch, one, other):
    ((code, key, _),) = faults(koch + obstacle(one) + obstacle(other))
    assert (code, key) == ("IRL634", "obstacle[2].name")
    group = obstacle(other, f'shape = "group"\nmembers = ["{one}"]')
    assert faults(koch + obstacle(one) + group)[0][:2] == ("IRL634", "obstacle[2].name")


def test_all_faults_at_once(faults, koch):
    text = obstacle("1", 'shape = "box"') + obstacle("b", more='frame = "x"\nmargin = 300') + obstacle("B")
    keys = {"obstacle[1].name", "obstacle[1]", "obstacle[2].frame", "obstacle[2].margin", "obstacle[3].name"}
    assert {key for _, key, _ in faults(koch.replace("koch11", "koch11") + text)} == keys


def test_without_the_reader_of_meshes(faults, koch, tmp_path, monkeypatch):
    (tmp_path / "alone.obj").write_bytes(obj(CUBE, TRIANGLES))
    monkeypatch.setitem(sys.modules, "trimesh", None)
    ((code, key, message),) = faults(koch + obstacle("b", 'shape = "mesh"\nfile = "alone.obj"'))
    assert (code, key) == ("IRL641", "obstacle[1].file")
    assert message.endswith('the package trimesh is not installed: pip install "irlx[meshes]"')


def test_faults_of_the_robot_are_told_with_those_of_obstacles(cell, koch):
    with pytest.raises(CellError) as caught:
        cell(koch + "start = [1]\n" + obstacle("1"))
    assert {d.code for d in caught.value.diagnostics} == {"IRL604", "IRL635"}


def test_a_turn_by_hand():
    outer = Placement.from_rpy((1.0, 0.0, 0.0), (0.0, 0.0, radians(45.0)))
    found = outer.of(Placement((sqrt(2.0), 0.0, 3.0)))
    assert found.position == pytest.approx((2.0, 1.0, 3.0))
    assert found.orientation == outer.orientation


def test_the_example_of_the_reference(cell, koch, tmp_path):
    page = (Path(__file__).parents[2] / "docs" / "reference" / "cell.md").read_text(encoding="utf-8")
    example = page.split("## `[[obstacle]]`")[1].split("```toml\n")[1].split("```")[0]
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "jig.stl").write_bytes(stl(CUBE * 300.0, TRIANGLES))
    found = cell(koch + example)
    assert found.scene.names == ("ściana_1", "jig", "tray", "fixture")
    assert [d.code for d in found.warnings] == ["IRL621"]
    assert obstacle_names(Path(found.file)) == ("ściana_1", "jig", "tray", "fixture")


def test_every_shape_is_in_the_reference():
    page = (Path(__file__).parents[2] / "docs" / "reference" / "cell.md").read_text(encoding="utf-8")
    table = page.split("| `shape` |")[1].split("\n\n")[0]
    for shape, needed in SIZES_OF_SHAPES.items():
        (row,) = [line for line in table.splitlines() if line.startswith(f"| `{shape}` |")]
        assert all(f"`{key}" in row for key in needed)
