"""docs/reference/robots.md is true: its commands print what it shows, its list of codes is whole."""

import re
import shlex
from pathlib import Path

import pytest

from irlx.cli.main import main
from irlx.diagnostics.codes.robot_model import ROBOT_MODEL

PAGE_PATH = Path(__file__).resolve().parents[1] / "docs" / "reference" / "robots.md"
PAGE = PAGE_PATH.read_text(encoding="utf-8")
FILES = dict(re.findall(r"^`(\w+\.urdf)`\n```\w+\n(.*?)```", PAGE, re.DOTALL | re.MULTILINE))


@pytest.mark.req("QA-10")
def test_commands_print_what_is_shown(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        Path(name).write_text(text, encoding="utf-8")
    sessions = re.findall(r"```console\n(.*?)```", PAGE, re.DOTALL)
    assert len(sessions) == 3
    for session in sessions:
        command, *shown = session.splitlines()
        assert command.startswith("$ irlx ")
        assert main(shlex.split(command)[2:]) == 0
        out, err = capsys.readouterr()
        for line in shown:
            assert line in (out + err).splitlines()


def test_what_it_points_to_exists():
    links = re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", PAGE)
    assert links
    assert [link for link in links if not (PAGE_PATH.parent / link).exists()] == []


def test_every_code_is_in_it():
    told = set(re.findall(r"IRL6[56]\d", PAGE))
    assert {code.id for code in ROBOT_MODEL} - told == {"IRL669"}


def test_the_example_of_files_that_stay(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.toml").write_text("", encoding="utf-8")
    (tmp_path / "p.irl").write_text("", encoding="utf-8")
    page = (PAGE_PATH.parents[1] / "diagnostics" / "IRL669.md").read_text(encoding="utf-8")
    line, *expected = re.search(r"```console\n(.*?)```", page, re.DOTALL)[1].splitlines()
    assert main(shlex.split(line)[2:]) == 2
    assert capsys.readouterr().err.splitlines() == expected
    assert [path.read_text() for path in tmp_path.iterdir()] == ["", ""]
