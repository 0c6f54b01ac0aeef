"""`irlx check --motion` says what a run would: the same errors at the same places, and what will be slow."""

from __future__ import annotations

import json
import time
from pathlib import Path

import pytest

import irlx
from drawn_programs import write_program
from irlx.cli.main import main
from irlx.dry_run import dry_run
from irlx.job import prepare
from irlx.pipeline import Execution
from long_run import first, portions

SEEDS, LONG = range(200, 215), range(2000, 2300)
SLOW = """PROGRAM slow;
VAR POSITION: p := (441, 100, 324), home := (441, 200, 324); POSE: q;
BEGIN
  q := R_ROBTARGET_ACT.PSE;
  MOVE LIN home;
  MOVE LIN p SPEED := 1500, ACC := 9000;
  MOVE LIN home SPEED := 50;
  OUT_1 := TRUE;
  MOVE LIN POSITION(800, 200, 324);
  MOVE LIN q;
  MOVE LIN POSITION(441, 200, 1500);
ENDPROGRAM;
"""
CELL = '[robot]\nmodel = "arm7"\n[signals.outputs]\n'


def motion_codes(found: list[irlx.Diagnostic]) -> list[tuple[int, str]]:
    return [(one.place.line, one.code) for one in found if one.place is not None and one.is_error]


@pytest.fixture(scope="module")
def slow(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("slow")
    (folder / "slow.toml").write_text('[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 20\n')
    (folder / "slow.irl").write_text(SLOW)
    return folder / "slow.irl"


@pytest.fixture(scope="module")
def found(slow) -> list[irlx.Diagnostic]:
    """What a dry run says of the program."""
    return irlx.check(slow, motion=True)


def test_all_that_is_wrong_is_told_in_one_pass(found) -> None:
    codes = [(one.place.line, one.code) for one in found if one.place is not None]
    assert (6, "IRL445") in codes
    assert [place for place in codes if place[1].startswith("IRL52")] == [(9, "IRL520"), (11, "IRL520")]
    assert all(line not in (7, 10) for line, _ in codes)


def test_it_is_off_unless_asked_for(slow) -> None:
    assert [one.code for one in irlx.check(slow)] == ["IRL205"]


def test_the_command_line_finds_the_same(tmp_path, capsys) -> None:
    (tmp_path / "t.toml").write_text('[robot]\nmodel = "arm7"\n')
    (tmp_path / "t.irl").write_text(PLACES.format(move="LIN", first=700, last=1))
    found = irlx.check(tmp_path / "t.irl", motion=True)
    assert [one.code for one in found if one.is_error] == ["IRL520"]
    assert main(["check", str(tmp_path / "t.irl"), "--motion", "--format", "json"]) == 1
    told = json.loads(capsys.readouterr().out)
    assert [(one["line"], one["code"]) for one in told] == [
        (one.place.line, one.code) for one in found if one.place is not None
    ]


def test_it_writes_nothing(tmp_path) -> None:
    (tmp_path / "w.toml").write_text('[robot]\nmodel = "arm7"\n')
    body = "OPEN(log, 'a.txt', 'WRITE');\nWRITE(log, 'x');\nCLOSE(log);"
    (tmp_path / "w.irl").write_text(f"PROGRAM w;\nVAR FILE: log;\nBEGIN\n{body}\nENDPROGRAM;\n")
    assert irlx.check(tmp_path / "w.irl", motion=True) == []
    assert sorted(path.name for path in tmp_path.iterdir()) == ["w.irl", "w.toml"]


def agree(folder: Path, seed: int) -> None:
    """The first error of a run is the dry run's first one, at the same line; without one there is none."""
    write_program(folder, seed)
    in_check = motion_codes(irlx.check(folder / "drawn.irl", motion=True))
    try:
        irlx.run(folder / "drawn.irl")
        in_run: list[tuple[int, str]] = []
    except irlx.RunError as error:
        in_run = motion_codes([error.reason])
    assert sorted(in_check)[:1] == in_run


@pytest.mark.parametrize("seed", first(4, SEEDS))
def test_drawn_programs_have_the_errors_of_their_runs(tmp_path, seed) -> None:
    agree(tmp_path, seed)


@pytest.mark.slow
@pytest.mark.parametrize("seeds", portions(LONG), ids=str)
def test_many_drawn_programs_have_the_errors_of_their_runs(tmp_path, seeds) -> None:
    for seed in seeds:
        print("seed", seed)
        agree(tmp_path, seed)


def test_it_takes_a_fifth_of_the_time_of_the_motion(tmp_path) -> None:
    """At a tick of 1 ms; what is slowed costs a plan in both."""
    (tmp_path / "long.toml").write_text('[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 1\n')
    moves = "MOVE LIN (441, 100, 324); MOVE LIN (541, 100, 424); MOVE LIN (441, 200, 324);" * 4
    (tmp_path / "long.irl").write_text(
        f"PROGRAM long;\nBEGIN\nMOVE LIN (441, 200, 324);\n{moves}\nENDPROGRAM;\n"
    )
    job = prepare(tmp_path / "long.irl")
    whole, dry = [], []
    # A machine may be slow for a while; one round that tells is enough.
    while len(whole) < 4 and not (whole and min(dry) * 5.0 < min(whole)):
        for taken, carry_out in ((whole, lambda: list(Execution(job))), (dry, lambda: dry_run(job))):
            begin = time.process_time()
            carry_out()
            taken.append(time.process_time() - begin)
    assert min(dry) * 5.0 < min(whole), (whole, dry)


def test_it_reads_in_the_folder_that_it_is_given(tmp_path, capsys) -> None:
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "ways.txt").write_text("150\n")
    (tmp_path / "r.toml").write_text('[robot]\nmodel = "arm7"\n')
    body = "OPEN(f, 'ways.txt', 'READ');\nREAD(f, y);\nCLOSE(f);\nMOVE LIN POSITION(441, y, 324);"
    (tmp_path / "r.irl").write_text(f"PROGRAM r;\nVAR FILE: f; REAL: y;\nBEGIN\n{body}\nENDPROGRAM;\n")
    assert main(["check", str(tmp_path / "r.irl"), "--motion", "--files", str(tmp_path / "data")]) == 0
    assert [one.code for one in irlx.check(tmp_path / "r.irl", motion=True)] == ["IRL541"]
    capsys.readouterr()


