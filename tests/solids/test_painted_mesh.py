"""Meshes with colours of their own, and surfaces of fewer triangles."""

import builtins

import numpy as np
import pytest
import trimesh

from irlx.solids.mesh_file import MeshFileError, MeshReaderMissing, read_mesh
from irlx.solids.painted_mesh import read_painted_mesh
from irlx.solids.shape import Mesh
from irlx.solids.simplify import fair_shares, simplified
from irlx.solids.triangles import Triangles
from mesh_files import CUBE, TRIANGLES, WRITERS, dae, stl

pytestmark = pytest.mark.req("REP-04")


def two_colours(path):
    """A COLLADA file of two unit cubes in mm, a red one and a translucent blue one 3 mm beside it."""
    cubes = []
    for place, colour in ((0.0, (255, 0, 0, 255)), (3.0, (0, 0, 255, 128))):
        cube = trimesh.Trimesh(CUBE + np.array([place, 0.0, 0.0]), TRIANGLES, process=False)
        material = trimesh.visual.material.PBRMaterial(baseColorFactor=colour)
        cube.visual = trimesh.visual.TextureVisuals(uv=np.zeros((len(CUBE), 2)), material=material)
        cubes.append(cube)
    text = trimesh.exchange.dae.export_collada(cubes).replace(b'meter="1.0"', b'meter="0.001"')
    path.write_bytes(text)
    return Mesh(str(path), (1.0, 2.0, -1.0))


def test_surfaces_by_colour(tmp_path):
    mesh = two_colours(tmp_path / "two.dae")
    whole, found = read_mesh(mesh), read_painted_mesh(mesh)
    assert [part.colour.code for part in found] == ["#ff0000", "#0000ff"]
    # The scene and the mesh of all that it holds are read in different ways.
    points = np.concatenate([part.surface.vertices for part in found])
    np.testing.assert_allclose(np.sort(points, axis=0), np.sort(whole.vertices, axis=0), atol=1e-15)
    assert sum(part.surface.volume for part in found) == pytest.approx(whole.volume)
    assert all(part.surface.volume > 0.0 for part in found)


@pytest.mark.parametrize("ending", WRITERS)
def test_meshes_without_colours(mesh, ending):
    (found,) = read_painted_mesh(mesh(f"cube.{ending}", WRITERS[ending](CUBE, TRIANGLES)))
    assert found.surface.volume == pytest.approx(1.0)
    if ending in {"stl", "obj"}:
        assert found.colour is None


@pytest.mark.parametrize(("name", "content"), [("no.dae", b"<COLLADA"), ("empty.obj", b"# nothing\n")])
def test_broken_files(mesh, name, content):
    with pytest.raises(MeshFileError):
        read_painted_mesh(mesh(name, content))


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(MeshFileError, match="No such file"):
        read_painted_mesh(Mesh(str(tmp_path / "no.dae")))


def test_a_file_written_anew_is_read_anew(mesh):
    before = read_painted_mesh(mesh("part.dae", dae(CUBE, TRIANGLES)))
    after = read_painted_mesh(mesh("part.dae", dae(2.0 * CUBE, TRIANGLES)))
    assert after[0].surface.volume == pytest.approx(8.0 * before[0].surface.volume)


def ball():
    found = trimesh.creation.icosphere(subdivisions=5)
    return Triangles(np.array(found.vertices), np.array(found.faces))


def test_a_simplified_surface_looks_like_the_real_one():
    surface = ball()
    found = simplified(surface, 1000)
    assert len(surface.faces) == 20480
    assert 500 < len(found.faces) <= 1000
    assert found.open_edges == 0
    assert np.abs(np.linalg.norm(found.vertices, axis=1) - 1.0).max() < 0.01
    assert found.volume == pytest.approx(surface.volume, rel=0.01)


def test_small_surfaces_stay_as_they_are(mesh):
    cube = read_mesh(mesh("cube.stl", stl(CUBE, TRIANGLES)))
    assert simplified(cube, 12) is cube


def test_without_the_library(monkeypatch):
    real = builtins.__import__

    def lacking(name, *args, **kwargs):
        if name == "fast_simplification":
            raise ImportError(name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", lacking)
    with pytest.raises(MeshReaderMissing, match="fast-simplification"):
        simplified(ball(), 999)


@pytest.mark.parametrize(
    ("sizes", "budget", "share"),
    [((), 10, 1), ((5, 3), 10, 5), ((10, 2, 10), 10, 4), ((10, 10), 10, 5), ((100, 100, 1), 3, 1)],
)
def test_fair_shares(sizes, budget, share):
    assert fair_shares(sizes, budget) == share
    assert sum(min(size, share) for size in sizes) <= max(budget, len(sizes))
