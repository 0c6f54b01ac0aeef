"""Distances to meshes: the very triangles, what is inside of them, and files of them as obstacles."""

import coal
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from clearance_streams import StreamMaker, clearance_of, obstacle, scene_of
from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Mesh, Point, Solid, Sphere
from irlx.verifier.distances.between import distances
from irlx.verifier.distances.body import body_of, mesh_body
from irlx.verifier.distances.sphere_tree import BRANCHES, sphere_tree
from long_run import first
from mesh_files import obj

SEED = 20261129


def bumpy(rings: int, size: float = 0.3) -> tuple[np.ndarray, np.ndarray]:
    """A closed surface with three lobes and a waist: its hull is much larger than it is."""
    around = np.linspace(0.0, 2.0 * np.pi, 2 * rings, endpoint=False)
    down = np.linspace(0.0, np.pi, rings)[1:-1]
    u, v = np.meshgrid(around, down)
    r = size * (1.0 + 0.35 * np.sin(3.0 * u) * np.sin(v) ** 2 + 0.2 * np.cos(4.0 * v))
    points = np.stack([r * np.sin(v) * np.cos(u), r * np.sin(v) * np.sin(u), r * np.cos(v)], axis=-1)
    rows, columns = points.shape[:2]
    poles = [[0.0, 0.0, 1.2 * size], [0.0, 0.0, -1.2 * size]]
    faces = []
    for i in range(rows - 1):
        for j in range(columns):
            a, b = i * columns + j, i * columns + (j + 1) % columns
            faces += [[a, a + columns, b], [b, a + columns, b + columns]]
    top, last = rows * columns, (rows - 1) * columns
    for j in range(columns):
        faces += [[top, j, (j + 1) % columns], [top + 1, last + (j + 1) % columns, last + j]]
    return np.concatenate([points.reshape(-1, 3), poles]), np.array(faces)


def box_triangles(size) -> tuple[np.ndarray, np.ndarray]:
    vertices = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]) * size
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def coal_mesh(vertices, faces):
    model = coal.BVHModelOBBRSS()
    model.beginModel(len(faces), len(vertices))
    points, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for vertex in vertices:
        points.append(vertex)
    for a, b, c in faces.tolist():
        triangles.append(coal.Triangle(a, b, c))
    model.addSubModel(points, triangles)
    model.endModel()
    return model


def by_coal(first, second, positions, rotations):
    request = coal.DistanceRequest()
    request.gjk_tolerance = 1e-10
    found = []
    for position, rotation in zip(positions, rotations, strict=True):
        at, result = coal.Transform3s(rotation, position), coal.DistanceResult()
        found.append(coal.distance(first, coal.Transform3s(), second, at, request, result))
    return np.array(found)


def poses(count, rng, away=1.0):
    positions = rng.normal(size=(count, 3)) * rng.choice([0.4, 0.8, 3.0], size=(count, 1)) * away
    return positions, Rotation.random(count, random_state=rng).as_matrix()


MOVING = {
    "point": (Point(), coal.Sphere(0.0)),
    "sphere": (Sphere(0.1), coal.Sphere(0.1)),
    "box": (Box((0.1, 0.2, 0.3)), coal.Box(0.1, 0.2, 0.3)),
    "cylinder": (Cylinder(0.06, 0.4), coal.Cylinder(0.06, 0.4)),
    "capsule": (Capsule(0.05, 0.4), coal.Capsule(0.05, 0.4)),
    "cone": (Cone(0.1, 0.3), coal.Cone(0.1, 0.3)),
}


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("name", first(5, sorted(MOVING, key="cylinder".__eq__)))
def test_distances_to_a_hollow_mesh_are_those_of_coal(name):
    rng = np.random.default_rng([SEED, len(name)])
    vertices, faces = bumpy(10)
    shape, theirs = MOVING[name]
    mesh, model = mesh_body(vertices, faces), coal_mesh(vertices, faces)
    positions, rotations = poses(250, rng)
    found = distances(mesh, body_of(shape), positions, rotations)
    due = by_coal(model, theirs, positions, rotations)
    clear = (found.upper > 0.0) & (due > 0.0)
    assert clear.sum() > 100
    assert found.upper[clear] == pytest.approx(due[clear], abs=3e-9, rel=2e-10)
    assert np.all((found.upper - found.lower)[clear] <= 1e-10)
    # coal knows surfaces only: what it holds to be apart and is not lies inside, as deep as it says.
    inside = (found.upper <= 0.0) & (due > 0.0)
    radius = body_of(shape).radius
    assert found.upper[inside] == pytest.approx(-(due[inside] + 2.0 * radius), abs=1e-8)
    # The other way round: the mesh moves about the solid.
    back = np.swapaxes(rotations, 1, 2)
    other = distances(body_of(shape), mesh, -np.einsum("mij,mj->mi", back, positions), back)
    assert other.upper[clear] == pytest.approx(found.upper[clear], abs=1e-10)
    assert np.all((other.upper > 0.0) == (found.upper > 0.0))


