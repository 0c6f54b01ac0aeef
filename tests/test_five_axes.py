"""programs/five_axes: a 5-axis arm with limits of position, speed and acceleration, and an obstacle."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import irlx
from irb6_by_hand import pose, posture, wrist_axes
from irlx.blocks import MoveBlock, MoveKind, PoseTarget
from irlx.promises import CLOSURE, PATH_ORIENTATION, PATH_POSITION
from nearness import least, nearest

pytestmark = pytest.mark.req("TRF-21")

FOLDER = Path(__file__).parents[1] / "programs" / "five_axes"
PROGRAM, CELL = FOLDER / "five_axes.irl", FOLDER / "five_axes.toml"


@pytest.fixture(scope="module")
def run() -> irlx.Run:
    return irlx.run(PROGRAM)


def rows_of(run: irlx.Run, line: int) -> np.ndarray:
    """Postures of the move of a line of the program, from the row before it on."""
    ticks = [record.tick for record in run.stream.records]
    number = next(
        k
        for k, record in enumerate(run.stream.records)
        if isinstance(record.block, MoveBlock) and record.block.origin.line == line
    )
    end = next((tick for tick in ticks[number + 1 :] if tick > ticks[number]), len(run.q) - 1)
    return run.q[ticks[number] : end + 1]


def line_of(text: str) -> int:
    lines = PROGRAM.read_text(encoding="utf-8").splitlines()
    return next(number for number, line in enumerate(lines, start=1) if text in line)


def test_it_runs_and_verifies(run) -> None:
    assert run.complete
    assert run.summary.moves >= 10
    assert [d for d in run.diagnostics if d.is_error] == []
    assert [d for d in irlx.check(PROGRAM, motion=True) if d.is_error] == []
    report = irlx.verify(run, program=PROGRAM, cell=CELL)
    assert report.passed, str(report)
    assert run.summary.path_position_error < PATH_POSITION
    assert run.summary.path_orientation_error < PATH_ORIENTATION


def test_every_posture_is_the_one_of_its_pose_on_paper(run) -> None:
    for q in run.q[::7]:
        rotation, position = pose(q)
        np.testing.assert_allclose(posture(rotation, position), q, atol=1e-12)


@pytest.mark.parametrize("text", ["MOVE CIRCLE across, last", "MOVE CIRCLE side_2, side_1"])
def test_about_the_axis_of_the_base_joint_1_alone_turns(run, text: str) -> None:
    rows = rows_of(run, line_of(text))
    assert np.max(np.abs(rows[:, 1:] - rows[0, 1:])) < 1e-12
    assert abs(np.degrees(rows[-1, 0] - rows[0, 0])) == pytest.approx(50.0 if "last" in text else 60.0)


def test_targets_are_met_in_all_that_they_give(run) -> None:
    """Also in the lean, which no row of a tick asks for."""
    met = 0
    for record in run.stream.records:
        block = record.block
        if not (isinstance(block, MoveBlock) and isinstance(block.target, PoseTarget)) or block.blend:
            continue
        if block.kind is MoveKind.SPLINE or block.target.orientation is None:
            continue
        rotation, position = pose(rows_of(run, block.origin.line)[-1])
        np.testing.assert_allclose(position, block.target.position, atol=1e-9)
        x, y, z, w = block.target.orientation
        asked = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)])
        np.testing.assert_allclose(rotation[:, 0], asked, atol=1e-9)
        met += 1
    assert met >= 7


def test_limits_hold_while_they_are_on(run) -> None:
    on, off = line_of("JOINTACCELLIMIT softest"), line_of("JOINTACCELLIMITEND")
    ticks = [r.tick for r in run.stream.records if on <= r.block.origin.line <= off]
    dt = run.header.tick_ns * 1e-9
    qd = np.diff(run.q[ticks[0] : ticks[-1] + 1], axis=0) / dt
    qdd = np.diff(qd, axis=0) / dt
    fastest, hardest = np.radians([40, 30, 30, 60, 90]), np.radians([150, 150, 150, 200, 400])
    assert np.max(np.abs(qd) / fastest) <= 1.0 + 1e-9
    assert np.max(np.abs(qdd) / hardest) <= 1.0 + 1e-9
    # They count for something: without them joints are faster.
    assert np.max(np.abs(qdd) / hardest) > 0.9


def test_the_posture_returns_and_the_post_is_kept_clear(run) -> None:
    (back,) = run.summary.returns
    assert back.largest < CLOSURE
    assert least(nearest(run, CELL)) >= 0.020


def test_a_lean_is_what_a_fifth_axis_lacks(run) -> None:
    """On a line whose ends it meets, it is off what the line asks for by turns about the third axis alone."""
    rows = rows_of(run, line_of("MOVE LIN side_3"))
    assert np.max(np.abs(np.diff(rows, axis=0))) > 0.0
    n = np.array([wrist_axes(q)[:, 2] for q in rows])
    # That axis itself turns on the way: no frame at rest could tell what is missing.
    assert np.degrees(np.arccos(n[0] @ n[-1])) > 5.0
