"""What comes nearest in every sample: what the ticks have looked at, and looked at again."""

from types import SimpleNamespace

import numpy as np
import pytest

import irlx
from irlx.cell.load import load_cell
from irlx.pacing.nearest_rows import FAR, nearest_of
from irlx.robot.kinematics import Kinematics
from irlx.scene.distances import Distances
from irlx.scene.watched_pair import WatchedPair, watched_pairs
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere

CELL = """
[robot]
model = "arm7"
[motion]
tick_ms = 20
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 60
margin = 10
influence = 150
trajectory = [{ time = 0, xyz = [149, -600, 660] }, { time = 4, xyz = [149, 400, 660] }]
[[obstacle]]
name = "post"
shape = "cylinder"
radius = 30
length = 400
margin = 15
influence = 120
xyz = [250, 330, 700]
"""
PROGRAM = """PROGRAM ball;
BEGIN
  {on}
  MOVE_INC LIN POSITION(0, 60, 0) SPEED := 30 C_CP := 20;
  MOVE_INC LIN POSITION(0, 0, 40) SPEED := 30;
  WAIT 0.3 SEC;
  MOVE_INC LIN POSITION(0, -40, 0) SPEED := 30;
ENDPROGRAM;
"""


def test_samples_have_the_pair_with_the_least_room(tmp_path):
    on = ("ball", "post")
    (tmp_path / "ball.toml").write_text(CELL, encoding="utf-8")
    switches = " ".join(f"OBSTACLE {name};" for name in on)
    (tmp_path / "ball.irl").write_text(PROGRAM.format(on=switches), encoding="utf-8")
    run = irlx.run(tmp_path / "ball.irl")
    cell = load_cell(tmp_path / "ball.toml")
    kinematics = Kinematics(cell.robot)
    pairs = watched_pairs(kinematics, [cell.scene.obstacles[name] for name in on], None)
    distances, every = Distances(kinematics, pairs), np.arange(len(pairs))
    found, near = run.clearances, 0
    for row in range(1, len(run.q)):
        distances.at_time(float(run.t[row]))
        here = distances.of(run.q[row], every).distance
        inside = here < distances.influence
        if not np.any(inside):
            assert found.pair[row] == -1
            continue
        near += 1
        nearest = int(np.argmin(np.where(inside, here - distances.margin, np.inf)))
        assert found.pairs[found.pair[row]] == (pairs[nearest].link, pairs[nearest].other)
        assert found.distance[row] == pytest.approx(here[nearest], abs=1e-12)
    assert near > 30
    # The hold rows between the moves, and the wait, are among them.
    assert len(run.q) > 150


def test_links_that_always_stand_at_the_influence_are_not_near():
    ball = Solid(Sphere(0.1), Placement())
    pair = WatchedPair("wrist", ball, "torch", ball, 0.005, 0.03)
    clearance = SimpleNamespace(distances=SimpleNamespace(pairs=(pair,)))
    found = nearest_of(clearance, [(0, 0.03 * (1.0 - 1e-13)), (0, 0.0299), None])
    assert found.pair.tolist() == [FAR, 0, FAR]
    np.testing.assert_array_equal(found.distance, [np.inf, 0.0299, np.inf])
    assert found.pairs == (("wrist", "torch"),)
