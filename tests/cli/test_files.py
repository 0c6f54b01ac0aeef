"""Files and standard channels of whole runs: places in time, stdout, stdin, the sandbox, errors."""

import io
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

import irlx
from irlx.cli.main import main
from irlx.cli.standard_channels import _Descriptor

CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 20\n'
LOGGING = """PROGRAM p;
VAR
  FILE: log;
  POSITION: near := (440, 260, 325), far := (440, 200, 380);
  INT: i;
BEGIN
  WRITELN('begun');
  OPEN(log, 'log.txt', 'WRITE');
  MOVE LIN near;
  WRITELN(log, R_ROBTARGET_ACT.PSE.POS.X:8:2);
  MOVE LIN far;
  WRITELN(log, R_ROBTARGET_ACT.PSE.POS.Y:8:2);
  CLOSE(log);
  WRITE('done');
ENDPROGRAM
"""


def program(body, declarations="VAR FILE: f, g; INT: i; REAL: x; POSITION: near := (440, 260, 325);"):
    return f"PROGRAM p; {declarations}\nBEGIN\n{body}\nENDPROGRAM\n"


@pytest.fixture
def place(folder, monkeypatch):
    """The folder of the command, with a program and the cell of a small arm."""
    (folder / "p.toml").write_text(CELL)
    monkeypatch.chdir(folder)

    def write(text, name="p.irl"):
        (folder / name).write_text(text)
        return folder / name

    return write


@pytest.mark.req("LANG-42")
@pytest.mark.req("LANG-54")
def test_a_log(place, inside, folder):
    place(LOGGING)
    done = inside("run", "p.irl")
    assert done.returncode == 0
    assert done.stdout.startswith("begun\ndone\np.irl: complete, verified, ")
    assert done.stdout.endswith(" samples, 24 checks passed\n")
    assert done.stderr == ""
    assert (folder / "log.txt").read_text() == "  440.00\n  200.00\n"


@pytest.mark.req("LANG-42")
def test_the_text_alone_with_quiet(place, inside):
    place(LOGGING)
    assert inside("run", "p.irl", "--quiet").stdout == "begun\ndone"


@pytest.mark.req("LANG-42")
def test_json_stays_one_document(place, inside):
    place(LOGGING)
    done = inside("run", "p.irl", "--json")
    found = json.loads(done.stdout)
    assert found["output"] == "begun\ndone"
    assert found["summary"]["complete"]
    place(LOGGING.replace("CLOSE(log);", "CLOSE(log); CLOSE(log);"))
    found = json.loads(inside("run", "p.irl", "--json").stdout)
    assert (found["output"], found["summary"]["complete"]) == ("begun\n", False)
    assert "IRL542" in [d["code"] for d in found["diagnostics"]]
    place("PROGRAM p; BEGIN WRITE(x); ENDPROGRAM")
    assert json.loads(inside("run", "p.irl", "--json").stdout)["output"] == ""


@pytest.mark.req("LANG-54")
def test_everything_happens_at_its_place_in_time(place, folder):
    """Samples are pulled one by one: the file of a move is there when its samples are behind, not earlier."""
    path = place(LOGGING)
    output = io.StringIO()
    sizes, texts = [], []
    for sample in irlx.stream(path, output=output):
        sizes.append((folder / "log.txt").stat().st_size if (folder / "log.txt").exists() else -1)
        texts.append(output.getvalue())
        last = sample
    # Row 0 stands before the program begins; the rows of a move come before what is written behind it.
    assert sizes[0] == -1
    assert sorted(set(sizes)) == [-1, 0, 9]
    assert sizes == sorted(sizes)
    assert texts[0] == ""
    assert set(texts[1:]) == {"begun\n"}
    assert output.getvalue() == "begun\ndone"
    assert last.tick == len(sizes) - 1