PLACES = """PROGRAM t;
VAR INT: i;
PROCEDURE place(REAL: x);
BEGIN
  MOVE {move} POSE((x, 200, 324), ORIZYX(0, 180, 0));
ENDPROC;
BEGIN
  MOVE LIN POSITION(441, 200, 324);
  FOR i := 0 TO {last} DO
    place({first} + 100 * i);
    place(441);
  ENDFOR;
ENDPROGRAM;
"""


@pytest.mark.parametrize(("move", "code"), [("PTP", "IRL522"), ("LIN", "IRL520")])
def test_which_targets_of_a_line_cannot_be_reached(tmp_path, move, code) -> None:
    """The wrist comes 0.76 m from the shoulder: of 600, 700, 800 and 900 mm the last two are too far."""
    (tmp_path / "t.toml").write_text('[robot]\nmodel = "arm7"\n')
    (tmp_path / "t.irl").write_text(PLACES.format(move=move, first=600, last=3))
    found = [one for one in irlx.check(tmp_path / "t.irl", motion=True) if one.is_error]
    assert [(one.code, one.place.line) for one in found if one.place] == [(code, 5)]
    (one,) = found
    assert "(800, 200, 324) mm" in one.message
    assert one.message.endswith("; so it is once more, for (900, 200, 324) mm")
    assert [(related.message, related.place.line) for related in one.related] == [("called here", 10)]


def test_a_run_tells_from_where_a_procedure_was_called(tmp_path) -> None:
    (tmp_path / "t.toml").write_text('[robot]\nmodel = "arm7"\n')
    (tmp_path / "t.irl").write_text(PLACES.format(move="PTP", first=800, last=0))
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(tmp_path / "t.irl")
    reason = caught.value.reason
    assert "(800, 200, 324) mm" in reason.message
    assert [(related.message, related.place.line) for related in reason.related] == [("called here", 10)]


