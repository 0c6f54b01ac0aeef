"""The acceptance cases of slowing down: durations, and every row of the written file judged from outside.

A run is written as NPZ; `stream_judge` reads it with numpy, knows the robot by Pinocchio's URDF reader alone,
and takes differences. Durations are without the two hold ticks of the reference motion.
"""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.cell.load import load_cell
from irlx.cell.robot_data import robot_data_folder
from kept_runs import kept_report, kept_run
from long_run import first
from reference_motion import DURATION, RADIUS, reference_motion
from stream_judge import Written, excess, on_circle, on_line, tool_poses

pytestmark = [pytest.mark.req("MOT-20"), pytest.mark.req("MOT-21")]

needs_panda = pytest.mark.skipif(robot_data_folder() is None, reason='pip install "irlx[robots]"')
ticks = pytest.mark.parametrize("tick", [pytest.param(1.0, marks=pytest.mark.slow), 4.0])
slow_ticks = pytest.mark.parametrize("tick", [pytest.param(1.0, marks=pytest.mark.slow), 4.0])
"""Ticks of the cases on other robots: 1 ms in the long run alone."""
KINDS = ("position", "speed", "acceleration")


def in_long_run(case: tuple):
    """A case that another one of its kind stands for in the default run."""
    return pytest.param(*case, marks=pytest.mark.slow)


def urdf_of(model: str) -> str:
    if model == "panda":
        return (robot_data_folder() / "panda_description/urdf/panda.urdf").read_text(encoding="utf-8")
    return (files("irlx.cell") / "robots" / f"{model}.urdf").read_text(encoding="utf-8")


def judged(folder: Path, program: Path, cell: Path, model: str) -> tuple[irlx.Run, Written]:
    """Run, write, read back; every bound of the cell holds in every row of the file."""
    run = kept_run(program, cell)
    run.save(folder / "run.npz")
    loaded = load_cell(cell)
    written = Written.read(folder / "run.npz", urdf_of(model), loaded.robot.tip)
    found = excess(written.q, written.dt, *(loaded.limits.pair(kind) for kind in KINDS))
    assert found.none, found
    assert kept_report(program, cell).passed
    return run, written


def reference(folder: Path, robot: str, tick: float, **bounds) -> tuple[irlx.Run, float]:
    """The reference motion under bounds, on its way in every row; the run and the time of its motions."""
    motion = reference_motion(folder, robot, tick, **bounds)
    run, written = judged(folder, motion.program, motion.cell, robot)
    turned = Rotation.from_matrix(motion.rotation)
    line, positions, rotations = written.move(1)
    assert on_line(positions, rotations, line, (motion.line_end, turned)).kept
    circle, positions, rotations = written.move(2)
    centre = circle[0] - [0.0, 0.0, RADIUS]
    on_way = on_circle(positions, rotations, circle, centre, np.array([-1.0, 0.0, 0.0]))
    assert on_way.kept
    return run, (len(written.t) - 3) * written.dt


# ---- panda, durations that a prototype of the method reached


@needs_panda
@ticks
def test_panda_by_its_own_limits_takes_the_programmed_time(tmp_path, tick: float) -> None:
    run, duration = reference(tmp_path, "panda", tick, acceleration=False)
    assert duration == pytest.approx({1.0: 4.950, 4.0: 4.952}[tick], abs=1e-9)
    assert run.summary.slowed == ()


@pytest.mark.slow
@needs_panda
@ticks
def test_panda_joint_1_is_absorbed_by_the_redundancy(tmp_path, tick: float) -> None:
    _, duration = reference(tmp_path, "panda", tick, acceleration=False, speed={1: 0.277})
    assert duration <= 4.955


@needs_panda
@ticks
@pytest.mark.parametrize("acceleration", [False, pytest.param(15.0, marks=pytest.mark.slow)])
def test_panda_joint_4_slows_the_circle_by_two_per_cent(tmp_path, tick: float, acceleration) -> None:
    run, duration = reference(tmp_path, "panda", tick, acceleration=acceleration, speed={4: 0.376})
    assert DURATION <= duration <= 5.06
    assert run.summary.planned >= 1
    assert run.summary.slowed
    assert {event.joint for event in run.summary.slowed} & {"panda_joint4"}
    assert sum(event.lost for event in run.summary.slowed) == pytest.approx(
        duration - DURATION, abs=3e-3 * tick
    )


# ---- arm7 and rail6: absorbed, slowed, slowed with accelerations; durations achieved and one per cent


