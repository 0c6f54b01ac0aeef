"""Obstacles that move: the arm makes room for them while the tool keeps its line."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.cell.load import load_cell
from irlx.robot.kinematics import Kinematics
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle, Waypoint
from irlx.scene.trajectory import Trajectory
from irlx.scene.watched_pair import watched_pairs
from irlx.solids.placement import Placement
from irlx.solids.shape import Solid, Sphere

PROGRAM = """PROGRAM ball;
BEGIN
  {on}
  MOVE_INC LIN POSITION(0, 160, 0) SPEED := 30;
  {off}
ENDPROGRAM;
"""
CELL = """
[robot]
model = "arm7"
[robot.self_collision]
active = false
[motion]
tick_ms = {tick}
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 60
margin = 10
influence = 150
trajectory = [{{ time = 0, xyz = [149, -600, 660] }}, {{ time = 4, xyz = [149, 400, 660] }}]
"""


def run(folder, avoiding, tick=10):
    (folder / "ball.toml").write_text(CELL.format(tick=tick), encoding="utf-8")
    on, off = ("OBSTACLE ball;", "OBSTACLEEND ball;") if avoiding else ("", "")
    (folder / "ball.irl").write_text(PROGRAM.format(on=on, off=off), encoding="utf-8")
    return irlx.run(folder / "ball.irl")


def test_places_on_a_trajectory():
    turned = Rotation.from_rotvec([0.0, 0.0, 2.0])
    points = (
        Waypoint(1.0, Placement((0.0, 0.0, 0.0))),
        Waypoint(3.0, Placement((1.0, 2.0, 3.0), tuple(turned.as_quat()))),
        Waypoint(4.0, Placement((1.0, 2.0, 5.0), tuple(turned.as_quat()))),
    )
    way = Trajectory(Obstacle("o", (Solid(Sphere(0.1)),), points[0].placement, 0.0, 0.1, points))
    for time, place, angle in ((0.0, (0, 0, 0), 0.0), (1.5, (0.25, 0.5, 0.75), 0.5), (3.0, (1, 2, 3), 2.0)):
        pose = way.pose(time)
        assert pose.translation == pytest.approx(np.array(place, dtype=float), abs=1e-14)
        expected = Rotation.from_rotvec([0.0, 0.0, angle]).as_matrix()
        assert pose.rotation == pytest.approx(expected, abs=1e-14)
    assert way.pose(3.5).translation == pytest.approx([1.0, 2.0, 4.0], abs=1e-14)
    assert way.pose(99.0).translation == pytest.approx([1.0, 2.0, 5.0], abs=1e-14)
    # 2 m/s in the second piece; in the first one the way and the turn of a point 1.5 m out.
    assert way.fastest(1.5) == pytest.approx(max((np.sqrt(14.0) + 2.0 * 1.5) / 2.0, 2.0))


def smallest_distance(cell, result):
    """Smallest distance (m) of arm and ball over a run, every pair looked at in every sample."""
    loaded = load_cell(cell)
    kinematics = Kinematics(loaded.robot)
    pairs = watched_pairs(kinematics, loaded.scene.obstacles.values(), None)
    smallest = np.inf
    for time, q in zip(result.t.tolist(), result.q, strict=True):
        distances = Distances(kinematics, pairs)
        distances.at_time(time)
        smallest = min(smallest, float(np.min(distances.of(q, np.arange(len(pairs))).distance)))
    return smallest


@pytest.mark.req("TRF-13")
@pytest.mark.parametrize("tick", [*(pytest.param(tick, marks=pytest.mark.slow) for tick in (5, 20)), 40])
def test_the_elbow_makes_room_for_a_ball(tmp_path, tick):
    plain, avoiding = run(tmp_path, False, tick), run(tmp_path, True, tick)
    near = avoiding.clearances
    assert near.smallest is not None
    assert near.smallest.other == "ball"
    assert near.smallest.distance >= 0.010 - 1e-6
    # The same line, at the same pace but for a hundredth.
    assert avoiding.summary.path_position_error < 1e-6
    assert avoiding.summary.duration <= plain.summary.duration * 1.01
    assert plain.clearances.smallest is None
    # Without OBSTACLE the ball would run into the arm.
    assert smallest_distance(tmp_path / "ball.toml", plain) < -0.05
    assert smallest_distance(tmp_path / "ball.toml", avoiding) == pytest.approx(near.smallest.distance)
    report = irlx.verify(avoiding, program=tmp_path / "ball.irl", cell=tmp_path / "ball.toml")
    assert report.passed, str(report)


def test_a_wall_that_comes_too_near_to_a_robot_that_waits_is_told(tmp_path):
    """A half-space is a wall without an end, and moves like any other obstacle."""
    cell = CELL.format(tick=50).replace('"sphere"\nradius = 60', '"halfspace"')
    cell = cell[: cell.index("trajectory")] + (
        "trajectory = [{ time = 0, xyz = [1500, 0, 0], rpy = [0, -90, 0] },"
        " { time = 4, xyz = [400, 0, 0], rpy = [0, -90, 0] }]\n"
    )
    (tmp_path / "ball.toml").write_text(cell, encoding="utf-8")
    text = PROGRAM.format(on="OBSTACLE ball;\n  WAIT 4 SEC;", off="OBSTACLEEND ball;")
    (tmp_path / "ball.irl").write_text(text, encoding="utf-8")
    with pytest.raises(irlx.RunError, match="IRL561: while it waits"):
        irlx.run(tmp_path / "ball.irl")
