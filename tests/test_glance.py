"""A dry run looks at motions far from all limits at a few places: as near to the run, and much cheaper."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.dry_run import _DryExecution, resolution_of
from irlx.job import prepare
from irlx.pacing import path_motion
from irlx.pacing.glance import NODES, Glanced, Undisturbed, _barycentric, glance
from irlx.pacing.path_motion import PacedPath
from irlx.pipeline import Execution
from irlx.robot.kinematics import Kinematics
from irlx.transform.tick import TickSolver
from irlx.transform.undisturbed import UndisturbedTick

LINES = """MOVE LIN (441, 200, 324); MOVE LIN (480, 140, 364) SPEED := 120; MOVE LIN (401, 230, 300);
MOVE CIRCLE (441, 180, 324), (481, 230, 300); MOVE LIN (441, 200, 324), (420, 160, 340), (450, 220, 300);
"""
BLENDED = """MOVE LIN (441, 200, 324) C_CP := 15; MOVE LIN (480, 140, 364) C_CP := 15;
MOVE LIN (401, 230, 300) C_CP := 15; MOVE LIN (441, 200, 324);
"""


def prepared(folder: Path, body: str, limits: str = "") -> object:
    (folder / "g.toml").write_text(f'[robot]\nmodel = "arm7"\n{limits}')
    (folder / "g.irl").write_text(f"PROGRAM g;\nBEGIN\n{body}\nENDPROGRAM;\n")
    return prepare(folder / "g.irl")


def dry(job: object) -> _DryExecution:
    return _DryExecution(job, resolution_of(job.tick_ns / 1e9))


@pytest.mark.parametrize("body", [LINES, BLENDED, f"CYCLICSTART; {LINES}", f"FREEZESTART 3; {LINES}"])
def test_rows_lie_on_the_run_at_their_ticks(tmp_path, body) -> None:
    """Against the rows of the run, tick by tick; between them the run moves by up to a step."""
    job = prepared(tmp_path, body)
    fine = np.vstack([job.cell.start, *(one.rows.q for one in Execution(job) if one.rows is not None)])
    execution = dry(job)
    for one in execution:
        if one.rows is None:
            continue
        for q, demand in zip(one.rows.q, one.rows.path.demands, strict=False):
            near = fine[max(demand.tick - 1, 0) : demand.tick + 2]
            assert np.all(q >= near.min(axis=0) - 2e-3)
            assert np.all(q <= near.max(axis=0) + 2e-3)
            distance = np.linalg.norm(execution.kinematics.tool_pose(q)[1] - demand.position)
            assert distance < 1e-4
        rotation, position = execution.kinematics.tool_pose(one.rows.q[-1])
        if one.rows.stops:
            assert np.linalg.norm(position - demand.position) < 1e-9
            assert np.linalg.norm(rotation - demand.rotation) < 1e-9


@pytest.mark.parametrize("body", [LINES, BLENDED])
def test_no_tick_is_solved_by_itself(tmp_path, monkeypatch, body) -> None:
    """What saves the time, counted: no tick is solved, and the model is asked less than half as often."""
    job, count = prepared(tmp_path, body), Counter()
    asked_of = ((Kinematics, "tool_difference"), (Kinematics, "tool_pose"))
    for of, name in (*asked_of, (TickSolver, "solve"), (UndisturbedTick, "solve")):
        own = getattr(of, name)

        def counted(self, *asked, own=own, which=name):
            count[which] += 1
            return own(self, *asked)

        monkeypatch.setattr(of, name, counted)
    run = [one.rows for one in Execution(job) if one.rows is not None]
    of_run = count.copy()
    count.clear()
    execution = dry(job)
    for executed in execution:
        execution.consider(executed)
    assert of_run["solve"] >= sum(len(rows) - rows.stops for rows in run)
    assert count["solve"] == 0
    assert (
        2 * (count["tool_difference"] + count["tool_pose"]) < of_run["tool_difference"] + of_run["tool_pose"]
    )


def test_a_motion_near_a_limit_is_none_of_its_business(tmp_path, monkeypatch) -> None:
    """The least limit that is left alone is the one that the run comes up to within the share."""
    job = prepared(tmp_path, "MOVE LIN (441, 200, 324); MOVE LIN (441, 100, 324) SPEED := 200;")
    run = irlx.run(tmp_path / "g.irl")
    fastest = np.degrees(np.max(np.abs(run.qd), axis=0))
    seen = []
    own = path_motion._glanced
    monkeypatch.setattr(
        path_motion, "_glanced", lambda *asked: seen.append(isinstance(own(*asked), PacedPath)) or own(*asked)
    )
    for share, sure in ((1.05, True), (1.01, False), (0.9, False)):
        speeds = ", ".join(f"{share * value:.9f}" for value in fastest)
        job = prepared(
            tmp_path,
            "MOVE LIN (441, 200, 324); MOVE LIN (441, 100, 324) SPEED := 200;",
            f"[robot.limits]\nspeed = [{speeds}]\n",
        )
        seen.clear()
        list(dry(job))
        assert all(seen) == sure, share


def test_links_that_come_too_near_are_none_of_its_business(tmp_path, monkeypatch) -> None:
    """The margin just below and just above what the run comes down to at the end of the second line."""
    body = "MOVE LIN (441, 200, 324); MOVE LIN (300, 150, 250) SPEED := 100;"
    wide = "[robot.self_collision]\nmargin = 5\ninfluence = 200\n"
    prepared(tmp_path, body, wide)
    smallest = 1e3 * irlx.run(tmp_path / "g.irl").clearances.distance.min()
    seen = []
    own = path_motion._glanced
    monkeypatch.setattr(
        path_motion, "_glanced", lambda *asked: seen.append(isinstance(own(*asked), PacedPath)) or own(*asked)
    )
    for over, sure in ((-1.0, True), (1.0, False)):
        limits = f"[robot.self_collision]\nmargin = {smallest + over:.6f}\ninfluence = 200\n"
        job = prepared(tmp_path, body, limits)
        seen.clear()
        execution = dry(job)
        list(execution)
        assert seen[0]
        assert seen[1] == sure, over


def test_polynomials_between_nodes_are_exact() -> None:
    rng = np.random.default_rng(3)
    angles = np.pi * np.arange(NODES) / (NODES - 1)
    at = 0.5 * (1.0 - np.cos(angles))
    x = np.concatenate([rng.uniform(0.0, 1.0, 20), at, [0.0, 1.0, 1e-16]])
    for degree in range(NODES):
        chebyshev = np.polynomial.Chebyshev.basis(degree, [0.0, 1.0])
        assert np.allclose(_barycentric(x) @ chebyshev(at), chebyshev(x), atol=1e-12)
        values = chebyshev(at)[None, :, None]
        tail = Undisturbed(np.array([0.0, 1.0]), values, at, None).tails
        assert tail == pytest.approx([1.0 if degree >= NODES - 2 else 0.0], abs=1e-12)


def test_the_last_move_has_the_duration_of_the_run(tmp_path) -> None:
    """A row of a dry run is no tick."""
    job = prepared(tmp_path, "MOVE LIN (441, 200, 324); MOVE LIN (441, 120, 324);")
    durations = []
    for execution in (Execution(job), dry(job)):
        list(execution)
        durations.append(execution._pacer._last_way)
    assert durations[0] == pytest.approx(durations[1], abs=1e-9)


def test_nothing_is_seen_of_more_ticks_than_it_looks_at(tmp_path) -> None:
    job = prepared(tmp_path, "MOVE LIN (441, 200, 324);")
    execution = dry(job)
    motion = Glanced(None, None, 10**9, job.cell.start, None, 0.01, 1)
    situation = execution._pacer._situation
    assert glance(motion, situation.model(situation.in_force())) is None
