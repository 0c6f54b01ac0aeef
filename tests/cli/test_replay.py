"""A stream in the place of a program: its blocks are carried out again, and the same comes of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import irlx
from irlx.cli.main import main
from irlx.streams import read_stream, write_stream
from irlx.streams.header_plain import header_to_plain

pytestmark = pytest.mark.req("STR-02")

CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 10\n'
"""The tool of arm7 starts at (441, 200, 324) mm."""

PROGRAMS = {
    "blends": """BEGIN
  MOVE LIN (500, 200, 325) C_CP := 20;
  MOVE LIN (500, 300, 325) C_CP := 20;
  MOVE LIN (440, 300, 380);
  MOVE CIRCLE (470, 320, 400), (500, 300, 380);
""",
    "a stop that a question makes": """VAR ROBTARGET: here; REAL: x;
BEGIN
  MOVE LIN (500, 200, 325) C_CP := 20;
  here := R_ROBTARGET_ACT;
  MOVE LIN (500, 300, 325) C_CP := 20;
  MOVE LIN (440, 300, 380);
""",
    "signals and time": """VAR OUTPUT BOOL: gripper AT 1; INPUT BOOL: part AT 3;
BEGIN
  MOVE LIN (500, 200, 325) C_CP := 20;
  gripper := TRUE;
  MOVE LIN (500, 300, 325);
  WAIT FOR part;
  IF part THEN MOVE LIN (440, 300, 380) C_CP := 20; ENDIF;
  gripper := FALSE;
  WAIT 0.05 SEC;
  MOVE LIN (440, 250, 380);
  PAUSE;
""",
    "options": """BEGIN
  MOVE PTP MAIN_JOINT(42, 31, -10, 90, 12, 45, -10) C_PTP := 50;
  CYCLICSTART;
  MOVE LIN (500, 200, 325) C_CP := 20;
  MOVE LIN (500, 300, 325);
  CYCLICEND;
  FREEZESTART 2;
  CRITERION JOINT_CENTRING WEIGHT := 2;
  MOVE_INC LIN POSITION(0, 0, 30);
  FREEZEEND;
