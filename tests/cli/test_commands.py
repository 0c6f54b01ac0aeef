"""What the commands print and write when all is well, and when somebody interrupts."""

import hashlib
import json
import os
import pty
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from irlx.cli.main import build_parser
from irlx.diagnostics.rendering import MACHINE_FORMATS
from irlx.streams.formats import read_stream
from terminal import seen_inside


@pytest.mark.req("QA-09")
def test_run_twice_gives_the_same_bytes(inside, folder, names):
    """In another process: test_surroundings.py."""
    outputs = ["-o", "a.irdata", "-o", "a.npz", "-o", "a.csv"]
    done = inside("run", "p.irl", *outputs)
    assert (done.returncode, done.stderr) == (0, "")
    assert "p.irl: complete, verified, " in done.stdout
    written = [line.split()[1] for line in done.stdout.splitlines() if line.startswith("written")]
    assert written == outputs[1::2]
    assert done.stdout.count(" checks passed") == 3
    assert names(folder) == ["a.csv", "a.irdata", "a.npz", "p.irl", "p.toml"]
    first = {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in written}
    assert inside("run", "p.irl", *outputs).returncode == 0
    assert first == {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in written}


@pytest.mark.req("STR-04")
def test_formats_hold_the_same_samples(inside, folder):
    inside("run", "p.irl", "-o", "a.irdata", "-o", "a.npz", "-o", "a.CSV")
    first, second, third = (read_stream(folder / f"a.{ending}") for ending in ("irdata", "npz", "CSV"))
    assert first.complete
    assert first.q.shape[1] == 11
    for other in (second, third):
        np.testing.assert_array_equal(first.q, other.q)
        np.testing.assert_array_equal(first.block, other.block)
        assert other.complete


def test_default_output_is_beside_the_program(inside, folder, names):
    done = inside("run", folder / "p.irl", "--quiet")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert names(folder) == ["p.irdata", "p.irl", "p.toml"]


@pytest.mark.req("QA-09")
def test_json(inside, folder):
    done = inside("run", "p.irl", "--json")
    assert (done.returncode, done.stderr) == (0, "")
    found = json.loads(done.stdout)
    assert found["files"] == ["p.irdata"]
    assert found["verified"] == {"p.irdata": True}
    assert found["summary"]["complete"] is True
    assert found["summary"]["moves"] == 2
    assert found["diagnostics"] == []
    stream = read_stream(folder / "p.irdata")
    assert found["summary"]["samples"] == stream.t.size
    assert found["summary"]["duration"] == stream.t[-1]


def test_json_of_a_run_that_ends_early(inside, folder, names):
    text = (folder / "p.irl").read_text().replace("MOVE LIN home;", "MOVE LIN home TIME := 0.01;")
    (folder / "p.irl").write_text(text)
    done = inside("run", "p.irl", "--json")
    found = json.loads(done.stdout)
    assert done.returncode == 1
    assert found["summary"]["complete"] is False
    assert [d["code"] for d in found["diagnostics"]] == ["IRL421"]
    assert found["diagnostics"][0]["place"] == "p.irl:5:3"
    assert names(folder) == ["p.irl", "p.partial.irdata", "p.toml"]


def test_a_partial_stream_ends_at_the_last_stop(inside, folder):
    inside("run", "p.irl", "-o", "whole.npz")
    text = (folder / "p.irl").read_text().replace("MOVE LIN home;", "MOVE LIN home TIME := 0.01;")
    (folder / "p.irl").write_text(text)
    done = inside("run", "p.irl", "-o", "out.npz")
    assert done.returncode == 1
    assert "p.irl:5:3: error IRL421: TIME 0.01 s is shorter than " in done.stderr
    whole, partial = read_stream(folder / "whole.npz"), read_stream(folder / "out.partial.npz")
    assert whole.complete
    assert not partial.complete
    assert not partial.qd[-1].any()
    np.testing.assert_array_equal(partial.q, whole.q[: len(partial.q)])


