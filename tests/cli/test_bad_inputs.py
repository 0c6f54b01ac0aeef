"""What users get wrong: a code, a place, an exit code, nothing left behind, never a traceback."""

import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from irlx.cli.main import main

UNCHANGED = ["p.irl", "p.toml"]


def write(folder, name, content):
    data = content if isinstance(content, bytes) else content.encode()
    (folder / name).write_bytes(data)


SYNTAX = [
    ("", 1, "p.irl:1:1: error IRL117: the file holds no program"),
    (b"PROGRAM p;\0\1\2", 1, "p.irl: byte 10: error IRL131: not a text file: NUL byte at offset 10"),
    (b"PROGRAM p; { \xfc }", 1, "p.irl: byte 13: error IRL130: not UTF-8 text: byte 0xFC at offset 13"),
    ("PROGRAM p;\nBEGIN\n  MOVE LIN (1, 2;\nENDPROGRAM", 1, "p.irl:3:17: error IRL120: missing "),
    ("PROGRAM p;\nBEGIN\n  MOVE LIN nowhere;\nENDPROGRAM", 1, "p.irl:3:12: error IRL201: unknown name"),
]


@pytest.mark.req("QA-09")
@pytest.mark.parametrize(("content", "code", "words"), SYNTAX)
def test_programs_that_cannot_be_read(inside, folder, names, content, code, words):
    write(folder, "p.irl", content)
    done = inside("run", "p.irl")
    assert done.returncode == code
    assert words in done.stderr
    assert done.stdout == ""
    assert names(folder) == UNCHANGED
    checked = inside("check", "p.irl")
    assert checked.returncode == code
    assert words in checked.stderr
    assert checked.stdout == "p.irl: 1 error, 0 warnings\n"


@pytest.mark.req("QA-09")
@pytest.mark.parametrize("verb", ["run", "check", "blocks"])
def test_a_missing_program(inside, folder, names, verb):
    done = inside(verb, "q.irl")
    assert done.returncode == 2
    assert done.stderr.startswith("error IRL001: no such file: q.irl; did you mean 'p.irl'?\n")
    assert names(folder) == UNCHANGED


@pytest.mark.req("QA-09")
@pytest.mark.parametrize("verb", ["check", "run", "blocks"])
@pytest.mark.parametrize("path", [".", "/"])
def test_a_folder_is_no_program(inside, verb, path):
    done = inside(verb, path)
    assert done.returncode == 2
    assert done.stderr == f"error IRL007: {path} is a folder, not a file\n"


CELLS = [
    ("[robot\n", "p.toml: error IRL601: the cell file is not TOML: "),
    (
        "[robot]\nmodel = 'koch12'\n",
        "p.toml: robot.model: error IRL611: no robot 'koch12'; did you mean 'koch11'?",
    ),
    (
        "[robot]\nmodel = 'koch11'\nstart = [0, 95, -102, 146, -80, -8, 55, 24, 106, -400, 58]\n",
        "p.toml: robot.start[2]: error IRL620: joint_2 starts at 95 deg, outside its limits",
    ),
    (
        "[robot]\nmodel = 'koch11'\nstrat = []\n",
        "p.toml: robot.strat: error IRL602: no such key: robot.strat; did you",
    ),
    (None, "p.irl: error IRL609: no cell file found; tried p.toml"),
]


@pytest.mark.req("QA-09")
@pytest.mark.req("CELL-01")
@pytest.mark.parametrize(("content", "words"), CELLS)
def test_cells_that_cannot_be_used(inside, folder, names, content, words):
    (folder / "p.toml").unlink()
    if content is not None:
        write(folder, "p.toml", content)
    before = names(folder)
    done = inside("run", "p.irl")
    assert done.returncode == 2
    assert words in done.stderr
    assert done.stdout == ""
    assert names(folder) == before


@pytest.mark.req("QA-09")
@pytest.mark.parametrize(
    ("arguments", "codes"),
    [
        (["bad.irl"], ["IRL201", "IRL301"]),
        (["p.irl", "--cell", "pp.toml"], ["IRL001"]),
        (["q.irl"], ["IRL001"]),
        (["p.irl", "-o", "out.foo"], ["IRL004"]),
    ],
)
def test_json_of_what_cannot_run(inside, folder, arguments, codes):
    write(folder, "bad.irl", "PROGRAM p;\nBEGIN\n  x := 1;\n  CYCLICSTART;\nENDPROGRAM")
    done = inside("run", *arguments, "--json")
    found = json.loads(done.stdout)
    assert found["summary"] is None
    assert [d["code"] for d in found["diagnostics"]] == codes
    assert done.returncode == (1 if "bad.irl" in arguments else 2)
    assert codes[0] in done.stderr


