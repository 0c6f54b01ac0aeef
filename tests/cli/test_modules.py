"""Programs with modules beside them: what they get, and what is wrong in which file."""

import hashlib

import numpy as np
import pytest

import irlx
from irlx.cli.main import main

pytestmark = [pytest.mark.req("LANG-12"), pytest.mark.req("LANG-10")]

CELL = '[robot]\nmodel = "koch11"\n[motion]\ntick_ms = 50\nspeed = 1000\nacc = 2000\n'
HOME = "POSE: home := ((11500, 1000, 3500), ORIZYX(0, 0, 0))"


@pytest.fixture
def files(tmp_path):
    """Writes p.irl with its cell, and files beside it by name; gives the path of the program."""

    def write(declarations, body, **others):
        (tmp_path / "p.toml").write_text(CELL, encoding="utf-8")
        for name, text in others.items():
            stem, ending = name.rsplit("_", 1)
            (tmp_path / f"{stem}.{ending}").write_text(text, encoding="utf-8")
        text = f"PROGRAM p;\n{declarations}\nBEGIN\n{body}\nENDPROGRAM\n"
        (tmp_path / "p.irl").write_text(text, encoding="utf-8")
        return tmp_path / "p.irl"

    return write


def told(path):
    return [str(found).replace(f"{path.parent}/", "") for found in irlx.check(path)]


TOOLS = """MODULE tools;
FROM places IMPORT home, spot;
EXPORT lift, up, count, bumped, pair TO p;
EXPORT again;
CONST REAL: lift := 50;
TYPE RECORD POSE: a, b; ENDRECORD = pair;
VAR INT: count := first(2); REAL: hidden := 1;
FUNCTION first(INT: n): INT; BEGIN RETURN n + 1; ENDFCT;
FUNCTION up(POSE: p): POSE; BEGIN RETURN p + POSITION(0, 0, lift); ENDFCT;
PROCEDURE bumped; BEGIN count := count + 1; ENDPROC;
PROCEDURE again(spot: s);
BEGIN
  MOVE LIN s.at;
  MOVE LIN home;
ENDPROC;
ENDMODULE
"""
PLACES = f"MODULE places; EXPORT home, spot; VAR {HOME}; TYPE RECORD POSE: at; ENDRECORD = spot; ENDMODULE;"
PROGRAM = """FROM tools IMPORT lift, up, count, bumped, pair, again; FROM places IMPORT home, spot;
VAR pair: q; spot: s;"""


def test_constants_types_variables_and_routines(files):
    body = """bumped; bumped; count := count + 1;
    q.a := up(home); q.b := (q.a + POSITION(0, 10 * count, 0)); s.at := q.b; again(s); MOVE LIN up(home);"""
    path = files(PROGRAM, body, tools_irl=TOOLS, places_irl=PLACES)
    assert told(path) == []
    run = irlx.run(path)
    moves = [(record.block.target.position, record.block.origin) for record in run.stream.records]
    expected = [(11.5, 1.06, 3.55), (11.5, 1.0, 3.5), (11.5, 1.0, 3.55)]
    assert np.array([at for at, _ in moves]) == pytest.approx(np.array(expected))
    assert [(origin.file, origin.line) for _, origin in moves] == [
        ("tools.irl", 13),
        ("tools.irl", 14),
        ("p.irl", 6),
    ]
    assert irlx.verify(run, path).passed


def test_a_module_exists_once(files):
    one = (
        "MODULE one; EXPORT raise; FROM both IMPORT n; PROCEDURE raise; BEGIN n := n + 1; ENDPROC; ENDMODULE"
    )
    both = "MODULE both; EXPORT n; VAR INT: n := 1; ENDMODULE"
    declarations = f"FROM one IMPORT raise; FROM both IMPORT n; VAR {HOME};"
    path = files(
        declarations, "raise; raise; home.pos.x := home.pos.x - n; MOVE LIN home;", one_irl=one, both_irl=both
    )
    (record,) = irlx.run(path).stream.records
    assert record.block.target.position[0] == 11.497


def test_system_variables_are_the_same_everywhere(files):
    slow = "MODULE slow; EXPORT slower; PROCEDURE slower; BEGIN R_SPEED := 123; ENDPROC; ENDMODULE"
    path = files(f"FROM slow IMPORT slower; VAR {HOME};", "slower; MOVE LIN home;", slow_irl=slow)
    assert irlx.run(path).stream.records[0].block.law.speed == 0.123


