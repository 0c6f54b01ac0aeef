"""Conditions between joints, from the cell to the verified stream, with every option of the language."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.promises import CLOSURE, CONDITION

pytestmark = pytest.mark.req("TRF-12")

CELL = """[robot]
model = "koch11"
{start}
[robot.limits]
speed = [{speed}, {speed}, {speed}, {speed}, {speed}, {speed}, {speed}, {speed}, {speed}, 1000, {speed}]
acceleration = [300, 300, 300, 300, 300, 300, 300, 300, 300, 3000, 300]
[motion]
tick_ms = 40
speed = 1000
acc = 2000
[[constraint]]
name = "booms"
joints = {{ joint_3 = 1, joint_2 = 2 }}
[[constraint]]
name = "slide follows the wrist"
joints = {{ joint_10 = 1, joint_9 = 2.5 }}
"""
BOOMS = np.array([0, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0], dtype=float)
SLIDE = np.array([0, 0, 0, 0, 0, 0, 0, 0, 2.5 * 1e-3 * 180 / np.pi, 1, 0])


def ran(folder: Path, body: str, speed: int = 100, declarations: str = "", start: str = "") -> irlx.Run:
    (folder / "p.toml").write_text(CELL.format(speed=speed, start=start), encoding="utf-8")
    (folder / "p.irl").write_text(f"PROGRAM p; {declarations}\nBEGIN\n{body}\nENDPROGRAM\n", encoding="utf-8")
    return irlx.run(folder / "p.irl")


def broken(run: irlx.Run) -> float:
    """How far any row is from what held in the first one; formulas of this file."""
    away = run.q - run.q[0]
    return float(np.max(np.abs(np.vstack([away @ BOOMS, away @ SLIDE]))))


def assert_kept(run: irlx.Run, folder: Path) -> None:
    assert broken(run) <= 1e-9
    report = irlx.verify(run, program=folder / "p.irl", cell=folder / "p.toml")
    assert report.passed, str(report)
    assert report["constraints"].status == "ok"
    assert run.summary.path_position_error <= 1e-9


SQUARE = """  MOVE LIN (9500, 1000, 3500);
  MOVE LIN ((9500, -1000, 3500), ORIVANG((0, 1, 0), -40));
  MOVE LIN ((11500, -1000, 3500), ORIQUAT(1, 0, 0, 0));
  MOVE LIN (11500, 1000, 3500);"""


def test_lines_keep_conditions(tmp_path: Path) -> None:
    free = irlx.run(without_constraints(tmp_path))
    assert broken(free) > 0.01
    run = ran(tmp_path, SQUARE)
    assert_kept(run, tmp_path)
    assert np.max(np.abs(run.q[-1] - free.q[-1])) > 0.01


def without_constraints(folder: Path) -> Path:
    text = CELL.format(speed=100, start="")
    (folder / "free.toml").write_text(text[: text.index("[[constraint]]")], encoding="utf-8")
    (folder / "free.irl").write_text(f"PROGRAM free;\nBEGIN\n{SQUARE}\nENDPROGRAM\n", encoding="utf-8")
    return folder / "free.irl"


def test_conditions_hold_while_the_posture_returns(tmp_path: Path) -> None:
    run = ran(tmp_path, f"  CYCLICSTART;\n{SQUARE}\n  CYCLICEND;")
    assert_kept(run, tmp_path)
    assert np.max(np.abs(run.q[-1] - run.q[0])) <= CLOSURE


def test_conditions_hold_where_the_tool_is_slowed(tmp_path: Path) -> None:
    run = ran(tmp_path, "  MOVE LIN (10500, 1000, 3500);", speed=5)
    assert run.summary.slowed
    assert_kept(run, tmp_path)


def test_conditions_hold_in_reconfiguration_and_with_frozen_joints(tmp_path: Path) -> None:
    body = f"""  FREEZESTART 7, 8;
  MOVE LIN (10500, 1000, 3500);
  FREEZEEND;
{SQUARE}
  RECONFIGURATION k;
  MOVE LIN (11000, 900, 3400) WITH RECONFIGURATION k;"""
    konf = "VAR MAIN_JOINT: k := (0, -75, -102, 146, -80, -8, 55, 24, 106, -460, 0);"
    run = ran(tmp_path, body, declarations=konf)
    assert_kept(run, tmp_path)
    assert np.max(np.ptp(run.q, axis=0)) > 0.1


def test_a_ptp_to_a_pose_ends_where_conditions_hold(tmp_path: Path) -> None:
    run = ran(tmp_path, "  MOVE PTP (11000, 800, 3400);")
    assert_kept(run, tmp_path)


def test_a_ptp_that_breaks_a_condition_is_refused(tmp_path: Path) -> None:
    with pytest.raises(irlx.RunError) as refused:
        ran(tmp_path, "  MOVE PTP (0, -75, -100, 146, -80, -8, 55, 24, 106, -460, 58);")
    reason = refused.value.diagnostics[0]
    assert reason.code == "IRL351"
    assert "'booms'" in reason.message
    assert reason.place.line_and_column[0] == 3
    assert len(refused.value.run.q) == 1


def test_too_many_joints_frozen_counts_the_conditions(tmp_path: Path) -> None:
    """Eleven joints, six coordinates, two conditions: three to spare."""
    ran(tmp_path, "  FREEZESTART 4, 5, 6;\n  MOVE LIN (11450, 1000, 3500);\n  FREEZEEND;")
    with pytest.raises(irlx.RunError) as refused:
        ran(tmp_path, "  FREEZESTART 4, 5, 6, 11;\n  MOVE LIN (11400, 1000, 3500);\n  FREEZEEND;")
    assert refused.value.diagnostics[0].code == "IRL347"


def test_a_stream_that_breaks_a_condition_fails(tmp_path: Path) -> None:
    run = ran(tmp_path, "  MOVE LIN (11400, 1000, 3500);")
    run.save(tmp_path / "p.npz")
    with np.load(tmp_path / "p.npz") as file:
        arrays = dict(file)
    arrays["q"][8, 2] += 2.0 * CONDITION
    np.savez(tmp_path / "p.npz", **arrays)
    report = irlx.verify(tmp_path / "p.npz", cell=tmp_path / "p.toml")
    failed = {check.name for check in report.failed}
    assert "constraints" in failed
    assert report["constraints"].first.tick == 8


@irlx.register
class Boom(irlx.Constraint):
    """The end of the second boom stays at its height: sines of two angles, no straight line."""

    name = "height of the second boom"

    def __init__(self, kinematics):
        self.joints = kinematics.joints
        self.due = 0.0
        start = np.zeros(self.joints)
        start[1:3] = np.radians([-75.0, -102.0])
        self.due = self._height(start)

    def _height(self, q):
        return 6.0 * np.sin(q[1]) + 4.0 * np.sin(q[1] + q[2])

    def residual(self, q):
        return np.array([self._height(q) - self.due])

    def derivative(self, q):
        row = np.zeros((1, self.joints))
        row[0, 2] = 4.0 * np.cos(q[1] + q[2])
        row[0, 1] = 6.0 * np.cos(q[1]) + row[0, 2]
        return row


def test_a_constraint_of_ones_own(tmp_path: Path) -> None:
    text = CELL.format(speed=100, start="")
    own = text[: text.index("[[constraint]]")] + f'[[constraint]]\nname = "boom"\nuse = "{Boom.name}"\n'
    (tmp_path / "p.toml").write_text(own, encoding="utf-8")
    text = f"PROGRAM p;\nBEGIN\n  CYCLICSTART;\n{SQUARE}\n  CYCLICEND;\nENDPROGRAM\n"
    (tmp_path / "p.irl").write_text(text, encoding="utf-8")
    run = irlx.run(tmp_path / "p.irl")
    heights = 6.0 * np.sin(run.q[:, 1]) + 4.0 * np.sin(run.q[:, 1] + run.q[:, 2])
    assert np.ptp(heights) <= 1e-9
    assert np.ptp(run.q[:, 1]) > 0.01
    assert np.max(np.abs(run.q[-1] - run.q[0])) <= CLOSURE


def test_what_is_no_constraint_and_no_criterion_is_refused() -> None:
    with pytest.raises(TypeError, match="neither"):
        irlx.register(int)


@pytest.mark.parametrize(
    ("section", "code", "key"),
    [
        ('name = "a"', "IRL603", "constraint[1]"),
        ('name = "a"\njoints = { joint_1 = 1 }\nuse = "b"', "IRL603", "constraint[1]"),
        ('name = "a"\nuse = "b"\nvalue = 1', "IRL603", "constraint[1]"),
        ('name = "a"\njoints = { joint_1 = 0 }', "IRL603", "constraint[1]"),
        ('name = "a"\njoints = {}', "IRL603", "constraint[1].joints"),
        ('name = ""\njoints = { joint_1 = 1 }', "IRL603", "constraint[1].name"),
        ('name = "a"\njoints = { joint_12 = 1 }', "IRL606", "constraint[1].joints.joint_12"),
        ('name = "a"\njoint = { joint_1 = 1 }', "IRL602", "constraint[1].joint"),
        ('name = "a"\njoints = { joint_2 = 1 }\nvalue = -74.9', "IRL616", "constraint[1]"),
        ('name = "a"\nuse = "nobody\'s"', "IRL617", "constraint[1].use"),
    ],
)
def test_faults_of_a_cell(tmp_path: Path, section: str, code: str, key: str) -> None:
    text = CELL.format(speed=100, start="")
    (tmp_path / "p.toml").write_text(text[: text.index("[[constraint]]")] + f"[[constraint]]\n{section}\n")
    (tmp_path / "p.irl").write_text("PROGRAM p;\nBEGIN\n  MOVE LIN (11400, 1000, 3500);\nENDPROGRAM\n")
    with pytest.raises(irlx.CellError) as caught:
        irlx.run(tmp_path / "p.irl")
    found = [(d.code, d.place.key) for d in caught.value.diagnostics]
    assert (code, key) in found
