"""Figures that docs/reference/pacing.md shows of `programs/koch/square_slow.irl` are those of today."""

import re
from pathlib import Path

import pytest

from irlx.cli.main import main

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "reference" / "pacing.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(
    r"^```console\n\$ irlx (run \S+square_slow\.irl.*)\n((?:.*\n)+?)```", PAGE, re.MULTILINE
)


@pytest.mark.slow
@pytest.mark.parametrize(("command", "shown"), EXAMPLES, ids=[command for command, _ in EXAMPLES])
def test_what_the_page_shows(tmp_path, monkeypatch, capsys, command, shown):
    monkeypatch.chdir(ROOT)
    status = main([*command.split(), "-o", str(tmp_path / "s.irdata"), "--no-verify"])
    told = capsys.readouterr()
    assert status == (1 if "error IRL" in shown else 0)
    lines = [line.rstrip() for line in (told.out + told.err).splitlines()]
    verified = [line.replace(" complete,", " complete, verified,") for line in lines]
    assert [line for line in shown.splitlines() if line.rstrip() not in {*lines, *verified}] == []


def test_the_page_shows_three_runs():
    assert len(EXAMPLES) == 3
