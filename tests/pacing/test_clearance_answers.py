"""CLEARANCE and OBSTACLE at the pacer: closed forms of planar arms, and what cannot be told."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise, permutations

import numpy as np
import pytest

from irlx.blocks import AskClearance, ObstacleBlock, Origin
from irlx.cell.packaged import packaged_urdf
from irlx.diagnostics import Place, SourceText, Span
from irlx.pacing.clearance_answers import Clearances, pairs_of
from irlx.pacing.errors import PacingError
from irlx.pacing.options import Options
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.urdf import read_urdf
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene
from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Solid, Sphere

TEXT = SourceText("p.irl", "a line\nanother\n")
HERE = Origin("p.irl", 0, 6, 1)
PLACE = Place.in_text(TEXT, Span(0, 6))
LINKS, THICK = (0.45, 0.35, 0.2), 0.035
"""planar3: lengths of its links, which are cylinders of this radius along their x axes."""


def obstacle(name, shape, xyz, rpy=(0.0, 0.0, 0.0)):
    return Obstacle(name, (Solid(shape),), Placement.from_rpy(xyz, rpy), 0.02, 0.2)


def scene_of(*obstacles, **groups):
    return Scene({one.name.casefold(): one for one in obstacles}, groups)


@pytest.fixture(scope="module")
def arm():
    return Kinematics(read_urdf(packaged_urdf("planar3"), "tool"))


def asked(q, name):
    return AskClearance(HERE, tuple(float(value) for value in q), name)


def cylinders(q):
    """Start and end (3,) of each link of planar3."""
    points, angle = [np.zeros(3)], 0.0
    for turn, length in zip(q, LINKS, strict=True):
        angle += turn
        points.append(points[-1] + length * np.array([np.cos(angle), np.sin(angle), 0.0]))
    return list(pairwise(points))


def to_cylinder(point, start, end):
    """Distance of a point from a solid cylinder of the links' radius, by its axis."""
    axis, length = end - start, float(np.linalg.norm(end - start))
    along = float((point - start) @ axis) / length
    across = float(np.linalg.norm(point - start - along * axis / length))
    beyond, beside = max(-along, along - length, 0.0), max(across - THICK, 0.0)
    if beyond or beside:
        return float(np.hypot(beyond, beside))
    return max(-along, along - length, across - THICK)


@pytest.mark.req("LANG-34")
@pytest.mark.parametrize("seed", range(3))
def test_distances_from_balls_are_those_of_the_closed_form(arm, seed):
    rng = np.random.default_rng([2024, seed])
    for _ in range(40):
        q = rng.choice([0.0, np.pi / 2, -1e-16, 1.0], 3) + rng.choice([0.0, 1.0]) * rng.normal(size=3)
        centre = rng.uniform(-1.2, 1.2, 3) * [1, 1, rng.choice([0.0, 0.3])]
        ball = obstacle("Ball", Sphere(0.05), tuple(centre.tolist()))
        (found,) = Clearances(arm, scene_of(ball)).answer(asked(q, "ball"), 0.0, PLACE)
        expected = min(to_cylinder(centre, start, end) for start, end in cylinders(q)) - 0.05
        # A centre inside a link: nothing but the sign is compared, the depth has several ways out.
        if expected > -0.05:
            assert found == pytest.approx(expected, abs=2e-8), (seed, q, centre)
        else:
            assert found < 0.0


@pytest.mark.req("LANG-34")
def test_a_group_is_as_near_as_its_nearest_member(arm):
    near = obstacle("near", Sphere(0.1), (1.5, 0.0, 0.0))
    wall = obstacle("Wall", Box((0.2, 4.0, 4.0)), (2.0, 0.0, 0.0), (0.0, 0.0, np.pi))
    told = Clearances(arm, scene_of(near, wall, both=("near", "wall")))
    distance = {
        name: told.answer(asked(np.zeros(3), name), 0.0, PLACE)[0] for name in ("near", "WALL", "Both")
    }
    assert distance == {
        "near": pytest.approx(0.4, abs=1e-9),
        "WALL": pytest.approx(0.9, abs=1e-9),
        "Both": pytest.approx(0.4, abs=1e-9),
    }


