"""Whole programs with obstacles: run, listed as blocks, verified, looked at by a dry run."""

from __future__ import annotations

from pathlib import Path

import pytest

import irlx
from irlx.cli.main import main
from irlx.streams import read_stream

pytestmark = [pytest.mark.req("LANG-64"), pytest.mark.req("LANG-34")]

CELL = """[robot]
model = "planar3"
[motion]
tick_ms = 10
[[obstacle]]
name = "Ball"
shape = "sphere"
radius = 100
xyz = [1500, 0, 0]
[[obstacle]]
name = "Far"
shape = "box"
size = [100, 100, 100]
xyz = [-3000, 0, 0]
"""
MOVING = CELL.replace(
    "xyz = [1500, 0, 0]",
    "trajectory = [{ time = 0, xyz = [1500, 0, 0] }, { time = 1, xyz = [1700, 0, 0] }]",
)
PROGRAM = """PROGRAM p;
VAR MAIN_JOINT: stretched := (0, 0, 0), there := (25, 55, -45), back := (20, 60, -50);
BEGIN
  OBSTACLE far;
  MOVE PTP there C_PTP := 50;
  IF CLEARANCE(stretched, BALL) > 399.999 AND CLEARANCE(stretched, ball) < 400.001 THEN
    MOVE PTP back;
  ENDIF;
  OBSTACLEEND far;
ENDPROGRAM
"""


@pytest.fixture
def files(tmp_path: Path, monkeypatch):
    """Writes program and cell into the present folder."""
    monkeypatch.chdir(tmp_path)

    def write(program: str = PROGRAM, cell: str = CELL) -> Path:
        Path("p.irl").write_text(program, encoding="utf-8")
        Path("p.toml").write_text(cell, encoding="utf-8")
        return Path("p.irl")

    return write


def test_a_run_and_what_is_written_of_it(files) -> None:
    files()
    assert main(["run", "p.irl", "--quiet"]) == 0
    blocks = [type(record.block).__name__ for record in read_stream("p.irdata").records]
    assert blocks == ["ObstacleBlock", "MoveBlock", "MoveBlock", "ObstacleBlock"]
    assert read_stream("p.irdata").records[0].block.name == "Far"


def test_a_distance_does_not_cost_a_blend(files) -> None:
    run = irlx.run(files())
    assert [one.code for one in run.diagnostics if one.code in ("IRL432", "IRL433")] == []
    assert irlx.check("p.irl") == []


@pytest.mark.req("LANG-54")
def test_a_distance_from_what_moves_stops_on_the_target_first(files) -> None:
    run = irlx.run(files(cell=MOVING))
    (note,) = (one for one in run.diagnostics if one.code == "IRL432")
    assert note.place is not None
    assert (note.place.line, [related.place.line for related in note.related]) == (5, [6])
    assert "where the obstacles are by then" in note.message


def test_the_blocks_are_listed(files, capsys) -> None:
    files()
    assert main(["blocks", "p.irl"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "1 OBSTACLE Far line 4"
    assert lines[-1] == "4 OBSTACLEEND Far line 9"


def test_the_check_of_the_program_ends_where_only_the_machine_can_answer(files) -> None:
    files()
    assert main(["run", "p.irl", "--quiet"]) == 0
    report = irlx.verify("p.irdata", program="p.irl")
    # With an answer of 0 the program would go another way than the blocks of the stream.
    assert report["program"].status == "ok"
    assert not report.failed


def test_a_dry_run_finds_the_same(files) -> None:
    assert irlx.check(files(), motion=True) == []
    found = irlx.check(files(PROGRAM.replace("far", "fra")), motion=True)
    assert {(one.code, one.place.line) for one in found} == {("IRL573", 4), ("IRL573", 9)}


def test_a_posture_that_avoids_is_one_of_the_pose(files) -> None:
    # planar3 has no joint to spare: its posture of a pose is one of two.
    asked = "p := FK((25, 55, -45)); j := POSTURE(p, far); WRITELN(DISTANCE(FK(j), p) < 0.001);"
    program = f"PROGRAM p; VAR MAIN_JOINT: j; POSE: p; BEGIN {asked} MOVE PTP j; ENDPROGRAM"
    run = irlx.run(files(program))
    assert run.output == "TRUE\n"
    assert not [one for one in irlx.check("p.irl") if one.is_error]


def test_the_forms_of_the_monograph_check_with_a_cell_of_theirs(files, tmp_path: Path) -> None:
    forms = Path(__file__).parents[1] / "language" / "data" / "forms.irl"
    cell = '[robot]\nmodel = "mobile8"\n' + "".join(
        f'[[obstacle]]\nname = "{name}"\nshape = "box"\nsize = [10, 10, 10]\nxyz = [0, 0, 9000]\n'
        for name in ("Ściana_1", "window")
    )
    path = files(forms.read_text(encoding="utf-8"), cell)
    told = {one.code for one in irlx.check(path)}
    assert not {"IRL573", "IRL590", "IRL591"} & told
    files(forms.read_text(encoding="utf-8"), cell.replace("window", "door"))
    assert [one.place.line for one in irlx.check(path) if one.code == "IRL573"] == [52, 57]
