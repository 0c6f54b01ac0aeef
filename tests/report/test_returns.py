"""Returns under CYCLICSTART: found, measured, and what held those that did not close."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.promises import CLOSURE
from irlx.report.terminal import summary_text

pytestmark = pytest.mark.req("TRF-11")

CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 10\n'
CORNERS = "(440, 260, 325)", "(500, 200, 325)", "(500, 330, 380)"


def ran(folder: Path, body: str, cell: str = CELL, declarations: str = "") -> irlx.Run:
    (folder / "p.toml").write_text(cell, encoding="utf-8")
    (folder / "p.irl").write_text(f"PROGRAM p; {declarations}\nBEGIN\n{body}\nENDPROGRAM\n", encoding="utf-8")
    return irlx.run(folder / "p.irl")


def text_of(run: irlx.Run) -> list[str]:
    """The lines on returns, which are the last ones."""
    lines = summary_text(run.summary).splitlines()
    first = next((number for number, line in enumerate(lines) if line.startswith("cyclic")), len(lines))
    return lines[first:]


def triangle(words: str = "") -> str:
    first, second, third = CORNERS
    return f"MOVE LIN {second};\nMOVE LIN {third};\nMOVE LIN {first}{words};\n"


def test_each_return_is_told(tmp_path: Path) -> None:
    run = ran(
        tmp_path, f"MOVE LIN {CORNERS[0]};\nCYCLICSTART;\n{triangle()}{triangle()}CYCLICEND;\n{triangle()}"
    )
    found = run.summary.returns
    assert [(one.line, one.since, one.held) for one in found] == [(7, 4, ""), (10, 4, "")]
    for one in found:
        start = np.flatnonzero(run.block == 1)[-1]
        np.testing.assert_array_equal(one.left, run.q[one.tick] - run.q[start])
        assert one.closed
        assert one.largest <= CLOSURE
        assert run.block[one.tick + 1] != run.block[one.tick]
    (line,) = text_of(run)
    assert line.startswith("cyclic      back in the posture of CYCLICSTART 2 times, to ")


def test_without_the_option_there_is_nothing_to_tell(tmp_path: Path) -> None:
    run = ran(tmp_path, f"MOVE LIN {CORNERS[0]};\n{triangle()}")
    assert run.summary.returns == ()
    assert text_of(run) == []


def test_a_criterion_is_named_with_every_joint_it_holds_off(tmp_path: Path) -> None:
    body = f"MOVE LIN {CORNERS[0]};\nCYCLICSTART;\nCRITERION JOINT_CENTRING;\n{triangle()}CYCLICEND;"
    run = ran(tmp_path, f"{body}\nCRITERIONEND JOINT_CENTRING;")
    (one,) = run.summary.returns
    assert not one.closed
    assert one.held == "CRITERION JOINT_CENTRING"
    line, joints = text_of(run)
    assert line.endswith("line 8: not back in the posture of line 4, held by CRITERION JOINT_CENTRING")
    off = sorted(
        (joint for joint in range(7) if abs(one.left[joint]) > CLOSURE), key=lambda k: -abs(one.left[k])
    )
    assert len(off) > 4
    named = re.findall(r"joint_(\d) ", joints)
    assert [int(name) - 1 for name in named] == off[:3]
    assert joints.endswith(f", and {len(off) - 3} more joints")


def test_a_posture_asked_for_on_the_way_back_is_named(tmp_path: Path) -> None:
    konf = "VAR MAIN_JOINT: k := (50, 29, -13, 95, 9, 48, -13);"
    words = " WITH RECONFIGURATION k"
    body = f"MOVE LIN {CORNERS[0]};\nCYCLICSTART;\n{triangle(words)}{triangle()}CYCLICEND;"
    run = ran(tmp_path, body, declarations=konf)
    away, back = run.summary.returns
    assert away.held == "WITH RECONFIGURATION on this move"
    assert back.closed


def test_a_limit_at_the_end_is_named(tmp_path: Path) -> None:
    """The limit closes behind the start: the posture of CYCLICSTART may not be had again."""
    range_ = "VAR MAIN_JOINT_MIN: low; MAIN_JOINT_MAX: high; MAIN_JOINT: start;"
    body = f"""MOVE LIN {CORNERS[0]};
CYCLICSTART;
MOVE LIN {CORNERS[1]};
start := R_JOINT_ACT.M_JOINT;
low := (-170, -115, start.A3 - 0.01, 0, -170, -120, -175);
high := (170, 115, start.A3 + 0.01, 170, 170, 120, 175);
JOINTLIMIT low, high;
MOVE LIN {CORNERS[2]};
MOVE LIN {CORNERS[0]};
JOINTLIMITEND;
CYCLICEND;"""
    run = ran(tmp_path, body, declarations=range_)
    (one,) = run.summary.returns
    assert not one.closed
    assert one.held.startswith("joint_3 at its ")
    assert one.held.endswith("position limit")


def test_frozen_joints_are_named(tmp_path: Path) -> None:
    konf = "VAR MAIN_JOINT: k := (60, 29, -13, 95, 9, 48, -13);"
    first, second, third = CORNERS
    body = f"""MOVE LIN {first};
CYCLICSTART;
MOVE LIN {second} WITH RECONFIGURATION k;
FREEZESTART 1;
MOVE LIN {third}, {first};
FREEZEEND;
CYCLICEND;"""
    run = ran(tmp_path, body, declarations=konf)
    (one,) = run.summary.returns
    assert one.held == "joint 1 frozen"
    assert run.summary.to_plain()["returns"][0]["closed"] is False
