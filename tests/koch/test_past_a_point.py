"""What the monograph reports of experiment 6.6, a line past a point, as far as the rebuilt robot bears it.

The distance of the point from arm 4 is written out here: a cylinder of 0.13 m radius about the line between
joints 3 and 4.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import irlx

PROGRAMS = Path(__file__).parents[2] / "programs" / "koch"
POINT, RADIUS = np.array([5.4, 0.0, 6.6]), 0.13
SAME = [10, 20, 25, 40, 50]
AT_START = 0.972193
JOINT_9, JOINT_10 = 8, 9

every_tick = pytest.mark.parametrize(
    "tick", [pytest.param(tick, marks=() if tick == 50 else pytest.mark.slow) for tick in SAME]
)


def joints_3_and_4(q: np.ndarray, square) -> tuple[np.ndarray, np.ndarray]:
    """Where joints 3 and 4 are, (N, 3) m each: the arms to them alone, all behind them left out."""
    found = []
    for arms in (3, 4):
        at = np.zeros((len(q), 3))
        for k in reversed(range(arms)):
            at = at + square.offsets[k]
            if k:
                axis = np.eye(3)["xyz".index(square.axes[k - 1][-1])]
                angle = q[:, k - 1, None]
                turned = np.cross(np.broadcast_to(axis, at.shape), at)
                along = (at @ axis)[:, None] * axis
                at = np.cos(angle) * (at - along) + np.sin(angle) * turned + along
        found.append(at)
    return found[0], found[1]


def distances(run: irlx.Run, square) -> tuple[np.ndarray, np.ndarray]:
    """Of the point from the axis of arm 4 and from its cylinder, (N,) m, below 0 inside."""
    begin, end = joints_3_and_4(run.q, square)
    length = np.linalg.norm(end - begin, axis=1)
    unit = (end - begin) / length[:, None]
    along = np.sum(unit * (POINT - begin), axis=1)
    aside = np.linalg.norm(np.cross(unit, POINT - begin), axis=1)
    beyond = np.maximum(np.maximum(-along, along - length), 0.0)
    inside = np.maximum(aside - RADIUS, np.maximum(-along, along - length))
    outside = np.hypot(np.maximum(aside - RADIUS, 0.0), beyond)
    return np.hypot(aside, beyond), np.where(inside < 0.0, inside, outside)


def active(run: irlx.Run) -> set[tuple[str, str, str]]:
    return {(event.joint, event.kind, event.side) for event in run.summary.active}


def test_the_distance_written_out_is_that_of_points_on_the_cylinder(square) -> None:
    """Points spread over the solid of arm 4; in one posture the point is beside it, in one beyond an end."""
    rng = np.random.default_rng(66)
    q = np.zeros((2, 11))
    q[:, :4] = [[0.2, -1.0, -1.5, 1.0], [0.9, -1.4, 0.4, 0.0]]

    class Posture:
        pass

    Posture.q = q
    begin, end = joints_3_and_4(q, square)
    for row in range(2):
        unit = (end - begin)[row] / np.linalg.norm((end - begin)[row])
        first = np.cross(unit, [0.0, 0.0, 1.0])
        first /= np.linalg.norm(first)
        angle, share = rng.uniform(0, 2 * np.pi, 200_000), rng.uniform(0, 1, 200_000)
        radius = RADIUS * np.sqrt(rng.uniform(0, 1, 200_000))
        spread = np.outer(np.cos(angle) * radius, first) + np.outer(
            np.sin(angle) * radius, np.cross(unit, first)
        )
        points = begin[row] + share[:, None] * (end - begin)[row] + spread
        nearest = np.linalg.norm(points - POINT, axis=1).min()
        assert 0.0 <= nearest - distances(Posture, square)[1][row] < 0.02


@pytest.mark.req("TRF-13")
@every_tick
def test_without_the_option_arm_4_runs_into_the_point(experiment, square, tick: int) -> None:
    run = experiment("line", tick, "line")
    axis, shape = distances(run, square)
    assert axis[0] == pytest.approx(1.102, abs=1e-3)
    assert shape[0] == pytest.approx(AT_START, abs=1e-6)
    assert axis.min() == pytest.approx(0.0133, abs=3e-4)
    assert shape.min() == pytest.approx(-0.1167, abs=3e-4)
    contact = run.t[shape <= 0.0]
    assert contact[0] == pytest.approx(2.61, abs=tick / 1000.0)
    assert contact[-1] == pytest.approx(3.29, abs=tick / 1000.0)
    assert active(run) == set()


@pytest.mark.req("TRF-13")
@every_tick
def test_with_it_the_distance_never_falls_below_that_of_the_start(experiment, square, tick: int) -> None:
    run = experiment("obstacle", tick, "line")
    axis, shape = distances(run, square)
    assert shape.min() == shape[0]
    assert axis.min() == axis[0]
    assert shape.max() > 1.06
    assert run.summary.clearance.distance == pytest.approx(shape[1:].min(), abs=1e-6)


@pytest.mark.req("MOT-20")
@every_tick
def test_the_line_is_kept_and_takes_its_5_and_a_half_seconds(experiment, square, tick: int) -> None:
    run = experiment("obstacle", tick, "line")
    ticks = -(-5500 // tick)
    share = np.concatenate([[0.0], square.share_of_way(ticks, 5.0, 1.0, 2.0), [1.0]])
    demanded = np.array([11.5, 1.0, 3.5]) + share[:, None] * [0.0, 0.0, -5.0]
    reached, turned = square.forward(run.q)
    assert reached.shape == demanded.shape
    assert np.max(np.linalg.norm(reached - demanded, axis=1)) <= 1e-6
    assert np.max(turned.magnitude()) <= 1e-6


@pytest.mark.req("TRF-13")
@every_tick
def test_joint_10_comes_to_700_mm_and_joint_9_to_180_degrees(experiment, tick: int) -> None:
    """The monograph tells of joint 10 alone."""
    run, plain = experiment("obstacle", tick, "line"), experiment("line", tick, "line")
    assert active(run) == {("joint_10", "position", "upper"), ("joint_9", "position", "upper")}
    assert run.q[:, JOINT_10].max() == pytest.approx(0.7, abs=1e-12)
    assert run.q[:, JOINT_9].max() == pytest.approx(np.pi, abs=1e-12)
    assert plain.q[:, JOINT_10].max() < -0.38


@pytest.mark.req("TRF-13")
@every_tick
def test_the_posture_at_the_end_is_the_same_at_every_tick(experiment, tick: int) -> None:
    ends = [experiment("obstacle", other, "line").q[-1] for other in (tick, 50)]
    assert np.max(np.abs(np.delete(ends[0] - ends[1], JOINT_10))) < np.radians(1.0)
    assert abs(ends[0][JOINT_10] - ends[1][JOINT_10]) < 1e-3


@pytest.mark.req("TRF-13")
def test_both_verify(experiment) -> None:
    for name in ("line", "obstacle"):
        run = experiment(name, 50, "line")
        assert run.complete
        assert irlx.verify(run, program=PROGRAMS / f"{name}.irl", cell=PROGRAMS / "line.toml").passed