@pytest.mark.req("LANG-34")
def test_the_same_answer_whatever_was_asked_before(arm):
    scene = scene_of(obstacle("a", Box((0.3, 0.2, 0.4)), (0.5, 0.5, 0.0), (0.3, 0.2, 0.1)))
    postures = [np.array(q) for q in [(0, 0, 0), (1.5, 0, 0), (0.8, 0.1, -0.3), (0, 0, 1e-16), (-2, 1, 1)]]
    alone = [Clearances(arm, scene).answer(asked(q, "a"), 0.0, PLACE) for q in postures]
    for order in permutations(range(len(postures))):
        told = Clearances(arm, scene)
        assert [told.answer(asked(postures[k], "a"), 0.0, PLACE) for k in order] == [alone[k] for k in order]


@pytest.mark.req("LANG-64")
def test_names_that_the_scene_lacks(arm):
    scene = scene_of(obstacle("Wall", Sphere(0.1), (2.0, 0.0, 0.0)))
    with pytest.raises(PacingError, match="IRL573") as caught:
        Clearances(arm, scene).answer(asked(np.zeros(3), "wal"), 0.0, PLACE)
    assert caught.value.reason.place == PLACE
    assert caught.value.reason.message == "the cell has no obstacle or group 'wal'; did you mean 'Wall'?"
    with pytest.raises(PacingError, match="IRL573"):
        pairs_of("x", arm, Scene(), PLACE)


@pytest.mark.req("LANG-64")
def test_a_robot_without_shapes(arm):
    scene = scene_of(obstacle("Wall", Sphere(0.1), (2.0, 0.0, 0.0)))
    bare = replace(arm.description, solids={"base_link": arm.description.solids["base_link"]})
    with pytest.raises(PacingError, match="IRL574") as caught:
        pairs_of("wall", Kinematics(bare), scene, PLACE)
    assert caught.value.reason.message == (
        "nothing tells how far planar3 is from 'wall': none of its links that move has a shape"
    )
    assert len(pairs_of("wall", arm, scene, PLACE)) == len(LINKS)


# ---- the pacer


@pytest.fixture
def pacer(arm):
    infinite = np.full(3, np.inf)
    limits = JointLimits(-infinite, infinite, -infinite, infinite, -infinite, infinite)
    ball = obstacle("Ball", Sphere(0.1), (1.5, 0.0, 0.0))
    scene = scene_of(ball, replace(ball, name="Other"), all=("ball", "other"))
    setup = PacingSetup(arm, limits, np.ones(3), np.array([0.3, 0.4, 0.5]), 0.01, scene=scene)
    return Pacer(setup, lambda o: Place.in_text(TEXT, Span(o.start, o.end)))


def switch(name, active=True):
    return ObstacleBlock(id=1, origin=HERE, name=name, active=active)


@pytest.mark.req("LANG-64")
def test_the_pacer_keeps_what_is_on(pacer):
    for block in (switch("Ball"), switch("Other"), switch("all"), switch("BALL")):
        pacer.execute(block)
    assert sorted(pacer.options.obstacles) == ["all", "ball", "other"]
    assert pacer.options.obstacles["ball"].name == "BALL"
    for block in (switch("other", active=False), switch("All", active=False)):
        pacer.execute(block)
    assert list(pacer.options.obstacles) == ["ball"]


@pytest.mark.req("LANG-64")
@pytest.mark.parametrize("active", [True, False])
def test_the_pacer_refuses_other_names_and_stays_as_it_was(pacer, active):
    before = pacer.options
    with pytest.raises(PacingError, match="IRL573") as caught:
        pacer.execute(switch("bal", active))
    assert caught.value.reason.place.line == 1
    assert pacer.options is before


@pytest.mark.req("LANG-34")
def test_the_pacer_answers(pacer):
    (found,) = pacer.answer(asked(np.zeros(3), "all"))
    assert found == pytest.approx(0.4, abs=1e-9)
    assert isinstance(found, float)


@pytest.mark.req("LANG-60")
def test_options_end_in_any_order():
    names = ("a", "B", "c")
    options = Options()
    for name in names:
        options = options.after(switch(name), np.zeros(3))
    for order in permutations(names):
        left = options
        for count, name in enumerate(order, 1):
            left = left.after(switch(name.swapcase(), active=False), np.zeros(3))
            assert set(left.obstacles) == {other.casefold() for other in order[count:]}
    assert options.after(switch("x", active=False), np.zeros(3)) == options
