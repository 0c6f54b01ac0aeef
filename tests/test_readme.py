"""The README is true: its commands run, its code runs, what it names exists."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest

from irlx.cli.main import main

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def fenced(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", README, flags=re.DOTALL)


@pytest.fixture
def clone(tmp_path):
    shutil.copytree(ROOT / "programs", tmp_path / "programs", ignore=shutil.ignore_patterns("*.irdata"))
    return tmp_path


@pytest.mark.req("QA-10")
def test_the_console_session_runs_and_prints_what_it_shows(clone, monkeypatch, capsys):
    monkeypatch.chdir(clone)
    lines = "".join(fenced("console")).splitlines()
    commands = [line[2:] for line in lines if line.startswith("$ ")]
    shown = [line for line in lines if line and not line.startswith("$ ")]
    assert commands
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
