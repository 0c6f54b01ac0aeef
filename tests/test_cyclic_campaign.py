"""Closed paths under CYCLICSTART: the posture closes from the first round on, and returns governed.

Without the option it drifts; both are shown (TRF-11). Figures by differences and the tool path's own start.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.cell.robot_data import robot_data_folder
from irlx.promises import CLOSURE
from long_run import diagonal, first
from machines import machine

pytestmark = [pytest.mark.req("TRF-11"), pytest.mark.req("TRF-05")]

PROGRAMS = Path(__file__).parents[1] / "programs" / "koch"
FRANKA = "acceleration = [859.4, 429.7, 572.9, 716.1, 859.4, 1145.9, 1145.9]\n"
NO_ACCELERATION = "acceleration = false\n"
BINDING = FRANKA + "speed = [10, 15, 12, 124, 149, 149, 149]\n"
PLANES = [(1.0, 0.0, 0.0), (0.8, 0.0, 0.6), (0.6, 0.5, 0.2)]
ROUNDS, RADIUS, RAMP_TIME = 5, 0.13, 0.2

QUICK = [(PLANES[1], FRANKA, 20.0), (PLANES[2], NO_ACCELERATION, 20.0)]
"""Planes, limits and ticks of the default run."""
SLOW = pytest.mark.slow
needs_panda = pytest.mark.skipif(robot_data_folder() is None, reason='pip install "irlx[robots]"')


def point(values) -> str:
    return f"POSITION({', '.join(repr(1e3 * float(value)) for value in values)})"


def panda_run(folder: Path, body: str, limits: str, tick: float) -> irlx.Run:
    start = ", ".join(repr(float(value)) for value in np.degrees(machine("panda").start))
    (folder / "p.toml").write_text(
        f'[robot]\nmodel = "panda"\nstart = [{start}]\n[robot.limits]\n{limits}'
        "[robot.self_collision]\nactive = false\n"
        f"[motion]\ntick_ms = {tick!r}\nspeed = 250\nacc = 1500\n",
        encoding="utf-8",
    )
    (folder / "p.irl").write_text(f"PROGRAM p;\n{body}ENDPROGRAM;\n", encoding="utf-8")
    return irlx.run(folder / "p.irl")


def circle(axis, speed: float = 250.0) -> str:
    """A full circle in a plane with that normal, hanging below the start or beside it."""
    robot = machine("panda")
    position, _ = robot.pose(robot.start)
    normal = np.array(axis) / np.linalg.norm(axis)
    arm = np.cross(normal, [0.0, 1.0, 0.0])
    arm = RADIUS * arm / np.linalg.norm(arm)
    arm = arm if arm[2] > 0.0 else -arm
    via, opposite = (position - arm + Rotation.from_rotvec(a * normal).apply(arm) for a in (np.pi / 2, np.pi))
    return f"  MOVE CIRCLE {point(via)}, {point(opposite)} ANGLE := 360 SPEED := {speed!r};\n"


def motion_ends(run: irlx.Run) -> np.ndarray:
    """Postures (K, n) at the ends of the motions."""
    block = np.asarray(run.stream.block)
    last = np.flatnonzero(np.append(block[1:] != block[:-1], True) & (block > 0))
    return run.q[last]


def assert_bounds(run: irlx.Run) -> np.ndarray:
    """Speeds and accelerations within the cell's limits; returns the accelerations (N, n)."""
    limits, dt = run.stream.header.limits, run.stream.dt
    v = np.diff(run.q, axis=0, prepend=run.q[:1]) / dt
    a = np.diff(v, axis=0, prepend=0.0 * v[:1]) / dt
    unit = float(np.spacing(np.max(np.abs(run.q))))
    assert np.all(np.abs(v) <= limits.speed_upper * (1.0 + 1e-9) + 2.0 * unit / dt)
    assert np.all(np.abs(a) <= limits.acceleration_upper * (1.0 + 1e-9) + 4.0 * unit / dt**2)
    return a


def governed(run: irlx.Run) -> np.ndarray:
    """Acceleration (n,) that stands for an unknown one: the speed limit in 0.2 s."""
    return run.stream.header.limits.speed_upper / RAMP_TIME


@needs_panda
@pytest.mark.parametrize(
    ("axis", "limits", "tick"),
    [
        pytest.param(axis, limits, tick, marks=() if (axis, limits, tick) in QUICK else SLOW)
        for axis in PLANES
        for limits in (NO_ACCELERATION, FRANKA)
        for tick in (1.0, 4.0, 10.0, 20.0)
    ],
)
def test_five_circles_close_from_the_first_on(tmp_path, axis, limits: str, tick: float) -> None:
    body = circle(axis) * ROUNDS
    drift = motion_ends(panda_run(tmp_path, f"BEGIN\n{body}", limits, tick))
    run = panda_run(tmp_path, f"BEGIN\n  CYCLICSTART;\n{body}", limits, tick)
    closed = np.max(np.abs(motion_ends(run) - run.q[0]), axis=1)
    first, away = np.max(np.abs(drift[0] - run.q[0])), np.max(np.abs(drift - run.q[0]), axis=1)
    print(f"plane {axis}, {tick} ms: closure {closed.max():.2g} rad, drift {away} rad")
    assert len(closed) == ROUNDS
    assert np.all(closed <= CLOSURE)
    assert 0.02 <= first <= 0.1
    assert np.all(np.diff(away) > 0.0)
    assert np.all(np.abs(assert_bounds(run)) <= governed(run))


