"""`irlx check` finds mistakes of types before anything runs, and without numpy."""

import subprocess
import sys
from pathlib import Path

import pytest

import irlx
from irlx.cli.main import main

CELL = '[robot]\nmodel = "arm7"\n'


def program(folder, declarations, body):
    path = folder / "p.irl"
    path.write_text(f"PROGRAM p;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM\n", encoding="utf-8")
    return path


@pytest.mark.req("LANG-24")
def test_a_mistake_behind_an_hour_of_motion_is_found_at_once(tmp_path, capsys):
    path = program(tmp_path, "VAR INT: n;", "MOVE LIN POSITION(600, 0, 400);\nn := 7 / 2;")
    assert main(["check", str(path)]) != 0
    assert "p.irl:5:6: error IRL222: expected INT, found REAL" in capsys.readouterr().err


@pytest.mark.req("LANG-24")
def test_a_run_does_not_begin(tmp_path):
    path = program(tmp_path, "VAR INT: n;", "n := 7 / 2;")
    with pytest.raises(irlx.IrlxError) as caught:
        irlx.run(path)
    assert caught.value.reason.code == "IRL222"


@pytest.mark.req("LANG-23")
def test_a_cell_tells_the_number_of_joints(tmp_path):
    path = program(tmp_path, "VAR MAIN_JOINT: m := (1, 2, 3);", "MOVE PTP m;")
    (tmp_path / "other.toml").write_text(CELL, encoding="utf-8")
    assert [d.code for d in irlx.check(path)] == []
    found = irlx.check(path, cell=tmp_path / "other.toml")
    assert [(d.code, d.message) for d in found] == [("IRL223", "MAIN_JOINT takes 7 values, found 3")]


@pytest.mark.req("LANG-23")
def test_a_joint_type_of_another_robot(tmp_path):
    path = program(tmp_path, "TYPE RECORD REAL: a, b; ENDRECORD = MAIN_JOINT;", "HALT;")
    (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
    (found,) = irlx.check(path, cell=tmp_path / "p.toml")
    assert (found.code, found.place.line) == ("IRL221", 2)
    assert found.message == "type MAIN_JOINT is defined with 2 fields, but the robot has 7 joints"


@pytest.mark.req("LANG-73")
def test_lints_are_for_the_check_alone(tmp_path):
    path = program(tmp_path, "VAR INT: n;", "HALT;")
    (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
    assert [d.code for d in irlx.check(path)] == ["IRL281"]
    assert list(irlx.run(path).diagnostics) == []


JOINTS = "VAR MAIN_JOINT: m := (1, 2, 3);"


@pytest.mark.req("LANG-10")
@pytest.mark.parametrize("name", ["p.toml", "line_4.toml"])
def test_the_cell_that_is_found_tells_the_number_of_joints(tmp_path, name):
    """As --cell does: that of the program's own name, or that of SYSTEM SPECIFICATION before it."""
    specification = "" if name == "p.toml" else "SYSTEM SPECIFICATION line_4;"
    path = program(tmp_path, f"{specification} {JOINTS}", "MOVE PTP m;")
    assert irlx.check(path) == []
    (tmp_path / "p.toml").write_text(CELL.replace("arm7", "planar3"), encoding="utf-8")
    (tmp_path / name).write_text(CELL, encoding="utf-8")
    found = [str(one) for one in irlx.check(path)]
    assert found == [str(one) for one in irlx.check(path, cell=tmp_path / name)]
    assert ["7 values, found 3" in one for one in found] == [True]


def test_of_a_found_cell_a_check_tells_that_it_is_no_toml_the_run_all_else(tmp_path):
    path = program(tmp_path, JOINTS, "MOVE PTP m;")
    cell = tmp_path / "p.toml"
    cell.write_text("[robot\n", encoding="utf-8")
    (found,) = irlx.check(path)
    assert (found.code, Path(found.place.file)) == ("IRL601", cell)
    cell.write_text('[robot]\nmodle = "arm7"\n', encoding="utf-8")
    assert irlx.check(path) == []


LOADED = """
import sys, irlx
for path in sys.argv[1:]:
    found = len(irlx.check(path))
    loaded = {"numpy", "pinocchio", "scipy", "pydantic", "xml"} & set(sys.modules)
    print(found, *sorted(loaded))
"""


@pytest.mark.req("LANG-76")
def test_no_numeric_library_is_loaded_by_a_found_cell_either(tmp_path):
    """Of a program that computes with poses, of one beside which there is no cell, and with one."""
    posed = "VAR POSE: p := ((1, 2, 3), ORIZYX(0, 1, 2));", "MOVE LIN p + POSITION(0, 0, 1);"
    paths = []
    for name, text in (
        ("posed", posed),
        ("alone", (JOINTS, "MOVE PTP m;")),
        ("celled", (JOINTS, "MOVE PTP m;")),
    ):
        (tmp_path / name).mkdir()
        paths.append(program(tmp_path / name, *text))
    (tmp_path / "celled" / "p.toml").write_text(CELL, encoding="utf-8")
    call = [sys.executable, "-c", LOADED, *paths]
    done = subprocess.run(call, check=True, timeout=60, capture_output=True, text=True)
    assert done.stdout.splitlines() == ["0", "0", "1 xml"]


@pytest.mark.req("LANG-53")
def test_notes_are_counted_for_themselves(tmp_path, capsys):
    target = "ROBTARGET(POSE((1, 2, 3), ORIZYX(0, 0, 0)), 4)"
    path = program(tmp_path, f"VAR ROBTARGET: t := {target};", "MOVE PTP t;")
    (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
    assert main(["check", str(path)]) == 0
    told = capsys.readouterr()
    assert told.out == f"{path}: 0 errors, 1 warning, 1 note\n"
    assert "info IRL313: a ROBTARGET does not fix the posture of a robot with 7 joints" in told.err
