"""Mesh files of links: where they are found, and what is said where they are not."""

import pytest

import irlx
from irlx.cell.errors import CellError
from irlx.cell.link_meshes import resolved_solids
from irlx.cell.robot_data import robot_data_folder
from irlx.solids import mesh_file
from irlx.solids.hull import hull_of
from irlx.solids.mesh_file import read_mesh
from irlx.solids.shape import Mesh
from mesh_files import CUBE, TRIANGLES, dae, obj

pytestmark = pytest.mark.req("CELL-06")
needs_robot_data = pytest.mark.skipif(robot_data_folder() is None, reason="the data package is missing")


@pytest.fixture
def load(cell, chain, tmp_path):
    """A cell whose robot's URDF, in ws/my_arm/urdf, has a mesh of a given name on link 1 and on link 3."""

    def run(name, more=""):
        mesh = f'<collision><geometry><mesh filename="{name}" scale="1 2 1"/></geometry></collision>'
        text = chain()
        for link in ("link1", "link3"):
            text = text.replace(f'<link name="{link}"/>', f'<link name="{link}">{mesh}</link>')
        folder = tmp_path / "ws" / "my_arm" / "urdf"
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "arm.urdf").write_text(text, encoding="utf-8")
        return cell(f'[robot]\nmodel = "ws/my_arm/urdf/arm.urdf"\n{more}')

    return run


def mesh_at(tmp_path, place, content=None):
    path = tmp_path / place
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(obj(CUBE, TRIANGLES) if content is None else content)
    return str(path)


PLACES = {
    "part.obj": "ws/my_arm/urdf/part.obj",
    "../meshes/part.obj": "ws/my_arm/urdf/../meshes/part.obj",
    "package://my_arm/meshes/part.obj": "ws/my_arm/meshes/part.obj",
    "package:///my_arm/meshes/part.obj": "ws/my_arm/meshes/part.obj",
    "package://parts/part.obj": "ws/parts/part.obj",
    "package://arm_of_another_name/meshes/part.obj": "ws/my_arm/meshes/part.obj",
    "package://beside/part.obj": "ws/my_arm/urdf/beside/part.obj",
}


@pytest.mark.parametrize("name", PLACES)
def test_places_of_mesh_files(load, tmp_path, name):
    expected = mesh_at(tmp_path, PLACES[name])
    found = load(name)
    assert found.robot.solids["link1"][0].shape == Mesh(expected, (1.0, 2.0, 1.0))
    assert resolved_solids(found.robot, found.model, found.file) is found.robot.solids


def test_a_uri_of_a_file(load, tmp_path):
    expected = mesh_at(tmp_path, "with space/part.obj")
    found = load(f"file://{tmp_path}/with%20space/part.obj")
    assert found.robot.solids["link1"][0].shape.file == expected


def test_a_workspace_of_ros(load, tmp_path, monkeypatch):
    expected = mesh_at(tmp_path, "ros/share/parts_description/part.obj")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"/no:{tmp_path / 'ros'}")
    assert load("package://parts_description/part.obj").robot.solids["link1"][0].shape.file == expected


def faults_of(found):
    with pytest.raises(CellError) as caught:
        resolved_solids(found.robot, found.model, found.file)
    return [(d.code, d.place.key, d.message) for d in caught.value.diagnostics]


def test_a_missing_file_is_told_once_and_only_where_it_is_needed(load, tmp_path):
    mesh_at(tmp_path, "ws/my_arm/urdf/my_arm/meshes/prat.obj")
    found = load("package://my_arm/meshes/part.obj")
    assert found.robot.solids["link1"][0].shape.file == "package://my_arm/meshes/part.obj"
    assert [d.code for d in found.warnings] == ["IRL621"]
    folder = tmp_path / "ws" / "my_arm" / "urdf"
    tried = (
        f"looked for {folder}/my_arm/meshes/part.obj, and from the folders above; did you mean 'prat.obj'?"
    )
    message = f"link 'link1': no mesh file 'package://my_arm/meshes/part.obj'; {tried}"
    assert faults_of(found) == [("IRL639", "robot.model", message)]


