"""The verifier's distances between convex solids against closed forms, an optimiser, and coal."""

import coal
import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Point, Sphere
from irlx.verifier.distances.between import displacement, distances, slab
from irlx.verifier.distances.body import body_of
from long_run import first

SEED = 20261129
KINDS = ("point", "sphere", "box", "cylinder", "capsule", "cone")
DEEP = ("box", "cylinder", "cone")
"""Kinds whose overlaps are looked at with those of all kinds."""
FLAT = {"point", "sphere", "box", "capsule"}
"""Kinds whose core has flat faces only: their overlap is exact."""


def drawn(kind: str, rng: np.random.Generator):
    """A shape of a kind, and coal's."""
    a, b, c = rng.uniform(0.02, 0.5, 3)
    if kind == "point":
        return Point(), coal.Sphere(0.0)
    if kind == "sphere":
        return Sphere(a), coal.Sphere(a)
    if kind == "box":
        return Box((a, b, c)), coal.Box(a, b, c)
    if kind == "cylinder":
        return Cylinder(a, b), coal.Cylinder(a, b)
    if kind == "capsule":
        return Capsule(0.3 * a, b), coal.Capsule(0.3 * a, b)
    return Cone(a, b), coal.Cone(a, b)


def poses(count: int, rng: np.random.Generator):
    """Positions and rotations: anywhere, far, on axes, turned by multiples of 90 degrees, and all but so."""
    positions = rng.normal(size=(count, 3)) * rng.choice([0.05, 0.3, 0.6, 1.5, 40.0], size=(count, 1))
    positions[rng.random((count, 3)) < 0.2] = 0.0
    rotations = Rotation.random(count, random_state=rng).as_matrix()
    square = Rotation.create_group("O").as_matrix()
    which = rng.random(count) < 0.3
    rotations[which] = square[rng.integers(24, size=int(which.sum()))]
    bent = Rotation.from_rotvec(rng.normal(size=(count, 3)) * 1e-16).as_matrix()
    return positions, np.where((rng.random(count) < 0.5)[:, None, None], rotations, bent @ rotations)


def by_coal(first, second, positions, rotations):
    request = coal.DistanceRequest()
    request.gjk_tolerance, request.epa_tolerance = 1e-10, 1e-9
    found = []
    for position, rotation in zip(positions, rotations, strict=True):
        result = coal.DistanceResult()
        at = coal.Transform3s(rotation, position)
        found.append(coal.distance(first, coal.Transform3s(), second, at, request, result))
    return np.array(found)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("turn", first(1, range(6)))
@pytest.mark.parametrize(
    ("kind", "other"),
    [
        # Every other pair by default, one way round.
        pytest.param(kind, other, marks=pytest.mark.slow if place < before or (place + before) % 2 else ())
        for before, kind in enumerate(KINDS)
        for place, other in enumerate(KINDS)
    ],
)
def test_distances_are_those_of_coal(kind, other, turn):
    rng = np.random.default_rng([SEED, KINDS.index(kind), KINDS.index(other), turn])
    for _ in range(2):
        (shape, theirs), (moving, their_moving) = drawn(kind, rng), drawn(other, rng)
        positions, rotations = poses(80, rng)
        found = distances(body_of(shape), body_of(moving), positions, rotations)
        due = by_coal(theirs, their_moving, positions, rotations)
        assert np.all(found.lower <= found.upper)
        apart = found.upper > 0.0
        # Whatever is found is proved from both sides, to far less than the verifier allows; coal ends its
        # search at a share of the distance.
        assert np.all((found.upper - found.lower)[apart] <= 1e-10)
        assert found.upper[apart] == pytest.approx(due[apart], abs=3e-9, rel=2e-10)
        assert np.all(found.upper[~apart] <= 0.0)
        # How deep round bodies overlap, coal gives only roughly.
        if {kind, other} <= FLAT:
            assert found.upper[~apart] == pytest.approx(due[~apart], abs=1e-8)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize(
    ("kind", "other"),
    [
        # Every other pair by default, one way round.
        pytest.param(
            kind, other, marks=pytest.mark.slow if other in DEEP[:before] or (before + place) % 2 else ()
        )
        for before, kind in enumerate(DEEP)
        for place, other in enumerate(KINDS)
    ],
)
def test_overlapping_bodies_are_parted_by_no_shorter_way(kind, other):
    """Of 3000 directions all round none parts them by less; and the way found does part them."""
    rng = np.random.default_rng([SEED, 7, KINDS.index(kind), KINDS.index(other)])
    around = Rotation.random(3000, random_state=rng).as_matrix()[:, 0]
    first, second = (body_of(drawn(name, rng)[0]) for name in (kind, other))
    positions, rotations = poses(120, rng)
    positions *= 0.1
    found = distances(first, second, positions, rotations)
    deep = np.flatnonzero(found.upper <= 0.0)
    assert deep.size >= 20
    for row in deep:
        here = np.repeat(positions[row][None], 3000, axis=0), np.repeat(rotations[row][None], 3000, axis=0)
        assert np.max(slab(first, second, *here, around)) <= found.upper[row] + 1e-9
    parted = positions[deep] + (1e-7 - found.upper[deep])[:, None] * found.direction[deep]
    assert np.all(distances(first, second, parted, rotations[deep]).upper > 0.0)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize(("kind", "other"), [("box", "cone"), ("cylinder", "capsule")])