@pytest.mark.req("STR-06")
def test_distances_between_meshes_are_those_of_coal():
    rng = np.random.default_rng(SEED)
    (vertices, faces), (others, sides) = bumpy(7), bumpy(6, 0.2)
    positions, rotations = poses(60, rng)
    found = distances(mesh_body(vertices, faces), mesh_body(others, sides), positions, rotations)
    due = by_coal(coal_mesh(vertices, faces), coal_mesh(others, sides), positions, rotations)
    clear = (found.upper > 0.0) & (due > 0.0)
    assert clear.sum() > 20
    assert found.upper[clear] == pytest.approx(due[clear], abs=1e-9)
    assert np.all(found.upper[due <= 0.0] <= 0.0)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("name", first(5, sorted(MOVING, key="cone".__eq__)))
def test_a_box_of_triangles_is_as_far_as_the_box(name):
    """The same solid in two forms: outside equal, inside both overlap; all that is wholly inside included."""
    rng = np.random.default_rng([SEED, len(name)])
    size = np.array([1.0, 1.4, 0.9])
    mesh, box, moving = mesh_body(*box_triangles(size)), body_of(Box(tuple(size))), body_of(MOVING[name][0])
    positions, rotations = poses(400, rng, 0.7)
    positions[:50] *= 0.1
    one, other = (distances(body, moving, positions, rotations) for body in (mesh, box))
    apart = other.upper > 0.0
    assert one.upper[apart] == pytest.approx(other.upper[apart], abs=1e-10)
    assert np.all(one.upper[~apart] <= 0.0)
    core = moving.core.reach + moving.radius
    inside = (np.abs(positions) + core < size / 2).all(axis=1)
    assert inside.sum() > 10
    # What is inside is as deep as the surfaces are apart, and further apart than it is long.
    assert np.all(one.upper[inside] < 0.0)


@pytest.mark.req("STR-06")
def test_points_in_a_mesh_are_told_by_how_often_it_winds_around_them():
    rng = np.random.default_rng(SEED)
    size = np.array([1.0, 1.4, 0.9])
    vertices, faces = box_triangles(size)
    points = rng.uniform(-1.0, 1.0, (2000, 3))
    inside = (np.abs(points) < size / 2).all(axis=1)
    for turned in (faces, faces[:, ::-1]):
        assert np.array_equal(np.abs(mesh_body(vertices, turned).winds_around(points)) > 0.5, inside)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("count", [1, 3, 4, 5, 17, 200])
