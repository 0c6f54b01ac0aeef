"""The tutorial is true: its files are in form and clean, its commands print what it shows, its code runs."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest

import irlx
from irlx.cli.main import main

ROOT = Path(__file__).resolve().parents[1]
TUTORIAL = (ROOT / "docs" / "tutorial.md").read_text(encoding="utf-8")
FILES = dict(re.findall(r"^`(\w+\.(?:irl|toml))`\n```\w+\n(.*?)```", TUTORIAL, re.DOTALL | re.MULTILINE))
ROUNDING = ("path error", "closure", "cyclic")
"""Lines whose figures differ between machines."""


def fenced(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", TUTORIAL, flags=re.DOTALL)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("tutorial")
    shutil.copytree(ROOT / "programs", folder / "programs", ignore=shutil.ignore_patterns("*.irdata"))
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


LONG = "irlx run programs/combined/combined.irl"
"""Takes as long as all others: `test_combined.py` runs and verifies it too."""


@pytest.mark.req("QA-10")
@pytest.mark.parametrize("long", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["short", "long"])
def test_commands_print_what_is_shown(folder, monkeypatch, capsys, long):
    monkeypatch.chdir(folder)
    sessions = [session for session in fenced("console") if (LONG in session) is long]
    assert len(sessions) == 1 if long else len(sessions) >= 4
    for session in sessions:
        commands = [line[2:] for line in session.splitlines() if line.startswith("$ ")]
        shown = [line for line in session.splitlines() if line and not line.startswith("$ ")]
        printed = ""
        for command in commands:
            assert command.startswith("irlx ")
            status = main(shlex.split(command)[1:])
            told = capsys.readouterr()
            assert status == 0, (command, told.err)
            printed += told.out
        for line in shown:
            assert (line.split()[0] if line.startswith(ROUNDING) else line) in printed


def test_programs_are_clean_and_in_form(folder):
    programs = [name for name in FILES if name.endswith(".irl")]
    assert programs == ["first.irl", "frame.irl", "slow.irl"]
    for name in programs:
        assert irlx.check(folder / name) == []
        assert irlx.format_source(FILES[name]) == FILES[name]


def test_the_misspelt_name_gives_the_code_that_is_told(folder):
    (folder / "wrong.irl").write_text(FILES["first.irl"].replace("LIN above", "LIN abov"), encoding="utf-8")
    (found,) = [finding for finding in irlx.check(folder / "wrong.irl") if finding.is_error]
    assert (found.code, found.place.line) == ("IRL201", 7)
    assert "above" in found.message


def test_the_code_runs(folder, monkeypatch, capsys):
    monkeypatch.chdir(folder)
    (code,) = fenced("python")
    exec(code, {})
    assert "(1212, 7)" in capsys.readouterr().out


def test_what_it_points_to_exists():
    for link in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", TUTORIAL):
        assert (ROOT / "docs" / link).exists(), link
