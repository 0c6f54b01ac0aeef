"""programs/two_arms: a pipe in one hand, a torch in the other, both moving: told by Pinocchio's reader."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.blocks import MoveBlock
from irlx.cell.packaged import packaged_urdf
from irlx.promises import CLOSURE, CONDITION, PATH_POSITION
from nearness import nearest

pytestmark = pytest.mark.req("TRF-23")

FOLDER = Path(__file__).parents[1] / "programs" / "two_arms"
CELL = FOLDER / "two_arms.toml"
RADIUS, HEIGHT, LEAN = 0.025, 0.005, np.radians(40.0)
SLOW = np.radians(6.0)
TURNED = Rotation.from_euler("x", -90, degrees=True)


@cache
def run() -> irlx.Run:
    return irlx.run(FOLDER / "two_arms.irl")


@cache
def hands() -> tuple[pin.Model, int, int]:
    model = pin.buildModelFromXML(packaged_urdf("dual14"))
    found = (model.getFrameId(name, pin.FrameType.BODY) for name in ("left_hand", "torch"))
    return model, *found


def poses(q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Rotations and positions of the torch as the pipe sees it, the torch's axis in the world, the hand's
    position there, for rows of q."""
    model, hand, torch = hands()
    data = model.createData()
    pipe = pin.SE3(TURNED.as_matrix(), np.array([0.0, 0.08, 0.0]))
    found = []
    for row in q:
        pin.framesForwardKinematics(model, data, row)
        seen = (data.oMf[hand] * pipe).actInv(data.oMf[torch])
        parts = seen.rotation, seen.translation, data.oMf[torch].rotation[:, 2], data.oMf[hand].translation
        found.append([np.array(part) for part in parts])
    return tuple(np.array(parts) for parts in zip(*found, strict=True))


def rows_of(line: int, kind: str = "MoveBlock") -> slice:
    """The rows of the statement in a line, the one before them included."""
    records = run().stream.records
    own = [one for one in records if one.block.origin.line == line and type(one.block).__name__ == kind]
    last = np.flatnonzero(np.isin(run().stream.block, [one.block.id for one in own]))[-1]
    return slice(own[0].tick, int(last) + 1)


def line_of(words: str, which: int = 0) -> int:
    text = (FOLDER / "two_arms.irl").read_text(encoding="utf-8").splitlines()
    return [number for number, line in enumerate(text, 1) if words in line][which]


WELD, PASS = line_of("MOVE CIRCLE"), line_of("MOVE CIRCLE", 1)


def test_it_runs_without_a_word_and_verifies() -> None:
    assert run().complete
    assert [str(told) for told in run().diagnostics] == []
    assert irlx.check(FOLDER / "two_arms.irl", cell=CELL) == []
    assert irlx.verify(run(), program=FOLDER / "two_arms.irl", cell=CELL).passed
    moves = [one.block for one in run().stream.records if isinstance(one.block, MoveBlock)]
    assert len(moves) >= 10
    assert {"pipe"} <= {move.frame.name for move in moves if move.frame is not None}


def test_the_torch_is_on_the_seam_while_both_hands_move() -> None:
    weld = run().q[rows_of(WELD)]
    rotation, position, _, hand = poses(weld)
    off = np.hypot(np.hypot(*position[:, :2].T) - RADIUS, position[:, 2] - HEIGHT)
    assert off.max() <= PATH_POSITION
    angles = np.unwrap(np.arctan2(position[:, 1], position[:, 0]))
    assert angles[-1] - angles[0] == pytest.approx(2 * np.pi, abs=1e-6)
    # The lean is that of the points, and hardly less between them.
    lean = np.arccos(-rotation[:, 2, 2])
    assert lean.max() == pytest.approx(LEAN, abs=1e-6)
    assert lean.min() > np.radians(36)
    moved = [np.ptp(part, axis=0).max() for part in (weld[:, :7], weld[:, 7:])]
    assert min(moved) > 0.05
    assert np.ptp(hand, axis=0).max() > 0.01


def test_the_torch_points_straight_down_all_the_time() -> None:
    _, _, axis, _ = poses(run().q[::3])
    assert np.linalg.norm(np.cross(axis, [0.0, 0.0, -1.0]), axis=1).max() <= CONDITION
    assert (axis[:, 2] < 0.0).all()


def test_the_weld_ends_in_the_posture_of_both_arms_that_it_began_in() -> None:
    weld = run().q[rows_of(WELD)]
    assert np.ptp(weld, axis=0).max() > 0.3
    assert np.abs(weld[-1] - weld[0]).max() <= CLOSURE