def test_distances_beyond_enough_are_bracketed_roughly_others_as_ever(kind, other):
    rng = np.random.default_rng([SEED, 8, KINDS.index(kind)])
    first, second = (body_of(drawn(name, rng)[0]) for name in (kind, other))
    positions, rotations = poses(200, rng)
    exact = distances(first, second, positions, rotations)
    enough = np.quantile(exact.upper, rng.uniform(0.0, 1.0, 200))
    rough = distances(first, second, positions, rotations, enough=enough)
    beyond = exact.lower > enough
    assert np.all(rough.lower <= exact.upper + 1e-12)
    assert np.all(rough.upper >= exact.lower - 1e-12)
    assert np.all(rough.lower[beyond] > enough[beyond])
    assert np.array_equal(rough.upper[~beyond], exact.upper[~beyond])
    assert np.array_equal(rough.lower[~beyond], exact.lower[~beyond])
    # It is what ends the search early.
    assert np.mean(rough.upper[beyond] - rough.lower[beyond] > 1e-6) > 0.5


def contains(shape, point) -> float:
    """How far a point is inside of the constraints that make a shape, at least 0 where it is in it."""
    x, y, z = point
    out = np.hypot(x, y)
    match shape:
        case Box(size):
            return min(0.5 * s - abs(c) for s, c in zip(size, point, strict=True))
        case Cylinder(radius, length):
            return min(radius - out, 0.5 * length - abs(z))
        case Cone(radius, length):
            return min(radius * (0.5 - z / length) - out, z + 0.5 * length)
        case Capsule(radius, length):
            along = min(max(z, -0.5 * length), 0.5 * length)
            return radius - np.hypot(out, z - along)
    return -np.hypot(out, z) + shape.radius


LESS_OFTEN = [pytest.param(kind, marks=pytest.mark.slow) for kind in ("box", "cylinder", "capsule", "sphere")]


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("kind", ["cone", *LESS_OFTEN])
def test_no_two_points_are_nearer_than_an_optimiser_finds(kind):
    """Least |a - b| over both sets, by sequential quadratic programming from the verifier's direction."""
    rng = np.random.default_rng([SEED, len(kind)])
    tried = 0
    for _ in range(6):
        shape, _ = drawn(kind, rng)
        moving, _ = drawn(str(rng.choice(["box", "cylinder", "cone", "capsule"])), rng)
        position = rng.normal(size=3)
        rotation = Rotation.random(random_state=rng).as_matrix()
        found = distances(body_of(shape), body_of(moving), position[None], rotation[None])
        if found.upper[0] <= 1e-3:
            continue
        tried += 1
        inside = (
            {"type": "ineq", "fun": lambda p, s=shape: contains(s, p[:3])},
            {
                "type": "ineq",
                "fun": lambda p, s=moving, r=rotation, o=position: contains(s, r.T @ (p[3:] - o)),
            },
        )
        start = np.concatenate([np.full(3, 1e-3), position + 1e-3])
        best = minimize(
            lambda p: float(np.sum((p[:3] - p[3:]) ** 2)),
            start,
            constraints=inside,
            method="SLSQP",
            options={"maxiter": 100, "ftol": 1e-16},
        )
        if min(c["fun"](best.x) for c in inside) >= -1e-7:
            assert np.sqrt(best.fun) >= found.lower[0] - 1e-6
    assert tried >= 5


