"""A program with an error does not begin: the start of a run finds what a check finds with the cell."""

import pytest

import irlx
from irlx.cell.load import load_cell
from irlx.cli.main import main

FIRST = "MOVE_INC LIN POSITION(0, 0, -10);"
SIX = "(0, -30, 90, 0, 60, 0)"
PROGRAMS = {
    "a target": ("", f"MOVE PTP {SIX};", "IRL222"),
    "a posture": ("", f"RECONFIGURATION {SIX};", "IRL222"),
    "a joint": ("", "FREEZESTART 9; FREEZEEND;", "IRL346"),
    "a variable": (f"VAR MAIN_JOINT: h := {SIX};", "MOVE PTP h;", "IRL223"),
    "a data list": ("IMPORT DATALIST pts;", "MOVE PTP home;", "IRL223"),
    "a module": ("FROM lib IMPORT go;", "go;", "IRL222"),
    "a frame": ("", "MOVE LIN p IN FRAME table;", "IRL290"),
    "an obstacle": ("", "OBSTACLE wall;", "IRL573"),
    "a port": ("", "IN_2 := TRUE;", "IRL211"),
}

pytestmark = pytest.mark.req("LANG-23")


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "c.toml").write_text('[robot]\nmodel = "arm7"\n', encoding="utf-8")
    list = f"DATALIST pts; MAIN_JOINT: home := {SIX}; ENDDATALIST"
    (tmp_path / "pts.dat").write_text(list, encoding="utf-8")
    module = f"MODULE lib; EXPORT go; PROCEDURE go; BEGIN MOVE PTP {SIX}; ENDPROC; ENDMODULE"
    (tmp_path / "lib.irl").write_text(module, encoding="utf-8")
    return tmp_path


def written(folder, kind, specification="SYSTEM SPECIFICATION c;"):
    declarations, statement, code = PROGRAMS[kind]
    path = folder / "p.irl"
    position = "VAR POSITION: p := (500, 0, 400);"
    text = f"PROGRAM p;\n{specification}\n{declarations} {position}\nBEGIN {FIRST}\n{statement}\nENDPROGRAM\n"
    path.write_text(text, encoding="utf-8")
    return path, code


def errors(found):
    return [str(one) for one in found if one.is_error]


def refused(begin):
    """Errors of a program that does not begin."""
    with pytest.raises(irlx.ProgramError) as caught:
        begin()
    return errors(caught.value.diagnostics)


@pytest.mark.parametrize("kind", PROGRAMS)
def test_a_run_finds_what_a_check_finds(folder, kind):
    path, code = written(folder, kind)
    found = errors(irlx.check(path))
    assert len(found) == 1
    assert code in found[0]
    assert errors(irlx.check(path, folder / "c.toml")) == found
    assert refused(lambda: irlx.load(path)) == found
    assert refused(lambda: irlx.run(path)) == found
    assert refused(lambda: irlx.record(path, folder / "p.irdata")) == found
    assert refused(lambda: irlx.stream(path)) == found
    assert not list(folder.glob("*.irdata"))


@pytest.mark.parametrize("kind", PROGRAMS)
def test_a_cell_elsewhere_tells_as_much(folder, kind):
    """By its path, or loaded; also of a program that was loaded when nothing was known of its cell."""
    path, code = written(folder, kind, specification="")
    cell = folder / "c.toml"
    found = errors(irlx.check(path, cell))
    assert len(found) == 1
    assert code in found[0]
    assert refused(lambda: irlx.run(path, cell)) == found
    assert refused(lambda: irlx.run(path, load_cell(cell))) == found
    if kind != "a port":
        loaded = irlx.load(path)
        # What was read then is what runs, and what is looked at.
        for file in (path, folder / "pts.dat", folder / "lib.irl"):
            file.unlink()
        assert refused(lambda: irlx.run(loaded, cell)) == found
        assert refused(lambda: irlx.stream(loaded, load_cell(cell))) == found


def test_a_program_loaded_for_another_cell(folder):
    path, _ = written(folder, "a target", specification="")
    (folder / "p.toml").write_text('[robot]\nmodel = "arm7"\nlocked = {joint_1 = 0}\n', encoding="utf-8")
    loaded = irlx.load(path)
    assert "IRL222" in refused(lambda: irlx.run(loaded, folder / "c.toml"))[0]


def test_no_stream_is_left_of_a_run_that_did_not_begin(folder, capsys):
    path, _ = written(folder, "a target")
    assert main(["run", str(path)]) == 1
    assert "help: MAIN_JOINT takes 7 values: the robot has 7 joints" in capsys.readouterr().err
    assert not list(folder.glob("*.irdata"))