def test_every_sphere_holds_the_triangles_below_it(count):
    rng = np.random.default_rng([SEED, count])
    corners = rng.normal(size=(count, 1, 3)) + 0.1 * rng.normal(size=(count, 3, 3))
    corners[count // 2 :] = corners[count // 2]
    tree = sphere_tree(corners)
    assert len(tree.radii[0]) == 1
    assert sorted(tree.order.tolist()) == list(range(count))
    for level in range(tree.depth):
        below = BRANCHES ** (tree.depth - 1 - level)
        for node in range(len(tree.radii[level])):
            triangles = tree.order[node * below : (node + 1) * below]
            away = np.linalg.norm(corners[triangles].reshape(-1, 3) - tree.centres[level][node], axis=1)
            assert away.max() <= tree.radii[level][node] * (1.0 + 1e-12) + 1e-15
        if level + 1 < tree.depth:
            parent, node = tree.below(level, np.arange(len(tree.radii[level])))
            assert node.tolist() == list(range(len(tree.radii[level + 1])))
            assert np.array_equal(parent, node // BRANCHES)


def written(path, vertices, faces) -> str:
    """Name of an OBJ file: every digit of the vertices."""
    path.write_bytes(obj(vertices, faces))
    return str(path)


def carriage(*solids: Solid) -> RobotDescription:
    """One slide along x with solids on it."""
    slide = Joint("x", JointKind.PRISMATIC, "base", "carriage", axis=(1.0, 0.0, 0.0))
    return RobotDescription("carriage", "base", "carriage", (slide,), solids={"carriage": solids})


@pytest.mark.req("STR-06")
def test_a_ball_goes_through_a_mesh_that_its_hull_would_not_let_it(tmp_path):
    """Two slabs in one file, 0.6 m apart: between them is room, and the room has walls."""
    vertices, faces = box_triangles((2.0, 0.2, 1.0))
    up = np.array([0.0, 0.4, 0.0])
    file = written(
        tmp_path / "slit.obj",
        np.concatenate([vertices + up, vertices - up]),
        np.concatenate([faces, faces + 8]),
    )
    robot = carriage(Solid(Sphere(0.1)))
    maker = StreamMaker(robot, np.array([-3.0]))
    maker.switch("slit")
    maker.move(np.linspace(-3.0, 3.0, 900)[:, None])
    mesh = Mesh(file)
    found = clearance_of(maker, scene_of(obstacle("slit", mesh)))
    assert found.status == "ok"
    assert found.worst.value == pytest.approx(0.3 - 0.1, abs=1e-6)
    aside = clearance_of(maker, scene_of(obstacle("slit", mesh, (0.0, 0.19, 0.0))))
    assert aside.status == "failed"
    # It comes near the edge of the lower slab, whose corner is at x = -1.
    assert aside.worst.value == pytest.approx(0.3 - 0.19 - 0.1, abs=1e-6)
    edge = np.sqrt(0.12**2 - 0.11**2)
    due = int(np.argmax(np.linspace(-3.0, 3.0, 900) > -1.0 - edge)) + 1
    assert aside.first.tick == due


@pytest.mark.req("STR-06")
def test_a_row_wholly_inside_a_mesh_is_found(tmp_path):
    """The row before and the row behind it are outside: no surface is near in any row."""
    file = written(tmp_path / "block.obj", *box_triangles((1.0, 1.0, 1.0)))
    maker = StreamMaker(carriage(Solid(Box((0.1, 0.1, 0.1)))), np.array([-3.0]))
    maker.switch("block")
    rows = np.full((2000, 1), -3.0)
    rows[1500] = 0.0
    first = maker.move(rows)
    found = clearance_of(maker, scene_of(obstacle("block", Mesh(file))))
    assert found.status == "failed"
    assert found.first.tick == found.worst.tick == first + 1500
    assert found.worst.value == pytest.approx(-0.45, abs=1e-9)


@pytest.mark.req("STR-06")
def test_meshes_of_links_against_meshes(tmp_path):
    """A mesh on the carriage, scaled in its file, runs against another one: by hand."""
    file = written(tmp_path / "block.obj", *box_triangles((1000.0, 1000.0, 1000.0)))
    small = Solid(Mesh(file, (2e-4, 2e-4, 2e-4)), Placement((0.0, 0.0, 0.1)))
    maker = StreamMaker(carriage(small), np.array([-2.0]))
    maker.switch("block")
    maker.move(np.linspace(-2.0, -0.65, 300)[:, None])
    found = clearance_of(maker, scene_of(obstacle("block", Mesh(file, (1e-3, 1e-3, 1e-3)), margin=0.06)))
    assert found.status == "failed"
    assert found.worst.value == pytest.approx(0.05, abs=1e-9)
    assert found.first.value < 0.06


@pytest.mark.req("STR-06")
def test_a_mesh_that_cannot_be_read_is_the_reason(tmp_path):
    maker = StreamMaker(carriage(Solid(Sphere(0.1))), np.array([-2.0]))
    maker.switch("block")
    maker.move(np.linspace(-2.0, -0.65, 30)[:, None])
    found = clearance_of(maker, scene_of(obstacle("block", Mesh(str(tmp_path / "none.obj")))))
    assert found.status == "not checked"
    assert "none.obj" in found.detail
