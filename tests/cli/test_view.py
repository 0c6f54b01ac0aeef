"""`irlx view` from the command line: what keeps it from serving, and how it ends."""

import signal
import socket
import subprocess
import sys

import pytest

pytest.importorskip("viser", reason="viser is not installed: pip install 'irlx[test]'")
pytestmark = pytest.mark.req("REP-05")

CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 40\n'
PROGRAM = "PROGRAM p;\nBEGIN\n  MOVE_INC LIN (0, 0, -20);\nENDPROGRAM;\n"


@pytest.fixture
def program(tmp_path):
    (tmp_path / "p.toml").write_text(CELL)
    (tmp_path / "p.irl").write_text(PROGRAM)
    return tmp_path / "p.irl"


def test_a_missing_package_costs_nothing_else(inside, program, monkeypatch):
    monkeypatch.setitem(sys.modules, "viser", None)
    done = inside("view", str(program))
    assert done.returncode == 2
    assert done.stderr == "error IRL010: irlx view needs viser: pip install 'irlx[view]'\n"
    assert inside("check", str(program)).returncode == 0


def test_a_port_in_use_is_told_before_anything_runs(inside, tmp_path):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        done = inside("view", str(tmp_path / "none.irl"), "--port", str(port))
    assert done.returncode == 2
    assert f"error IRL014: the page cannot be served on port {port} of 127.0.0.1: it is in use" in done.stderr


@pytest.mark.parametrize(
    ("text", "code", "told"),
    [
        (PROGRAM.replace("20", "p2"), 1, "error IRL201"),
        (PROGRAM.replace("MOVE_INC", "MOVE_IN"), 1, "error IRL121"),
    ],
)
def test_a_mistake_in_the_program(inside, program, text, code, told):
    program.write_text(text)
    done = inside("view", str(program), "--port", "0", "--no-open")
    assert done.returncode == code
    assert told in done.stderr
    assert "http" not in done.stdout


def test_no_such_file(inside, tmp_path):
    for name in ("none.irl", "none.npz"):
        done = inside("view", str(tmp_path / name), "--port", "0", "--no-open")
        assert done.returncode == 2
        assert "error IRL001" in done.stderr


def test_a_program_that_ends_in_an_error_is_shown_as_far_as_it_came(inside, program, monkeypatch):
    seen = []
    monkeypatch.setattr("irlx.viewer.viewer.Viewer.wait", lambda self: seen.append(self.shown))
    program.write_text(PROGRAM.replace("END", "  MOVE_INC LIN (0, 0, -20 / (R_ACC - R_ACC));\nEND", 1))
    done = inside("view", str(program), "--port", "0", "--no-open")
    assert done.returncode == 1
    assert "error IRL5" in done.stderr
    (shown,) = seen
    assert not shown.stream.complete
    assert shown.duration > 0.1
    assert shown.line_at(len(shown.stream.q) - 1).number == 3


def test_ctrl_c_ends_it(program):
    command = [sys.executable, "-m", "irlx", "view", str(program), "--port", "0", "--no-open"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            first = process.stdout.readline()
            assert first.startswith("irlx view: http://127.0.0.1:")
            process.send_signal(signal.SIGINT)
            rest, errors = process.communicate(timeout=20)
        finally:
            process.kill()
    assert process.returncode == 0
    assert (rest, errors.count("Traceback")) == ("", 0)