@pytest.mark.req("LANG-42")
def test_a_stream_that_is_left_leaves_the_file(place, folder):
    samples = irlx.stream(place(LOGGING))
    for sample in samples:  # noqa: B007
        if (folder / "log.txt").exists() and (folder / "log.txt").stat().st_size:
            break
    before = len(os.listdir("/proc/self/fd"))
    samples.close()
    assert len(os.listdir("/proc/self/fd")) == before - 1
    assert (folder / "log.txt").read_text() == "  440.00\n"
    assert sample.tick > 0


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize(
    "end", ["MOVE PTP MAIN_JOINT(400, 0, 0, 0, 0, 0, 0);", "i := 1 DIV i;", "HALT;", "READ(i);", ""]
)
def test_what_was_written_is_there_however_it_ends(place, inside, folder, end):
    place(program(f"i := 0; OPEN(f, 'log.txt', 'WRITE'); WRITE('so ', 'far'); WRITELN(f, 'kept');\n{end}"))
    done = inside("run", "p.irl", "--quiet")
    assert (folder / "log.txt").read_text() == "kept\n"
    assert done.stdout.startswith("so far")
    failed = end not in ("HALT;", "")
    assert done.returncode == failed
    with pytest.raises(irlx.RunError) if failed else open(os.devnull) as caught:
        run = irlx.run("p.irl")
        assert [d.code for d in run.diagnostics] == ["IRL549"]
    if failed:
        assert caught.value.run.output == "so far"


@pytest.mark.req("LANG-42")
def test_open_files_are_told_at_the_end(place, inside):
    place(program("OPEN(f, 'log.txt', 'WRITE');\nCLOSE(f);\nOPEN(f, 'b.txt', 'WRITE');"))
    done = inside("run", "p.irl")
    assert "p.irl:5:1: warning IRL549: the file 'b.txt' was still open at the end" in done.stderr
    assert "help: write CLOSE(f);" in done.stderr
    assert done.returncode == 0


@pytest.mark.req("LANG-42")
def test_standard_input(place, inside, monkeypatch):
    place(program("WHILE NOT EOF() DO READ(i); WRITELN(i * 2); ENDWHILE;"))

    def told(given):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(given)))
        return inside("run", "p.irl", "--quiet")

    done = told(b"1 2\n3")
    assert (done.stdout, done.returncode) == ("2\n4\n6\n", 0)
    done = told(b"1 \xff")
    assert "IRL550: STANDARD_IN is no text in UTF-8: byte 2" in done.stderr
    done = told(b"1 zwei")
    assert "error IRL547: STANDARD_IN, line 1, column 3: expected a whole number, found 'zwei'" in done.stderr
    assert (done.stdout, done.returncode) == ("2\n", 1)


@pytest.mark.req("LANG-42")
def test_a_dialogue(place, folder, environment):
    """Prompt and answer in turns: what is written is out before the program waits, and a line is enough.

    Behind the last answer there is no end of a line, and stdout cannot hold what is written then.
    A signal while it waits: test_channels.py.
    """
    asking = "REPEAT WRITE('? '); READ(i); WRITELN(i + 1); UNTIL i = 0;"
    place(program(f"{asking} READ(i); WRITELN('żółć', i); WRITELN(EOF());"))
    call = [sys.executable, "-m", "irlx", "run", "p.irl", "--quiet"]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "bufsize": 0}
    env = {**environment, "PYTHONIOENCODING": "ascii"}
    with subprocess.Popen(call, cwd=folder, env=env, **pipes) as process:
        for number in (5, 7, 0):
            assert process.stdout.read(2) == "? "
            process.stdin.write(f"{number}\n")
            process.stdin.flush()
            assert process.stdout.readline() == f"{number + 1}\n"
        process.stdin.write("3")
        process.stdin.close()
        assert process.stdout.read() == "\\u017c\\xf3\\u0142\\u01073\nTRUE\n"
        assert process.wait(30) == 0


