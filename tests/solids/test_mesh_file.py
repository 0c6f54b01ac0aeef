"""Mesh files: sizes known in closed form, faults, and what another library makes of the same files."""

import logging
import os
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from irlx.cell.robot_data import robot_data_folder
from irlx.solids.mesh_file import MeshFileError, MeshReaderMissing, read_closed_mesh, read_mesh
from irlx.solids.shape import Mesh
from irlx.solids.triangles import Triangles
from long_run import first
from mesh_files import CUBE, QUADS, TRIANGLES, WRITERS, dae, obj, stl

pytestmark = pytest.mark.req("CELL-06")


@pytest.mark.parametrize("ending", sorted(WRITERS))
def test_a_box_is_read_from_every_format(mesh, ending):
    size = np.array([2.0, 3.0, 0.5])
    found = read_closed_mesh(mesh(f"box.{ending.upper()}", WRITERS[ending](CUBE * size, TRIANGLES)))
    assert found.vertices.shape == (8, 3)
    assert found.faces.shape == (12, 3)
    assert found.volume == pytest.approx(3.0, rel=1e-6)
    assert np.ptp(found.vertices, axis=0) == pytest.approx(size, rel=1e-6)


def test_an_octahedron_has_a_third_of_its_prism(mesh):
    vertices = np.vstack([np.eye(3), -np.eye(3)]) * 0.3 + [5.0, -4.0, 100.0]
    faces = [(0, 1, 2), (0, 2, 4), (0, 4, 5), (0, 5, 1), (3, 2, 1), (3, 4, 2), (3, 5, 4), (3, 1, 5)]
    found = read_closed_mesh(mesh("o.obj", obj(vertices, faces)))
    assert found.volume == pytest.approx(4.0 / 3.0 * 0.3**3, rel=1e-9)


def test_quads_become_triangles(mesh):
    assert read_closed_mesh(mesh("q.obj", obj(CUBE, QUADS))).volume == pytest.approx(1.0)


@pytest.mark.parametrize(
    "scale", [(0.001, 0.001, 0.001), (1.0, -1.0, 1.0), (-2.0, 3.0, -0.5), (-1.0, -1.0, -1.0)]
)
def test_scales_that_mirror_leave_the_faces_outwards(mesh, scale):
    found = read_closed_mesh(mesh("s.stl", stl(CUBE, TRIANGLES), scale))
    assert found.volume == pytest.approx(abs(np.prod(scale)), rel=1e-6)
    assert found.vertices.max(axis=0) == pytest.approx(np.maximum(scale, 0.0))


@pytest.mark.parametrize("scale", [(1e-150, -1e-150, -1e-150), (-1e9, 1e9, -1e9)])
def test_scales_whose_product_is_out_of_range(mesh, scale):
    found = read_mesh(mesh("s.stl", stl(CUBE, TRIANGLES), scale))
    faces = read_mesh(mesh("t.stl", stl(CUBE, TRIANGLES))).faces
    assert np.array_equal(found.faces, faces)


@pytest.mark.parametrize("scale", [(1e308, 1e308, 1e308), (1.0, 1e13, 1.0)])
def test_scales_at_which_nothing_is_a_length(mesh, scale):
    with pytest.raises(MeshFileError, match="its scale makes coordinates of it that are no lengths"):
        read_mesh(mesh("s.stl", stl(CUBE, TRIANGLES), scale))


def test_the_unit_of_collada_counts_and_its_upward_axis_does_not(mesh):
    found = read_closed_mesh(mesh("inch.dae", dae(CUBE * [10, 20, 30], TRIANGLES, metre=0.0254)))
    assert found.vertices.max(axis=0) == pytest.approx([0.254, 0.508, 0.762])


def test_faces_without_area_and_vertices_without_faces_are_dropped(mesh):
    vertices = np.vstack([CUBE, CUBE[:1], [[9.0, 9.0, 9.0]]])
    found = read_closed_mesh(mesh("d.obj", obj(vertices, [*TRIANGLES, (0, 8, 1), (2, 2, 2)])))
    assert (len(found.vertices), len(found.faces)) == (8, 12)