@pytest.mark.req("QA-09")
def test_a_cell_path_with_a_slip(inside):
    done = inside("run", "p.irl", "--cell", "pp.toml")
    assert done.stderr.startswith("error IRL001: no such file: pp.toml; did you mean 'p.toml'?\n")


LIMITS = """MAIN_JOINT_MIN: lo := (-180, -150, -180, 0, -180, -180, -180, -60, -180, -500, {});
MAIN_JOINT_MAX: hi := (180, 0, 0, 180, 0, 0, 180, 60, 180, 500, {});"""
RUNS = [
    (LIMITS.format(60, 0), "JOINTLIMIT lo, hi;", "IRL340: JOINTLIMIT: the lower bound"),
    (
        LIMITS.format(0, 20),
        "JOINTLIMIT lo, hi;",
        "IRL345: joint_11 stands at 58.9879 deg, above the bound 20 deg",
    ),
    (
        "",
        "FREEZESTART 1, 2, 3, 4, 5, 6;",
        "IRL347: 6 joints are frozen, but a robot of 11 joints can spare 5",
    ),
    ("", "FREEZESTART 12; FREEZEEND;", "IRL346: FREEZESTART names joint 12; the robot has joints 1 to 11"),
    ("", "MOVE LIN POSITION(11400, 1000, 1 / 0);", "IRL502: division by zero"),
    ("", "OBSTACLE wall; OBSTACLEEND wall;", "IRL573: the cell has no obstacle or group 'wall'"),
    (
        "MAIN_JOINT: j := R_JOINT_ACT.M_JOINT;",
        "x := CLEARANCE(j, wall);",
        "IRL573: the cell has no obstacle or group 'wall'",
    ),
]


@pytest.mark.req("QA-09")
@pytest.mark.req("LANG-72")
@pytest.mark.parametrize(("declarations", "statement", "words"), RUNS)
def test_programs_that_the_robot_cannot_execute(inside, folder, names, declarations, statement, words):
    text = f"PROGRAM p;\nVAR REAL: x; {' '.join(declarations.split())}\nBEGIN\n  {statement}\nENDPROGRAM\n"
    write(folder, "p.irl", text)
    done = inside("run", "p.irl", "--quiet")
    assert done.returncode == 1
    place, _, message = done.stderr.splitlines()[0].partition(" error ")
    assert place.startswith("p.irl:4:")
    assert message.startswith(words)
    assert names(folder) == UNCHANGED


@pytest.mark.req("QA-09")
@pytest.mark.req("LANG-72")
def test_a_pose_out_of_reach_in_the_third_move(inside, folder, names):
    text = """PROGRAM p;
VAR POSITION: near := (441, 160, 324);
BEGIN
  MOVE LIN near, POSITION(441, 200, 324);
  MOVE LIN POSITION(800, 200, 324);
ENDPROGRAM
"""
    write(folder, "p.irl", text)
    write(folder, "p.toml", '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 20\n')
    done = inside("run", "p.irl", "-o", "out.irdata", "-o", "out.csv")
    assert done.returncode == 1
    assert done.stdout == ""
    message = done.stderr.splitlines()[0]
    assert message.startswith("p.irl:5:3: error IRL520: the tool cannot follow this move beyond ")
    assert "joint_" in message
    assert "out of reach" in message
    assert "leaves" in message
    assert "MOVE LIN POSITION(800, 200, 324);" in done.stderr
    # The asked names only ever hold complete streams.
    assert names(folder) == ["out.partial.csv", "out.partial.irdata", *UNCHANGED]
    assert "marked incomplete: out.partial.irdata" in done.stderr
    verified = inside("verify", "out.partial.irdata", "--cell", "p.toml")
    assert verified.returncode == 1
    failed = [line.split()[0] for line in verified.stdout.splitlines() if "  FAILED" in line]
    assert failed == ["complete"]


