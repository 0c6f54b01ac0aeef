"""programs/combined: all redundancy options in one program; which of them governs in which move.

Judged from the rows alone: the tool's Jacobian comes from differences of the verifier's forward kinematics,
distances from the URDF and the cell read anew (tests/support/nearness.py).
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.blocks import MoveBlock, ReconfigureBlock
from irlx.cell.load import load_cell
from irlx.promises import CLOSURE
from irlx.verifier.geometry.forward import forward
from irlx.verifier.geometry.rotations import rotation_vectors
from nearness import nearest

FOLDER = Path(__file__).parents[1] / "programs" / "combined"
UNITS = np.array([1e-3, 1e-3, *[np.pi / 180.0] * 6])
CONF = {
    "0": np.array([150, 100, 5, 20, 20, 12, 50, -5]) * UNITS,
    "1": np.array([300, -50, 20, 28, 8, 8, 42, -12]) * UNITS,
    "p": np.array([420, -50, 10, 25, 12, 10, 45, -8]) * UNITS,
    "3": np.array([350, -50, -12, 35, 0, 8, 40, 4]) * UNITS,
}
PLATFORM_Y = 1


@pytest.fixture(scope="module")
def run() -> irlx.Run:
    return irlx.run(FOLDER / "combined.irl")


@pytest.fixture(scope="module")
def cell():
    return load_cell(FOLDER / "combined.toml")


@pytest.fixture(scope="module")
def moves(run: irlx.Run) -> list[np.ndarray]:
    """Rows of each motion in order, the row it starts from first and its hold row left out."""
    motions = [r.block for r in run.stream.records if isinstance(r.block, MoveBlock | ReconfigureBlock)]
    found = []
    for block in motions:
        rows = np.flatnonzero(run.block == block.id)
        found.append(run.q[rows[0] - 1 : rows[-1]])
    return found


def up_to_the_circle() -> str:
    """The program without what comes after its circle."""
    text = (FOLDER / "combined.irl").read_text(encoding="utf-8")
    done, behind, _ = text.partition("  MOVE LIN p2, p1;")
    assert behind
    return f"{done}ENDPROGRAM\n"


def null_space(robot, q: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Orthonormal basis (n, r) of the joint motions that leave the tool where it is."""
    step, rows = 1e-6, []
    for joint in range(q.size):
        moved = np.array([q, q])
        moved[:, joint] += [step, -step]
        positions, rotations = forward(robot, moved)
        turn = rotation_vectors((rotations[1].T @ rotations[0])[None])[0]
        rows.append(np.concatenate([positions[0] - positions[1], turn]) / (2.0 * step))
    jacobian = np.array(rows).T[:, free]
    basis = np.zeros((q.size, int(np.sum(free)) - 6))
    basis[free] = np.linalg.svd(jacobian)[2][6:].T
    return basis


def pull(cell, q: np.ndarray, goal: np.ndarray, frozen: tuple[int, ...] = ()) -> float:
    """How much of W (q - goal) lies along the motions that leave the tool where it is."""
    free = ~np.isin(np.arange(q.size), frozen)
    return float(np.linalg.norm(null_space(cell.robot, q, free).T @ (cell.weights * (q - goal))))


RESTING = 1e-6
PULLED = 0.05


def test_it_runs_whole_and_verifies(run: irlx.Run) -> None:
    assert run.complete
    assert [d for d in run.diagnostics if d.is_error] == []
    assert [str(d) for d in run.diagnostics] == []
    report = irlx.verify(run, program=FOLDER / "combined.irl", cell=FOLDER / "combined.toml")
    assert report.passed, str(report)
    assert irlx.check(FOLDER / "combined.irl", cell=FOLDER / "combined.toml") == []


@pytest.mark.req("LANG-62")
def test_a_posture_asked_for_on_the_way_is_reached(moves) -> None:
    np.testing.assert_allclose(moves[0][-1], CONF["0"], atol=1e-6)


@pytest.mark.req("LANG-61")
def test_without_an_option_least_motion_governs(moves, cell) -> None:
    """Every step is the shortest of its tick: nothing of W S lies along the null space."""
    rows = moves[1]
    free = np.ones(8, dtype=bool)
    for before, after in pairwise(rows[20:41]):
        basis = null_space(cell.robot, after, free)
        step = after - before
        along = np.linalg.norm(basis.T @ (cell.weights * step))
        assert along < 1e-6 * np.linalg.norm(cell.weights * step)


@pytest.mark.req("LANG-65")
def test_the_statement_moves_the_posture_and_not_the_tool(moves, cell) -> None:
    rows = moves[2]
    np.testing.assert_allclose(rows[-1], CONF["1"], atol=1e-6)
    positions, _ = forward(cell.robot, rows)
    assert np.max(np.linalg.norm(positions - positions[0], axis=1)) < 1e-6
    assert np.max(np.abs(rows[-1] - rows[0])) > 0.05


@pytest.mark.req("LANG-63")
def test_the_platform_stands_in_y_while_it_is_frozen(run: irlx.Run, moves) -> None:
    held = np.concatenate([rows[:, PLATFORM_Y] for rows in moves[3:7]])
    assert len(np.unique(held)) == 1
    assert np.ptp(np.concatenate([rows[:, 0] for rows in moves[3:7]])) > 0.01
    assert np.ptp(np.concatenate([rows[:, PLATFORM_Y] for rows in moves[7:]])) > 0.01