ABSORBED = [("arm7", {2: 0.383}), ("arm7", {1: 0.26}), ("rail6", {5: 0.175}), ("rail6", {4: 0.08})]
SLOWED = [
    ("arm7", {4: 0.2}, False, 5.584),
    ("arm7", {4: 0.2}, 2.5, 5.716),
    ("arm7", {}, 1.5, 5.624),
    ("rail6", {3: 0.236}, False, 5.476),
    ("rail6", {3: 0.236}, 1.0, 5.932),
    ("rail6", {}, 0.6, 5.988),
]


@slow_ticks
@pytest.mark.parametrize(("robot", "speed"), [ABSORBED[0], *map(in_long_run, ABSORBED[1:])])
def test_a_limit_that_the_redundancy_absorbs_costs_a_thousandth(
    tmp_path, robot: str, speed, tick: float
) -> None:
    free, _ = reference(tmp_path, robot, tick, acceleration=False)
    joint, bound = next(iter(speed.items()))
    assert np.max(np.abs(free.qd[:, joint - 1])) > bound
    _, duration = reference(tmp_path, robot, tick, acceleration=False, speed=speed)
    # Each of the two motions is rounded up to whole ticks.
    assert duration <= 1.001 * DURATION + 2e-3 * tick


@slow_ticks
@pytest.mark.parametrize(
    ("robot", "speed", "acceleration", "achieved"),
    [case if case == SLOWED[2] else in_long_run(case) for case in SLOWED],
)
def test_a_limit_that_costs_time_costs_no_more_than_achieved(
    tmp_path, robot: str, speed, acceleration, achieved: float, tick: float
) -> None:
    run, duration = reference(tmp_path, robot, tick, acceleration=acceleration, speed=speed)
    assert DURATION <= duration <= 1.01 * achieved + 2e-3 * tick
    assert run.summary.planned >= 1


# ---- koch11: the square of the monograph


@pytest.mark.parametrize("tick", first(1, [50, 10, 20, 100]))
def test_koch11_square_keeps_350_deg_per_s2_in_the_programmed_time(tmp_path, tick: int) -> None:
    folder = Path(__file__).parents[1] / "programs" / "koch"
    text = (folder / "square.toml").read_text(encoding="utf-8")
    bound = "[robot.limits]\nacceleration = [350, 350, 350, 350, 350, 350, 350, 350, 350, 3500, 350]\n"
    cell = tmp_path / "square.toml"
    text = text.replace("[robot.limits]\n", bound).replace("tick_ms = 50", f"tick_ms = {tick}")
    cell.write_text(text, encoding="utf-8")
    assert np.all(np.isfinite(load_cell(cell).limits.acceleration_upper))
    _, written = judged(tmp_path, folder / "square.irl", cell, "koch11")
    motions = 5
    assert written.t[-1] == pytest.approx(12.5 + motions * tick / 1000.0, abs=1e-9)


# ---- a wrist path past a singular posture


WRIST_START = (-0.5142, 0.2232, -1.4027, -2.4027, 0.4455, 1.4752, -2.0526)
WRIST_WAY = 0.2
"""A line along the tool's own axis; the free motion comes to a smallest singular value of 0.0095."""
WRIST_LAW = "speed = 250\nacc = 1500\nspeed_ori = 60\nacc_ori = 240\n"
WRIST_TIME = WRIST_WAY / 0.25 + 0.25 / 1.5


def wrist(folder: Path, tick: float, limits: str = "") -> tuple[irlx.Run, Written]:
    cell, program = folder / "wrist.toml", folder / "wrist.irl"
    start = ", ".join(repr(float(value)) for value in np.degrees(WRIST_START))
    head = f'[robot]\nmodel = "panda"\nstart = [{start}]\n'
    cell.write_text(
        f"{head}[robot.limits]\n{limits}\n[robot.self_collision]\nactive = false\n"
        f"[motion]\ntick_ms = {tick}\n{WRIST_LAW}",
        encoding="utf-8",
    )
    position, rotation = wrist_start(cell)
    end = position + rotation.apply([0.0, 0.0, WRIST_WAY])
    target = ", ".join(repr(float(value)) for value in 1e3 * end)
    program.write_text(
        f"PROGRAM wrist;\nBEGIN\n  MOVE LIN POSITION({target});\nENDPROGRAM;\n", encoding="utf-8"
    )
    run, written = judged(folder, program, cell, "panda")
    start, positions, rotations = written.move(1)
    assert on_line(positions, rotations, start, (end, rotation)).kept
    return run, written


