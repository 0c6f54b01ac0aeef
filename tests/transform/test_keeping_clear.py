"""The push away from obstacles, against its formula written out, and its calm variant."""

from dataclasses import replace

import numpy as np
import pytest

from drawn_scenes import cell_of, drawn_scene
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle
from irlx.scene.watched_pair import watched_pairs
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere
from irlx.transform.criteria.keeping_clear import KeepingClear

pytestmark = pytest.mark.req("TRF-14")


def distances_of(kinematics, obstacles):
    return Distances(kinematics, watched_pairs(kinematics, obstacles, None))


def formula(distances, free, q):
    """B of the monograph's term with the weights of several pairs, b for 50 ms along the null space of the
    tool's Jacobian, and that null space, by singular vectors."""
    near, kinematics = distances.near(q), distances.kinematics
    points = distances.jacobians(q, near)
    jacobian = kinematics.here(q)[1][:, free]
    basis = np.linalg.svd(jacobian)[2][len(jacobian) :].T
    away = np.maximum(near.distance, 0.02)
    influence, margin = distances.influence[near.pairs], distances.margin[near.pairs]
    inside = np.clip((influence - away) / (0.25 * (influence - margin)), 0.0, 1.0)
    weights = inside**2 * (3.0 - 2.0 * inside) * (away.min() / away) ** 4
    weights *= 0.7e6 / max(weights.sum(), 1.0)
    b, matrix = np.zeros(q.size), np.zeros((q.size, q.size))
    for w, gap, depth, v, rows in zip(weights, away, influence - away, near.away, points, strict=True):
        alpha = min(1e-3 / gap, 0.25 * max(depth, 0.0))
        gain = basis.T @ rows[:, free].T @ v
        moved = rows[:, free] @ basis @ gain
        length = np.linalg.norm(gain)
        if length > 1e-12:
            alpha *= min(1.0, 0.05 * moved @ moved / max(alpha * length**3, 1e-300))
        b -= w * alpha * (v @ rows)
        matrix += w * rows.T @ rows
    return matrix, basis.T @ b[free], basis


@pytest.mark.parametrize("name", ["arm7", "koch11", "mobile8"])
def test_it_is_the_formula(name):
    cell, kinematics = cell_of(name)
    rng, size = np.random.default_rng(5), 8.0 if name == "koch11" else 1.0
    for _ in range(6):
        balls = [
            Obstacle(
                f"o{k}",
                (Solid(Sphere(0.05 * size)),),
                Placement(tuple((kinematics.tool_pose(cell.start)[1] * rng.uniform(0.3, 0.9, 3)).tolist())),
                0.01 * size,
                0.4 * size,
            )
            for k in range(3)
        ]
        distances, free = distances_of(kinematics, balls), np.ones(cell.start.size, dtype=bool)
        free[rng.integers(free.size)] = rng.random() < 0.5 or free.size == 7
        q = cell.start + rng.uniform(-0.1, 0.1, free.size)
        term = KeepingClear(distances, free)
        matrix, b, basis = formula(distances, free, q)
        if not term.acts(q):
            assert not np.any(matrix)
            continue
        np.testing.assert_allclose(term.quadratic(q), matrix, rtol=1e-12, atol=1e-9 * np.max(np.abs(matrix)))
        pushed = basis.T @ term.linear(q, 0.05)[free]
        np.testing.assert_allclose(pushed, b, rtol=1e-9, atol=1e-9 * np.max(np.abs(matrix)))


def beside(link, depth=0.5):
    """arm7 at its start, a ball and a solid of a link: `depth` of the way over which the push comes up."""
    cell, kinematics = cell_of("arm7")
    kinematics.tool_pose(cell.start)
    joint, frame = kinematics.body_of(link)
    place = (kinematics.data.oMi[joint] * frame).translation + np.array([0.0, 0.25, 0.0])
    ball = Obstacle("ball", (Solid(Sphere(0.02)),), Placement(tuple(place.tolist())), 0.0, 9.0)
    pair = next(pair for pair in watched_pairs(kinematics, [ball], None) if pair.link == link)
    gap = float(Distances(kinematics, [pair]).of(cell.start, np.array([0])).distance[0])
    return cell.start, Distances(kinematics, [replace(pair, influence=gap / (1.0 - 0.25 * depth))])