def test_the_digest_covers_modules(files):
    path = files(PROGRAM, "MOVE LIN home;", tools_irl=TOOLS, places_irl=PLACES)
    digests = [
        hashlib.sha256((path.parent / f"{n}.irl").read_bytes()).hexdigest() for n in ("p", "places", "tools")
    ]
    run = irlx.run(path)
    assert (
        run.stream.header.program_sha256
        == hashlib.sha256("".join(f"{d}\n" for d in digests).encode()).hexdigest()
    )
    (path.parent / "places.irl").write_text(PLACES.replace("3500", "3400"), encoding="utf-8")
    report = irlx.verify(run, path)
    assert not report.passed
    assert "or another text of places.irl, tools.irl" in str(report)


def test_a_module_may_import_a_data_list(files):
    tools = """MODULE tools; IMPORT DATALIST points; EXPORT raise;
    PROCEDURE raise; BEGIN home.pos.x := 11400; ENDPROC; ENDMODULE"""
    points = f"DATALIST points; {HOME}; ENDDATALIST"
    path = files(
        "IMPORT DATALIST points; FROM tools IMPORT raise;",
        "raise; MOVE LIN home;",
        tools_irl=tools,
        points_dat=points,
    )
    assert irlx.run(path).stream.records[0].block.target.position[0] == 11.4


WRONG = [
    (
        "FROM tols IMPORT x;",
        {"tools_irl": "MODULE tools; ENDMODULE"},
        ["p.irl:2:6: error IRL218: no module 'tols'; did you mean 'tools'?"],
    ),
    (
        "FROM tools IMPORT gripp;",
        {"tools_irl": "MODULE tools; EXPORT grip; VAR INT: grip; ENDMODULE"},
        ["p.irl:2:19: error IRL219: tools.irl does not export 'gripp'; did you mean 'grip'?"],
    ),
    (
        "FROM a IMPORT x;",
        {
            "a_irl": "MODULE a; FROM b IMPORT y; EXPORT x; VAR INT: x; ENDMODULE",
            "b_irl": "MODULE b; FROM a IMPORT x; EXPORT y; VAR INT: y; ENDMODULE",
        },
        ["b.irl:1:16: error IRL260: module 'a' is imported in a circle: a.irl imports b.irl imports a.irl"],
    ),
    (
        "FROM a IMPORT x;",
        {"a_irl": "MODULE a; FROM a IMPORT x; EXPORT x; ENDMODULE"},
        ["a.irl:1:16: error IRL260: module 'a' is imported in a circle: a.irl imports a.irl"],
    ),
    (
        "FROM other IMPORT x;",
        {"other_irl": "PROGRAM other; BEGIN ENDPROGRAM"},
        ["other.irl:1:1: error IRL262: expected a module, found PROGRAM other"],
    ),
    (
        "FROM tools IMPORT x;",
        {"tools_irl": "MODULE old; EXPORT x; VAR INT: x; ENDMODULE"},
        ["tools.irl:1:8: warning IRL263: the module is called 'old' here and 'tools' where it is imported"],
    ),
    (
        "FROM tools IMPORT x;",
        {"tools_irl": "MODULE tools;\nEXPORT x;\nVAR INT: x := lenght;\nENDMODULE"},
        ["tools.irl:3:15: error IRL201: unknown name 'lenght'"],
    ),
    (
        "FROM tools IMPORT x;",
        {"tools_irl": "MODULE tools; EXPORT x; PROCEDURE x; VAR SEMAPHORE: s; BEGIN ENDPROC; ENDMODULE"},
        [
            "tools.irl:1:42: warning IRL591: this version of irlx reads the type SEMAPHORE but does not "
            "execute it yet; a run would end here"
        ],
    ),
    (
        "FROM tools IMPORT x;",
        {"tools_irl": "MODULE tools; EXPORT x; PROCEDURE x; BEGIN OBSTACLE a; ENDPROC; ENDMODULE"},
        ["tools.irl:1:53: error IRL573: the cell has no obstacle or group 'a'"],
    ),
]


@pytest.mark.parametrize(("declarations", "others", "expected"), WRONG)
def test_what_is_wrong_is_told_in_its_file(files, declarations, others, expected):
    assert told(files(declarations, "", **others)) == expected


