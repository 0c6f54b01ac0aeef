"""A folder with a program and its cell, and the command line as a subprocess of its own."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import irlx
from irlx.cli.main import main

CELL = """[robot]
model = "koch11"
[robot.limits]
position = [180, [-150, 0], [-180, 0], [0, 180], [-180, 0], [-180, 0], 180, 60, 180, 500, [-20, 60]]
acceleration = [500, 500, 500, 500, 500, 500, 500, 500, 500, 5000, 500]
[motion]
tick_ms = 50
speed = 1000
acc = 2000
"""
# The tool of the start posture stands at (11500, 1000, 3500) mm, not turned.
PROGRAM = """PROGRAM p;
VAR POSITION: near := (11400, 1000, 3500), home := (11500, 1000, 3500);
BEGIN
  MOVE LIN near;
  MOVE LIN home;
ENDPROGRAM
"""


def program(body, declarations=""):
    """Text of a program; its body begins on line 3, after one line of declarations."""
    return f"PROGRAM p; {declarations}\nBEGIN\n{body}\nENDPROGRAM\n"


@pytest.fixture
def folder(tmp_path):
    """A folder with p.irl and p.toml."""
    folder = tmp_path / "work"
    folder.mkdir()
    (folder / "p.irl").write_text(PROGRAM, encoding="utf-8")
    (folder / "p.toml").write_text(CELL, encoding="utf-8")
    return folder


@pytest.fixture
def environment(tmp_path):
    """Environment of a subprocess: an empty home, nothing of the caller's settings but the path, and what
    chooses the kernels of the linear algebra, since their last bits differ."""
    home = tmp_path / "home"
    home.mkdir()
    return {
        **{name: value for name, value in os.environ.items() if name.startswith("OPENBLAS_")},
        "PATH": os.environ.get("PATH", ""),
        "HOME": str(home),
        "PYTHONPATH": str(Path(irlx.__file__).parents[1]),
        "PYTHONDONTWRITEBYTECODE": "1",
    }


@pytest.fixture
def command(folder, environment):
    """Run `irlx` with arguments in the folder; never may it print a traceback."""

    def run(*arguments, env=None, **more):
        done = subprocess.run(
            [sys.executable, "-m", "irlx", *map(str, arguments)],
            cwd=more.pop("cwd", folder),
            env={**environment, **(env or {})},
            capture_output=True,
            timeout=120,
            check=False,
            **more,
        )
        done.stdout, done.stderr = done.stdout.decode("utf-8"), done.stderr.decode("utf-8")
        assert "Traceback" not in done.stdout + done.stderr
        assert "IRL090" not in done.stderr
        assert "\x1b" not in done.stdout + done.stderr
        return done

    return run


@pytest.fixture
def inside(folder, monkeypatch, capsys):
    """Like `command`, without the start of a process: exit code, stdout, stderr."""

    def run(*arguments):
        monkeypatch.chdir(folder)
        code = main([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert "IRL090" not in err
        return subprocess.CompletedProcess(arguments, code, out, err)

    return run


@pytest.fixture
def names():
    """Names of everything in a folder, to see what a command leaves behind."""
    return lambda folder: sorted(path.name for path in folder.iterdir())