def test_slow_joints_of_both_arms_slow_the_second_pass_on_its_arc() -> None:
    part = rows_of(PASS)
    q, dt = run().q[part], run().stream.header.dt
    speeds = np.abs(np.diff(q, axis=0)).max(axis=0) / dt
    assert speeds.max() <= SLOW * (1 + 1e-9)
    assert speeds[:7].max() == pytest.approx(SLOW, rel=2e-2)
    assert speeds[7:].max() == pytest.approx(SLOW, rel=2e-2)
    _, position, _, _ = poses(q)
    assert np.hypot(np.hypot(*position[:, :2].T) - RADIUS, position[:, 2] - HEIGHT).max() <= PATH_POSITION
    (slowed,) = run().summary.slowed
    assert slowed.line == PASS


def test_frozen_joints_of_the_left_shoulder_stand_bit_by_bit() -> None:
    part = run().q[rows_of(line_of("POSITION(0, 0, -60)"))]
    assert (part[:, :3] == part[0, :3]).all()
    assert np.ptp(part[:, 3:7], axis=0).max() > 0.02


def test_the_left_elbow_keeps_off_the_lamp() -> None:
    begin = rows_of(line_of("MOVE_INC LIN POSITION(0, 0, 60);")).start
    end = rows_of(line_of("RECONFIGURATION"), "ReconfigureBlock").start
    least = min(rows.min() for rows in nearest(run(), CELL, slice(begin, end)).values())
    assert least >= 0.050


def test_both_arms_come_home() -> None:
    assert run().q[-1] == pytest.approx(run().q[0], abs=1e-6)
    part = rows_of(line_of("RECONFIGURATION"), "ReconfigureBlock")
    ready = run().q[rows_of(line_of("MOVE LIN seam(0, 30)")).stop - 1]
    assert run().q[part.stop - 1] == pytest.approx(ready, abs=1e-6)
    _, position, _, _ = poses(run().q[part])
    assert np.abs(position - position[0]).max() <= PATH_POSITION


SHARED = """[robot]
model = "dual14"
weights = [%s]
[robot.self_collision]
active = false
[motion]
tick_ms = 20
speed = 50
[frames]
pipe = { link = "left_hand", xyz = [0, 80, 0], rpy = [-90, 0, 0] }
"""
LINE = "PROGRAM p; BEGIN MOVE_INC LIN POSITION(40, 0, 40), POSITION(-40, 0, -40) IN FRAME pipe; ENDPROGRAM\n"


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Callable[[float, float], irlx.Run]:
    """Runs in which the joints of one arm weigh more than those of the other."""
    return cache(partial(weighed, tmp_path_factory.mktemp("shared")))


def weighed(folder: Path, left: float, right: float) -> irlx.Run:
    weights = ", ".join(map(str, [left] * 7 + [right] * 7))
    (folder / "p.toml").write_text(SHARED % weights, encoding="utf-8")
    (folder / "p.irl").write_text(LINE, encoding="utf-8")
    found = irlx.run(folder / "p.irl")
    assert irlx.verify(found).passed
    return found


def left_share(found: irlx.Run) -> float:
    """The part of all that the joints go which those of the left arm go."""
    gone = np.abs(np.diff(found.q, axis=0)).sum(axis=0)
    return float(gone[:7].sum() / gone.sum())


def jacobian(q: np.ndarray) -> np.ndarray:
    """Of the position and turn of the torch as the pipe sees it, (6, 14), by central differences."""
    h, columns = 1e-6, []
    for step in h * np.eye(14):
        rotation, position, _, _ = poses(np.array([q - step, q + step]))
        turn = Rotation.from_matrix(rotation[1] @ rotation[0].T).as_rotvec()
        columns.append(np.concatenate([position[1] - position[0], turn]) / (2 * h))
    return np.column_stack(columns)


def test_weights_share_the_motion_between_the_arms(shared) -> None:
    alike, lazy_left, lazy_right = (left_share(shared(*pair)) for pair in ((1, 1), (10, 1), (1, 10)))
    assert 0.4 < alike < 0.6
    assert lazy_left < 0.35
    assert lazy_right > 0.75


@pytest.mark.parametrize(("left", "right"), [(1, 1), (10, 1), (1, 10)])
def test_each_step_is_the_least_of_all_that_lead_along_the_line(shared, left: float, right: float) -> None:
    q = shared(left, right).q
    inverse = np.repeat([1 / left, 1 / right], 7)
    for row in (20, 45):
        before, after = q[row - 1], q[row + 1]
        matrix = jacobian(q[row])
        way = poses(np.array([before, after]))[1]
        twist = np.concatenate([way[1] - way[0], np.zeros(3)])
        least = inverse * (matrix.T @ np.linalg.solve(matrix * inverse @ matrix.T, twist))
        assert after - before == pytest.approx(least, abs=2e-3 * np.linalg.norm(least))
