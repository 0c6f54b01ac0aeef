"""The reference motion is well inside what the robots can do: a plain least-motion walk along it."""

import numpy as np
import pytest

import irlx
from irlx.cell.load import load_cell
from irlx.cell.robot_data import robot_data_folder
from irlx.robot.kinematics import Kinematics
from reference_motion import (
    ACCELERATION,
    DURATION,
    LINE,
    RADIUS,
    SPEED,
    STARTS,
    reference_motion,
)

TICK = 0.01


def robots():
    missing = pytest.mark.skipif(
        robot_data_folder() is None, reason='the data package is missing: pip install "irlx[robots]"'
    )
    return [pytest.param(name, marks=missing if name == "panda" else ()) for name in STARTS]


def lengths(total):
    """Way at every tick of a trapezoid from rest to rest, m."""
    ramp = SPEED / ACCELERATION
    end = total / SPEED + ramp
    t = np.linspace(0.0, end, round(end / TICK) + 1)[1:]
    down = total - 0.5 * ACCELERATION * (end - t) ** 2
    up = np.where(t < ramp, 0.5 * ACCELERATION * t**2, SPEED * (t - 0.5 * ramp))
    return np.where(t > end - ramp, down, up)


def walk(motion, cell):
    """Postures (N, n), and the smallest singular value met: least motion without limits or solver."""
    kinematics, inverse = Kinematics(cell.robot), np.diag(1.0 / cell.weights)
    points = [motion.line_start - [0.0, way, 0.0] for way in lengths(LINE)]
    points += [motion.on_circle(way / RADIUS) for way in lengths(2 * np.pi * RADIUS)]
    q, rows, least = motion.start, [motion.start, motion.start], np.inf
    for point in points:
        target, old = kinematics.target(motion.rotation, point), q
        for _ in range(5):
            twist, jacobian = kinematics.difference(q, target)
            pull = inverse @ jacobian.T
            q = old + pull @ np.linalg.solve(jacobian @ pull, twist + jacobian @ (q - old))
        assert np.abs(kinematics.tool_pose(q)[1] - point).max() < 1e-9
        least = min(least, np.linalg.svd(jacobian, compute_uv=False)[-1])
        rows.append(q)
    return np.array([*rows, q]), least


def test_its_duration():
    assert pytest.approx(4.949, abs=5e-4) == DURATION


@pytest.mark.req("CELL-04")
@pytest.mark.parametrize("robot", robots())
def test_no_limit_of_the_robot_is_near(tmp_path, robot):
    motion = reference_motion(tmp_path, robot)
    cell = load_cell(motion.cell)
    rows, least = walk(motion, cell)
    assert least > 0.12
    limits = cell.limits
    assert np.minimum(rows - limits.position_lower, limits.position_upper - rows).min() > 0.4
    speeds = np.diff(rows, axis=0) / TICK
    assert (np.abs(speeds).max(axis=0) < 0.4 * limits.speed_upper).all()
    assert (np.abs(np.diff(speeds, axis=0) / TICK).max(axis=0) < 0.6 * limits.acceleration_upper).all()


@pytest.mark.req("CELL-04")
@pytest.mark.parametrize("robot", robots())
def test_the_line_runs(tmp_path, robot):
    motion = reference_motion(tmp_path, robot, tick_ms=10)
    text = motion.program.read_text(encoding="utf-8")
    motion.program.write_text(
        "".join(x for x in text.splitlines(True) if "CIRCLE" not in x), encoding="utf-8"
    )
    run = irlx.run(motion.program)
    assert run.complete
    assert run.diagnostics == ()
    assert np.abs(run.tool[-1, :3] - motion.line_end).max() < 1e-9
    assert irlx.verify(run, cell=motion.cell).passed


def test_bounds_of_single_joints(tmp_path):
    plain = load_cell(reference_motion(tmp_path, "rail6").cell).limits
    motion = reference_motion(
        tmp_path,
        "rail6",
        1.0,
        position={1: (-0.5, 0.25)},
        speed={1: 0.1, 4: 0.376},
        acceleration={2: 3.0},
        weights=range(1, 8),
    )
    cell = load_cell(motion.cell)
    assert cell.tick_ns == 1_000_000
    assert cell.weights.tolist() == [1, 2, 3, 4, 5, 6, 7]
    assert (cell.limits.position_lower[0], cell.limits.position_upper[0]) == (-0.5, 0.25)
    assert cell.limits.speed_upper[[0, 3]] == pytest.approx([0.1, 0.376], rel=1e-15)
    assert cell.limits.acceleration_lower[1] == pytest.approx(-3.0, rel=1e-15)
    kept = [1, 2, 4, 5, 6]
    assert cell.limits.position_upper[1:] == pytest.approx(plain.position_upper[1:], rel=1e-15)
    assert cell.limits.speed_upper[kept] == pytest.approx(plain.speed_upper[kept], rel=1e-15)
    every = load_cell(reference_motion(tmp_path, "arm7", acceleration=15.0).cell).limits
    assert every.acceleration_upper == pytest.approx([15.0] * 7, rel=1e-15)
    free = load_cell(reference_motion(tmp_path, "arm7", acceleration=False).cell).limits
    assert np.isinf(free.acceleration_upper).all()