def wrist_start(cell: Path) -> tuple[np.ndarray, Rotation]:
    loaded = load_cell(cell)
    names = loaded.robot.joint_names
    positions, rotations = tool_poses(urdf_of("panda"), loaded.robot.tip, names, loaded.start[None])
    return positions[0], rotations[0]


def smallest_singular_value(q: np.ndarray) -> float:
    """Over rows, by central differences of the tool's pose, in m and rad."""
    names, h = tuple(f"panda_joint{i}" for i in range(1, 8)), 1e-6
    values = []
    for row in q[::6]:
        steps = row + h * np.vstack([np.eye(7), -np.eye(7)])
        p, r = tool_poses(urdf_of("panda"), "panda_hand_tcp", names, steps)
        turns = (r[:7] * r[7:].inv()).as_rotvec()
        jacobian = np.hstack([p[:7] - p[7:], turns]).T / (2.0 * h)
        values.append(np.linalg.svd(jacobian, compute_uv=False)[-1])
    return float(min(values))


@needs_panda
@ticks
def test_wrist_path_past_a_singular_posture_takes_the_programmed_time(tmp_path, tick: float) -> None:
    _, free = wrist(tmp_path, tick, "acceleration = false")
    assert 0.008 < smallest_singular_value(free.q) < 0.012
    assert free.t[-1] <= 1.05 * WRIST_TIME
    run, written = wrist(tmp_path, tick)
    assert written.t[-1] - written.dt <= 1.01 * WRIST_TIME
    assert run.summary.planned == 1


@needs_panda
@slow_ticks
@pytest.mark.parametrize(("joint", "share"), [(3, 0.8), *map(in_long_run, ((5, 0.8), (6, 0.5), (7, 0.5)))])
def test_wrist_path_meets_a_position_limit_on_the_way(
    tmp_path, joint: int, share: float, tick: float
) -> None:
    """A range is cut by that share of what the free motion uses of it, and the limit is met."""
    _, free = wrist(tmp_path, tick, "acceleration = false")
    way = free.q[:, joint - 1] - free.q[0, joint - 1]
    furthest = way[np.argmax(np.abs(way))]
    loaded = load_cell(tmp_path / "wrist.toml").limits
    lower, upper = (np.degrees(side) for side in loaded.pair("position"))
    bound = float(np.degrees(free.q[0, joint - 1] + share * furthest))
    (upper if furthest > 0.0 else lower)[joint - 1] = bound
    entries = ", ".join(f"[{a!r}, {b!r}]" for a, b in zip(lower.tolist(), upper.tolist(), strict=True))
    _, written = wrist(tmp_path, tick, f"position = [{entries}]")
    assert written.t[-1] - written.dt <= 1.05 * WRIST_TIME
    assert np.min(np.abs(np.degrees(written.q[:, joint - 1]) - bound)) < 0.05


@pytest.mark.req("MOT-03")
def test_slowed_moves_that_are_joined_keep_each_its_own_acc(tmp_path) -> None:
    """Joints slow both down and set them free again: the second one gains speed by its own ACC."""
    (tmp_path / "p.toml").write_text(
        '[robot]\nmodel = "arm7"\n[robot.limits]\nspeed = [22, 22, 22, 22, 22, 22, 22]\n'
        "[motion]\ntick_ms = 10\nspeed = 300\n",
        encoding="utf-8",
    )
    program = tmp_path / "p.irl"
    program.write_text(
        "PROGRAM p;\nBEGIN\nMOVE LIN POSITION(440, 400, 200) ACC := 4000 C_CP := 15;\n"
        "MOVE LIN POSITION(470, 220, 420) ACC := 380;\nENDPROGRAM;\n",
        encoding="utf-8",
    )
    run = kept_run(program, tmp_path / "p.toml")
    assert run.summary.planned == 2
    position, corner = run.tool[:, :3], np.array([0.44, 0.4, 0.2])
    way = np.array([0.47, 0.22, 0.42]) - corner
    along = (position - corner) @ way / np.linalg.norm(way)
    off = np.linalg.norm(position - corner - along[:, None] * way / np.linalg.norm(way), axis=1)
    behind = np.flatnonzero((off < 1e-9) & (along > 0.015))
    gained = np.diff(along[behind[0] :], n=2) / 0.01**2
    assert len(gained) > 100
    assert 0.37 < np.max(np.abs(gained)) < 0.38 * (1.0 + 1e-5)
    assert kept_report(program, tmp_path / "p.toml").passed
