"""programs/koch/experiments.py: the facts of every experiment, and what it says without matplotlib."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

import irlx
from kept_runs import kept_run
from long_run import first

KOCH = Path(__file__).parents[2] / "programs" / "koch"
SOURCE = Path(irlx.__file__).parents[1]


@pytest.fixture(scope="module")
def experiments():
    """The script as a module; a run that tests of this folder have asked for is not made again."""
    before = set(sys.modules)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(KOCH))
        import experiments

        def run_of(program: str, cell: str, tick: float) -> irlx.Run:
            return kept_run(KOCH / program, KOCH / cell, tick_ms=tick)

        patch.setattr(experiments, "run_of", run_of)
        yield experiments
    for name in ("experiments", "experiment_facts", "experiment_figures"):
        if name not in before:
            sys.modules.pop(name, None)


@pytest.fixture
def inside(experiments, tmp_path, monkeypatch, capsys):
    """Runs experiments.py with arguments in a folder of its own: exit code, stdout, stderr."""

    def run(*arguments: str) -> subprocess.CompletedProcess[str]:
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "argv", ["experiments.py", *arguments])
        code = experiments.main()
        return subprocess.CompletedProcess(arguments, code, *capsys.readouterr())

    return run


FACTS = {
    50: {
        "limits met (ticks), basic 11+ 42",
        "joint 7, free -412.8",
        "limits met (ticks), cyclic 10- 68, 11+ 139",
        "nearest shape, plain, mm -116.5",
        "limits met (ticks), clear 10+ 81, 9+ 36",
    },
    100: {
        "limits met (ticks), basic 11+ 21",
        "joint 7, free -243.2",
        "limits met (ticks), cyclic 10- 34, 11+ 70",
        "nearest shape, plain, mm -109.6",
        "limits met (ticks), clear 10+ 37, 9+ 17",
    },
}
"""Facts by tick, ms, some of each experiment."""


@pytest.mark.parametrize("tick", first(1, [50, 100]))
def test_facts_of_all_experiments(inside, tick: int) -> None:
    done = inside("all", "--facts", "--tick", str(tick))
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    lines = done.stdout.splitlines()
    assert [line[:3] for line in lines if line and not line.startswith(" ")] == [
        "6.1",
        "6.2",
        "6.3",
        "6.4",
        "6.5",
        "6.6",
    ]
    told = {" ".join(line.split()) for line in lines}
    assert told >= FACTS[tick]
    assert "different values of joints 2, 3 1, 1" in told
    assert "nearest shape, clear, mm 972.193" in told


def test_without_matplotlib_one_line_and_the_facts(tmp_path) -> None:
    """As a process of its own, as a person starts it."""
    hidden = tmp_path / "hidden"
    hidden.mkdir()
    message = "No module named 'matplotlib'"
    text = f'raise ModuleNotFoundError("{message}", name="matplotlib")\n'
    (hidden / "matplotlib.py").write_text(text, encoding="utf-8")
    path = os.pathsep.join([str(hidden), str(SOURCE)])
    done = subprocess.run(
        [sys.executable, str(KOCH / "experiments.py"), "6.1", "--tick", "200", "400"],
        capture_output=True,
        text=True,
        encoding="utf-8",
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": path, "PYTHONIOENCODING": "utf-8"},
        check=False,
    )
    assert done.returncode == 1
    assert done.stderr == "no pictures: matplotlib is missing; pip install matplotlib\n"
    told = {" ".join(line.split()) for line in done.stdout.splitlines()}
    # A column for each tick.
    assert {"200 ms 400 ms", "limits met (ticks), basic 11+ 11 11+ 6"} <= told
    assert [path.name for path in tmp_path.iterdir()] == ["hidden"]


def test_weight_and_limit_can_be_others(inside) -> None:
    """Ten times the weight: joint 10 moves less; 200 deg/s2 holds where 350 would have been used."""
    done = inside("6.3", "--weight", "50", "--acceleration", "200", "--facts", "--tick", "100")
    assert done.returncode == 0, done.stderr
    facts = {line[2:46].strip(): line[46:].strip() for line in done.stdout.splitlines()}
    assert float(facts["largest of all joints but 10, both limited"]) <= 200.0
    free, *_ = facts["joint 10: free, limited, weight x 4, mm/s²"].split(",")
    assert float(free) < 50.0


@pytest.mark.parametrize("name", first(1, ["6.3", "6.6"]))
def test_drawn_where_matplotlib_is(inside, tmp_path, name: str) -> None:
    pytest.importorskip("matplotlib")
    window = ["--joints", "7", "11", "--window", "5", "6.2"]
    done = inside(name, *window, "--out", str(tmp_path / "new"))
    assert done.returncode == 0, done.stderr
    picture = tmp_path / "new" / f"experiment_{name.replace('.', '_')}.png"
    assert picture.read_bytes().startswith(b"\x89PNG")