@pytest.mark.req("STR-06")
def test_spheres_capsules_and_boxes_by_closed_forms():
    rng = np.random.default_rng(SEED)
    positions, rotations = poses(3000, rng)
    spheres = distances(body_of(Sphere(0.2)), body_of(Sphere(0.1)), positions, rotations)
    assert spheres.upper == pytest.approx(np.linalg.norm(positions, axis=1) - 0.3, abs=1e-12)
    box = distances(body_of(Box((0.4, 0.2, 1.0))), body_of(Sphere(0.1)), positions, rotations)
    beyond = np.abs(positions) - [0.2, 0.1, 0.5]
    outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    signed = np.where(outside > 0.0, outside, beyond.max(axis=1))
    assert box.upper == pytest.approx(signed - 0.1, abs=1e-11)
    capsule = distances(body_of(Capsule(0.1, 0.8)), body_of(Sphere(0.05)), positions, rotations)
    along = np.clip(positions[:, 2], -0.4, 0.4)
    due = np.hypot(np.hypot(positions[:, 0], positions[:, 1]), positions[:, 2] - along) - 0.15
    assert capsule.upper == pytest.approx(due, abs=1e-12)
    cylinder = distances(body_of(Cylinder(0.3, 0.4)), body_of(Point()), positions, rotations)
    out = np.hypot(positions[:, 0], positions[:, 1]) - 0.3
    above = np.abs(positions[:, 2]) - 0.2
    due = np.where(
        (out > 0.0) | (above > 0.0),
        np.hypot(np.maximum(out, 0.0), np.maximum(above, 0.0)),
        np.maximum(out, above),
    )
    assert cylinder.upper == pytest.approx(due, abs=1e-10)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("kind", KINDS)
def test_a_halfspace_ends_at_its_plane(kind):
    rng = np.random.default_rng(SEED)
    shape, theirs = drawn(kind, rng)
    positions, rotations = poses(400, rng)
    found = distances(body_of(Halfspace()), body_of(shape), positions, rotations)
    due = by_coal(coal.Halfspace(np.array([0.0, 0.0, 1.0]), 0.0), theirs, positions, rotations)
    # coal swells round bodies by some 1e-11 for its search.
    assert found.upper == pytest.approx(due, abs=3e-11)
    assert np.array_equal(found.upper, found.lower)


TOUCHING = {
    "boxes, faces in one plane": (
        Box((1.0, 1.0, 1.0)),
        Box((0.4, 0.4, 0.4)),
        (0.7, 0.0, 0.0),
        (0.0, 0.0, 0.0),
    ),
    "boxes, corner on a face": (
        Box((1.0, 1.0, 1.0)),
        Box((0.4, 0.4, 0.4)),
        (0.5 + 0.2 * 3**0.5, 0.1, 0.1),
        (np.pi / 4, np.arctan(2**0.5), 0.0),
    ),
    "boxes, edge on edge": (Box((1.0, 1.0, 1.0)), Box((0.4, 0.4, 0.4)), (0.7, 0.7, 0.0), (0.0, 0.0, 0.0)),
    "cylinders, cap on cap": (Cylinder(0.2, 1.0), Cylinder(0.3, 0.4), (0.1, 0.0, 0.7), (0.0, 0.0, 0.3)),
    "cylinders, side on side": (Cylinder(0.2, 1.0), Cylinder(0.3, 0.4), (0.3, 0.4, 0.0), (0.0, 0.0, 0.0)),
    "cylinders across": (Cylinder(0.2, 1.0), Cylinder(0.3, 0.4), (0.5, 0.0, 0.0), (np.pi / 2, 0.0, 0.0)),
    "apex on a face": (Box((1.0, 1.0, 1.0)), Cone(0.1, 0.4), (0.1, 0.1, -0.7), (0.0, 0.0, 0.0)),
    "capsules end to end": (Capsule(0.1, 0.6), Capsule(0.2, 0.4), (0.0, 0.0, 0.8), (0.0, 0.0, 0.0)),
    "a point on a corner": (Box((1.0, 1.0, 1.0)), Point(), (0.5, 0.5, 0.5), (0.0, 0.0, 0.0)),
    "a point on a rim": (Cylinder(0.5, 1.0), Point(), (0.3, 0.4, 0.5), (0.0, 0.0, 0.0)),
}


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("name", TOUCHING)
def test_bodies_that_touch_are_neither_apart_nor_deep(name):
    """At the touch, a residue to either side of it, and by known amounts off it along the line of centres."""
    first, second, position, rpy = TOUCHING[name]
    rotation = Rotation.from_euler("xyz", rpy).as_matrix()
    residues = np.array([0.0, 1e-16, -1e-16, 3e-14, -3e-14])
    offsets = residues[:, None] * np.ones(3)
    found = distances(
        body_of(first), body_of(second), np.array(position) + offsets, np.repeat(rotation[None], 5, axis=0)
    )
    assert found.upper == pytest.approx(np.zeros(5), abs=1e-12)
    assert found.lower == pytest.approx(np.zeros(5), abs=1e-9)