KNOWN = ".irdata, .csv, .npz, .jsonl, .parquet, .rosbag"
OUTPUTS = [
    (["-o", "out.foo"], f"IRL004: -o out.foo: no format has the ending '.foo'; known: {KNOWN}"),
    (["-o", "out"], f"IRL004: -o out: no format has the ending ''; known: {KNOWN}"),
    (["-o", "link.csv"], "IRL005: -o link.csv would overwrite an input of this run"),
    (["-o", "no/out.csv"], "IRL003: cannot write no/out.csv: no such file or directory"),
    (["-o", "p.irl/out.csv"], "IRL003: cannot write p.irl/out.csv: "),
    (["-o", "/proc/out.csv"], "IRL003: cannot write /proc/out.csv: "),
    (["-o", "folder.csv"], "IRL003: cannot write folder.csv: "),
    (["-o", "ok.csv", "-o", "out.foo"], "IRL004: -o out.foo: "),
    (["--tick", "0.1"], "IRL006: --tick 0.1: a tick lasts 0.25 to 1000 ms"),
    (["--tick", "1001"], "IRL006: --tick 1001: a tick lasts 0.25 to 1000 ms"),
    (["--tick", "nan"], "IRL006: --tick nan: a tick lasts 0.25 to 1000 ms"),
]


@pytest.mark.req("QA-09")
@pytest.mark.parametrize(("options", "words"), OUTPUTS)
def test_options_that_cannot_be(inside, folder, names, options, words):
    (folder / "link.csv").symlink_to("p.irl")
    (folder / "folder.csv").mkdir()
    done = inside("run", "p.irl", *options)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"error {words}")
    assert names(folder) == ["folder.csv", "link.csv", *UNCHANGED]


@pytest.mark.req("QA-09")
def test_a_program_with_the_ending_of_a_stream_is_taken_for_one(inside, folder, names):
    (folder / "p.irl").rename(folder / "p.irdata")
    done = inside("run", "p.irdata", "--cell", "p.toml")
    assert done.returncode == 1
    assert "p.irdata: record 1: error IRL701" in done.stderr
    assert names(folder) == ["p.irdata", "p.toml"]


@pytest.mark.req("QA-09")
@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["run", "p.irl", "--tick", "fast"], "--tick fast: a number is expected"),
        (["run", "p.irl", "--tick="], "--tick '': a number is expected"),
        (["run", "p.irl", "--max-steps", "1e6"], "--max-steps 1e6: a whole number is expected"),
        (["completion", "fis"], "shell fis: not one of bash, zsh, fish, tcsh; did you mean 'fish'?"),
        (
            ["convert", "p.csv", "-o", "a", "--to", "kuka"],
            "--to kuka: not one of urscript, krl, rapid, robodk",
        ),
    ],
)
def test_values_of_another_kind(inside, arguments, words):
    done = inside(*arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith(f"error IRL006: {words}")
    assert f"help: irlx {arguments[0]} --help has examples\n" in done.stderr


@pytest.mark.parametrize("arguments", [["convert"], ["verify"], ["run"], ["run", "p.irl", "--tick"]])
def test_usage_errors(capsys, arguments):
    with pytest.raises(SystemExit) as caught:
        main(arguments)
    out, err = capsys.readouterr()
    assert (caught.value.code, out) == (2, "")
    assert err.startswith("usage: irlx")


def test_verifying_what_is_no_stream(inside):
    done = inside("verify", "p.irl")
    assert "IRL707" in done.stderr
    assert done.returncode == 2


UNPRIVILEGED = """
import os, sys
from irlx.cli.main import main
program, elsewhere = sys.argv[1:]
os.chdir(elsewhere)
# Loads everything that a run needs, for another user may not be allowed to read it.
assert main(["run", program, "-o", "first.csv", "--quiet"]) == 0
if os.geteuid() == 0:
    os.setgroups([])
    os.setgid(65534)
    os.setuid(65534)
print(main(["run", program, "--quiet"]), flush=True)
print(main(["run", program, "-o", program.replace(".irl", ".csv"), "--quiet"]), flush=True)
"""


@pytest.fixture
def shared():
    """A folder that every user can look into."""
    with tempfile.TemporaryDirectory(prefix="irlx-") as name:
        Path(name).chmod(0o755)
        yield Path(name)


@pytest.mark.req("QA-09")
def test_a_folder_without_write_permission(folder, environment, names, shared):
    programs, elsewhere = shared / "programs", shared / "elsewhere"
    shutil.copytree(folder, programs)
    elsewhere.mkdir()
    elsewhere.chmod(0o777)
    programs.chmod(0o555)
    arguments = [sys.executable, "-c", UNPRIVILEGED, programs / "p.irl", elsewhere]
    done = subprocess.run(arguments, env=environment, capture_output=True, text=True, check=True, timeout=60)
    programs.chmod(0o755)
    assert done.stdout == "0\n2\n"
    assert done.stderr.startswith(f"error IRL003: cannot write {programs / 'p.csv'}: permission denied")
    assert names(elsewhere) == ["first.csv", "p.irdata"]
    assert names(programs) == UNCHANGED