def test_a_line_that_fails_all_the_time_is_given_up(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("irlx.dry_run.MOST_FAILURES", 3)
    monkeypatch.setattr("irlx.dry_run.MOST_TARGETS", 1)
    (tmp_path / "t.toml").write_text('[robot]\nmodel = "arm7"\n')
    (tmp_path / "t.irl").write_text(PLACES.format(move="PTP", first=800, last=3))
    (one,) = [one for one in irlx.check(tmp_path / "t.irl", motion=True) if one.is_error]
    assert one.message.endswith("; so it is 2 more times at least, for (900, 200, 324) mm and 1 other")


def test_nobody_is_asked_on_standard_in(tmp_path) -> None:
    (tmp_path / "s.toml").write_text('[robot]\nmodel = "arm7"\n')
    (tmp_path / "s.irl").write_text("PROGRAM s;\nVAR INT: i;\nBEGIN\nREAD(i);\nWRITE(i);\nENDPROGRAM;\n")
    assert [one.code for one in irlx.check(tmp_path / "s.irl", motion=True)] == ["IRL546"]


def test_a_coarse_row_is_told_by_its_tick(tmp_path) -> None:
    """Something comes near a PTP, and a wait: a run says when, a dry run by its coarse rows."""
    (tmp_path / "p.toml").write_text(
        '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 10\n[[obstacle]]\nname = "ball"\nshape = "sphere"\n'
        "radius = 50\nmargin = 10\ninfluence = 10\ntrajectory = [\n"
        "  { time = 1.0, xyz = [441, -2000, 325] }, { time = 2.0, xyz = [441, 261, 325] } ]\n"
    )
    for move in ("WAIT 3 SEC;", "MOVE PTP MAIN_JOINT(40, 29, -13, 95, 9, 48, 80) OVERRIDE := 10;"):
        (tmp_path / "p.irl").write_text(f"PROGRAM p;\nBEGIN\n  OBSTACLE ball;\n  {move}\nENDPROGRAM;\n")
        with pytest.raises(irlx.RunError) as caught:
            irlx.run(tmp_path / "p.irl")
        (dry,) = (one for one in irlx.check(tmp_path / "p.irl", motion=True) if one.is_error)
        assert dry.code == caught.value.reason.code == "IRL561"
        assert 0 <= dry.data["tick"] - caught.value.reason.data["tick"] < 10


def test_a_band_that_few_knots_would_pass_is_no_error(tmp_path) -> None:
    """Joints are so slow that the move is planned; between the knots of a dry run the bands swing too far."""
    (tmp_path / "p.toml").write_text('[robot]\nmodel = "koch11"\n[motion]\ntick_ms = 50\n')
    (tmp_path / "p.irl").write_text(
        "PROGRAM p;\nVAR ORIENTATION: o := ORIQUAT(1, 0, 0, 0);\n"
        "  MAIN_JOINT_SPEED_MIN: lo := (-11, -11, -1, -1, -11, -1, -11, -1, -34, -200, -34);\n"
        "  MAIN_JOINT_SPEED_MAX: hi := (11, 11, 1, 1, 11, 1, 11, 1, 34, 200, 34);\n"
        "BEGIN\n  MOVE LIN POSITION(11501, 1046, 3490) SPEED := 265;\n  JOINTSPEEDLIMIT lo, hi;\n"
        "  MOVE LIN ((11482, 1064, 3497), o @ ORIZYX(-3, -6, 3.5)) ACC := 867\n"
        "    WITH TOLERANCE (0, 300, 5, 1, 5, 0);\nENDPROGRAM;\n"
    )
    assert irlx.run(tmp_path / "p.irl").complete
    assert motion_codes(irlx.check(tmp_path / "p.irl", motion=True)) == []


def test_it_ends_at_a_closed_path_that_would_begin_nobody_knows_where(tmp_path) -> None:
    """Questions for the posture: the page of IRL447."""
    (tmp_path / "t.toml").write_text('[robot]\nmodel = "arm7"\n')
    beyond = "MOVE LIN POSITION(900, 261, 325);"
    body = f"{beyond}\nCYCLICSTART;\nMOVE_INC LIN (0, 20, 0);\nCYCLICEND;"
    (tmp_path / "t.irl").write_text(f"PROGRAM t;\nBEGIN\n{body}\nENDPROGRAM;\n")
    found = irlx.check(tmp_path / "t.irl", motion=True)
    assert [(one.place.line, one.code) for one in found if one.place] == [(3, "IRL520"), (4, "IRL447")]
    assert "since the move of line 3" in found[1].message


def test_of_joined_moves_the_one_that_cannot_be_done_is_told_and_the_next_looked_at(tmp_path) -> None:
    (tmp_path / "t.toml").write_text('[robot]\nmodel = "arm7"\n')
    lines = ["(441, 150, 324) C_CP := 10", "(900, 261, 325) C_CP := 10", "(441, 200, 324) C_CP := 10"]
    body = "\n".join(f"MOVE LIN {line};" for line in [*lines, "(441, 180, 324)"])
    (tmp_path / "t.irl").write_text(f"PROGRAM t;\nBEGIN\n{body}\nENDPROGRAM;\n")
    assert motion_codes(irlx.check(tmp_path / "t.irl", motion=True)) == [(4, "IRL520")]
