"""Stdin, stdout and stderr that are closed, full or without a reader; what stops a command from outside."""

import io
import os
import signal
import subprocess
import sys
import time

import pytest

import irlx
from irlx.cli import main as entry
from irlx.cli.standard_channels import OutputLost, _Descriptor
from irlx.cli.stopping import Stopped, heard_signal, heed_signals, stopped_code
from irlx.streams import read_stream
from long_run import first

pytestmark = pytest.mark.req("QA-09")

WAITING = """PROGRAM p; VAR INT: i; FILE: f; POSITION: near := (11400, 1000, 3500);
BEGIN MOVE LIN near; OPEN(f, 'log.txt', 'WRITE'); WRITE(f, 'kept'); WRITE('żółć'); READ(i); ENDPROGRAM
"""
CALLS = [
    ("explain IRL203", ">&-", 0, ""),
    ("explain IRL000", "2>&-", 2, ""),
    ("explain IRL000", "2>/dev/full", 2, ""),
    ("check bad.irl", "<&- >&- 2>&-", 1, ""),
    ("explain IRL203", ">/dev/full 2>/dev/full", 2, ""),
    ("--help", ">/dev/full", 2, "error IRL003: cannot write stdout: no space left on device"),
    ("explain IRL203", "2>&1 >&- | true", 0, ""),
    ("fmt - <p.irl", ">/dev/full", 2, "error IRL003: cannot write stdout: no space left on device"),
    ("fmt -", "<&-", 1, "<stdin>:1:1: error IRL117: the file holds no program"),
    ("explain IRL000", "2>&1 >/dev/null | true", 2, ""),
]


def shell(folder, environment, words, channel):
    """What came of a command of irlx behind a shell's redirections: exit code, stderr."""
    call = f"set -o pipefail; {sys.executable} -m irlx {words} {channel}"
    options = {"capture_output": True, "text": True, "timeout": 60}
    done = subprocess.run(["bash", "-c", call], cwd=folder, env=environment, check=False, **options)
    assert "Traceback" not in done.stderr
    assert "Exception ignored" not in done.stderr
    return done.returncode, done.stderr


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
@pytest.mark.parametrize(("words", "channel", "code", "told"), CALLS)
def test_channels_that_are_closed_or_full(folder, environment, words, channel, code, told):
    """The exit code is that of the command, or 2 where its output is lost; nothing else is said."""
    (folder / "bad.irl").write_text("PROGRAM p; BEGIN x := 1; ENDPROGRAM")
    found, errors = shell(folder, environment, words, channel)
    assert found == code
    assert errors.startswith(told)
    assert bool(errors) == bool(told)


def test_a_run_whose_output_nobody_takes(folder, environment, names):
    """Closed channels: no file of the run gets their numbers, whatever a library may say on them."""
    assert shell(folder, environment, "run p.irl -o p.irdata", "<&- >&- 2>&-") == (0, "")
    assert irlx.verify(folder / "p.irdata").passed
    assert names(folder) == ["p.irdata", "p.irl", "p.toml"]


def test_a_pipe_that_does_not_wait_gets_everything():
    """The other side of a pipe may have made it one that does not block."""
    into, out = os.pipe()
    os.set_blocking(out, False)
    kept = os.dup(1)
    try:
        os.dup2(out, 1)
        with subprocess.Popen(["sleep", "0.1"]) as pause:
            text = b"x" * 300_000
            reader = subprocess.Popen(["wc", "-c"], stdin=into, stdout=subprocess.PIPE)
            os.close(into)
            assert _Descriptor(1).write(text) == len(text)
            pause.wait()
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(out)
    assert reader.communicate(timeout=10)[0].strip() == b"300000"


def test_a_help_that_is_lost_at_once(monkeypatch, capsys):
    """As with PYTHONUNBUFFERED, where each text is written when it is said."""

    class Full(io.StringIO):
        def write(self, _):
            raise OutputLost(28, "No space left on device")

    monkeypatch.setattr(sys, "stdout", Full())
    assert entry.main(["--help"]) == 2
    assert "error IRL003: cannot write stdout: no space left on device" in capsys.readouterr().err


