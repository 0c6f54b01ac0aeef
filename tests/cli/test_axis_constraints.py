"""The axis of a link along a direction of the root frame, from the cell to the verified stream."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.promises import CLOSURE, CONDITION

pytestmark = pytest.mark.req("TRF-12")

CELL = """[robot]
model = "koch11"
start = [0, -75, -102, 147, -80, 20, 0, 24, 106, -460, 58]
[robot.limits]
speed = [60, 60, 60, 60, 60, 60, 60, 60, 60, 1000, 60]
acceleration = [300, 300, 300, 300, 300, 300, 300, 300, 300, 3000, 300]
[motion]
tick_ms = 20
speed = 1000
acc = 2000
[[constraint]]
name = "level"
link = "arm_8"
axis = [0, 0, 2]
direction = [-3, 0, 0]
"""
SQUARE = """  MOVE_INC LIN POSITION(-1000, 0, 0);
  MOVE_INC LIN POSITION(0, -1000, 0);
  MOVE_INC LIN POSITION(1000, 0, 0);
  MOVE_INC LIN POSITION(0, 1000, 0);"""


def ran(folder: Path, body: str, cell: str = CELL, declarations: str = "") -> irlx.Run:
    (folder / "p.toml").write_text(cell, encoding="utf-8")
    (folder / "p.irl").write_text(f"PROGRAM p; {declarations}\nBEGIN\n{body}\nENDPROGRAM\n", encoding="utf-8")
    return irlx.run(folder / "p.irl")


def tilt(q: np.ndarray) -> float:
    """The largest angle (rad) of the z axis of arm_8 to -x, by hand.

    Joint 1 turns about z, joints 2 to 6 turn about y, joint 7 turns about -x.
    """
    pitch = np.sum(q[:, 1:6], axis=1)
    ahead, aside = np.sin(pitch) * np.cos(q[:, 6]), np.sin(q[:, 6])
    x = np.cos(q[:, 0]) * ahead - np.sin(q[:, 0]) * aside
    y = np.sin(q[:, 0]) * ahead + np.cos(q[:, 0]) * aside
    return float(np.max(np.arctan2(np.hypot(y, np.cos(pitch) * np.cos(q[:, 6])), -x)))


def test_an_axis_stays_level(tmp_path: Path) -> None:
    without = CELL[: CELL.index("[[constraint]]")]
    assert tilt(ran(tmp_path, SQUARE, without).q) > 0.05
    run = ran(tmp_path, SQUARE)
    assert tilt(run.q) <= 1e-9
    report = irlx.verify(run, program=tmp_path / "p.irl", cell=tmp_path / "p.toml")
    assert report.passed, str(report)
    assert report["constraints"].status == "ok"
    assert report["constraints"].worst.constraint == "level"
    assert report["constraints"].worst.unit == "rad"
    assert "level" in str(report)


def test_it_stays_level_with_the_options(tmp_path: Path) -> None:
    konf = "VAR MAIN_JOINT: k := (5, -75, -102, 147, -70, 10, 0, 24, 106, -460, 58);"
    body = f"""  CYCLICSTART;
{SQUARE}
  CYCLICEND;
  FREEZESTART 8, 10;
  MOVE_INC LIN POSITION(-300, 0, 200);
  FREEZEEND;
  RECONFIGURATION k;
  MOVE_INC LIN POSITION(300, 0, -200) WITH RECONFIGURATION k;"""
    run = ran(tmp_path, body, declarations=konf)
    assert tilt(run.q) <= 1e-9
    report = irlx.verify(run, program=tmp_path / "p.irl", cell=tmp_path / "p.toml")
    assert report.passed, str(report)
    assert report["cyclic closure"].worst.value <= CLOSURE


def test_a_ptp_that_tilts_it_is_refused(tmp_path: Path) -> None:
    with pytest.raises(irlx.RunError) as refused:
        ran(tmp_path, "  MOVE PTP (0, -70, -102, 147, -80, 20, 0, 24, 106, -460, 58);")
    assert refused.value.reason.code == "IRL351"
    assert "'level'" in refused.value.reason.message
    run = ran(tmp_path, "  MOVE PTP (0, -70, -107, 147, -80, 20, 0, 24, 106, -460, 58);")
    assert tilt(run.q) <= CONDITION


def test_a_stream_that_tilts_it_fails_by_its_name(tmp_path: Path) -> None:
    run = ran(tmp_path, "  MOVE_INC LIN POSITION(-300, 0, 0);")
    run.save(tmp_path / "p.npz")
    with np.load(tmp_path / "p.npz") as file:
        arrays = dict(file)
    arrays["q"][20, 2] += 2.0 * CONDITION
    np.savez(tmp_path / "p.npz", **arrays)
    found = irlx.verify(tmp_path / "p.npz", cell=tmp_path / "p.toml")["constraints"]
    assert found.status == "failed"
    assert (found.first.tick, found.first.constraint) == (20, "level")
    assert found.first.value == pytest.approx(2.0 * CONDITION, abs=1e-9)


def test_an_axis_that_points_the_other_way_is_no_start(tmp_path: Path) -> None:
    with pytest.raises(irlx.CellError) as refused:
        ran(tmp_path, SQUARE, CELL.replace("direction = [-3, 0, 0]", "direction = [1, 0, 0]"))
    found = refused.value.diagnostics[0]
    assert (found.code, found.place.key) == ("IRL619", "constraint[1]")
    assert found.message == (
        "the start posture breaks the constraint 'level': "
        "the axis of arm_8 points along (-1, 0, 0), 180 deg off"
    )


@pytest.mark.parametrize(
    ("section", "code", "key"),
    [
        ("axis = [0, 0, 1]\ndirection = [0, 0, 1]", "IRL603", "constraint[1]"),
        ('link = "arm_7"\naxis = [1, 0, 0]', "IRL603", "constraint[1]"),
        ('link = "arm_7"\ndirection = [1, 0, 0]', "IRL603", "constraint[1]"),
        ('link = "arm_7"\naxis = [1, 0, 0]\ndirection = [0, 0, 1]\nvalue = 1', "IRL603", "constraint[1]"),
        ('link = "arm_7"\naxis = [1, 0, 0]\ndirection = [0, 0, 1]\nuse = "a"', "IRL603", "constraint[1]"),
        ('link = "arm_7"\naxis = [0, 0, 0]\ndirection = [0, 0, 1]', "IRL603", "constraint[1].axis"),
        ('link = "arm_7"\naxis = [1, 0, 0]\ndirection = [0, -0.0, 0]', "IRL603", "constraint[1].direction"),
        ('link = "arm_7"\naxis = [1, 0]\ndirection = [0, 0, 1]', "IRL603", "constraint[1].axis"),
        ('link = "arm_7"\naxis = [1, 0, nan]\ndirection = [0, 0, 1]', "IRL603", "constraint[1].axis[3]"),
        ('link = "arm7"\naxis = [1, 0, 0]\ndirection = [0, 0, 1]', "IRL643", "constraint[1].link"),
        ('link = "arm_7"\naxis = [1, 0, 0]\ndirection = [0.1, 0, 1]', "IRL619", "constraint[1]"),
        # Joints tilt it one way only: a relation between them says as much.
        ('link = "arm_7"\naxis = [1, 0, 0]\ndirection = [0, 0, 1]', "IRL624", "constraint[1]"),
        # No joint moves it.
        ('link = "arm_2"\naxis = [0, 0, 1]\ndirection = [0, 0, 1]', "IRL624", "constraint[1]"),
    ],
)
def test_faults_of_a_cell(tmp_path: Path, section: str, code: str, key: str) -> None:
    cell = CELL[: CELL.index("[[constraint]]")] + f'[[constraint]]\nname = "a"\n{section}\n'
    cell = cell.replace("tick_ms = 20", "tick_ms = 50")
    with pytest.raises(irlx.CellError) as caught:
        ran(tmp_path, "  MOVE_INC LIN POSITION(-100, 0, 0);", cell)
    assert (code, key) in [(d.code, d.place.key) for d in caught.value.diagnostics]


def test_what_the_pose_of_the_tool_says_already_is_refused(tmp_path: Path) -> None:
    run = ran(tmp_path, "  WAIT 0.1 SEC;")
    rotation = Rotation.from_quat(run.tool[0, 3:]).as_matrix()
    cell = CELL.replace('link = "arm_8"', 'link = "tcp"').replace("[-3, 0, 0]", str(rotation[:, 2].tolist()))
    with pytest.raises(irlx.CellError) as caught:
        ran(tmp_path, SQUARE, cell)
    assert caught.value.diagnostics[0].code == "IRL624"


def test_the_same_constraint_twice_is_refused(tmp_path: Path) -> None:
    again = CELL[CELL.index("[[constraint]]") :].replace("level", "again")
    with pytest.raises(irlx.CellError) as caught:
        ran(tmp_path, SQUARE, CELL + again)
    found = caught.value.diagnostics[0]
    assert (found.code, found.place.key) == ("IRL624", "constraint[2]")
    assert "'again' holds 2 coordinates" in found.message
    assert "can move 0 of them" in found.message
