"""docs/reference/plot.md is true: its pictures are drawn by the script, its commands can be given.

That its text is what irlx prints is asked in `koch/test_plot_page_text.py`, which has the run.
"""

import ast
import re
from pathlib import Path

import pytest

from irlx.cli.main import build_parser

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "docs" / "reference" / "plot.md").read_text(encoding="utf-8")
PICTURES = ROOT / "docs" / "pictures"

pytestmark = pytest.mark.req("REP-03")


def test_pictures_are_those_of_the_script():
    tree = ast.parse((PICTURES / "draw_plots.py").read_text(encoding="utf-8"))
    (drawn,) = [
        [key.value for key in node.value.keys]
        for node in tree.body
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Dict)
    ]
    shown = re.findall(r"!\[[^]]+\]\(\.\./pictures/(\w+)\.png\)", PAGE)
    assert sorted(shown) == sorted(drawn)
    for name in shown:
        assert len((PICTURES / f"{name}.png").read_bytes()) < 200_000


def test_commands_and_options_of_the_page():
    commands = re.findall(r"^\$ irlx (.*)$", PAGE, re.MULTILINE)
    assert len(commands) == 4
    for command in commands:
        build_parser().parse_args(command.split())
    options = set(re.findall(r"^\| `(-[-\w]+)", PAGE, re.MULTILINE))
    assert options == {"-o", "--joints", "--show", "--from", "--cell", "--width"}
