"""`irlx demo`: what it writes runs, shows what it says, and leads on; nothing that is there is touched."""

from __future__ import annotations

import contextlib
import io
import re
import shlex
from pathlib import Path

import pytest

import irlx
from irlx.cell.packaged import demo_texts
from irlx.cli import demo
from irlx.cli.main import main
from irlx.streams.formats import read_stream
from nearness import nearest

pytestmark = pytest.mark.req("REP-02")

PAGE = Path(__file__).resolve().parents[2] / "docs" / "diagnostics" / "IRL018.md"
FILES = ["demo.html", "demo.irdata", "demo.irl", "demo.toml"]


class Told:
    """What a command printed."""

    def __init__(self, code: int, out: str, err: str) -> None:
        self.code, self.out, self.err = code, out, err
        self.lines = out.splitlines()


def called(capsys: pytest.CaptureFixture[str], *arguments: str) -> Told:
    code = main(list(arguments))
    out, err = capsys.readouterr()
    return Told(code, out, err)


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("demo")


@pytest.fixture(scope="module")
def told(place: Path) -> Told:
    """The demo with nothing asked for, run once."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(place)
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = main(["demo"])
    return Told(code, out.getvalue(), err.getvalue())


def test_it_runs_and_says_what_it_shows(told: Told, place: Path) -> None:
    assert (told.code, told.err) == (0, "")
    assert sorted(path.name for path in (place / "irlx-demo").iterdir()) == FILES
    verdict = re.fullmatch(
        r"demo\.irl: complete, verified, ([\d.]+) s, slowed by ([\d.]+) s, nearest ([\d.]+) mm", told.lines[0]
    )
    duration, slowed, distance = map(float, verdict.groups())
    assert duration < 10.0
    assert slowed > 0.5
    assert distance > 20.0
    assert any(re.match(r"cyclic +back in the posture of CYCLICSTART once", line) for line in told.lines)
    page = (place / "irlx-demo" / "demo.html").resolve().as_uri()
    assert f"page        {page}" in told.lines
    assert all(len(line) <= 80 for line in told.lines if place.name not in line)


def test_the_reference_and_the_readme_show_it(told: Told) -> None:
    readme = (PAGE.parents[2] / "README.md").read_text(encoding="utf-8")
    first = readme.split("```console\n$ irlx demo\n")[1].split("```")[0].splitlines()
    assert first == [line for line in told.lines if line in first]
    page = (PAGE.parents[1] / "reference" / "interface.md").read_text(encoding="utf-8")
    shown = page.split("$ irlx demo\n")[1].split("```")[0].splitlines()
    # Figures at rounding level differ between machines.
    figures = "cyclic"
    assert [line for line in shown if not line.startswith(figures)] == [
        line for line in told.lines if not line.startswith((figures, "page "))
    ]


def test_the_stream_is_what_it_says(told: Told, place: Path) -> None:
    folder = place / "irlx-demo"
    assert read_stream(folder / "demo.irdata").complete
    report = irlx.verify(folder / "demo.irdata", program=folder / "demo.irl", cell=folder / "demo.toml")
    assert report.passed
    assert not report.unchecked


def test_the_text_teaches(place: Path, told: Told) -> None:
    """It is short, in form and without a finding, and no clause goes without a comment."""
    program, cell = demo_texts()
    folder = place / "irlx-demo"
    assert (folder / "demo.irl").read_text(encoding="utf-8") == program
    assert (folder / "demo.toml").read_text(encoding="utf-8") == cell
    assert irlx.check(folder / "demo.irl", cell=folder / "demo.toml") == []
    assert irlx.format_source(program) == program
    lines = program.splitlines()
    assert len(lines) <= 40
    assert all(len(line) <= 120 for line in lines)
    for clause in ("MOVE PTP", "MOVE LIN", "CYCLICSTART", "OBSTACLE post", "WITH JOINTSPEEDLIMIT", "FK("):
        first = next(number for number, line in enumerate(lines) if clause in line)
        assert any("{" in line for line in lines[max(first - 3, 0) : first + 1]), clause
    settings = [
        line
        for line in cell.splitlines()
        if " = " in line and not line.startswith(("model", "name", "shape"))
    ]
    assert all("#" in line for line in settings)


def test_without_the_obstacle_line_the_elbow_hits_the_post(tmp_path: Path) -> None:
    """What the comment says, by distances of another maker."""
    program, cell = demo_texts()
    (tmp_path / "demo.toml").write_text(cell, encoding="utf-8")
    (tmp_path / "demo.irl").write_text(re.sub(r"OBSTACLE(END)? post;", "", program), encoding="utf-8")
    distances = nearest(irlx.run(tmp_path / "demo.irl"), tmp_path / "demo.toml")
    assert distances["upper_arm_2", "post"].min() < -0.02


def test_what_comes_next_works(told: Told, place: Path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(place)
    commands = [line.strip() for line in told.lines if line.startswith("  irlx ")]
    assert len(commands) == 3
    for command in commands:
        words = shlex.split(command, comments=True)
        assert words[0] == "irlx"
        done = called(capsys, *words[1:])
        assert done.code == 0, (command, done.err)
        assert done.out.strip()


def test_it_replaces_nothing(tmp_path: Path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "p.irl").write_text("mine", encoding="utf-8")
    done = called(capsys, "demo", "mine")
    assert (done.code, done.out) == (2, "")
    shown = re.search(
        r"```console\n\$ irlx demo mine\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL
    )[1]
    assert done.err == shown
    assert [path.name for path in (tmp_path / "mine").iterdir()] == ["p.irl"]
    here = called(capsys, "demo", ".")
    assert here.code == 2
    assert here.err.startswith("error IRL018: . is not empty")


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["file"], "IRL003", "cannot write file: it is a file, not a folder\n  help: name another folder"),
        (["file/below"], "IRL003", "cannot write file/below"),
        (["new", "--robot", "arm8"], "IRL006", "did you mean 'arm7'"),
        (["new", "--robot", "nope"], "IRL006", "help: irlx robots lists all names"),
    ],
)
def test_refusals(tmp_path: Path, monkeypatch, capsys, arguments, code, words) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("x", encoding="utf-8")
    done = called(capsys, "demo", *arguments)
    assert done.code == 2
    assert code in done.err
    assert words in done.err
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_another_robot(tmp_path: Path, monkeypatch, capsys) -> None:
    """The first program of `irlx new`, in an empty folder that is there."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "x").mkdir()
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    done = called(capsys, "demo", "x", "--robot", "planar4", "--open")
    assert done.code == 0, done.err
    assert done.lines[0].startswith("demo.irl: complete, verified, ")
    assert sorted(path.name for path in (tmp_path / "x").iterdir()) == FILES
    assert "planar4" in (tmp_path / "x" / "demo.toml").read_text(encoding="utf-8")
    assert opened == [(tmp_path / "x" / "demo.html").resolve().as_uri()]


def test_a_run_that_fails_is_told(tmp_path: Path, monkeypatch, capsys) -> None:
    monkeypatch.chdir(tmp_path)
    program, cell = demo_texts()
    beyond = program.replace("(0, 30, 0,", "(0, 300, 0,")
    monkeypatch.setattr("irlx.cell.packaged.demo_texts", lambda: (beyond, cell))
    done = called(capsys, "demo")
    assert (done.code, done.out) == (1, "")
    assert done.err.startswith("irlx-demo/demo.irl:16:3: error IRL424")


@pytest.mark.parametrize(("shown", "another"), [(None, "rail6"), ("arm7", "rail6"), ("rail6", "arm7")])
def test_the_robot_to_try_next_is_another(shown: str | None, another: str) -> None:
    files = demo._Files(*map(Path, FILES))
    assert f"irlx new first --robot {another} " in demo._next(files, shown)[-1]