def test_corners_that_float32_told_apart_are_one(mesh):
    noise = np.random.default_rng(7).choice([0.0, 1e-9, -1e-9], size=(36, 3))
    soup = CUBE[np.array(TRIANGLES).ravel()] + 0.25 + noise
    found = read_closed_mesh(mesh("n.obj", obj(soup, np.arange(36).reshape(-1, 3))))
    assert (len(found.vertices), found.open_edges) == (8, 0)


OPEN = "its surface is not closed: {} edges without a matching face on the other side"
BAD = {
    "one face missing": (TRIANGLES[1:], OPEN.format(3)),
    "two faces missing": (TRIANGLES[2:], OPEN.format(4)),
    "one face turned": ([TRIANGLES[0][::-1], *TRIANGLES[1:]], OPEN.format(3)),
    "one face twice": ([TRIANGLES[0], *TRIANGLES], OPEN.format(3)),
    "all inwards": ([face[::-1] for face in TRIANGLES], "its faces look inwards"),
    "both sides of a sheet": ([(0, 1, 3), (0, 3, 1)], "its surface encloses no volume"),
    "both sides of a skew sheet": ([(0, 3, 6), (0, 6, 3)], "its surface encloses no volume"),
}


@pytest.mark.parametrize("fault", BAD)
def test_surfaces_that_bound_no_body(mesh, fault):
    faces, reason = BAD[fault]
    written = mesh("b.obj", obj(CUBE, faces))
    with pytest.raises(MeshFileError) as caught:
        read_closed_mesh(written)
    assert caught.value.reason == reason
    assert len(read_mesh(written).faces) == len(faces)


