"""The README is true: its commands run, its code runs, what it names exists."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest

from irlx.cli.main import build_parser, main

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def fenced(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", README, flags=re.DOTALL)


@pytest.fixture
def clone(tmp_path):
    shutil.copytree(ROOT / "programs", tmp_path / "programs", ignore=shutil.ignore_patterns("*.irdata"))
    return tmp_path


LONG = ("irlx run programs/koch/square_slow.irl",)
"""The first commands of sessions that take most of the time of all: tests of slowed runs look at what such a
one prints, of shorter programs."""
DEMO = "irlx demo"
"""What it prints, `cli/test_demo.py` compares."""


def sessions() -> list[tuple[list[str], list[str]]]:
    """Commands, and lines shown, of every console session."""
    found = []
    for session in fenced("console"):
        lines = session.splitlines()
        commands = [line[2:] for line in lines if line.startswith("$ ")]
        found.append((commands, [line for line in lines if line and not line.startswith("$ ")]))
    return found


def carry_out(session: tuple[list[str], list[str]], capsys) -> None:
    commands, shown = session
    printed = ""
    for command in commands:
        words = shlex.split(command)
        assert words[0] == "irlx"
        status = main(words[1:])
        told = capsys.readouterr()
        assert status == 0, (command, told.err)
        printed += told.out
    for line in shown:
        # Figures at rounding level differ between machines.
        rounding = line.startswith(("path error", "closure"))
        assert (line.split()[0] if rounding else line) in printed


@pytest.mark.req("QA-10")
def test_the_console_sessions_run_and_print_what_they_show(clone, monkeypatch, capsys):
    monkeypatch.chdir(clone)
    short = [session for session in sessions() if session[0][0] not in (*LONG, DEMO)]
    assert len(short) == len(fenced("console")) - len(LONG) - 1
    for session in short:
        carry_out(session, capsys)


@pytest.mark.req("QA-10")
def test_the_long_sessions_are_command_lines_of_files_that_are_there(clone, monkeypatch):
    monkeypatch.chdir(clone)
    made = {word for commands, _ in sessions() for line in commands for word in re.findall(r"-o (\S+)", line)}
    for commands, _ in sessions():
        for line in commands if commands[0] in LONG else ():
            words = shlex.split(line)[1:]
            build_parser().parse_args(words)
            files = [word for word in words if "." in word]
            assert files
            assert [name for name in files if name not in made and not Path(name).is_file()] == []


@pytest.mark.slow
@pytest.mark.req("QA-10")
def test_the_long_sessions_run_and_print_what_they_show(clone, monkeypatch, capsys):
    """In their order, with those before them: some read what others wrote."""
    monkeypatch.chdir(clone)
    for session in sessions():
        carry_out(session, capsys)


@pytest.mark.req("QA-10")
def test_the_python_code_runs(clone, monkeypatch, capsys):
    monkeypatch.chdir(clone)
    code = "".join(fenced("python"))
    assert "irlx.run" in code
    exec(code, {})
    assert capsys.readouterr().out.strip().endswith("True")


@pytest.mark.req("QA-10")
def test_the_main_job_command_runs_a_program_that_exists():
    main_job, test_command = fenced("sh")
    assert (ROOT / re.search(r"irlx run (\S+)", main_job)[1]).is_file()
    assert "-m pytest" in test_command
    assert "python -m pytest" in (ROOT / ".ci" / "run").read_text(encoding="utf-8")


def test_every_file_it_names_exists():
    linked = [target for target in re.findall(r"\]\(([^)#]+)\)", README) if "://" not in target]
    named = re.findall(r"`(tests/[\w/.]+)`", README)
    assert linked
    assert named
    missing = [path for path in [*linked, *named] if not (ROOT / path).exists()]
    assert missing == []