@needs_panda
@pytest.mark.parametrize(
    ("tick", "rounds"), [(4.0, 1), *(pytest.param(tick, 2, marks=SLOW) for tick in (1.0, 4.0))]
)
def test_circles_that_must_slow_down_close_too(tmp_path, tick: float, rounds: int) -> None:
    run = panda_run(tmp_path, f"BEGIN\n  CYCLICSTART;\n{circle(PLANES[0]) * rounds}", BINDING, tick)
    free = rounds * (2 * np.pi * RADIUS / 0.25 + 0.25 / 1.5)
    assert run.summary.duration > 1.05 * free
    assert np.max(np.abs(motion_ends(run) - run.q[0])) <= CLOSURE
    assert_bounds(run)


@pytest.mark.parametrize("tick", [pytest.param(10.0, marks=SLOW), 50.0])
@pytest.mark.parametrize(
    "limits", first(1, ["acceleration = 350\n", ""]), ids=["350 deg/s2", "no acceleration"]
)
def test_the_square_closes(tmp_path, limits: str, tick: float) -> None:
    """The monograph's square, once more with every joint bounded to 350 deg/s2 (the slide to 350 mm/s2)."""
    cell = (PROGRAMS / "square.toml").read_text(encoding="utf-8")
    entries = "acceleration = [" + "350, " * 9 + "3500, 350]\n" if limits else ""
    (tmp_path / "square.toml").write_text(cell.replace("[motion]", f"{entries}[motion]"), encoding="utf-8")
    text = (PROGRAMS / "square_cyclic.irl").read_text(encoding="utf-8")
    (tmp_path / "square_cyclic.irl").write_text(text, encoding="utf-8")
    run = irlx.run(tmp_path / "square_cyclic.irl", cell=tmp_path / "square.toml", tick_ms=tick)
    assert np.max(np.abs(run.q[-1] - run.q[0])) <= CLOSURE
    assert_bounds(run)


def corners() -> list[np.ndarray]:
    position, _ = machine("panda").pose(machine("panda").start)
    return [position + np.array(way) for way in ((0, -0.1, 0), (0, -0.1, -0.1), (0, 0, -0.1), (0, 0, 0))]


@needs_panda
@pytest.mark.parametrize(
    ("limits", "tick"),
    [
        pytest.param(
            limits, tick, marks=() if (limits, tick) in {(NO_ACCELERATION, 50.0), (FRANKA, 4.0)} else SLOW
        )
        for limits in (NO_ACCELERATION, FRANKA)
        for tick in (1.0, 4.0, 50.0)
    ],
)
def test_after_a_reconfiguration_on_the_way_the_posture_returns_governed(tmp_path, limits, tick) -> None:
    """A move to the first corner in another posture, and twice round the square: each move goes part of the
    way, as far as half of each joint's limits allow, and the second round closes."""
    first, *others = corners()
    ways = "".join(f"  MOVE LIN {point(corner)};\n" for corner in others)
    again = "".join(f"  MOVE LIN {point(corner)};\n" for corner in corners())
    body = (
        "VAR MAIN_JOINT: konf;\nBEGIN\n  CYCLICSTART;\n  konf := R_JOINT_ACT.M_JOINT;\n"
        "  konf.A1 := konf.A1 + 25;\n  konf.A3 := konf.A3 - 30;\n  konf.A5 := konf.A5 - 20;\n"
        f"  MOVE LIN {point(first)} WITH RECONFIGURATION konf;\n{ways}{again}"
    )
    run = panda_run(tmp_path, body, limits, tick)
    ends = motion_ends(run)
    away = np.max(np.abs(ends[[3, 7]] - run.q[0]), axis=1)
    print(f"{tick} ms: from {np.max(np.abs(ends[0] - run.q[0])):.3g} rad to {away} rad")
    assert np.max(np.abs(ends[0] - run.q[0])) > 0.1
    assert away[0] < 0.5 * np.max(np.abs(ends[0] - run.q[0]))
    assert away[1] <= CLOSURE
    after = run.q[np.asarray(run.stream.block) > np.min(np.asarray(run.stream.block)[1:])]
    a = np.abs(assert_bounds(run))[-len(after) :]
    assert np.all(a <= governed(run))