BROKEN = {
    "empty.stl": (b"", "it is empty"),
    "blank.obj": (b" \n", "it is empty"),
    "text.stl": (b"solid x\nendsolid x\n", "it holds no triangles"),
    "points.obj": (b"v 0 0 0\nv 1 0 0\n", "it holds no triangles"),
    "speck.obj": (b"v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n", "it holds no triangles"),
    "nan.obj": (b"v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "it holds coordinates that are no lengths"),
    "far.obj": (b"v 1e300 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "it holds coordinates that are no lengths"),
    "index.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "it is no whole OBJ file"),
    "row.obj": (b"v 0\nv 1\nf 3\nv 1", "it holds vertices that have no three coordinates"),
    "cut.ply": (b"ply\nformat ascii 1.0\n", "it is no whole PLY file"),
    "count.stl": (b"\0" * 80 + b"\xff\xff\xff\x7f", "it is no whole STL file"),
    "other.dae": (b"<robot/>", "it is no whole DAE file"),
    "part.step": (b"ISO", "'.step' is no format of meshes that irlx reads: stl, obj, ply, dae"),
    "part": (b"", "'' is no format of meshes that irlx reads: stl, obj, ply, dae"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_files(mesh, name):
    content, reason = BROKEN[name]
    with pytest.raises(MeshFileError) as caught:
        read_mesh(mesh(name, content))
    assert caught.value.reason.startswith(reason)
    assert "\n" not in caught.value.reason


@pytest.mark.parametrize("seed", range(30))
def test_files_cut_off_or_altered_are_read_or_refused(mesh, seed):
    random = np.random.default_rng(seed)
    ending = sorted(WRITERS)[seed % 4]
    content = bytearray(WRITERS[ending](CUBE, TRIANGLES))
    for _ in range(3):
        content[random.integers(len(content))] = random.integers(256)
    if seed % 3 == 0:
        del content[random.integers(len(content)) :]
    written = mesh(f"x.{ending}", bytes(content))
    try:
        found = read_mesh(written)
    except MeshFileError:
        found = None
    if found is not None:
        assert np.all(np.isfinite(found.vertices)), seed
        assert found.faces.max() < len(found.vertices), seed


def test_a_broken_file_does_not_speak_on_the_terminal(mesh, monkeypatch):
    """Trimesh logs a traceback of this one; without a handler Python prints what is logged."""
    spoken = []
    monkeypatch.setattr(logging.root, "handlers", [])
    monkeypatch.setattr(logging, "lastResort", SimpleNamespace(level=0, handle=spoken.append))
    with pytest.raises(MeshFileError):
        read_mesh(mesh("x.stl", b"solid x\nfacet normal a b c\nouter loop\nvertex 1 2\nendloop\nendfacet\n"))
    assert not spoken


def test_missing_files(tmp_path):
    for file in (tmp_path / "no.stl", tmp_path / "a\0b.stl"):
        with pytest.raises(MeshFileError):
            read_mesh(Mesh(str(file)))
    (tmp_path / "folder.stl").mkdir()
    with pytest.raises(MeshFileError):
        read_mesh(Mesh(str(tmp_path / "folder.stl")))


@pytest.mark.parametrize(("package", "ending"), [("trimesh", "ply"), ("collada", "dae")])
def test_without_the_packages(mesh, monkeypatch, package, ending):
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(MeshReaderMissing, match=f"the package (py)?{package} is not installed"):
        read_mesh(mesh(f"missing.{ending}", WRITERS[ending](CUBE, TRIANGLES)))


def test_binary_stl_needs_no_package(mesh, monkeypatch):
    monkeypatch.setitem(sys.modules, "trimesh", None)
    found = read_closed_mesh(mesh("own.stl", stl(CUBE * 3.0, TRIANGLES)))
    assert found.volume == pytest.approx(27.0)
    text = b"solid x\n" + b"facet normal 0 0 0\nouter loop\n" + b"vertex 0 0 0\n" * 3 + b"endloop\nendfacet\n"
    with pytest.raises(MeshReaderMissing):
        read_mesh(mesh("text.stl", text + b"endsolid x\n"))


def test_stl_as_text(mesh):
    lines = ["solid cube"]
    for face in TRIANGLES:
        corners = [f"vertex {x} {y} {z}" for x, y, z in CUBE[list(face)]]
        lines += ["facet normal 0 0 0", "outer loop", *corners, "endloop", "endfacet"]
    found = read_closed_mesh(mesh("t.stl", "\n".join([*lines, "endsolid cube", ""]).encode()))
    assert found.volume == pytest.approx(1.0)


def test_a_file_is_read_once_while_it_stays_as_it_is(mesh):
    written = mesh("c.stl", stl(CUBE, TRIANGLES))
    first = read_mesh(written)
    assert read_mesh(written) is first
    with pytest.raises(ValueError, match="read-only"):
        first.vertices[0, 0] = 7.0
    mesh("c.stl", stl(2.0 * CUBE, TRIANGLES))
    os.utime(written.file, ns=(1, 1))
    assert read_mesh(written).volume == pytest.approx(8.0)


def test_open_edges_of_random_patches_are_counted_as_by_hand():
    random = np.random.default_rng(3)
    for _ in range(20):
        faces = np.array([f for f in TRIANGLES if random.random() < 0.7], dtype=np.int64).reshape(-1, 3)
        run = [(a, b) for face in faces.tolist() for a, b in zip(face, face[1:] + face[:1], strict=True)]
        unmatched = sum((b, a) not in run for a, b in run)
        assert Triangles(CUBE, faces).open_edges == unmatched


@pytest.mark.skipif(robot_data_folder() is None, reason="the data package is missing")
@pytest.mark.parametrize("robot", first(2, ["panda", "ur", "tiago", "z1"]))
def test_the_same_bounds_as_coal_reads(robot):
    """coal reads meshes by assimp, in C++."""
    import coal

    files = [
        p for p in (robot_data_folder() / f"{robot}_description").rglob("*collision*/**/*") if p.is_file()
    ]
    files += (robot_data_folder() / f"{robot}_description").rglob("*_collision.*")
    meshes = [path for path in sorted(set(files)) if path.suffix.lower() in (".stl", ".dae")]
    assert meshes
    for path in meshes:
        found = read_mesh(Mesh(str(path))).vertices
        other = coal.MeshLoader().load(str(path))
        other.computeLocalAABB()
        assert found.min(axis=0) == pytest.approx(other.aabb_local.min_, abs=1e-6), path.name
        assert found.max(axis=0) == pytest.approx(other.aabb_local.max_, abs=1e-6), path.name