def test_verify(inside, folder):
    assert inside("run", "p.irl", "--quiet").returncode == 0
    done = inside("verify", "p.irdata", "--program", "p.irl", "--cell", "p.toml", "--json")
    found = json.loads(done.stdout)
    assert (done.returncode, done.stderr) == (0, "")
    assert found["passed"] is True
    with (folder / "p.irl").open("a") as file:
        file.write("{ another text }\n")
    done = inside("verify", "p.irdata", "--program", "p.irl")
    assert done.returncode == 1
    assert "the stream was made from p.irl with another text" in done.stdout


def test_blocks(inside, folder, names):
    done = inside("blocks", "p.irl")
    assert (done.returncode, done.stderr) == (0, "")
    first, second = done.stdout.splitlines()
    assert first.startswith("1 MOVE LIN to (11400 1000 3500) kept in R_BASE speed 1000 mm/s")
    assert second.endswith("line 5")
    assert names(folder) == ["p.irl", "p.toml"]


def test_check_takes_several_programs_and_a_cell(inside, folder):
    (folder / "bad.irl").write_text("PROGRAM b; BEGIN x := 1; ENDPROGRAM")
    done = inside("check", "p.irl", "bad.irl")
    assert done.returncode == 1
    assert done.stdout == "p.irl: 0 errors, 0 warnings\nbad.irl: 1 error, 0 warnings\n"
    assert "bad.irl:1:18: error IRL201: unknown name 'x'" in done.stderr
    (folder / "p.toml").write_text("[robot]\nmodel = 'koch11'\n")
    done = inside("check", "p.irl", "--cell", "p.toml")
    assert (done.returncode, done.stdout) == (0, "p.irl: 0 errors, 1 warning\n")
    assert done.stderr.startswith("p.toml: robot.limits.acceleration: warning IRL621: ")


def test_a_cell_that_cannot_be_read_is_told_by_a_check(inside, folder):
    """The one that is found as well as one that is given, also beside a program that is not there."""
    (folder / "p.toml").write_text("[robot\n")
    done = inside("check", "p.irl")
    assert (done.returncode, done.stdout) == (2, "p.irl: 1 error, 0 warnings\n")
    assert done.stderr.startswith("p.toml: error IRL601: ")
    done = inside("check", "none.irl", "--cell", "none.toml")
    assert done.stdout == "none.irl: 2 errors, 0 warnings\n"
    assert [name in done.stderr for name in ("none.irl", "none.toml")] == [True, True]


@pytest.mark.parametrize("name", ["cells.toml", "p.toml"])
def test_the_cell_is_found_beside_the_program(inside, folder, name):
    text = (folder / "p.irl").read_text().replace("PROGRAM p;", "PROGRAM p;\nSYSTEM SPECIFICATION cells;")
    (folder / "p.irl").write_text(text)
    (folder / "p.toml").rename(folder / name)
    assert inside("run", "p.irl", "--quiet").returncode == 0
    (folder / name).unlink()
    done = inside("run", "p.irl")
    assert done.returncode == 2
    assert "p.irl:2:22: error IRL609: no cell file found; tried cells.toml, p.toml" in done.stderr


MODULES = """
import sys
from irlx.cli.main import main
unwanted, *lines = sys.argv[1:]
for line in lines:
    try:
        code = main(line.split())
    except SystemExit as stop:
        code = stop.code
    print(f"{line}:", code, sorted(set(unwanted.split()) & set(sys.modules)), file=sys.stderr)
"""
"""Carries out commands, and tells of unwanted modules that are there behind each of them."""
NUMERIC = "numpy scipy pinocchio proxsuite pydantic rich lark"
COMMANDS = "irlx.cli.run irlx.cli.robots irlx.cli.demo"


