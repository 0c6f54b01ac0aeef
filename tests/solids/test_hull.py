"""Convex hulls against those known in closed form and against the definition."""

import numpy as np
import pytest

from irlx.solids.hull import hull_of
from irlx.solids.mesh_file import MeshFileError, read_mesh
from irlx.solids.triangles import Triangles
from mesh_files import CUBE, TRIANGLES, obj, stl

pytestmark = pytest.mark.req("CELL-06")
NO_FACES = np.zeros((0, 3), dtype=np.int64)


def planes(hull):
    a, b, c = np.moveaxis(hull.corners, 1, 0)
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return normals, np.einsum("fi,fi->f", normals, a)


def test_the_hull_of_a_notched_cube_is_the_cube():
    random = np.random.default_rng(5)
    inside = random.uniform(0.0, 1.0, (50, 3))
    hull = hull_of(Triangles(np.vstack([inside, CUBE, CUBE, [[0.5, 0.5, 1.0]]]), NO_FACES))
    assert hull.volume == pytest.approx(1.0, rel=1e-12)
    assert hull.open_edges == 0
    assert {tuple(v) for v in hull.vertices} >= {tuple(v) for v in CUBE}


@pytest.mark.parametrize("seed", range(10))
def test_every_point_lies_behind_every_face(seed):
    random = np.random.default_rng(seed)
    points = random.normal(size=(40, 3)) * [1.0, 10.0**-seed, 1.0] + [100.0, 0.0, -3.0]
    points = np.vstack([points, points[:5], points[:5] + 1e-16])
    hull = hull_of(Triangles(points, NO_FACES))
    normals, offsets = planes(hull)
    assert np.max(points @ normals.T - offsets) < 1e-12 * 100.0, seed
    assert hull.open_edges == 0
    assert hull.volume > 0.0
    assert {tuple(v) for v in hull.vertices} <= {tuple(v) for v in points}


@pytest.mark.parametrize("flat", [CUBE * [1, 1, 0], CUBE * [1, 0, 0], CUBE * 0.0, CUBE[:3]])
def test_flat_surfaces_have_none(flat):
    with pytest.raises(MeshFileError, match="lie in one plane"):
        hull_of(Triangles(flat, NO_FACES))


def test_the_hull_of_a_file_is_built_once(mesh):
    written = mesh("h.stl", stl(CUBE, TRIANGLES[1:]), (2.0, -1.0, 1.0))
    hull = hull_of(read_mesh(written))
    assert hull is hull_of(read_mesh(written))
    assert hull.volume == pytest.approx(2.0, rel=1e-6)


def test_a_flat_file_tells_its_reason(mesh):
    with pytest.raises(MeshFileError, match="one plane"):
        hull_of(read_mesh(mesh("f.obj", obj(CUBE, [(0, 1, 2), (1, 3, 2)]))))
