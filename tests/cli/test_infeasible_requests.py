"""What cannot be had is refused with what stands in its way, and the stream until then can be read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.cli.main import main
from irlx.streams import JointStream, read_stream

CELL = """[robot]
model = "koch11"
[robot.limits]
position = [180, [-150, 0], [-180, 0], [0, 180], [-180, 0], [-180, 0], 180, 60, 180, 500, [-20, 60]]
acceleration = [500, 500, 500, 500, 500, 500, 500, 500, 500, 5000, 500]
[motion]
tick_ms = 50
speed = 1000
acc = 2000
"""
FIRST = "MOVE LIN (11400, 1000, 3500);"
NARROW = """VAR MAIN_JOINT_MIN: low := (-0.2, -150, -180, 0, -180, -180, 50, 20, 100, -470, 50);
MAIN_JOINT_MAX: high := (0.2, 0, 0, 180, 0, 0, 60, 30, 110, -455, 60);"""


def written(folder: Path, body: str, declarations: str = "") -> Path:
    (folder / "p.toml").write_text(CELL, encoding="utf-8")
    text = f"PROGRAM p; {declarations}\nBEGIN\n  {FIRST}\n{body}\nENDPROGRAM\n"
    (folder / "p.irl").write_text(text, encoding="utf-8")
    return folder / "p.irl"


def refused(folder: Path, body: str, declarations: str = "") -> tuple[irlx.Diagnostic, irlx.Run]:
    """The error of a program whose first move is `FIRST`, line 3 or 4, and the run until then."""
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(written(folder, body, declarations))
    return next(d for d in caught.value.diagnostics if d.is_error), caught.value.run


def assert_readable(folder: Path, run: irlx.Run, capsys: pytest.CaptureFixture[str]) -> None:
    """The first move stands in the stream, in memory and in the file that the command leaves."""
    assert not run.complete
    assert main(["run", str(folder / "p.irl"), "-o", str(folder / "p.npz"), "--quiet"]) == 1
    capsys.readouterr()
    stream = read_stream(folder / "p.partial.npz")
    assert not stream.complete
    np.testing.assert_array_equal(stream.q, run.q)
    assert_first_move(stream)


def assert_first_move(stream: JointStream) -> None:
    """It ends where the first move does."""
    assert np.linalg.norm(stream.tool[-1, :3] - [11.4, 1.0, 3.5]) < 1e-6


@pytest.mark.req("LANG-72")
@pytest.mark.req("MOT-22")
@pytest.mark.parametrize("clause", [True, False])
def test_limits_that_exclude_the_path(tmp_path: Path, capsys, clause: bool) -> None:
    if clause:
        body, line, told = (
            "  MOVE LIN (11400, -500, 3500) WITH JOINTLIMIT low, high;",
            5,
            "WITH JOINTLIMIT in line 5",
        )
    else:
        body = "  JOINTLIMIT low, high;\n  MOVE LIN (11400, -500, 3500);\n  JOINTLIMITEND;"
        line, told = 6, "JOINTLIMIT in line 5"
    found, run = refused(tmp_path, body, NARROW)
    assert found.code == "IRL520"
    assert found.place.line_and_column[0] == line
    assert "joint_1 is at its lower position limit -0.2 deg" in found.message
    assert f"({told})" in found.message
    assert found.data["tick"] > len(run.q) - 1
    assert "mm (tick " in found.message
    assert_readable(tmp_path, run, capsys)


@pytest.mark.req("LANG-63")
def test_too_many_frozen_joints(tmp_path: Path, capsys) -> None:
    found, run = refused(tmp_path, "  FREEZESTART 1, 2, 3, 4, 5, 6;\n  MOVE LIN (11500, 1000, 3500);")
    assert (found.code, found.place.line_and_column[0]) == ("IRL347", 4)
    assert "6 joints are frozen, but a robot of 11 joints can spare 5" in found.message
    assert_readable(tmp_path, run, capsys)


@pytest.mark.req("LANG-72")
def test_frozen_joints_that_leave_no_way(tmp_path: Path) -> None:
    """Five frozen joints are allowed; here they hold all but one of those that reach sideways."""
    body = "  FREEZESTART 1, 2, 3, 7, 8;\n  MOVE LIN (11400, -500, 3500);\n  FREEZEEND;"
    with pytest.raises(irlx.RunError) as caught:
        irlx.record(written(tmp_path, body), [tmp_path / "p.npz"])
    found = next(d for d in caught.value.diagnostics if d.is_error)
    assert found.code in {"IRL520", "IRL521", "IRL524"}
    assert found.place.line_and_column[0] == 5
    assert "singular value" in found.message
    stream = read_stream(tmp_path / "p.partial.npz")
    assert not stream.complete
    assert_first_move(stream)


@pytest.mark.req("LANG-65")
def test_a_posture_outside_the_limits_is_led_to_the_nearest_inside(tmp_path: Path) -> None:
    """No error: the rule is the nearest posture, with a warning for the bound and one for what is left."""
    konf = "VAR MAIN_JOINT: k := (0, -75, -102, 146, -80, -8, 55, 24, 106, -460, 75);"
    (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
    text = f"PROGRAM p; {konf}\nBEGIN\n  {FIRST}\n  RECONFIGURATION k;\nENDPROGRAM\n"
    (tmp_path / "p.irl").write_text(text, encoding="utf-8")
    run = irlx.run(tmp_path / "p.irl")
    outside = next(d for d in run.diagnostics if d.code == "IRL350")
    assert outside.place.line_and_column[0] == 4
    assert "joint_11 at 75 deg, outside its limits -20 deg to 60 deg" in outside.message
    assert any(d.code == "IRL349" for d in run.diagnostics)
    assert run.complete


@pytest.mark.req("LANG-69")
def test_a_target_posture_outside_the_limits_is_refused(tmp_path: Path, capsys) -> None:
    body = "  MOVE LIN (0, -75, -102, 146, -80, -8, 55, 24, 106, -460, 75);"
    found, run = refused(tmp_path, body)
    assert (found.code, found.place.line_and_column[0]) == ("IRL424", 4)
    assert "joint_11" in found.message
    assert_readable(tmp_path, run, capsys)
