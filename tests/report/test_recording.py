"""What is recorded: one row a tick from the start on, quaternions without jumps, samples as in the run."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from irlx.blocks import JointTarget, MotionLaw, MoveBlock, MoveKind, Origin
from irlx.pacing.executed import Executed
from irlx.pacing.rows import MotionRows
from irlx.report.recorder import Recorder
from irlx.report.recording import Recording
from irlx.report.samples import Samples
from irlx.robot.limits import JointLimits
from irlx.streams.joint_stream import FORMAT_VERSION, StreamHeader

START = np.array([0.1, 0.2])
LAW = MotionLaw(speed=1.0, acc=1.0, speed_ori=1.0, acc_ori=1.0)


def header() -> StreamHeader:
    bounds = JointLimits.unlimited(2).with_pair("position", -np.ones(2), np.ones(2))
    names, units = ("a", "b"), ("rad", "m")
    return StreamHeader(
        FORMAT_VERSION,
        "0",
        "p.irl",
        "ab",
        "c.toml",
        "r",
        "r",
        "f",
        "tip",
        names,
        units,
        4_000_000,
        bounds,
        (1.0, 1.0),
    )


def motion(number: int, first_tick: int, q: np.ndarray, angles: np.ndarray) -> MotionRows:
    """Rows at q, the tool at (q, 0) turned about x by the angles; the last row is a hold."""
    origin = Origin("p.irl", 0, 1, 1)
    target = JointTarget((0.0, 0.0))
    block = MoveBlock(id=number, origin=origin, kind=MoveKind.PTP, target=target, law=LAW)
    held = np.vstack([q, q[-1:]])
    turn = Rotation.from_euler("x", np.append(angles, angles[-1])[:, None]).as_matrix()
    position = np.column_stack([held, np.zeros(len(held))])
    error = np.linspace(0.0, number * 1e-9, len(held))
    flags = np.zeros((len(held), 2), dtype=np.int8)
    return MotionRows(
        block, first_tick, held, position, turn, error, 2 * error, flags, np.arange(len(held)) * 1.0, 1.0, 3
    )


def recorded() -> tuple[Recording, list[MotionRows]]:
    """A recording of two motions that turn the tool all the way round, and more."""
    recording = Recording(header(), START, np.eye(3), np.array([0.1, 0.2, 0.0]))
    first = motion(1, 1, START + np.linspace(0.02, 0.2, 10)[:, None], np.linspace(0.5, 5.0, 10))
    second = motion(2, 12, first.q[-1] - np.linspace(0.05, 0.2, 4)[:, None], np.linspace(5.5, 9.0, 4))
    return recording, [first, second]


def test_rows_start_at_tick_0_and_carry_their_block() -> None:
    recording, motions = recorded()
    for rows in motions:
        recording.add(Executed(rows.block, rows.first_tick - 1, rows))
    run = recording.finish(True, ())
    np.testing.assert_array_equal(run.q, np.vstack([START, motions[0].q, motions[1].q]))
    assert run.block.tolist() == [0] + [1] * 11 + [2] * 5
    np.testing.assert_allclose(run.t, 0.004 * np.arange(17), atol=1e-15)
    assert run.summary.samples == 17
    assert run.summary.moves == 2
    assert run.summary.duration == pytest.approx(16 * 0.004)
    assert run.summary.path_position_error == 2e-9
    assert run.summary.path_orientation_error == 4e-9
    assert run.summary.iterations_per_tick == pytest.approx(6 / 16)
    assert [(record.tick, record.block.id) for record in run.stream.records] == [(0, 1), (11, 2)]


def test_rates_are_backward_differences_from_rest() -> None:
    recording, motions = recorded()
    for rows in motions:
        recording.add(Executed(rows.block, rows.first_tick - 1, rows))
    run = recording.finish(True, ())
    before = START
    speed_before = np.zeros(2)
    for q, qd, qdd in zip(run.q, run.qd, run.qdd, strict=True):
        speed = (q - before) / 0.004
        np.testing.assert_allclose(qd, speed, atol=1e-12)
        np.testing.assert_allclose(qdd, (speed - speed_before) / 0.004, atol=1e-9)
        before, speed_before = q, speed


@pytest.mark.req("STR-01")
def test_quaternions_are_unit_and_do_not_change_sign() -> None:
    recording, motions = recorded()
    for rows in motions:
        recording.add(Executed(rows.block, rows.first_tick - 1, rows))
    quaternions = recording.finish(True, ()).tool[:, 3:]
    np.testing.assert_allclose(np.linalg.norm(quaternions, axis=1), 1.0, atol=1e-15)
    assert np.all(np.sum(quaternions[1:] * quaternions[:-1], axis=1) > 0.0)
    angles = np.concatenate([[0.0], np.linspace(0.5, 5.0, 10), [5.0], np.linspace(5.5, 9.0, 4), [9.0]])
    wanted = np.column_stack([np.sin(angles / 2), 0 * angles, 0 * angles, np.cos(angles / 2)])
    np.testing.assert_allclose(quaternions, wanted, atol=1e-12)


@pytest.mark.req("MOT-10")
def test_samples_taken_motion_by_motion_are_those_of_the_run() -> None:
    whole, motions = recorded()
    waiting = Samples(header())
    lazy = Recorder(header(), START, np.eye(3), np.array([0.1, 0.2, 0.0]), (waiting,))
    samples = list(waiting.new())
    assert len(samples) == 1
    for rows in motions:
        whole.add(Executed(rows.block, rows.first_tick - 1, rows))
        lazy.add(Executed(rows.block, rows.first_tick - 1, rows))
        samples += waiting.new()
    assert list(waiting.new()) == []
    run = whole.finish(True, ())
    assert [sample.tick for sample in samples] == list(range(17))
    for k, sample in enumerate(samples):
        assert sample.t == run.t[k]
        assert sample.block == run.block[k]
        for name in ("q", "qd", "qdd", "tool"):
            np.testing.assert_array_equal(getattr(sample, name), getattr(run, name)[k], err_msg=f"{name} {k}")