def test_a_missing_file_is_an_error_where_links_are_to_be_kept_off_each_other(load):
    with pytest.raises(CellError, match=r"IRL639: link 'link1': no mesh file 'no\.stl'"):
        load("no.stl", "[robot.self_collision]\nactive = true\n")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"v 0 0 0\n", "it holds no triangles"),
        (obj(CUBE * [1, 1, 0], TRIANGLES), "its vertices lie in one plane, so it has no convex hull"),
    ],
)
def test_a_mesh_that_cannot_be_used(load, tmp_path, content, words):
    path = mesh_at(tmp_path, "ws/my_arm/urdf/bad.obj", content)
    found = faults_of(load("bad.obj"))
    assert found == [
        ("IRL640", "robot.model", f"link '{link}': the mesh {path} cannot be used: {words}")
        for link in ("link1", "link3")
    ]


def test_an_open_surface_of_a_link_has_a_hull(load, tmp_path):
    mesh_at(tmp_path, "ws/my_arm/urdf/open.obj", obj(CUBE, TRIANGLES[3:]))
    found = load("open.obj")
    (solid,) = resolved_solids(found.robot, found.model, found.file)["link1"]
    assert hull_of(read_mesh(solid.shape)).volume == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("module", "package", "ending"), [("trimesh",) * 2 + ("obj",), ("collada", "pycollada", "dae")]
)
def test_without_the_readers(load, tmp_path, monkeypatch, module, package, ending):
    mesh_at(tmp_path, f"ws/my_arm/urdf/part.{ending}", dae(CUBE, TRIANGLES))
    found = load(f"part.{ending}")
    monkeypatch.setattr(mesh_file, "_is_installed", lambda name: name != module)
    ((code, _, message),) = faults_of(found)
    assert code == "IRL641"
    assert message.endswith(f'the package {package} is not installed: pip install "irlx[meshes]"')


BALL = '[[obstacle]]\nname = "ball"\nshape = "sphere"\nradius = 50\nxyz = [0, 0, 30000]\n'


@pytest.mark.parametrize("body", ["OBSTACLE ball; OBSTACLEEND ball;", "x := CLEARANCE(R_JOINT_ACT, ball);"])
@pytest.mark.parametrize(
    ("content", "code"), [(None, "IRL639"), (b"v 0 0 0\n", "IRL640"), (dae(CUBE, TRIANGLES), "IRL641")]
)
def test_a_run_that_needs_a_mesh_tells_what_is_wrong_with_it(
    load, tmp_path, monkeypatch, content, code, body
):
    """The cell loads without: only obstacles that are asked for need the shapes of links."""
    if content is not None:
        mesh_at(tmp_path, "ws/my_arm/urdf/bad.obj", content)
    found = load("bad.obj", BALL)
    if code == "IRL641":
        monkeypatch.setattr(mesh_file, "_is_installed", lambda name: False)
    program = tmp_path / "p.irl"
    program.write_text("PROGRAM p;\nVAR REAL: x;\nBEGIN\nx := 1;\nENDPROGRAM\n")
    assert irlx.run(program, found).summary.complete
    program.write_text(f"PROGRAM p;\nVAR REAL: x;\nBEGIN\n{body}\nENDPROGRAM\n")
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(program, found)
    assert caught.value.diagnostics[0].code == code
    assert code in [told.code for told in irlx.check(program, tmp_path / "cell.toml", motion=True)]


@needs_robot_data
def test_a_robot_by_name_runs_without_the_reader_of_its_meshes(cell, monkeypatch):
    monkeypatch.setattr(mesh_file, "_is_installed", lambda name: False)
    found = cell('[robot]\nmodel = "baxter_left"\n')
    assert found.scene.links is None
    assert [d.code for d in found.warnings] == ["IRL645", "IRL621"]
    assert 'pip install "irlx[meshes]"' in found.warnings[0].message
    with pytest.raises(CellError, match="IRL641"):
        cell('[robot]\nmodel = "baxter_left"\n[robot.self_collision]\nmargin = 8\n')
    silent = cell('[robot]\nmodel = "baxter_left"\n[robot.self_collision]\nactive = false\n')
    assert [d.code for d in silent.warnings] == ["IRL621"]
    # The meshes of the Panda are binary STL files.
    assert cell('[robot]\nmodel = "panda"\n').scene.links is not None


@needs_robot_data
@pytest.mark.parametrize("name", ["panda", "talos_left", "tiago", "kinova", "baxter_left"])
def test_robots_by_name_have_all_their_files(cell, name):
    found = cell(f'[robot]\nmodel = "{name}"\n').robot
    files = {s.shape.file for solids in found.solids.values() for s in solids if isinstance(s.shape, Mesh)}
    assert files
    assert all(file.startswith(str(robot_data_folder())) for file in files)
