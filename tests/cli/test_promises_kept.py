"""Programs that once broke a promise: closure under slowing, frozen zeros, joints that may not move."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import irlx
from irlx.cli.main import main

TIGHT = """[robot]
model = "koch11"
[robot.limits]
position = [180, [-150, 0], [-180, 0], [0, 180], [-180, 0], [-180, 0], 180, 60, 180, 500, [-20, 60]]
speed = [3, 1.8, 1.8, 1.8, 3, 2, 2, 3, 2, 2, 3]
acceleration = [9, 9, 9, 9, 9, 9, 9, 9, 9, 90, 9]
[motion]
tick_ms = 40
speed = 1000
acc = 2000
"""
ARM7 = '[robot]\nmodel = "arm7"\n'


@pytest.fixture
def files(tmp_path):
    """Writes a program and its cell, and gives the path of the program."""

    def write(body: str, cell: str, declarations: str = ""):
        (tmp_path / "p.irl").write_text(
            f"PROGRAM p; {declarations}\nBEGIN\n{body}\nENDPROGRAM\n", encoding="utf-8"
        )
        (tmp_path / "p.toml").write_text(cell, encoding="utf-8")
        return tmp_path / "p.irl"

    return write


def zeros(speed: str) -> str:
    """Declaration of a speed range, one number a joint."""
    minus = ", ".join(f"-{part}" for part in speed.split(", "))
    return f"VAR MAIN_JOINT_SPEED_MIN: lo := ({minus}); MAIN_JOINT_SPEED_MAX: hi := ({speed});"


@pytest.mark.req("TRF-11")
def test_a_closed_path_closes_however_slow_its_moves_become(files):
    """Steps of the joints lag behind the posture by programmed time; the end must not."""
    there, back = "MOVE LIN POSITION(10700, 700, 3300);", "MOVE LIN POSITION(11500, 1000, 3500);"
    body = f"CYCLICSTART;\n{there}\n{back}\nCYCLICEND;"
    program = files(body, TIGHT)
    run = irlx.run(program)
    assert run.summary.slowed
    assert np.max(np.abs(run.q[-1] - run.q[0])) <= 1e-6
    assert irlx.verify(run, program=program).passed


@pytest.mark.req("TRF-12")
def test_a_frozen_minus_zero_keeps_its_sign(files):
    cell = '[robot]\nmodel = "arm7"\nstart = [-0.0, 20, -0.0, 60, 10, 50, 0]\n'
    pose = irlx.run(files("FREEZESTART 3;", cell)).tool[0, :3] * 1e3
    body = f"FREEZESTART 3;\nMOVE LIN POSITION({pose[0] - 20}, {pose[1]}, {pose[2]});\nFREEZEEND;"
    run = irlx.run(files(body, cell))
    assert np.all(np.signbit(run.q[:, 2]))


@pytest.mark.req("MOT-22")
@pytest.mark.parametrize(
    ("speed", "named"), [("0, 0, 0, 0, 0, 0, 0", range(1, 8)), ("50, 50, 50, 0, 50, 50, 50", [4])]
)
def test_joints_that_may_not_move_are_named(files, speed, named):
    program = files("MOVE LIN POSITION(441, 200, 324) WITH JOINTSPEEDLIMIT lo, hi;", ARM7, zeros(speed))
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(program)
    reason = caught.value.reason
    assert reason.code == "IRL520"
    assert reason.place.line == 3
    words = [f"joint_{number} may not move (its speed limit is 0)" for number in range(1, 8)]
    assert [number for number, word in enumerate(words, 1) if word in reason.message] == list(named)


def test_a_stream_codes_faults_of_irlx(files, monkeypatch):
    monkeypatch.delenv("IRLX_DEBUG", raising=False)

    def broken(*_):
        raise np.linalg.LinAlgError("no")

    monkeypatch.setattr("irlx.pacing.path_moves.plan_chain", broken)
    program = files("MOVE LIN POSITION(441, 200, 324);", ARM7)
    with pytest.raises(irlx.IrlxError, match="IRL090"):
        list(irlx.stream(program))


def test_a_tick_is_explained_in_a_run_that_fails_later(files, monkeypatch, capsys):
    pose = irlx.run(files("HALT;", ARM7)).tool[0, :3] * 1e3
    beyond = "MOVE PTP MAIN_JOINT(400, 0, 0, 0, 0, 0, 0);"
    body = f"MOVE LIN POSITION({pose[0]}, {pose[1] + 30}, {pose[2]});\n{beyond}"
    program = files(body, ARM7)
    monkeypatch.chdir(program.parent)
    assert main(["run", "p.irl", "-o", "out.npz", "--explain-tick", "5"]) == 1
    assert capsys.readouterr().out.startswith("tick 5 (")
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(program, explain_tick=5)
    assert caught.value.run.explanation.tick == 5


def test_a_turn_with_a_rounded_way_is_told_in_degrees(files):
    """The target's position was typed with two decimals: a way of micrometres beside a turn of 60 degrees."""
    pose = irlx.run(files("HALT;", ARM7)).tool[0]
    x, y, z = (round(value * 1e3, 2) for value in pose[:3])
    turned = Rotation.from_quat(pose[3:]) * Rotation.from_rotvec([0.0, 0.0, np.radians(60.0)])
    qx, qy, qz, qw = turned.as_quat()
    turn = f"ORIQUAT({qw}, {qx}, {qy}, {qz})"
    speed = "5, 5, 5, 5, 5, 5, 5"
    body = f"MOVE LIN POSE(POSITION({x}, {y}, {z}), {turn}) WITH JOINTSPEEDLIMIT lo, hi;"
    run = irlx.run(files(body, ARM7, zeros(speed)))
    assert run.summary.slowed
    for event in run.summary.slowed:
        assert event.turns
        assert event.length == pytest.approx(np.radians(60.0), rel=1e-3)
        assert event.requested <= np.radians(90.0) * (1.0 + 1e-9)
