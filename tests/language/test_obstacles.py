"""Names of obstacles: known to a check where the cell is, and no names of the program."""

import subprocess
import sys

import pytest

import irlx
from irlx.cli.main import main

pytestmark = pytest.mark.req("LANG-64")

PROGRAM = """PROGRAM t;
VAR
  MAIN_JOINT: j := (0, 0, 0, 0, 0, 0, 0);
  POSITION: p := (400, 0, 400);
  REAL: x;
BEGIN
  OBSTACLE {0};
  x := CLEARANCE(j, {0});
  j := POSTURE(p, {0});
  OBSTACLEEND {0};
  WRITELN(x, j.A1);
ENDPROGRAM
"""
CELL = """[robot]
model = "arm7"
[[obstacle]]
name = "s\u0301ciana_1"
shape = "sphere"
radius = 100
xyz = [2000, 0, 0]
[[obstacle]]
name = "Window"
shape = "group"
members = ["s\u0301ciana_1"]
"""


def found(told_of, name, known):
    told = told_of(PROGRAM.format(name), obstacles=lambda _: known)
    return [(code, message) for code, message, _ in told]


@pytest.mark.parametrize("name", ["wall", "Ściana_1", "in_3", "j"])
def test_without_a_cell_any_name_will_do(told_of, name):
    assert found(told_of, name, None) == []
    assert told_of(PROGRAM.format(name)) == []


@pytest.mark.parametrize("name", ["ŚCIANA_1", "window", "s\u0301ciana_1"])
def test_names_of_the_cell(told_of, name):
    assert found(told_of, name, ("ściana_1", "Window")) == []


def test_other_names(told_of):
    message = "the cell has no obstacle or group 'wndow'; did you mean 'Window'?"
    assert found(told_of, "wndow", ("ściana_1", "Window")) == [("IRL573", message)] * 4
    assert found(told_of, "wndow", ()) == [("IRL573", "the cell has no obstacle or group 'wndow'")] * 4


def test_a_cell_without_obstacles_is_told(told_of):
    assert {code for code, _ in found(told_of, "x", ())} == {"IRL573"}


def test_a_name_of_the_program_stays_unknown_elsewhere(told_of):
    text = "PROGRAM t; VAR REAL: x; BEGIN x := NORM(wall) + SQRT(wall); ENDPROGRAM"
    assert [code for code, _, _ in told_of(text)] == ["IRL201"]


def test_a_function_of_the_program_takes_names_of_the_program(told_of):
    text = (
        "PROGRAM t; VAR MAIN_JOINT: j; REAL: x; FUNCTION clearance(MAIN_JOINT: m; REAL: r): REAL;"
        " BEGIN RETURN r; ENDFCT; BEGIN x := clearance(j, wall); ENDPROGRAM"
    )
    assert [(code, marked) for code, _, marked in told_of(text, obstacles=lambda _: ("a",))] == [
        ("IRL201", "wall")
    ]


# ---- files


@pytest.fixture
def program(tmp_path):
    """Writes program and cell; gives the path of the program."""

    def write(name, cell=CELL, text=PROGRAM):
        path = tmp_path / "p.irl"
        path.write_text(text.format(name), encoding="utf-8")
        if cell is not None:
            (tmp_path / "p.toml").write_text(cell, encoding="utf-8")
        return path

    return write


def codes_of(path, cell=None):
    return [(one.code, one.place.line) for one in irlx.check(path, cell) if one.code == "IRL573"]


def test_a_check_looks_into_the_cell_beside_the_program(program):
    assert codes_of(program("wall")) == [("IRL573", line) for line in (7, 8, 9, 10)]
    assert codes_of(program("ŚCIANA_1")) == []
    assert codes_of(program("window")) == []


def test_a_check_looks_into_the_cell_that_is_given(program, tmp_path):
    path = program("wall", cell=None)
    assert codes_of(path) == []
    other = tmp_path / "other.toml"
    other.write_text(CELL.replace("Window", "wall"), encoding="utf-8")
    assert codes_of(path, other) == []
    other.write_text(CELL, encoding="utf-8")
    assert len(codes_of(path, other)) == 4


def test_a_cell_at_fault_is_told_once(program):
    path = program("wall", cell="[[obstacle")
    assert codes_of(path) == []
    assert codes_of(path, path.with_suffix(".toml")) == []


def test_modules_and_what_loads_a_program(program, tmp_path):
    (tmp_path / "tools.irl").write_text(
        "MODULE tools; EXPORT go; PROCEDURE go; BEGIN OBSTACLE roof; ENDPROC; ENDMODULE", encoding="utf-8"
    )
    path = program("", text="PROGRAM t; FROM tools IMPORT go; BEGIN go; ENDPROGRAM")
    assert codes_of(path) == [("IRL573", 1)]
    with pytest.raises(irlx.IrlxError, match="IRL573"):
        irlx.load(path)


def test_the_command_says_where_and_what_there_is(program, capsys):
    assert main(["check", str(program("windw")), "--format", "concise"]) == 1
    line = capsys.readouterr().out.splitlines()[0]
    assert line.endswith(
        "p.irl:7:12: error IRL573 the cell has no obstacle or group 'windw'; did you mean 'Window'?"
    )


def test_a_check_loads_no_numeric_library(program):
    path = program("wall")
    code = (
        "import sys, irlx; found = irlx.check(sys.argv[1]); assert any(d.code == 'IRL573' for d in found);"
        " assert not {'numpy', 'pinocchio', 'pydantic'} & set(sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code, str(path)], check=False).returncode == 0


def test_the_form_keeps_the_names(program, capsys):
    path = program("Ściana_1")
    assert main(["fmt", "--check", str(path)]) == 0
    path.write_text(
        path.read_text(encoding="utf-8").replace("x := CLEARANCE(j", "x:=CLEARANCE( j"), encoding="utf-8"
    )
    assert main(["fmt", str(path)]) == 0
    assert path.read_text(encoding="utf-8") == PROGRAM.format("Ściana_1")