def test_a_reader_that_goes_away(place, folder, environment):
    """The run comes to its end all the same, and its stream is written; no pipe holds all of its lines."""
    place(program("FOR i := 1 TO 8000 DO WRITELN('line ', i); ENDFOR; MOVE LIN near;"))
    call = [sys.executable, "-m", "irlx", "run", "p.irl"]
    with subprocess.Popen(
        call, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        process.stdout.readline()
        process.stdout.close()
        errors = process.stderr.read()
        assert (process.wait(60), errors) == (0, b"")
    assert irlx.verify(folder / "p.irdata").passed


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_stdout_that_is_full(place, inside, monkeypatch):
    """As the stdout of a process is one: what it is made of then, test_channels.py looks at."""
    place(program("WRITELN('line');"))
    kept, full = os.dup(1), os.open("/dev/full", os.O_WRONLY)
    try:
        os.dup2(full, 1)
        with io.TextIOWrapper(io.BufferedWriter(_Descriptor(1))) as stdout:
            monkeypatch.setattr(sys, "stdout", stdout)
            done = inside("run", "p.irl", "--quiet")
            monkeypatch.undo()
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(full)
    told = "p.irl:3:1: error IRL548: STANDARD_OUT cannot be written: no space left on device"
    assert (done.returncode, done.stderr.splitlines()[0]) == (1, told)


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize(
    "name", ["p.irl", "p.toml", "tools.irl", "points.dat", "p.irdata", "p.partial.irdata"]
)
def test_files_of_the_run(place, inside, folder, name):
    place("MODULE tools; EXPORT n; VAR INT: n := 1; ENDMODULE", "tools.irl")
    place("DATALIST points; REAL: up := 1; ENDDATALIST", "points.dat")
    declarations = "FROM tools IMPORT n; IMPORT DATALIST points; VAR FILE: f;"
    place(program(f"WRITELN(n, up);\nOPEN(f, '{name}', 'APPEND'); WRITE(f, 'x'); CLOSE(f);", declarations))
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    done = inside("run", "p.irl", "--quiet")
    assert (done.returncode, done.stdout) == (1, "11.0\n")
    assert f"p.irl:4:9: error IRL551: '{name}' is " in done.stderr
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.req("LANG-42")
def test_another_folder(place, inside, folder, tmp_path):
    place(program("OPEN(f, 'a.txt', 'WRITE'); WRITELN(f, 'here'); CLOSE(f);"))
    other = tmp_path / "other"
    other.mkdir()
    assert inside("run", "p.irl", "--quiet", "--files", other).returncode == 0
    assert (other / "a.txt").read_text() == "here\n"
    assert not (folder / "a.txt").exists()
    assert irlx.run("p.irl", files=folder).complete
    assert (folder / "a.txt").exists()
    # It takes the place of the folder of the program, in both directions.
    place(program("OPEN(f, 'p.toml', 'READ'); CLOSE(f);"))
    assert "IRL541" in inside("run", "p.irl", "--quiet", "--files", other).stderr
    done = inside("run", "p.irl", "--files", "none")
    assert (done.returncode, done.stderr.splitlines()[0]) == (
        2,
        "error IRL006: --files none: there is no such folder",
    )


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("../a.txt", "IRL540"),
        ("/dev/zero", "IRL540"),
        ("out/a.txt", "IRL540"),
        ("pipe", "IRL548"),
        ("zero", "IRL540"),
    ],
)
@pytest.mark.parametrize("mode", ["READ", "WRITE"])
def test_hostile_names(place, inside, folder, tmp_path, name, code, mode):
    (folder / "out").symlink_to(tmp_path)
    (folder / "zero").symlink_to("/dev/zero")
    os.mkfifo(folder / "pipe")
    place(program(f"OPEN(f, '{name}',\n'{mode}'); CLOSE(f);"))
    began = time.monotonic()
    done = inside("run", "p.irl", "--quiet")
    assert f"p.irl:3:9: error {code}: '{name}'" in done.stderr
    assert done.returncode == 1
    assert time.monotonic() - began < 20.0
    assert not (tmp_path / "a.txt").exists()


@pytest.mark.req("LANG-42")
def test_blocks_write_no_files(place, inside, folder, names):
    place(LOGGING + "{ }\n")
    before = names(folder)
    done = inside("blocks", "p.irl")
    assert names(folder) == before
    shown = [line if line.startswith(" ") else line.split(" to ")[0] for line in done.stdout.splitlines()]
    assert shown == [
        '  WRITE "begun\\n"',
        "1 MOVE LIN",
        "  WRITE 'log.txt' \"  440.00\\n\"",
        "2 MOVE LIN",
        "  WRITE 'log.txt' \"  200.00\\n\"",
        '  WRITE "done"',
    ]


@pytest.mark.req("LANG-42")
def test_blocks_tell_of_open_files(place, inside, folder):
    place(program("MOVE LIN near; OPEN(f, 'a.txt', 'WRITE'); WRITE(f, 'x');"))
    done = inside("blocks", "p.irl")
    assert done.stderr.count("IRL549") == 1
    assert done.returncode == 0
    assert not (folder / "a.txt").exists()


@pytest.mark.req("LANG-12")
@pytest.mark.req("LANG-42")
def test_files_of_a_module(place, folder):
    """A module has the log, the program opens it by a procedure; messages name the text of the module."""
    place(
        "MODULE logbook; EXPORT log, begin_log, note; VAR FILE: log; INT: lines := 0;\n"
        "PROCEDURE begin_log; BEGIN\nOPEN(log, 'log.txt', 'WRITE'); ENDPROC;\n"
        "PROCEDURE note(STRING: what); BEGIN lines := lines + 1;\n"
        "WRITELN(log, lines:3, ' ', what); WRITE(what); ENDPROC;\n"
        "ENDMODULE",
        "logbook.irl",
    )
    path = place(
        "PROGRAM p; FROM logbook IMPORT log, begin_log, note;\n"
        "BEGIN begin_log; note('a'); note('b'); WRITELN(log); ENDPROGRAM"
    )
    assert irlx.check(path) == []
    run = irlx.run(path)
    assert (run.output, (folder / "log.txt").read_text()) == ("ab", "  1 a\n  2 b\n\n")
    (told,) = run.diagnostics
    assert (told.code, Path(told.place.file).name, told.place.line_and_column) == (
        "IRL549",
        "logbook.irl",
        (3, 1),
    )