def test_a_reader_that_has_read_enough(monkeypatch, capsys):
    """Nothing is wrong then: what follows is dropped."""

    class Left(io.StringIO):
        def write(self, _):
            raise BrokenPipeError

        def fileno(self):
            return 77

    dropped = []
    monkeypatch.setattr(entry, "drop_output", dropped.append)
    monkeypatch.setattr(sys, "stdout", Left())
    assert entry.main(["explain", "IRL203"]) == 0
    assert dropped == [77]
    assert capsys.readouterr().err == ""


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_what_is_lost_is_told_once():
    kept, full = os.dup(1), os.open("/dev/full", os.O_WRONLY)
    try:
        os.dup2(full, 1)
        stream = io.TextIOWrapper(io.BufferedWriter(_Descriptor(1)))
        stream.write("lost")
        with pytest.raises(OutputLost):
            stream.flush()
        stream.write("more")
        stream.flush()
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(full)


def test_all_three_signals_are_heard_alike(monkeypatch):
    """What becomes of a run then, the next test shows by one of them."""
    given: dict = {}
    monkeypatch.setattr(signal, "getsignal", lambda number: given.get(number, signal.SIG_DFL))
    monkeypatch.setattr(signal, "signal", given.__setitem__)
    heed_signals()
    assert set(given) == {signal.SIGINT, signal.SIGTERM, signal.SIGHUP}
    for number, listener in given.items():
        with pytest.raises(Stopped) as caught:
            listener(number, None)
        assert (caught.value.number, stopped_code(caught.value)) == (number, 128 + number)
        assert heard_signal() is not None


@pytest.mark.parametrize(
    "which", first(1, [signal.SIGTERM, signal.SIGHUP, signal.SIGINT]), ids=lambda which: which.name
)
def test_other_signals_end_a_run_as_ctrl_c_does(folder, environment, names, which):
    """While it waits for input: what was written is kept. Ctrl-C in a move: test_commands.py."""
    (folder / "p.irl").write_text(WAITING, encoding="utf-8")
    call = [sys.executable, "-m", "irlx", "run", "p.irl", "-o", "p.csv", "--quiet"]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    env = {**environment, "LC_ALL": "C.UTF-8"}
    with subprocess.Popen(call, cwd=folder, env=env, **pipes) as process:
        assert process.stdout.read(8) == "żółć".encode()
        time.sleep(0.1)
        process.send_signal(which)
        _, errors = process.communicate(timeout=30)
    assert process.returncode == 128 + which
    assert errors.startswith(b"irlx: interrupted\n")
    assert b"Traceback" not in errors
    assert (folder / "log.txt").read_text() == "kept"
    assert names(folder) == ["log.txt", "p.irl", "p.partial.csv", "p.toml"]
    assert not read_stream(folder / "p.partial.csv").complete


@pytest.mark.parametrize("after", [0.0, 0.05, 0.4], ids="{:g} s".format)
def test_ctrl_c_before_anything_moves(folder, environment, names, after):
    """While libraries are loaded: one message, whatever it hits."""
    call = (
        "import os, signal, sys, threading, time; from irlx.cli.main import entry_point;"
        "signal.signal(signal.SIGINT, signal.default_int_handler);"
        # Not before irlx can hear it.
        "deaf = lambda: signal.getsignal(signal.SIGHUP) is signal.SIG_DFL;"
        "waited = lambda: all(time.sleep(0.001) is None for _ in iter(deaf, False));"
        f"kill = lambda: (waited(), time.sleep({after}), os.kill(os.getpid(), signal.SIGINT));"
        "threading.Thread(target=kill, daemon=True).start();"
        "entry_point()"
    )
    options = {"capture_output": True, "timeout": 60}
    done = subprocess.run(
        [sys.executable, "-c", call, "run", "p.irl"], cwd=folder, env=environment, check=False, **options
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, b"", b"irlx: interrupted\n")
    assert names(folder) == ["p.irl", "p.toml"]


def test_an_older_partial_file_is_told_of(inside, folder, names):
    """Nothing is removed that nobody asked to have removed, and nobody takes it for the new run's."""
    (folder / "p.partial.csv").write_text("of an earlier run")
    done = inside("run", "p.irl", "-o", "p.csv", "--no-verify")
    assert (done.returncode, done.stderr) == (
        0,
        "irlx: p.partial.csv is left as it was, from an earlier run\n",
    )
    assert (folder / "p.partial.csv").read_text() == "of an earlier run"
    assert inside("run", "p.irl", "-o", "p.csv", "--no-verify", "--quiet").stderr == ""
    assert names(folder) == ["p.csv", "p.irl", "p.partial.csv", "p.toml"]
