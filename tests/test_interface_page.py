"""docs/reference/interface.md names every command, option, function, extra and exit code as they are."""

import inspect
import re
from pathlib import Path
from types import SimpleNamespace

import pytest
import tomllib

import irlx
from irlx.cli.main import build_parser
from irlx.cli.output import exit_code
from irlx.diagnostics import CATALOGUE

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "reference" / "interface.md").read_text(encoding="utf-8")
COMMANDS = build_parser().commands.choices
FUNCTIONS = [name for name in irlx.__all__ if inspect.isfunction(getattr(irlx, name)) and name != "register"]
MADE_BY_PIP = {"browser", "test", "dev"}
"""Extras for those who work on irlx."""


def table_rows(start):
    """First cells of the rows of tables that begin like this."""
    return [line.split(" | ")[0] for line in PAGE.splitlines() if line.startswith(start)]


@pytest.mark.parametrize("name", COMMANDS)
def test_every_option_of_a_command_stands_in_its_row(name):
    rows = " ".join(table_rows(f"| `irlx {name}"))
    actions = [action for action in COMMANDS[name]._actions if "--help" not in action.option_strings]
    for action in actions:
        options = set(action.option_strings)
        assert not options or any(re.search(rf"{option}\b", rows) for option in options), options
    known = {option for action in actions for option in action.option_strings}
    assert set(re.findall(r"(?<![\w-])--?[a-z][a-z-]*", rows)) <= known


@pytest.mark.parametrize("name", FUNCTIONS)
def test_every_function_is_shown_as_it_is_called(name):
    (shown,) = re.findall(rf"^\| `irlx\.{name}\((.*?)\) -> ", PAGE, re.MULTILINE)
    parameters = inspect.signature(getattr(irlx, name)).parameters.values()
    words, keyword_only = [], False
    for parameter in parameters:
        if parameter.kind is parameter.KEYWORD_ONLY and not keyword_only:
            words.append("*")
            keyword_only = True
        default = "" if parameter.default is parameter.empty else f"={parameter.default!r}"
        words.append(f"{parameter.name}{default}")
    if shown.endswith(", ..."):
        assert ", ".join(words).startswith(shown.removesuffix("..."))
    else:
        assert shown.replace('"', "'") == ", ".join(words)


def test_run_record_and_stream_take_the_same_options_alike():
    run = inspect.signature(irlx.run).parameters
    for function in (irlx.record, irlx.stream):
        for name, parameter in inspect.signature(function).parameters.items():
            if name in run:
                assert parameter.default == run[name].default
                assert name == "cell" or parameter.annotation == run[name].annotation


def test_every_extra_is_told():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    _, _, section = PAGE.partition("### Extras\n")
    shown = re.findall(r"^\| `(\w+)` \| ", section.partition("\n### ")[0], re.MULTILINE)
    assert set(shown) == set(project["optional-dependencies"]) - MADE_BY_PIP


def test_what_ends_with_exit_code_2():
    (row,) = [line for line in PAGE.splitlines() if line.startswith("| 2 |")]
    groups = {code[:4] for code in re.findall(r"IRL\dxx", row)}
    single = set(re.findall(r"IRL\d{3}", row))
    for code in CATALOGUE:
        promised = code[:4] in groups or code in single
        assert (exit_code([SimpleNamespace(code=code, is_error=True)]) == 2) is promised, code