@pytest.fixture
def loaded(folder, environment):
    """What commands write, carried out in one process: lines of `MODULES`, other lines of stderr, stdout."""

    def carried_out(unwanted, *lines):
        call = [sys.executable, "-c", MODULES, unwanted, *lines]
        done = subprocess.run(
            call, cwd=folder, env=environment, capture_output=True, text=True, check=True, timeout=60
        )
        told = done.stderr.splitlines()
        # Quoted source lines are indented.
        ours = [line for line in told if line.partition(":")[0] in lines]
        return ours, [line for line in told if line not in ours], done.stdout

    return carried_out


@pytest.mark.req("QA-11")
def test_a_help_loads_no_messages_either(loaded):
    """They and what they need took a third of the time; of numeric libraries nobody talks then."""
    lines = ["--version", "--help", "run --help"]
    late = "dataclasses irlx.diagnostics json inspect"
    told, others, out = loaded(f"{late} {NUMERIC}", *lines)
    assert (told, others) == ([f"{line}: 0 []" for line in lines], [])
    assert out.count("usage: irlx") == 2


@pytest.mark.req("QA-11")
def test_light_commands_load_nothing_numeric_and_no_other_command(loaded, folder):
    (folder / "listed.irl").write_text(
        "PROGRAM l; IMPORT DATALIST points; BEGIN MOVE LIN near; ENDPROGRAM", encoding="utf-8"
    )
    points = "DATALIST points; POSITION: near := (11400, 1000, 3500); ENDDATALIST"
    (folder / "points.dat").write_text(points, encoding="utf-8")
    lines = [
        "check p.irl", "check listed.irl", "check points.dat", "check p.irl --format sarif", "fmt listed.irl",
        "explain IRL203", "explain",
    ]  # fmt: skip
    told, others, out = loaded(f"{NUMERIC} {COMMANDS}", *lines)
    assert (told, others) == ([f"{line}: 0 []" for line in lines], [])
    assert "points.dat: 0 errors, 0 warnings\n" in out


@pytest.mark.req("QA-11")
def test_the_table_of_robots_and_a_mistake_in_the_text_need_nothing_numeric(loaded, folder):
    (folder / "p.irl").write_text("PROGRAM p; BEGIN x := 1; ENDPROGRAM")
    told, others, _ = loaded(NUMERIC, "robots", "run p.irl")
    assert told == ["robots: 0 []", "run p.irl: 1 []"]
    assert "IRL201" in others[0]


def test_check_offers_every_format():
    (formats,) = (
        action.choices
        for action in build_parser("check").commands.choices["check"]._actions
        if action.dest == "format"
    )
    assert list(formats) == ["text", *MACHINE_FORMATS]


@pytest.mark.parametrize("locale", ["C", "C.UTF-8"])
@pytest.mark.req("QA-09")
@pytest.mark.req("LANG-01")
def test_locales(command, folder, locale):
    text = "PROGRAM p;\nVAR REAL: ściana;\nBEGIN\n  ściana := ściny;\nENDPROGRAM\n"
    (folder / "p.irl").write_text(text, encoding="utf-8")
    # Without UTF-8 mode of its own accord, a C locale means ASCII; POSIX is another name of it.
    done = command("check", "p.irl", env={"LC_ALL": locale, "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"})
    assert done.returncode == 1
    letter = "ś" if locale == "C.UTF-8" else r"\u015b"
    words = f"unknown name '{letter}ciny'; did you mean '{letter}ciana'?"
    assert f"p.irl:4:13: error IRL201: {words}" in done.stderr
    assert done.stdout == "p.irl: 1 error, 0 warnings\n"


def told_at_a_terminal(folder, environment):
    """What `irlx check` writes on stderr when that is a terminal."""
    (folder / "p.irl").write_text("PROGRAM p; BEGIN x := 1; ENDPROGRAM")
    ours, theirs = pty.openpty()
    call = [sys.executable, "-m", "irlx", "check", "p.irl"]
    env = {**environment, "TERM": "xterm"}
    subprocess.run(
        call, cwd=folder, env=env, stdout=subprocess.DEVNULL, stderr=theirs, check=False, timeout=60
    )
    os.close(theirs)
    text = b""
    try:
        while part := os.read(ours, 4096):
            text += part
    except OSError:
        pass  # Linux reports the end of a terminal as an error.
    os.close(ours)
    return text.decode()