@needs_panda
@pytest.mark.parametrize(
    ("limits", "tick"),
    diagonal(
        [pytest.param(NO_ACCELERATION, id="no acceleration"), pytest.param(FRANKA, id="franka")],
        [4.0, 50.0, 1.0],
    ),
)
def test_a_short_line_far_from_the_stored_posture_does_not_jump(tmp_path, limits, tick) -> None:
    """It once jumped at the speed limits in a tick, rang under acceleration limits, or ended in IRL521."""
    there = (
        "VAR MAIN_JOINT: j;\nBEGIN\n  CYCLICSTART;\n  j := R_JOINT_ACT.M_JOINT;\n"
        "  j.A1 := j.A1 + 40;\n  j.A2 := j.A2 - 20;\n  j.A3 := j.A3 + 50;\n  j.A5 := j.A5 - 40;\n"
        "  MOVE PTP j TIME := 5;\n"
    )
    near = panda_run(tmp_path, there, limits, tick)
    position, _ = machine("panda").pose(near.q[-1])
    lines = "".join(
        f"  MOVE LIN {point(position + np.array([way, 0.0, 0.0]))} SPEED := 20;\n" for way in (0.02, 0.0) * 2
    )
    run = panda_run(tmp_path, there + lines, limits, tick)
    a = assert_bounds(run)[len(near.q) :]
    share = np.max(np.abs(a) / governed(run))
    turns = int(np.max(np.count_nonzero(np.diff(np.sign(np.round(a, 2)), axis=0), axis=0)))
    print(f"{tick} ms: {share:.3g} of the governed rate, {turns} changes of sign")
    assert share <= 0.5
    assert turns <= 4 * 6
    # Once the posture has come back, each corner has its own.
    ends = motion_ends(run)
    assert np.max(np.abs(ends[-1] - ends[-3])) <= CLOSURE


@needs_panda
@pytest.mark.parametrize("limits", first(1, [FRANKA, NO_ACCELERATION]), ids=["franka", "no acceleration"])
def test_after_a_ptp_elsewhere_enough_moves_close_again(tmp_path, limits) -> None:
    """By PTP into another posture, back to the first pose by LIN in several moves."""
    home, _ = machine("panda").pose(machine("panda").start)
    body = (
        "VAR MAIN_JOINT: j;\nBEGIN\n  CYCLICSTART;\n  j := R_JOINT_ACT.M_JOINT;\n"
        "  j.A1 := j.A1 + 20;\n  j.A3 := j.A3 - 35;\n  j.A5 := j.A5 + 15;\n  MOVE PTP j TIME := 4;\n"
        f"  MOVE LIN {point(home)};\n"
    )
    robot = machine("panda")
    home, rotation = robot.pose(robot.start)
    angles = ", ".join(repr(float(x)) for x in Rotation.from_matrix(rotation).as_euler("ZYX", degrees=True))
    body = body.replace(f"LIN {point(home)}", f"LIN ({point(home)}, ORIZYX({angles}))")
    body += "".join(f"  MOVE LIN {point(corner)};\n" for corner in corners())
    run = panda_run(tmp_path, body, limits, 4.0)
    ends = motion_ends(run)
    away = np.max(np.abs(ends - run.q[0]), axis=1)
    print(f"away at the ends of the moves: {away} rad")
    assert away[0] > 0.3
    assert away[-1] <= CLOSURE
    a = assert_bounds(run)
    assert np.all(np.abs(a) <= governed(run))


@needs_panda
@pytest.mark.req("LANG-62")
@pytest.mark.parametrize("tick", first(1, [50.0, 4.0]))
def test_a_posture_too_far_for_the_joints_is_waited_for(tmp_path, tick: float) -> None:
    """A joint slower than the posture asked for needs: the move slows down, reaches it, and comes to rest.

    Without an acceleration limit it once ran at its speed limit into the stop of the move.
    """
    body = (
        "VAR MAIN_JOINT: konf;\nBEGIN\n  konf := R_JOINT_ACT.M_JOINT;\n"
        "  konf.A1 := konf.A1 + 25;\n  konf.A3 := konf.A3 - 30;\n  konf.A5 := konf.A5 - 20;\n"
        f"  MOVE LIN {point(corners()[0])} WITH RECONFIGURATION konf;\n"
    )
    free = panda_run(tmp_path, body, NO_ACCELERATION, tick)
    fastest = np.max(np.abs(np.diff(free.q, axis=0)), axis=0) / free.stream.dt
    slow = 0.4 * np.degrees(fastest.max())
    speeds = ", ".join([repr(float(slow))] * 7)
    run = panda_run(tmp_path, body, f"{NO_ACCELERATION}speed = [{speeds}]\n", tick)
    assert_bounds(run)
    assert run.summary.duration > 1.1 * free.summary.duration
    assert np.max(np.abs(run.q[-1] - free.q[-1])) <= 1e-6
    stop = np.abs(run.q[-2] - run.q[-3]) / run.stream.dt
    # The reference runs with the tool, whose ramp is shorter than the governed one.
    assert np.all(stop <= 4.0 * governed(run) * run.stream.dt)
