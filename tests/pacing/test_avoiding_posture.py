"""POSTURE(pose, obstacle): the posture of a pose that keeps best clear, and the circle that finds it, too."""

import numpy as np
import pytest

import irlx
from irlx.cell.load import load_cell
from irlx.pacing.avoiding_posture import _room
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.scene.distances import Distances
from irlx.scene.watched_pair import watched_pairs
from irlx.transform.step_bounds import BoundSource

PROGRAM = """PROGRAM away;
VAR POSE: p; MAIN_JOINT: best;
BEGIN
  p := FK(R_JOINT_ACT);
  best := POSTURE(p, {name});
  RECONFIGURATION best;
  WRITELN(CLEARANCE(R_JOINT_ACT, {name}));
ENDPROGRAM;
"""
CIRCLE = """PROGRAM round;
BEGIN
  OBSTACLE block;
  MOVE_INC CIRCLE POSITION(0.1, 0, 0), POSITION(0.1, 0.1, 0) ANGLE := 360 SPEED := 0.1;
  OBSTACLEEND block;
  WRITELN(CLEARANCE(R_JOINT_ACT, block));
ENDPROGRAM;
"""
CELL = """[robot]
model = "arm7"
[[obstacle]]
name = "block"
shape = "sphere"
radius = 50
xyz = [149, {y}, {z}]
margin = 10
influence = 300
"""


def run(folder, text, y=-20, z=760):
    (folder / "p.toml").write_text(CELL.format(y=y, z=z), encoding="utf-8")
    (folder / "p.irl").write_text(text, encoding="utf-8")
    result = irlx.run(folder / "p.irl")
    return result, float(result.output)


def fibre(kinematics, q, steps, size):
    """Postures of the same tool pose, by small steps along the null space both ways, each put back on it."""
    target = kinematics.target(*kinematics.tool_pose(q))
    for sign in (1.0, -1.0):
        here, way = q.copy(), None
        for _ in range(steps):
            _, jacobian = kinematics.difference(here, target)
            null = np.linalg.svd(jacobian)[2][-1]
            way = sign * null if way is None else null * np.sign(null @ way)
            here = here + size * way
            for _ in range(4):
                left, jacobian = kinematics.difference(here, target)
                here = here + np.linalg.pinv(jacobian) @ left
            yield here


@pytest.mark.req("TRF-16")
def test_no_posture_near_by_keeps_clearer(tmp_path):
    """With one redundant joint the fibre of a pose is a curve: looked through on both sides."""
    result, told = run(tmp_path, PROGRAM.format(name="block"))
    cell = load_cell(tmp_path / "p.toml")
    kinematics = Kinematics(cell.robot)
    pairs = watched_pairs(kinematics, cell.scene.obstacles.values(), None)
    distances = Distances(kinematics, pairs)

    def clearance(q):
        return float(np.min(distances.of(q, np.arange(len(pairs))).distance))

    before, behind = clearance(result.q[0]), clearance(result.q[-1])
    assert told == pytest.approx(behind * 1e3, abs=1e-9)
    assert behind > before + 0.005
    assert np.linalg.norm(kinematics.tool_pose(result.q[-1])[1] - kinematics.tool_pose(result.q[0])[1]) < 1e-6
    # The posture term still draws a little: not the very best of the fibre, but nearly.
    best = max(clearance(q) for q in fibre(kinematics, result.q[0], 60, 0.01))
    assert behind > before + 0.8 * (best - before)


@pytest.mark.req("TRF-16")
def test_a_tiny_circle_leads_away_as_well(tmp_path):
    plain, _ = run(tmp_path, CIRCLE.replace("OBSTACLE block;", "").replace("OBSTACLEEND block;", ""))
    result, told = run(tmp_path, CIRCLE)
    assert result.clearances.smallest is not None
    assert told > result.clearances.smallest.distance * 1e3 + 0.5
    assert np.max(np.abs(result.tool[-1] - result.tool[0])) < 1e-6
    assert np.max(np.abs(plain.q[-1] - plain.q[0])) < 1e-4
    assert np.max(np.abs(result.q[-1] - result.q[0])) > 1e-2


def test_where_no_posture_is_clear_a_warning_says_so(tmp_path):
    result, told = run(tmp_path, PROGRAM.format(name="block"), y=200, z=760)
    assert [found.code for found in result.diagnostics if found.code == "IRL565"] == ["IRL565"]
    assert told < 10.0


@pytest.mark.req("TRF-16")
def test_a_tick_goes_no_further_than_the_criterion_is_itself_and_keeps_the_limits():
    """5E-2 each way, less where a limit is nearer; each bound is one of position."""
    inf = np.full(3, np.inf)
    limits = JointLimits(np.full(3, -1.0), np.full(3, 1.0), -inf, inf, -inf, inf)
    room = _room(np.array([0.0, 0.98, -0.97]), limits)
    np.testing.assert_allclose(room.lower, [-0.05, -0.05, -0.03])
    np.testing.assert_allclose(room.upper, [0.05, 0.02, 0.05])
    assert room.lower_source.tolist() == room.upper_source.tolist() == [BoundSource.POSITION] * 3
