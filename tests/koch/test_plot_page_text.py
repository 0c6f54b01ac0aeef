"""The text of docs/reference/plot.md is what `irlx plot` prints of the square of the monograph."""

import re
from pathlib import Path

import pytest

from irlx.cli.main import main

PAGE = Path(__file__).resolve().parents[2] / "docs" / "reference" / "plot.md"


@pytest.mark.req("REP-03")
def test_text_of_the_terminal(experiment, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    experiment("square_cyclic", 50).save("square_cyclic.irdata")
    text = PAGE.read_text(encoding="utf-8")
    command, *lines = re.search(r"^```text\n(.*?)^```", text, re.MULTILINE | re.DOTALL)[1].splitlines()
    assert main(command.split()[2:]) == 0
    assert capsys.readouterr().out.splitlines() == lines