@pytest.mark.req("LANG-61")
def test_cyclic_draws_every_move_to_the_stored_posture(moves, cell) -> None:
    stored = moves[3][0]
    np.testing.assert_array_equal(stored, moves[2][-1])
    frozen = (PLATFORM_Y,)
    for rows in (moves[3], moves[5], moves[6]):
        assert pull(cell, rows[-1], stored, frozen) < RESTING
    assert np.max(np.abs(moves[6][-1] - stored)) <= CLOSURE


@pytest.mark.req("LANG-62")
def test_cyclic_is_off_while_a_posture_is_asked_for(moves, cell) -> None:
    """The circle ends in the posture nearest to conf_3, not to the stored one; then the option is back."""
    stored, end, frozen = moves[3][0], moves[4][-1], (PLATFORM_Y,)
    assert pull(cell, end, CONF["3"], frozen) < RESTING
    assert pull(cell, end, stored, frozen) > PULLED
    np.testing.assert_allclose(end, CONF["3"], atol=1e-6)
    assert pull(cell, moves[5][-1], stored, frozen) < RESTING


@pytest.mark.req("LANG-62")
def test_the_posture_of_the_via_point_is_passed(run: irlx.Run, moves, cell, tmp_path: Path) -> None:
    """At the via point the posture is nearer to conf_p than it would be with the end posture alone."""
    via = np.array([1.18, -0.06, 0.59])

    def distance(rows: np.ndarray) -> float:
        positions, _ = forward(cell.robot, rows)
        there = rows[int(np.argmin(np.linalg.norm(positions - via, axis=1)))]
        return float(np.sqrt(cell.weights @ (there - CONF["p"]) ** 2))

    for name in ("combined.toml", "points.dat"):
        (tmp_path / name).write_text((FOLDER / name).read_text(encoding="utf-8"), encoding="utf-8")
    text = up_to_the_circle()
    assert "conf_p, conf_3;" in text
    (tmp_path / "combined.irl").write_text(text.replace("conf_p, conf_3;", "conf_3;"), encoding="utf-8")
    other = irlx.run(tmp_path / "combined.irl")
    circle = next(r.block.id for r in other.stream.records if getattr(r.block, "course", None) is not None)
    assert distance(moves[4]) < 0.7 * distance(other.q[other.block == circle])


@pytest.mark.req("LANG-60")
def test_several_targets_each_have_their_posture(moves) -> None:
    for rows, name in zip(moves[7:10], ("0", "1", "3"), strict=True):
        np.testing.assert_allclose(rows[-1], CONF[name], atol=1e-6)


@pytest.mark.req("LANG-60")
def test_limits_hold_where_they_are_on_and_a_clause_for_its_move_alone(run: irlx.Run, moves) -> None:
    """The switch of acceleration is off for the last two moves, but for the clause of the first of them."""
    speed = np.array([300, 300, 60, 60, 60, 120, 120, 180]) * UNITS
    acceleration = np.array([800, 800, 200, 200, 200, 400, 400, 600]) * UNITS
    ids = [r.block.id for r in run.stream.records if isinstance(r.block, MoveBlock | ReconfigureBlock)]
    assert np.all(np.abs(run.qd) <= speed * (1.0 + 1e-9))
    switched = np.isin(run.block, ids[:11])
    assert np.all(np.abs(run.qdd[switched]) <= acceleration * (1.0 + 1e-9) + 1e-9)
    use = np.max(np.abs(run.qdd[switched]) / acceleration)
    assert use > 0.9
    assert len(moves) == 12


def nearest_by_obstacle(run: irlx.Run) -> dict[str, np.ndarray]:
    """Distance (M,) m of the arm from the wall and from the frame in the rows of the circle."""
    circle = next(r.block.id for r in run.stream.records if getattr(r.block, "course", None) is not None)
    found: dict[str, np.ndarray] = {}
    for (_, other), rows in nearest(run, FOLDER / "combined.toml", run.block == circle).items():
        name = "window" if other.startswith("window") else other
        found[name] = np.minimum(found.get(name, np.inf), rows)
    return found


@pytest.mark.req("TRF-13")
def test_wall_and_window_are_kept_clear_of_where_the_plain_run_comes_too_near(run, tmp_path: Path) -> None:
    for name in ("combined.toml", "points.dat"):
        (tmp_path / name).write_text((FOLDER / name).read_text(encoding="utf-8"), encoding="utf-8")
    lines = up_to_the_circle().splitlines(keepends=True)
    left = [line for line in lines if not line.lstrip().startswith("OBSTACLE")]
    assert len(left) == len(lines) - 2
    (tmp_path / "combined.irl").write_text("".join(left), encoding="utf-8")
    plain, clear = nearest_by_obstacle(irlx.run(tmp_path / "combined.irl")), nearest_by_obstacle(run)
    for name, margin in (("ściana_1", 0.015), ("window", 0.020)):
        assert clear[name].min() >= margin - 1e-6
        assert plain[name].min() < margin - 1e-3
    assert run.summary.clearance.other == "window_top"
    assert run.summary.clearance.distance == pytest.approx(clear["window"].min(), abs=1e-5)


def test_it_tells_the_return(run: irlx.Run) -> None:
    (back,) = run.summary.returns
    assert back.closed