@pytest.mark.req("STR-06")
def test_parallel_faces_keep_their_distance():
    rng = np.random.default_rng(SEED)
    gap = rng.choice([1e-9, 1e-6, 1e-3, 0.1, 5.0], size=500)
    aside = rng.uniform(-0.4, 0.4, size=(500, 2))
    turn = Rotation.from_euler("z", rng.uniform(-3, 3, (500, 1))).as_matrix()
    for one, other, half in (
        (Box((1.0, 1.0, 0.4)), Box((0.3, 0.2, 0.6)), 0.5),
        (Cylinder(0.7, 0.4), Cone(0.2, 0.6), 0.5),
        (Box((1.0, 1.0, 0.4)), Cylinder(0.2, 0.6), 0.5),
    ):
        positions = np.column_stack([aside, half + gap])
        found = distances(body_of(one), body_of(other), positions, turn)
        assert found.upper == pytest.approx(gap, abs=1e-14)
        assert found.lower == pytest.approx(gap, abs=1e-10)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize("other", KINDS)
def test_far_bodies_keep_digits(other):
    """1 km away what is left of a double's digits is 1e-13 m."""
    rng = np.random.default_rng(SEED)
    moving, theirs = drawn(other, rng)
    positions = 1e3 * Rotation.random(200, random_state=rng).as_matrix()[:, 0]
    rotations = Rotation.random(200, random_state=rng).as_matrix()
    found = distances(body_of(Box((0.3, 0.5, 0.7))), body_of(moving), positions, rotations)
    assert np.all(found.upper - found.lower <= 1e-10)
    # The same pair brought near: what is between its centres and its surfaces does not change much.
    due = by_coal(coal.Box(0.3, 0.5, 0.7), theirs, positions, rotations)
    assert found.upper == pytest.approx(due, abs=1e-6)


@pytest.mark.req("STR-06")
def test_every_slab_is_narrower_than_the_distance():
    rng = np.random.default_rng(SEED)
    for kind in KINDS:
        first, second = (body_of(drawn(name, rng)[0]) for name in ("cylinder", kind))
        positions, rotations = poses(250, rng)
        directions = Rotation.random(250, random_state=rng).as_matrix()[:, 0]
        found = distances(first, second, positions, rotations)
        assert np.all(slab(first, second, positions, rotations, directions) <= found.lower + 1e-9)
        own = slab(first, second, positions, rotations, found.direction)
        apart = found.upper > 0.0
        assert own[apart] == pytest.approx(found.upper[apart], abs=1e-10)


@pytest.mark.req("STR-06")
def test_no_point_of_a_body_goes_further_than_its_displacement():
    rng = np.random.default_rng(SEED)
    for kind in KINDS:
        body = body_of(drawn(kind, rng)[0])
        one, other = poses(300, rng), poses(300, rng)
        directions = Rotation.random(300, random_state=rng).as_matrix()[:, 1]
        points = body.core.support(directions)
        way = (
            other[0]
            + np.einsum("mij,mj->mi", other[1], points)
            - one[0]
            - np.einsum("mij,mj->mi", one[1], points)
        )
        assert np.all(np.linalg.norm(way, axis=1) <= displacement(body, *other, *one) + 1e-12)


@pytest.mark.req("STR-06")
@pytest.mark.parametrize(
    "shape",
    [
        Sphere(0.0),
        Box((1.0, 0.0, 1.0)),
        Cylinder(0.1, 0.0),
        Cone(-1.0, 1.0),
        Capsule(0.1, np.nan),
        Sphere(np.inf),
    ],
)
def test_sizes_that_are_none_are_refused(shape):
    with pytest.raises(ValueError, match="have to be above 0"):
        body_of(shape)
