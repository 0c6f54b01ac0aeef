"""The quadratic problem that --explain-tick prints is the one whose solution the tick is."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.cli.main import main
from long_run import first

pytestmark = pytest.mark.req("TRF-01")

PROGRAM = Path(__file__).parents[2] / "programs" / "koch" / "square.irl"
LINE = PROGRAM.with_name("line.irl")


def solution(problem: dict) -> np.ndarray:
    """Minimiser without bounds, from the equations of Lagrange written out."""
    jacobian, hessian = np.array(problem["jacobian"]), np.array(problem["hessian"])
    hessian = np.diag(hessian) if hessian.ndim == 1 else hessian
    m, n = jacobian.shape
    matrix = np.block([[hessian, jacobian.T], [jacobian, np.zeros((m, m))]])
    right = np.concatenate([-np.array(problem["gradient"]), problem["left"]])
    return np.linalg.solve(matrix, right)[:n]


@pytest.mark.parametrize("tick", first(1, [12, 30]))
def test_its_solution_is_the_first_newton_step(tick: int) -> None:
    """Ticks in which no bound holds: the first step leaves what is of second order in its length."""
    run = irlx.run(LINE, tick_ms=20, explain_tick=tick)
    problem = run.explanation.to_plain()["problem"]
    assert problem["rows"] == ("x", "y", "z", "rx", "ry", "rz")
    assert problem["joints"] == run.joint_names
    step = run.q[tick] - run.q[tick - 1]
    found = solution(problem)
    assert np.max(np.abs(step)) > 1e-4
    assert np.max(np.abs(found - step)) < 10.0 * np.max(np.abs(step)) ** 2


def test_frozen_joints_and_a_whole_hessian(tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text('[robot]\nmodel = "rail6"\n[motion]\ntick_ms = 10\n', encoding="utf-8")
    text = "PROGRAM p;\nVAR POSE: here;\nBEGIN\n  CRITERION KINETIC_ENERGY;\n  MOVE LIN {0};\n"
    text += "  CRITERIONEND KINETIC_ENERGY;\n  FREEZESTART 1;\n  MOVE LIN {1};\n  FREEZEEND;\nENDPROGRAM\n"
    start = irlx.run(written(tmp_path, "PROGRAM p;\nBEGIN\n  HALT;\nENDPROGRAM\n"))
    x, y, z = start.tool[0, :3] * 1e3
    near, back = f"({x}, {y + 40.0}, {z - 30.0})", f"({x}, {y}, {z})"
    program = written(tmp_path, text.format(near, back))
    run = irlx.run(program, explain_tick=12)
    problem = run.explanation.to_plain()["problem"]
    assert np.array(problem["hessian"]).shape == (7, 7)
    step = run.q[12] - run.q[11]
    assert np.max(np.abs(solution(problem) - step)) < 10.0 * np.max(np.abs(step)) ** 2 + 1e-9
    second = next(r.tick for r in run.stream.records if r.block.origin.line == 8)
    run = irlx.run(program, explain_tick=second + 12)
    problem = run.explanation.to_plain()["problem"]
    assert problem["joints"] == run.joint_names[1:]
    step = (run.q[second + 12] - run.q[second + 11])[1:]
    assert np.max(np.abs(solution(problem) - step)) < 10.0 * np.max(np.abs(step)) ** 2


def written(folder: Path, text: str) -> Path:
    (folder / "p.irl").write_text(text, encoding="utf-8")
    return folder / "p.irl"


def test_it_is_printed_and_in_the_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = ["-o", str(tmp_path / "s.npz"), "--no-verify", "--tick", "100"]
    assert main(["run", str(PROGRAM), "--explain-tick", "15", *out]) == 0
    lines = capsys.readouterr().out.splitlines()
    start = next(k for k, line in enumerate(lines) if line.startswith("problem: min g'd"))
    assert "11 joints, 6 rows, 5 unknowns when compact" in lines[start]
    table = {line.split()[0]: line.split()[1:] for line in lines[start + 2 : start + 10]}
    assert list(table) == ["gradient", "hessian", "x", "y", "z", "rx", "ry", "rz"]
    assert [float(value) for value in table["hessian"]] == [11, 10, 9, 8, 7, 6, 5, 4, 3, 5, 1]
    assert all(len(table[row]) == 12 for row in ("x", "rz"))
    assert main(["run", str(PROGRAM), "--explain-tick", "15", "--json", *out]) == 0
    told = json.loads(capsys.readouterr().out)["tick"]["problem"]
    assert [f"{value:.4g}" for value in told["jacobian"][0]] == table["x"][:11]


def test_motions_of_the_joints_have_none(tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text('[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 20\n', encoding="utf-8")
    text = "PROGRAM p;\nVAR JOINT: start;\nBEGIN\n  start := R_JOINT_ACT;\n"
    text += "  FREEZESTART 3;\n  MOVE_INC LIN (30, -60, 0);\n  FREEZEEND;\n"
    text += "  MOVE_INC LIN (-30, 60, 0);\n  RECONFIGURATION start;\nENDPROGRAM\n"
    program = written(tmp_path, text)
    run = irlx.run(program, explain_tick=5)
    assert run.explanation.problem is not None
    last = next(r for r in run.stream.records if r.block.__class__.__name__ == "ReconfigureBlock")
    run = irlx.run(program, explain_tick=last.tick + 3)
    assert run.explanation.motion == "RECONFIGURATION"
    assert run.explanation.problem is None