@pytest.mark.req("LANG-13")
def test_no_file_in_a_data_list(place, folder):
    place("DATALIST points; FILE: log; ENDDATALIST", "points.dat")
    place("PROGRAM p; IMPORT DATALIST points; BEGIN OPEN(log, 'a', 'WRITE'); CLOSE(log); ENDPROGRAM")
    assert [(d.code, d.data["what"]) for d in irlx.check("p.irl")] == [("IRL267", "part of a data list")]


@pytest.mark.req("LANG-42")
def test_blocks_read_what_they_wrote(place, inside, folder):
    (folder / "n.txt").write_text("1\n")
    body = """OPEN(f, 'n.txt', 'APPEND'); WRITELN(f, 2); CLOSE(f);
    OPEN(f, 'n.txt', 'READ'); WHILE NOT EOF(f) DO READ(f, i); WRITE(i:2); ENDWHILE; CLOSE(f);"""
    place(program(body))
    assert inside("blocks", "p.irl").stdout.splitlines()[1:] == ['  WRITE " 1"', '  WRITE " 2"']
    assert (folder / "n.txt").read_text() == "1\n"


@pytest.mark.req("LANG-42")
def test_verification_writes_and_reads_nothing(place, folder, monkeypatch):
    """A counter in a file, which the run changes: its stream passes; blocks before the READ are compared."""
    (folder / "n.txt").write_text("1\n")
    body = """MOVE LIN near; OPEN(f, 'n.txt', 'READ'); READ(f, i); CLOSE(f);
    OPEN(f, 'n.txt', 'WRITE'); WRITELN(f, i + 1); CLOSE(f); MOVE LIN POSITION(440, 260 - i, 325);"""
    path = place(program(body))
    assert main(["run", str(path), "--quiet"]) == 0
    assert (folder / "n.txt").read_text() == "2\n"
    assert irlx.verify("p.irdata", program=path, cell="p.toml").passed
    assert (folder / "n.txt").read_text() == "2\n"
    place(program(body.replace("LIN near", "LIN POSITION(440, 261, 325)")))
    assert not irlx.verify("p.irdata", program=path, cell="p.toml").passed


@pytest.mark.req("LANG-42")
def test_from_python(place, folder):
    path = place(program("READ(i, x); WRITELN(i, ' ', x);"))
    assert irlx.run(path, input="4 .5").output == "4 0.5\n"
    assert irlx.run(path, input=io.StringIO("5\r\n1")).output == "5 1.0\n"
    assert irlx.run(path, input=io.BytesIO(b"\xef\xbb\xbf6 1")).output == "6 1.0\n"
    told = io.StringIO()
    assert irlx.run(path, input="7 7", output=told).output == told.getvalue() == "7 7.0\n"
    with pytest.raises(irlx.RunError, match="IRL546"):
        irlx.run(path)
    with pytest.raises(irlx.IrlxError, match="IRL006"):
        irlx.run(path, input=5)


def test_the_stream_does_not_change(place, folder):
    """Texts are no part of the stream: with and without them it has the same rows and blocks."""
    path = place(LOGGING)
    with_texts = irlx.run(path)
    plain = [line for line in LOGGING.splitlines() if "WRITE" not in line and "CLOSE" not in line]
    without = irlx.run(place("\n".join(plain)))
    assert (with_texts.q == without.q).all()
    assert [r.block.id for r in with_texts.stream.records] == [r.block.id for r in without.stream.records]
    assert without.output == ""


@pytest.mark.slow
def test_many_small_writes(place, folder):
    path = place(
        program("OPEN(f, 'a.txt', 'WRITE'); FOR i := 1 TO 1000000 DO WRITELN(f, i); ENDFOR; CLOSE(f);")
    )
    began = time.monotonic()
    irlx.run(path)
    assert time.monotonic() - began < 30.0
    assert len((folder / "a.txt").read_text().splitlines()) == 1_000_000