""",
}


_made: dict[tuple[str, str], irlx.Run] = {}
"""Runs by name of the program and text of the cell: each is made once, whoever replays it."""


def made(folder: Path, name: str, cell: str = CELL) -> irlx.Run:
    (folder / "p.toml").write_text(cell, encoding="utf-8")
    (folder / "p.irl").write_text(f"PROGRAM p;\n{PROGRAMS[name]}ENDPROGRAM;\n", encoding="utf-8")
    if (name, cell) not in _made:
        inputs = {"IN_3": [(0.0, 0.0), (2.0, 1.0)]} if "INPUT" in PROGRAMS[name] else {}
        _made[name, cell] = irlx.run(folder / "p.irl", inputs=inputs, pause_s=0.03)
    _made[name, cell].save(folder / "p.irdata")
    return _made[name, cell]


def assert_same(one: irlx.Run, other: irlx.Run) -> None:
    for name in ("ticks", "q", "block", "tool"):
        assert np.array_equal(getattr(one.stream, name), getattr(other.stream, name)), name
    assert one.stream.records == other.stream.records


@pytest.mark.req("STR-03")
@pytest.mark.parametrize("name", PROGRAMS)
@pytest.mark.parametrize("ending", [".irdata", ".npz", ".jsonl"])
def test_a_replay_is_the_same_stream(name: str, ending: str, tmp_path: Path) -> None:
    run = made(tmp_path, name)
    path = tmp_path / f"p{ending}"
    run.save(path)
    # Nothing of the program is needed.
    (tmp_path / "p.irl").unlink()
    again = irlx.run(path)
    assert_same(run, again)
    assert again.summary == run.summary
    plain, recorded = (header_to_plain(found.header) for found in (again, run))
    assert len(plain["making"].pop("replay_of")) == 64
    for key in ("replay_of", "given", "pause"):
        plain["making"].pop(key, None), recorded["making"].pop(key, None)
    assert plain == recorded


def test_the_blends_of_these_programs_are_made_and_lost(tmp_path: Path) -> None:
    assert not {found.code for found in made(tmp_path, "blends").diagnostics} & {"IRL432", "IRL433"}
    run = made(tmp_path, "a stop that a question makes")
    assert [found.code for found in run.diagnostics if found.code == "IRL432"] == ["IRL432"]
    again = irlx.run(tmp_path / "p.irdata")
    (lost,) = [found for found in again.diagnostics if found.code == "IRL432"]
    assert lost.place is not None
    assert lost.place.line == 4


def test_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = made(tmp_path, "options")
    assert main(["run", str(tmp_path / "p.irdata")]) == 0
    out = capsys.readouterr().out
    assert out.startswith("p.irl: complete, verified, ")
    assert f"written     {tmp_path}/p.replay.irdata  " in out
    assert np.array_equal(read_stream(tmp_path / "p.replay.irdata").q, run.q)
    assert irlx.verify(tmp_path / "p.replay.irdata", tmp_path / "p.irl").passed
    assert main(["run", str(tmp_path / "p.irdata"), "-o", str(tmp_path / "other.npz"), "--quiet"]) == 0
    assert np.array_equal(read_stream(tmp_path / "other.npz").q, run.q)


def test_samples_and_blocks_of_a_replay(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    run = made(tmp_path, "signals and time")
    q = np.array([sample.q for sample in irlx.stream(tmp_path / "p.irdata")])
    assert np.array_equal(q, run.q)
    outcome = irlx.record(tmp_path / "p.irdata", tmp_path / "again.csv")
    assert outcome.summary.samples == len(q)
    inputs = tmp_path / "in.csv"
    inputs.write_text("time,input,value\n0,IN_3,FALSE\n2,IN_3,TRUE\n", encoding="utf-8")
    assert main(["blocks", str(tmp_path / "p.irl"), "--inputs", str(inputs)]) == 0
    of_program = capsys.readouterr().out
    assert main(["blocks", str(tmp_path / "p.irdata")]) == 0
    # The text of the program knows nothing of the time that somebody gave a pause.
    assert [line for line in capsys.readouterr().out.splitlines() if "PAUSE" not in line] == [
        line for line in of_program.splitlines() if "PAUSE" not in line
    ]


def test_another_tick_and_another_robot_of_the_same_joints(tmp_path: Path) -> None:
    run = made(tmp_path, "blends")
    again = irlx.run(tmp_path / "p.irdata", tick_ms=20)
    assert again.header.tick_ns == 20_000_000
    again.save(tmp_path / "again.irdata")
    assert irlx.verify(tmp_path / "again.irdata", cell=tmp_path / "p.toml").passed
    assert again.summary.duration == pytest.approx(run.summary.duration, abs=0.05)
    slow = CELL.replace("[motion]", "[robot.limits]\nspeed = [20, 20, 20, 20, 20, 20, 20]\n[motion]")
    (tmp_path / "slow.toml").write_text(slow, encoding="utf-8")
    slowed = irlx.run(tmp_path / "p.irdata", tmp_path / "slow.toml")
    assert slowed.summary.duration > run.summary.duration
    assert np.max(np.abs(slowed.qd)) <= np.radians(20.0) + 1e-9
    slowed.save(tmp_path / "slowed.irdata")
    assert irlx.verify(tmp_path / "slowed.irdata", cell=tmp_path / "slow.toml").passed


def reason(*arguments: object, **options: object) -> irlx.Diagnostic:
    with pytest.raises(irlx.IrlxError) as caught:
        irlx.run(*arguments, **options)  # type: ignore[arg-type]
    return caught.value.reason


def test_inputs_are_compared_with_the_recorded_ones(tmp_path: Path) -> None:
    run = made(tmp_path, "signals and time")
    same = {"IN_3": [(0.0, 0.0), (2.0, 1.0)]}
    assert_same(run, irlx.run(tmp_path / "p.irdata", inputs=same))
    for trace in ([(0.0, 0.0)], [(0.0, 0.0), (3.0, 1.0)]):
        found = reason(tmp_path / "p.irdata", inputs={"IN_3": trace})
        assert found.code == "IRL728"
        assert "read 1 from IN_3 here, which is 0 now" in found.message
        assert found.place is not None
        assert found.place.line == 7
    assert reason(tmp_path / "p.irdata", inputs=lambda name, time: 0.0).code == "IRL728"
    (tmp_path / "p.irl").unlink()
    assert str(reason(tmp_path / "p.irdata", inputs={"IN_3": [(0.0, 0.0)]}).place) == "p.irl: line 7"


def test_what_cannot_be_replayed(tmp_path: Path) -> None:
    run = made(tmp_path, "blends")
    run.save(tmp_path / "p.csv")
    found = reason(tmp_path / "p.csv")
    assert found.code == "IRL725"
    assert ".irdata" in found.help
    write_stream(replace(run.stream, complete=False), tmp_path / "half.irdata")
    assert reason(tmp_path / "half.irdata", tmp_path / "p.toml").code == "IRL726"
    other = CELL.replace("arm7", "planar3")
    (tmp_path / "other.toml").write_text(other, encoding="utf-8")
    found = reason(tmp_path / "p.irdata", tmp_path / "other.toml")
    assert found.code == "IRL727"
    assert found.place is not None
    assert found.place.file.endswith("other.toml")
    assert reason(tmp_path / "missing.irdata").code == "IRL001"
    (tmp_path / "p.toml").unlink()
    found = reason(tmp_path / "p.irdata")
    assert found.code == "IRL609"
    assert str(tmp_path / "p.toml") in found.message


@pytest.mark.parametrize(
    ("options", "name"),
    [({"max_steps": 5}, "--max-steps"), ({"pause_s": 1.0}, "--pause"), ({"files": "."}, "--files")],
)
def test_options_that_are_for_programs(options: dict[str, object], name: str, tmp_path: Path) -> None:
    made(tmp_path, "blends")
    found = reason(tmp_path / "p.irdata", **options)
    assert found.code == "IRL006"
    assert name in found.message


def test_an_obstacle_that_the_cell_does_not_have(tmp_path: Path) -> None:
    wall = '[[obstacle]]\nname = "wall"\nshape = "sphere"\nradius = 50\nxyz = [1500, 0, 300]\n'
    wall += "margin = 10\ninfluence = 100\n"
    PROGRAMS["obstacle"] = "BEGIN\n  OBSTACLE wall;\n  MOVE LIN (500, 200, 325);\n  OBSTACLEEND wall;\n"
    try:
        run = made(tmp_path, "obstacle", CELL + wall)
    finally:
        del PROGRAMS["obstacle"]
    assert_same(run, irlx.run(tmp_path / "p.irdata"))
    (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
    found = reason(tmp_path / "p.irdata")
    assert found.code == "IRL573"
    assert "'wall'" in found.message