def test_calm_it_does_not_count_what_goes_with_the_tool():
    q, distances = beside("flange")
    free = np.ones(q.size, dtype=bool)
    plain, calm = KeepingClear(distances, free), KeepingClear(distances, free, calm=True)
    assert np.max(np.abs(plain.quadratic(q))) > 1.0
    assert np.max(np.abs(calm.quadratic(q))) < 1e-6
    assert np.max(np.abs(calm.linear(q, 0.05))) < 1e-6


@pytest.mark.parametrize("depth", [0.02, 0.3, 0.9])
def test_calm_it_comes_up_with_the_fourth_power(depth):
    q, distances = beside("forearm_1", depth)
    free = np.ones(q.size, dtype=bool)
    plain, calm = KeepingClear(distances, free), KeepingClear(distances, free, calm=True)
    rise = depth**2 * (3.0 - 2.0 * depth)
    np.testing.assert_allclose(calm.quadratic(q), rise * plain.quadratic(q), rtol=1e-6, atol=1e-9)
    assert calm.posture_share(q) == plain.posture_share(q) == pytest.approx(1.0 - 0.7 * rise, rel=1e-9)


def test_calm_it_does_not_push_from_end_to_end():
    # The shoulder of an arm lies along a face of a cube: either end is the nearest in turn.
    scene = drawn_scene(1197)
    distances = distances_of(scene.setup.kinematics, [scene.setup.scene.obstacles["o6"]])
    either = np.array(
        [
            [0.29226, 0.542218, -0.460104, 1.970018, 0.25658, 0.954884, -0.908661],
            [0.289105, 0.538176, -0.419867, 1.99212, 0.24137, 0.928325, -0.875898],
        ]
    )
    free = np.ones(7, dtype=bool)
    basis = [np.linalg.svd(scene.setup.kinematics.here(q)[1])[2][6] for q in either]
    basis[1] *= np.sign(basis[0] @ basis[1])
    pushes = {
        calm: [
            KeepingClear(distances, free, calm).linear(q, 0.05) @ way
            for q, way in zip(either, basis, strict=True)
        ]
        for calm in (False, True)
    }
    assert pushes[False][0] * pushes[False][1] < 0.0
    # What other links are pushed by stays.
    assert abs(np.subtract(*pushes[True])) < 0.1 * abs(np.subtract(*pushes[False]))


def test_each_posture_is_looked_at_anew():
    """What was found at one posture says nothing of the next one, nor what a tick made of it."""
    cell, kinematics = cell_of("arm7")
    place = kinematics.tool_pose(cell.start)[1] + np.array([0.15, 0.0, 0.0])
    ball = Obstacle("ball", (Solid(Sphere(0.05)),), Placement(tuple(place.tolist())), 0.01, 0.4)
    free = np.ones(7, dtype=bool)
    kept = KeepingClear(distances_of(kinematics, [ball]), free)
    for turn in (0.0, 0.05, -0.1, 0.0):
        q = cell.start + turn
        alone = KeepingClear(distances_of(kinematics, [ball]), free)
        # Searches for distances begin where the last one ended, so that rounding differs.
        for found, wanted in (
            (kept.linear(q, 0.05), alone.linear(q, 0.05)),
            (kept.quadratic(q), alone.quadratic(q)),
        ):
            np.testing.assert_allclose(found, wanted, rtol=1e-5, atol=1e-6 * np.max(np.abs(wanted)))
        assert kept.posture_share(q) == pytest.approx(alone.posture_share(q), abs=1e-6)