@pytest.mark.req("QA-09")
def test_colour_at_a_terminal_only_where_wanted(folder, environment):
    assert "\x1b[1;31merror IRL201\x1b[0m: unknown name" in told_at_a_terminal(folder, environment)
    for unwanted in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
        code, told, _ = seen_inside(["check", "p.irl"], folder, unwanted)
        assert code == 1
        assert "error IRL201: unknown name" in told
        assert "\x1b" not in told


@pytest.mark.req("QA-09")
def test_a_reader_that_goes_away(folder, environment):
    """Of what a run writes: test_files.py."""
    call = f"{sys.executable} -m irlx explain | true"
    done = subprocess.run(
        ["sh", "-c", call],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    assert (done.returncode, done.stderr) == (0, "")


WATCH = """from pathlib import Path
from irlx.pacing.pacer import Pacer
carry_out = Pacer.carry_out
def watched(pacer, group):
    if group[0].id == 2:
        Path("second").touch()
    return carry_out(pacer, group)
Pacer.carry_out = watched
"""
"""A plugin that tells when the second block begins."""


@pytest.mark.req("QA-09")
def test_interrupt(folder, environment, names):
    """In the midst of the second move, however long it takes to get there; the first one is kept."""
    (folder / "watch.py").write_text(WATCH)
    far = "MOVE LIN POSITION(10000, 1000, 3500) SPEED := 20;"
    text = (folder / "p.irl").read_text().replace("MOVE LIN home;", far)
    (folder / "p.irl").write_text(text)
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "irlx",
            "run",
            "p.irl",
            "--tick",
            "0.25",
            "-o",
            "out.irdata",
            "--plugin",
            "watch.py",
        ],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # A shell starts its background jobs with interrupts ignored, and children inherit that.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509
    )
    end = time.monotonic() + 60.0
    while not (folder / "second").exists() and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
    assert process.poll() is None, process.communicate()
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert out == ""
    assert "Traceback" not in err
    assert err.startswith("irlx: interrupted\n")
    assert set(names(folder)) - {"p.irl", "p.toml"} == {"out.partial.irdata", "second", "watch.py"}
    stream = read_stream(folder / "out.partial.irdata")
    assert not stream.complete
    assert not stream.qd[-1].any()
    assert set(stream.block) == {0, 1}


@pytest.mark.req("STR-06")
def test_a_run_whose_file_fails_says_so(inside, folder, monkeypatch):
    """A writer that loses a bit of a joint: the file is read back, judged and refused."""
    from irlx.streams import StreamWriter

    samples = StreamWriter.samples

    def changed(writer, ticks, q, block, tool):
        samples(writer, ticks, q + 2e-6 * (ticks[:, None] == 3) * (np.arange(q.shape[1]) == 1), block, tool)

    monkeypatch.setattr(StreamWriter, "samples", changed)
    done = inside("run", "p.irl", "-o", "a.irdata")
    assert done.returncode == 1
    assert "a.irdata: error IRL709: the stream fails the check 'tool position': first" in done.stderr
    assert "at tick 3, block 1, line 4" in done.stderr
    last = done.stdout.splitlines()[-1]
    assert last.startswith("VERIFY      a.irdata: FAILED:")
    done = inside("run", "p.irl", "-o", "a.irdata", "--json")
    found = json.loads(done.stdout)
    assert found["verified"] == {"a.irdata": False}
    assert "IRL709" in {entry["code"] for entry in found["diagnostics"]}
    done = inside("run", "p.irl", "-o", "a.irdata", "--no-verify")
    assert done.returncode == 0
    assert "verif" not in done.stdout.lower()
    assert inside("verify", "a.irdata").returncode == 1