TYPED = [
    ("t := lift;", ["5:6: error IRL222: expected STRING, found REAL"]),
    ("lift := 3;", ["5:1: error IRL211: 'lift' is a constant and cannot be set"]),
    ("count := 1.5;", ["5:10: error IRL222: expected INT, found REAL"]),
    ("count := lift DIV 2;", ["5:10: error IRL227: DIV is not defined for REAL and INT"]),
    ("q.a := up(home); q.b := up(s.at); x := lift + count; FOR count := 1 TO 3 DO bumped; ENDFOR;", []),
    ("q.a := up(lift);", ["5:11: error IRL222: expected POSE, found REAL"]),
    ("q.a := up();", ["5:8: error IRL228: up takes 1 value, found 0"]),
    ("q.a := s.at; s := (home); s.on := home;", ["5:28: error IRL225: spot has no field 'on'"]),
    ("again(home);", ["5:7: error IRL222: expected spot, found POSE"]),
    ("x := bumped;", ["5:6: error IRL250: 'bumped' is a procedure, not a value"]),
    ("count;", ["5:1: error IRL250: 'count' is a variable, not a procedure"]),
]


@pytest.mark.req("LANG-20")
@pytest.mark.parametrize(("body", "expected"), TYPED)
def test_names_have_the_types_of_the_module(files, body, expected):
    path = files(f"{PROGRAM} STRING: t; REAL: x;", body, tools_irl=TOOLS, places_irl=PLACES)
    errors = [str(found) for found in irlx.check(path) if found.is_error]
    assert [one.removeprefix(f"{path}:").split(";")[0] for one in errors] == expected


def test_what_is_wrong_in_a_module_is_told_once(files):
    tools = """MODULE tools; EXPORT x, f; VAR nothing: x;
    FUNCTION f(nothing: n): INT; BEGIN RETURN 1; ENDFCT; ENDMODULE"""
    path = files("FROM tools IMPORT x, f, gone;", "x := f(gone) + x.a[3]; gone(x);", tools_irl=tools)
    assert sorted(d.code for d in irlx.check(path) if d.is_error) == ["IRL204", "IRL219"]


def test_a_module_that_is_a_folder(files):
    path = files("FROM tools IMPORT x;", "")
    (path.parent / "tools.irl").mkdir()
    (found,) = irlx.check(path)
    assert (found.code, found.data["cause"]) == ("IRL261", "it is a folder")


def test_errors_of_a_run_are_told_in_the_module(files, capsys):
    tools = """MODULE tools; EXPORT half;
FUNCTION half(REAL: x): REAL; BEGIN RETURN x / (x - x); ENDFCT;
ENDMODULE"""
    path = files(
        f"FROM tools IMPORT half; VAR {HOME}; REAL: y;", "MOVE LIN home; y := half(3);", tools_irl=tools
    )
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(path)
    assert (
        str(caught.value.reason).replace(f"{path.parent}/", "")
        == "tools.irl:2:44: error IRL502: division by zero"
    )
    assert len(caught.value.run.stream.records) == 1


def test_a_move_of_a_module_that_cannot_be_made_is_told_there(files):
    tools = (
        "MODULE tools; EXPORT far;\nPROCEDURE far; BEGIN\nMOVE PTP POSITION(1E6, 0, 0);\nENDPROC; ENDMODULE"
    )
    path = files("FROM tools IMPORT far;", "far;", tools_irl=tools)
    with pytest.raises(irlx.RunError) as caught:
        irlx.run(path)
    assert str(caught.value.reason).replace(f"{path.parent}/", "").startswith("tools.irl:3:1: error IRL522")


def test_a_module_is_checked_by_itself(files, capsys):
    path = files("", "", tools_irl=TOOLS, places_irl=PLACES)
    assert main(["check", str(path.with_name("tools.irl"))]) == 0
    assert "0 errors, 0 warnings" in capsys.readouterr().out


def test_bounds_on_the_command_line(files, capsys, monkeypatch):
    path = files("VAR INT: i;", "FOR i := 1 TO 5000 DO ENDFOR; CYCLICSTART; CYCLICEND;")
    monkeypatch.chdir(path.parent)
    assert main(["run", "p.irl", "--max-steps", "3000", "--quiet"]) == 1
    assert "IRL510: the program has executed 3,000 statements" in capsys.readouterr().err
    assert main(["run", "p.irl", "--max-steps", "0"]) == 2
    assert main(["run", "p.irl", "--max-steps", "30000"]) == 0
    assert main(["verify", "p.irdata", "--program", "p.irl"]) == 0
    assert main(["verify", "p.irdata", "--program", "p.irl", "--max-steps", "3000"]) == 1
