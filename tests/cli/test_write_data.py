"""Values of data lists written back: only what changed, to the last bit, and never over somebody's work."""

import pytest

import irlx
from irlx.cli.main import main

pytestmark = pytest.mark.req("LANG-13")

CELL = '[robot]\nmodel = "planar3"\n'
POINTS = """DATALIST points;
  { taught by hand }
  REAL: lift := 1.5E1 , drop:=2;   (* mm *)
  POSITION:
    a := (1, 2, 3),  { first }
    b := a + POSITION(0, 0, lift),
    c;
  ARRAY [1..2, 1..2] OF INT: m := (1, 2, 3, 4);
  STRING: s := 'it''s'; CHAR: k := 'x'; BOOL: yes := TRUE;
  JOINT: j := ((1, 2, 3), ADD_JOINT()); INT: n := 2;
  ARRAY [1..n] OF REAL: row;
  ORIENTATION: o := ORIZYX(10, 0, 0);
ENDDATALIST
"""


@pytest.fixture
def files(tmp_path):
    def write(body, points=POINTS, declarations="", **others):
        (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
        (tmp_path / "points.dat").write_text(points, encoding="utf-8")
        for name, text in others.items():
            (tmp_path / f"{name}.irl").write_text(text, encoding="utf-8")
        text = f"PROGRAM p;\nIMPORT DATALIST points;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM\n"
        (tmp_path / "p.irl").write_text(text, encoding="utf-8")
        return tmp_path / "p.irl"

    return write


def data_of(path):
    return path.with_name("points.dat").read_text(encoding="utf-8")


CHANGES = [
    ("lift := lift;", {}),
    ("drop := 0.1 + 0.2;", {"drop:=2": "drop:=0.30000000000000004"}),
    # What is calculated from a changed value keeps its own.
    ("lift := 20;", {"lift := 1.5E1": "lift := 20.0", "a + POSITION(0, 0, lift)": "(1.0, 2.0, 18.0)"}),
    (
        "a.y := -5;",
        {"a := (1, 2, 3)": "a := (1.0, -5.0, 3.0)", "a + POSITION(0, 0, lift)": "(1.0, 2.0, 18.0)"},
    ),
    ("c := (7, 8, 9);", {"    c;": "    c := (7.0, 8.0, 9.0);"}),
    ("m[1, 2] := 9;", {"(1, 2, 3, 4)": "(1, 9, 3, 4)"}),
    ("m[2, 2] := -9223372036854775807 - 1;", {"(1, 2, 3, 4)": "(1, 2, 3, -9223372036854775807 - 1)"}),
    ("s := s + CHR(10) + 'x';", {"'it''s'": "'it''s' + CHR(10) + 'x'"}),
    ("s := '';", {"'it''s'": "''"}),
    ("k := ''''; yes := FALSE;", {"'x'": "''''", ":= TRUE": ":= FALSE"}),
    ("j.m_joint.a2 := 0.25;", {"((1, 2, 3), ADD_JOINT())": "((1.0, 0.25, 3.0), ADD_JOINT())"}),
    ("row[1] := 1; row[2] := 1E300;", {"row;": "row := (1.0, 1e+300);"}),
    ("o := ORIQUAT(0, 0, 1, 0);", {"ORIZYX(10, 0, 0)": "(0.0, 0.0, 1.0, 0.0)"}),
]


@pytest.mark.parametrize(("body", "changes"), CHANGES)
def test_only_what_changed_is_written(files, body, changes):
    path = files(body)
    assert irlx.run(path, write_data=True).diagnostics == irlx.run(path).diagnostics
    expected = POINTS
    for old, new in changes.items():
        assert expected.count(old) == 1
        expected = expected.replace(old, new)
    assert data_of(path) == expected
    # Read again, nothing has changed.
    files("", points=expected)
    irlx.run(path, write_data=True)
    assert data_of(path) == expected


def test_values_come_back_to_the_last_bit(files):
    body = "lift := lift / 3; a := a * 1E-300; o := ORIXYZ(1, 2, 3);"
    path = files(body)
    irlx.run(path, write_data=True)
    checks = "IF lift <> 15. / 3 OR a.x <> 1E-300 THEN lift := 1 / (lift - lift); ENDIF;"
    irlx.run(files(checks, points=data_of(path)))


def test_by_default_nothing_is_written(files):
    path = files("lift := 3;")
    irlx.run(path)
    assert data_of(path) == POINTS


def test_a_run_that_ends_in_an_error_writes_nothing(files):
    path = files("lift := 3; lift := 1 / (lift - 3);")
    with pytest.raises(irlx.RunError):
        irlx.run(path, write_data=True)
    assert data_of(path) == POINTS


NOT_WRITTEN = [
    ("c.x := 1;", "the value of 'c' is not written back: c.Y has no value"),
    ("n := 3;", "the value of 'n' is not written back: bounds of arrays depend on it"),
]


@pytest.mark.parametrize(("body", "message"), NOT_WRITTEN)
def test_what_cannot_be_written_stays(files, body, message):
    path = files(body)
    (warning,) = (d for d in irlx.run(path, write_data=True).diagnostics if d.code == "IRL264")
    assert warning.message == message
    assert warning.place.file.endswith("points.dat")
    assert data_of(path) == POINTS


def test_a_file_that_was_changed_meanwhile_is_not_replaced(files):
    path = files("lift := 3; CYCLICSTART; CYCLICEND;")
    newer = POINTS.replace("1.5E1", "99")

    def edit(*_):
        path.with_name("points.dat").write_text(newer, encoding="utf-8")

    with pytest.raises(irlx.IrlxError, match="IRL265"):
        irlx.run(path, write_data=True, progress=edit)
    assert data_of(path) == newer


def test_lists_of_modules_are_written_too(files):
    tools = """MODULE tools; IMPORT DATALIST points; EXPORT raise;
    PROCEDURE raise; BEGIN drop := 5; ENDPROC; ENDMODULE"""
    path = files("raise;", declarations="FROM tools IMPORT raise;", tools=tools)
    irlx.run(path, write_data=True)
    assert data_of(path) == POINTS.replace("drop:=2", "drop:=5.0")


def test_on_the_command_line_the_stream_is_verified_before(files, capsys):
    path = files("drop := 5;")
    assert main(["run", str(path), "--write-data"]) == 0
    assert "checks passed" in capsys.readouterr().out
    assert data_of(path) == POINTS.replace("drop:=2", "drop:=5.0")
    assert main(["verify", str(path.with_suffix(".irdata")), "--program", str(path)]) == 1


def test_functions_that_ask_are_no_values_of_a_list(files):
    path = files("", points="DATALIST points; POSE: p := FK((1, 2, 3)); ENDDATALIST")
    assert [d.code for d in irlx.check(path)] == ["IRL245"]
