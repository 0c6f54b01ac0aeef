"""What is written is verified against the robot of the run's own cell, wherever it was started."""

from __future__ import annotations

from pathlib import Path

import pytest

import irlx
from irlx.cli.main import main

ROOT = Path(__file__).resolve().parents[2]

PROGRAM = "PROGRAM p;\nBEGIN\n  MOVE LIN (11300, 1000, 3500);\nENDPROGRAM;\n"
CELL = '[robot]\nmodel = "robot.urdf"\nstart = [{start}]\ntip = "tcp"\n'


@pytest.fixture
def away(tmp_path, monkeypatch) -> Path:
    """A program with a URDF of its own in one folder, started from another that holds a strange cell."""
    home, other = tmp_path / "home", tmp_path / "other"
    home.mkdir()
    other.mkdir()
    packaged = ROOT / "src" / "irlx" / "cell" / "robots" / "koch11.urdf"
    (home / "robot.urdf").write_text(packaged.read_text(encoding="utf-8"), encoding="utf-8")
    start = ", ".join(map(str, [0, -75, -102, 146.65, -80.6, -8.3, 55.4, 24.8, 106.1, -462, 59]))
    (home / "p.toml").write_text(CELL.format(start=start))
    (home / "p.irl").write_text(PROGRAM)
    monkeypatch.chdir(other)
    return other


@pytest.mark.req("STR-06")
def test_geometry_is_checked_from_another_folder(away, capsys) -> None:
    assert main(["run", "../home/p.irl", "-o", "out.irdata"]) == 0
    assert "not made" not in capsys.readouterr().out


@pytest.mark.req("STR-06")
def test_a_strange_cell_of_the_same_name_is_not_taken_for_the_robot(away) -> None:
    (away / "p.toml").write_text('[robot]\nmodel = "koch11"\nlocked = { joint_1 = 10 }\n')
    run = irlx.run("../home/p.irl")
    report = irlx.verify(run)
    assert report.passed
    assert report["robot"].status == "not checked"


@pytest.mark.req("STR-06")
def test_the_same_program_named_by_two_paths_gives_the_same_bytes(away) -> None:
    for number, path in enumerate(["../home/p.irl", str(away.parent / "home" / "p.irl")]):
        irlx.run(path).save(f"{number}.irdata")
    assert Path("0.irdata").read_bytes() == Path("1.irdata").read_bytes()


@pytest.mark.req("LANG-60")
def test_a_limit_made_of_the_present_posture_may_be_left(tmp_path) -> None:
    """Through degrees and back a value may lose its last bit; the joint still stands on its bound."""
    (tmp_path / "p.toml").write_text('[robot]\nmodel = "koch11"\n')
    fields = ", ".join(f"a{number}" for number in range(1, 12))
    declared = "".join(
        f"RECORD REAL: {fields}; ENDRECORD = {name};\n" for name in ("MAIN_JOINT_MIN", "MAIN_JOINT_MAX")
    )
    copied = "".join(f"lo.a{k} := h.A{k}; hi.a{k} := h.A{k} + 40;\n" for k in range(1, 11))
    (tmp_path / "p.irl").write_text(
        f"PROGRAM p;\nTYPE {declared}VAR MAIN_JOINT: h; MAIN_JOINT_MIN: lo; MAIN_JOINT_MAX: hi;\nBEGIN\n"
        f"h := R_JOINT_ACT.M_JOINT;\n{copied}lo.a11 := h.A11 - 40; hi.a11 := h.A11;\n"
        "JOINTLIMIT lo, hi;\nJOINTLIMITEND;\nENDPROGRAM;\n"
    )
    assert irlx.verify(irlx.run(tmp_path / "p.irl")).passed


@pytest.mark.req("CELL-01")
def test_a_broken_cell_is_told_before_the_names_it_would_have_given(tmp_path) -> None:
    (tmp_path / "p.toml").write_text("[robot\n")
    (tmp_path / "p.irl").write_text("PROGRAM p;\nBEGIN\n  MOVE LIN table;\nENDPROGRAM;\n")
    with pytest.raises(irlx.CellError) as caught:
        irlx.run(tmp_path / "p.irl")
    assert caught.value.reason.code == "IRL601"


@pytest.mark.req("CELL-01")
def test_frames_that_differ_in_case_alone_are_refused(tmp_path) -> None:
    frames = "[frames]\ntable = { xyz = [1, 0, 0] }\nTable = { xyz = [2, 0, 0] }\n"
    (tmp_path / "p.toml").write_text(f'[robot]\nmodel = "koch11"\n{frames}')
    (tmp_path / "p.irl").write_text("PROGRAM p;\nBEGIN\nENDPROGRAM;\n")
    with pytest.raises(irlx.CellError) as caught:
        irlx.run(tmp_path / "p.irl")
    assert caught.value.reason.code == "IRL603"
    assert caught.value.reason.place.key == "frames.Table"


@pytest.mark.req("STR-05")
def test_a_fault_of_irlx_in_a_run_keeps_what_was_executed(tmp_path, monkeypatch) -> None:
    from irlx.pacing.pacer import Pacer

    (tmp_path / "p.toml").write_text('[robot]\nmodel = "koch11"\n')
    moves = "MOVE LIN (11400, 1000, 3500);\nMOVE LIN (11300, 1000, 3500);\n"
    (tmp_path / "p.irl").write_text(f"PROGRAM p;\nBEGIN\n{moves}ENDPROGRAM;\n")
    carry_out = Pacer.carry_out

    def faulty(self, group):
        if group[0].id == 2:
            raise ArithmeticError("on purpose")
        return carry_out(self, group)

    monkeypatch.setattr(Pacer, "carry_out", faulty)
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(tmp_path / "p.irl")
    assert caught.value.reason.code == "IRL090"
    assert not caught.value.run.complete
    assert len(caught.value.run.t) > 1
    monkeypatch.setenv("IRLX_DEBUG", "1")
    with pytest.raises(ArithmeticError):
        irlx.run(tmp_path / "p.irl")
