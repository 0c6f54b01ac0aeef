"""Obstacles switched on one after another: what is told of each, and what making ready all of them costs."""

from __future__ import annotations

import numpy as np
import pytest

from drawn_scenes import cell_of
from irlx.blocks import ObstacleBlock, Origin
from irlx.diagnostics import Place, SourceText, Span
from irlx.pacing import kept_clear
from irlx.pacing.errors import PacingError
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere

TEXT = SourceText("cell.irl", "-\n")
ORIGIN = Origin("cell", 0, 1, 1)


def ball(name: str, x: float, margin: float = 0.01) -> Obstacle:
    return Obstacle(name, (Solid(Sphere(0.05)),), Placement((x, 0.45, 0.75)), margin, margin + 0.3)


def pacer_among(*obstacles: Obstacle) -> Pacer:
    cell, kinematics = cell_of("arm7")
    scene = Scene({obstacle.name: obstacle for obstacle in obstacles})
    setup = PacingSetup(kinematics, cell.limits, np.ones(7), cell.start, 0.01, scene=scene)
    return Pacer(setup, lambda origin: Place.in_text(TEXT, Span(origin.start, origin.end)))


def switch_on(pacer: Pacer, *names: str) -> None:
    for number, name in enumerate(names, start=1):
        pacer.execute(ObstacleBlock(id=number, origin=ORIGIN, name=name, active=True))


def test_switching_on_costs_each_obstacle_once(monkeypatch) -> None:
    """As many pairs of solids are made ready in all as there are, and once more when something asks."""
    made: list[int] = []

    class Counted(Distances):
        def __init__(self, kinematics, pairs, sightings=None) -> None:
            made.append(len(pairs))
            super().__init__(kinematics, pairs, sightings)

    monkeypatch.setattr(kept_clear, "Distances", Counted)
    names = [f"ball{number}" for number in range(12)]
    pacer = pacer_among(*(ball(name, 2.0 + 0.2 * number) for number, name in enumerate(names)))
    switch_on(pacer, *names)
    assert len(made) == 12
    assert len(set(made)) == 1
    clearance = pacer.clearance
    assert clearance is not None
    assert list(dict.fromkeys(pair.other for pair in clearance.distances.pairs)) == names
    assert pacer.clearance is clearance
    assert made[12:] == [sum(made[:12])]


@pytest.mark.req("MOT-22")
def test_only_the_obstacle_that_is_switched_on_is_told_of() -> None:
    near = ball("near", 0.25, margin=0.5)
    pacer = pacer_among(near, ball("far", 2.0), ball("other", 0.25, margin=0.4))
    switch_on(pacer, "near")
    told = [warning.message for warning in pacer.warnings]
    assert told
    assert all("near" in message for message in told)
    switch_on(pacer, "far")
    assert [warning.message for warning in pacer.warnings] == told
    switch_on(pacer, "other")
    later = [warning.message for warning in pacer.warnings][len(told) :]
    assert later
    assert all("other" in message for message in later)


def test_an_obstacle_in_the_robot_is_refused_while_others_are_on() -> None:
    cell, kinematics = cell_of("arm7")
    place = Placement(tuple(float(c) for c in kinematics.tool_pose(cell.start)[1]))
    inside = Obstacle("inside", (Solid(Sphere(0.2)),), place, 0.01, 0.3)
    pacer = pacer_among(ball("far", 2.0), inside)
    switch_on(pacer, "far")
    with pytest.raises(PacingError) as refused:
        switch_on(pacer, "inside")
    assert refused.value.reason.code == "IRL562"
