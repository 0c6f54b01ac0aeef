"""Planar arms: the whole language on a task of three coordinates."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.cell.load import load_cell
from irlx.promises import CLOSURE
from irlx.robot.description import COORDINATES

pytestmark = pytest.mark.req("TRF-21")

LINKS = {"planar3": [0.45, 0.35, 0.2], "planar4": [0.4, 0.3, 0.25, 0.15]}


def ran(folder: Path, body: str, model: str = "planar4", more: str = "", declarations: str = "") -> irlx.Run:
    cell = f'[robot]\nmodel = "{model}"\n{more}\n[motion]\ntick_ms = 4\nspeed = 400\nacc = 2000\n'
    (folder / "p.toml").write_text(cell, encoding="utf-8")
    (folder / "p.irl").write_text(f"PROGRAM p; {declarations}\nBEGIN\n{body}\nENDPROGRAM\n", encoding="utf-8")
    run = irlx.run(folder / "p.irl")
    report = irlx.verify(run, program=folder / "p.irl", cell=folder / "p.toml")
    assert report.passed, str(report)
    return run


def refused(folder: Path, body: str, model: str = "planar4") -> irlx.Diagnostic:
    with pytest.raises(irlx.RunError) as caught:
        ran(folder, body, model)
    return caught.value.diagnostics[0]


def tool(run: irlx.Run, model: str = "planar4") -> np.ndarray:
    """x, y (m) and angle (rad) of the tool in every row, in closed form."""
    angles = np.cumsum(run.q, axis=1)
    links = np.array(LINKS[model])
    return np.stack([np.cos(angles) @ links, np.sin(angles) @ links, angles[:, -1]], axis=1)


def test_a_line_is_straight_in_closed_form(tmp_path: Path) -> None:
    run = ran(tmp_path, "  MOVE LIN ((400, 600, 0), ORIZYX(65, 0, 0));")
    x, y, angle = tool(run).T
    start, end = tool(run)[0], np.array([0.4, 0.6, np.radians(65.0)])
    np.testing.assert_allclose(tool(run)[-1], end, atol=1e-9)
    away = (x - start[0]) * (end[1] - start[1]) - (y - start[1]) * (end[0] - start[0])
    assert np.max(np.abs(away)) < 1e-12
    np.testing.assert_allclose(angle, angle[0], atol=1e-12)


def test_an_arm_without_redundancy_has_one_answer(tmp_path: Path) -> None:
    """Three joints: the posture of a pose in closed form, whatever the option."""
    body = "  CYCLICSTART;\n  MOVE LIN ((300, 650, 0), ORIZYX(60, 0, 0));\n  CYCLICEND;"
    run = ran(tmp_path, body, "planar3")
    np.testing.assert_allclose(tool(run, "planar3")[-1], [0.3, 0.65, np.radians(60.0)], atol=1e-9)
    wrist = np.array([0.3, 0.65]) - 0.2 * np.array([np.cos(np.radians(60)), np.sin(np.radians(60))])
    elbow = np.arccos((wrist @ wrist - 0.45**2 - 0.35**2) / (2 * 0.45 * 0.35))
    shoulder = np.arctan2(wrist[1], wrist[0]) - np.arctan2(0.35 * np.sin(elbow), 0.45 + 0.35 * np.cos(elbow))
    np.testing.assert_allclose(run.q[-1, :2], [shoulder, elbow], atol=1e-9)
    assert (
        refused(tmp_path, "  FREEZESTART 1;\n  MOVE LIN POSITION(300, 650, 0);\n  FREEZEEND;", "planar3").code
        == "IRL347"
    )


def test_every_option(tmp_path: Path) -> None:
    konf = "VAR MAIN_JOINT: k := (35, 40, 40, -50); MAIN_JOINT_MIN: low := (-160, -137, 0, -137);"
    konf += " MAIN_JOINT_MAX: high := (160, 137, 70, 137);"
    body = """  MOVE CIRCLE (450, 700, 0), (400, 620, 0) ANGLE := 360;
  CYCLICSTART;
  MOVE LIN (450, 650, 0), (380, 760, 0) WITH JOINTLIMIT low, high;
  CYCLICEND;
  FREEZESTART 2;
  MOVE LIN ((420, 700, 0), ORIZYX(70, 0, 0));
  FREEZEEND;
  RECONFIGURATION k;
  MOVE LIN (400, 700, 0) WITH RECONFIGURATION k;
  MOVE LIN (300, 650, 0) WITH CRITERION MANIPULABILITY;
  MOVE PTP ((420, 640, 0), ORIZYX(50, 0, 0));
  MOVE PTP k;"""
    run = ran(tmp_path, body, declarations=konf)
    frozen = next(r for r in run.stream.records if r.block.origin.line == 8).block.id
    rows = np.flatnonzero(run.block == frozen)
    assert len(np.unique(run.q[rows, 1])) == 1
    assert run.summary.path_position_error < 1e-9


def test_slowed_on_the_path(tmp_path: Path) -> None:
    slow = "[robot.limits]\nspeed = [10, 10, 10, 10]\nacceleration = [200, 200, 200, 200]"
    body = (
        "  CYCLICSTART;\n  MOVE LIN (350, 650, 0);\n  MOVE LIN (373.52139202, 767.31998434, 0);\n  CYCLICEND;"
    )
    run = ran(tmp_path, body, more=slow)
    assert run.summary.slowed
    assert np.max(np.abs(run.qd)) <= np.radians(10.0) * (1.0 + 1e-9)
    assert np.max(np.abs(run.q[-1] - run.q[0])) <= CLOSURE


def test_manipulability_rises_on_the_rows_of_the_task(tmp_path: Path) -> None:
    """sqrt(det(J J')) of the three rows, by this file's own Jacobian."""

    def measure(run: irlx.Run) -> float:
        angles, links = np.cumsum(run.q[-1]), np.array(LINKS["planar4"])
        x, y = links * np.cos(angles), links * np.sin(angles)
        columns = [[-np.sum(y[j:]), np.sum(x[j:]), 1.1] for j in range(4)]
        rows = np.array(columns).T / 1.1
        return float(np.sqrt(np.linalg.det(rows @ rows.T)))

    target = "MOVE LIN ((500, 500, 0), ORIZYX(40, 0, 0))"
    plain, drawn = ran(tmp_path, f"  {target};"), ran(tmp_path, f"  {target} WITH CRITERION MANIPULABILITY;")
    assert measure(drawn) > 1.01 * measure(plain)


@pytest.mark.parametrize(
    ("target", "off"),
    [
        ("(400, 700, 50)", "z by 50 mm"),
        ("((400, 700, -1), ORIZYX(65, 0, 0))", "z by -1 mm"),
        ("((400, 700, 0), ORIZYX(65, 10, 0))", "ry by 10 deg"),
        ("((400, 700, 0.002), ORIZYX(65, 0, -3))", "z by 0.002 mm, rx by -3 deg"),
    ],
)
@pytest.mark.parametrize("kind", ["LIN", "PTP"])
def test_a_target_out_of_the_plane_is_refused(tmp_path: Path, kind: str, target: str, off: str) -> None:
    found = refused(tmp_path, f"  MOVE {kind} {target};")
    assert (found.code, found.place.line_and_column) == ("IRL430", (3, 3))
    assert off in found.message


def test_a_via_point_out_of_the_plane_is_refused(tmp_path: Path) -> None:
    assert refused(tmp_path, "  MOVE CIRCLE (450, 700, 1), (400, 620, 0);").code == "IRL430"


@pytest.mark.parametrize(
    ("section", "code", "words"),
    [
        ('model = "planar4"\ntask = ["x", "y"]', "IRL615", "rz"),
        ('model = "koch11"\ntask = ["x", "y", "z"]', "IRL615", "rx, ry, rz"),
        ('model = "planar4"\ntask = ["x", "y", "z", "rx", "ry", "rz"]', "IRL613", "6 coordinates"),
        ('model = "planar4"\nlocked = { joint_1 = 0, joint_2 = 0 }', "IRL613", "3 coordinates"),
        ('model = "planar4"\ntask = ["x", "phi"]', "IRL603", "robot.task"),
        ('model = "planar4"\ntask = []', "IRL603", "robot.task"),
    ],
)
def test_tasks_that_do_not_fit(tmp_path: Path, section: str, code: str, words: str) -> None:
    (tmp_path / "p.toml").write_text(f"[robot]\n{section}\n", encoding="utf-8")
    (tmp_path / "p.irl").write_text("PROGRAM p;\nBEGIN\n  HALT;\nENDPROGRAM\n", encoding="utf-8")
    with pytest.raises(irlx.CellError) as caught:
        irlx.run(tmp_path / "p.irl")
    assert caught.value.diagnostics[0].code == code
    assert words in str(caught.value.diagnostics[0])


def test_the_task_is_part_of_what_a_robot_is(tmp_path: Path) -> None:
    """The same links asked for whole poses are another robot: a stream of the one is none of the other."""
    run = ran(tmp_path, "  MOVE LIN (400, 700, 0);")
    robot = load_cell(tmp_path / "p.toml").robot
    assert run.stream.header.robot_fingerprint == robot.fingerprint
    assert replace(robot, coordinates=COORDINATES).fingerprint != robot.fingerprint
