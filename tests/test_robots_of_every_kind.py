"""Programs of a mobile platform, a rail, a gantry and a snake: ten moves and three options each, verified.

The posture, the path and the limits are looked at anew with formulas of this file.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import irlx
from irlx.promises import CLOSURE
from nearness import nearest

pytestmark = [pytest.mark.req("TRF-20"), pytest.mark.req("TRF-22")]

FOLDER = Path(__file__).parents[1] / "programs"
JOINTS = {"mobile": 9, "rail": 7, "gantry": 9, "snake": 20}
SLOWED = {"mobile", "gantry"}
"""Programs whose tool gives way in time to limits that they set."""
OPTIONS = re.compile(r"CYCLICSTART|FREEZESTART|RECONFIGURATION|JOINT(?:SPEED|ACCEL)?LIMIT\b|OBSTACLE\b")


@cache
def run_of(name: str) -> irlx.Run:
    return irlx.run(FOLDER / name / f"{name}.irl")


def moves(run: irlx.Run) -> list[np.ndarray]:
    """Rows of each move in order."""
    return [np.flatnonzero(run.block == block) for block in dict.fromkeys(run.block[run.block > 0].tolist())]


@pytest.mark.parametrize("name", JOINTS)
def test_it_runs_without_a_word_and_verifies(name: str) -> None:
    run, program, cell = run_of(name), FOLDER / name / f"{name}.irl", FOLDER / name / f"{name}.toml"
    assert run.complete
    assert run.q.shape[1] == JOINTS[name]
    assert [str(told) for told in run.diagnostics] == []
    assert irlx.check(program, cell=cell) == []
    assert irlx.verify(run, program=program, cell=cell).passed
    assert bool(run.summary.slowed) == (name in SLOWED)
    assert len(moves(run)) >= 10
    assert len(set(OPTIONS.findall(program.read_text(encoding="utf-8")))) >= 3


@pytest.mark.parametrize("name", JOINTS)
def test_it_ends_in_the_posture_it_began_with(name: str) -> None:
    run = run_of(name)
    assert np.max(np.abs(run.q[-1] - run.q[0])) <= CLOSURE
    assert np.max(np.ptp(run.q, axis=0)) > 0.2


@pytest.mark.parametrize(("name", "joints"), [("mobile", 3), ("rail", 1), ("gantry", 3)])
def test_slides_that_are_frozen_do_not_move_a_bit(name: str, joints: int) -> None:
    run = run_of(name)
    parked = np.concatenate(moves(run)[2:6])
    assert not np.ptp(run.q[parked, :joints], axis=0).any()
    assert np.ptp(run.tool[parked, :3], axis=0).max() > 0.05


def test_the_platform_is_on_its_aisle_and_along_it() -> None:
    points = np.array([[-0.8, 0.0], [0.0, 0.0], [0.8, 0.0], [1.5, -0.25], [2.3, -0.25]])
    at = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    fine = np.linspace(0.0, at[-1], 40_001)
    spline = CubicSpline(at, points, bc_type="natural")
    curve, rate = spline(fine), spline(fine, 1)
    run = run_of("mobile")
    for x, y, phi in run.q[:, :3]:
        k = int(np.argmin(np.hypot(curve[:, 0] - x, curve[:, 1] - y)))
        tangent = rate[k] / np.linalg.norm(rate[k])
        assert abs(tangent[0] * (y - curve[k, 1]) - tangent[1] * (x - curve[k, 0])) <= 1e-7
        assert abs(phi - np.arctan2(tangent[1], tangent[0])) <= 1e-4
    assert np.ptp(run.q[:, 0]) > 0.3
    assert np.ptp(run.q[:, 1]) > 0.01


def test_the_slow_platform_makes_the_tool_slow_and_nothing_else() -> None:
    run = run_of("mobile")
    creeping = moves(run)[8]
    assert 0.095 < np.abs(run.qd[creeping, 0]).max() <= 0.1 * (1.0 + 1e-9)
    assert "platform_x" in {slowed.joint for slowed in run.summary.slowed}
    # Elsewhere the platform drives faster than that.
    assert np.abs(run.qd[:, 0]).max() > 0.11
    assert run.summary.path_position_error <= 1e-9


UNWATCHED = "[robot.self_collision]\nactive = false\n[motion]\ntick_ms = 50\n"


def shares(folder: Path, model: str, weights: str, way: str, slides: int) -> float:
    """Way of the platform or carriage by the way of the tool."""
    (folder / "p.toml").write_text(f'[robot]\nmodel = "{model}"\n{weights}\n{UNWATCHED}')
    (folder / "p.irl").write_text(f"PROGRAM p;\nBEGIN\n  MOVE_INC LIN POSITION({way});\nENDPROGRAM\n")
    run = irlx.run(folder / "p.irl")
    away = run.q[-1] - run.q[0]
    return float(np.linalg.norm(away[:slides]) / np.linalg.norm(run.tool[-1, :3] - run.tool[0, :3]))


@pytest.mark.parametrize(
    ("model", "slides", "way", "own"),
    [
        ("mobile9", 2, "0, 300, 0", 0.265),
        ("mobile9", 2, "300, 0, 0", 0.563),
        ("gantry9", 3, "0, 300, 0", 0.484),
    ],
)
def test_weights_prefer_the_arm(tmp_path: Path, model: str, slides: int, way: str, own: float) -> None:
    """The figures of the reference: alike weights, those of the robot, weights of 1000."""
    alike = shares(tmp_path, model, f"weights = {[1] * 9}", way, slides)
    heavy = shares(tmp_path, model, f"weights = {[1000] * slides + [1] * (9 - slides)}", way, slides)
    assert shares(tmp_path, model, "", way, slides) == pytest.approx(own, abs=2e-3)
    assert alike > 0.8
    assert heavy < 0.06


def test_the_rail_keeps_joint_3_bent() -> None:
    run = run_of("rail")
    held = np.concatenate(moves(run)[7:10])
    assert np.degrees(run.q[held, 3]).max() <= 60.0 + 1e-9
    assert np.ptp(run.q[held, 0]) > 0.25


def test_the_gantry_brakes_softly_at_the_second_place() -> None:
    run = run_of("gantry")
    soft = np.concatenate(moves(run)[6:10])
    assert np.abs(run.qdd[soft, :2]).max() <= 0.5 * (1.0 + 1e-9) + 1e-9
    assert 0.35 < np.abs(run.qdd[soft, 2]).max() <= 0.4 * (1.0 + 1e-9) + 1e-9
    others = np.setdiff1d(np.arange(len(run.q)), soft)
    assert np.abs(run.qdd[others, :3]).max() > 0.5


def test_the_snake_bends_no_more_than_it_may_and_keeps_off_the_beam(tmp_path: Path) -> None:
    run = run_of("snake")
    held = np.concatenate(moves(run)[:2])
    assert np.degrees(np.abs(run.q[held]).max()) <= 28.0 + 1e-9
    frozen = np.concatenate(moves(run)[3:7])
    assert not np.ptp(run.q[frozen, :4], axis=0).any()
    cell = FOLDER / "snake" / "snake.toml"
    assert off_the_beam(run, cell) >= 0.02
    text = (FOLDER / "snake" / "snake.irl").read_text(encoding="utf-8")
    plain = re.sub(r"^  (OBSTACLE(END)? beam|RECONFIGURATION start);\n", "", text, flags=re.MULTILINE)
    (tmp_path / "snake.irl").write_text(plain, encoding="utf-8")
    assert off_the_beam(irlx.run(tmp_path / "snake.irl", cell=cell), cell) < 0.02


def off_the_beam(run: irlx.Run, cell: Path) -> float:
    """The least distance (m) of a link from the beam in the last three moves, with shapes of the URDF."""
    rows = np.concatenate(moves(run)[7:10])
    return min(float(found[rows].min()) for found in nearest(run, cell).values())
