"""The help of every command has examples, and these work in a clean copy of the repository."""

import os
import re
import shlex
import shutil
from pathlib import Path

import pytest

from irlx.cli.main import build_parser, main

ROOT = Path(__file__).parents[2]
SERVING = {"view"}
"""Commands that go on until somebody stops them: their examples are only parsed here."""
ELSEWHERE = {
    "irlx demo",
    "irlx demo try_it --open",
    "irlx run programs/koch/square_cyclic.irl --html square.html",
    "irlx plot programs/koch/square.irdata -o square.svg",
}
"""Examples only parsed here: `test_demo.py` carries out the first, and another folder with `--open`. The
README runs that program for other files, and draws the figure of the last from Python; pages and figures of
the command are for `test_page.py` and `test_plot.py`, and of two streams an example here writes one."""
SEEN_BY_EXAMPLES = ("programs", "tests/conformance", "src/irlx/cell/robots")
"""Folders of the repository that examples name."""
MADE_BY_RUNS = shutil.ignore_patterns("*.irdata", "*.npz", "*.csv.*", "readings.txt", "__pycache__")


def parsers():
    """The parser of the whole line and that of every command, by name, in the order of the help."""
    whole = build_parser()
    return {"": whole, **whole.commands.choices}


def examples(parser):
    """Commands in the help of a parser: lines behind `examples:` that begin with irlx."""
    _, _, shown = (parser.epilog or "").partition("examples:\n")
    return re.findall(r"^  (irlx .+)$", shown, re.MULTILINE)


COMMANDS = parsers()
EXAMPLES = list(dict.fromkeys(line for parser in COMMANDS.values() for line in examples(parser)))


@pytest.fixture(scope="module")
def clone(tmp_path_factory):
    """What examples see of the repository, without what earlier runs made; shared by all of them."""
    folder = tmp_path_factory.mktemp("clone")
    for name in SEEN_BY_EXAMPLES:
        shutil.copytree(ROOT / name, folder / name, ignore=MADE_BY_RUNS)
    return folder


def made_before(words):
    """Make the streams that a command reads and that no example before it has made."""
    for word in words[1:]:
        path = Path(word)
        if path.suffix == ".irdata" and not path.exists() and path.with_suffix(".irl").exists():
            program = str(path.with_suffix(".irl"))
            assert main(["run", program, "--tick", "200", "--no-verify", "--quiet"]) == 0


@pytest.mark.parametrize("name", COMMANDS)
def test_every_help_has_examples_of_its_command(name):
    shown = examples(COMMANDS[name])
    assert shown, "give add_parser() an epilog: 'examples:', then lines of two blanks and a command"
    assert all(line.split()[:2] == ["irlx", name] for line in shown if name)
    assert COMMANDS[name].format_help().rstrip().endswith(shown[-1])


@pytest.mark.req("QA-10")
@pytest.mark.parametrize("line", EXAMPLES)
def test_examples_work(clone, monkeypatch, capsys, line):
    monkeypatch.chdir(clone)
    words = shlex.split(line)[1:]
    if words[0] in SERVING or line in ELSEWHERE:
        given = COMMANDS[""].parse_args(words)
        assert all(Path(path).is_file() for path in getattr(given, "programs", []) if line in ELSEWHERE)
        return
    made_before(words)
    capsys.readouterr()
    code = main(words)
    out, err = capsys.readouterr()
    assert code == 0, out + err
    assert out or words[0] == "fmt"


@pytest.mark.parametrize("name", COMMANDS)
def test_help_is_printed(capsys, name):
    with pytest.raises(SystemExit) as caught:
        main([*name.split(), "--help"])
    out, err = capsys.readouterr()
    assert (caught.value.code, err) == (0, "")
    assert out.startswith(f"usage: irlx {name}".rstrip())


def test_irlx_alone_prints_its_help(capsys):
    assert main([]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert out == build_parser().format_help()
    for name in COMMANDS:
        assert re.search(rf"^    {name} ", out, re.MULTILINE) or not name


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("chek p.irl", "IRL016: irlx has no command 'chek'; did you mean 'check'?"),
        ("fly", "IRL016: irlx has no command 'fly'"),
        ("p.irl --cell c.toml", "IRL016: irlx has no command 'p.irl'; did you mean 'irlx run p.irl'?"),
        ("--verbos run p.irl", "IRL017: irlx has no option --verbos; did you mean '--version'?"),
        ("run p.irl --cel=c.toml --tik 3", "IRL017: irlx run has no option --tik; did you mean '--tick'?"),
        ("verify --prorgam p.irl", "IRL017: irlx verify has no option --prorgam; did you mean '--program'?"),
        ("check p.irl -x", "IRL017: irlx check has no option -x"),
        ("convert a.irdata --outptu=b.npz", "IRL017: irlx convert has no option --outptu; did you mean"),
    ],
)
def test_what_is_unknown_is_told_with_what_may_be_meant(monkeypatch, tmp_path, capsys, line, told):
    monkeypatch.chdir(tmp_path)
    assert main(line.split()) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"error {told}")
    assert re.search(r"^  help: irlx .*--help lists", err, re.MULTILINE)
    assert os.listdir(tmp_path) == []


def test_beginnings_of_options_and_names_like_options_are_no_mistakes(monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "--x.irl").write_text("PROGRAM p; BEGIN ENDPROGRAM")
    assert main(["check", "--form", "json", "--", "--x.irl"]) == 0
    assert capsys.readouterr().out.strip() == "[]"


def test_what_the_process_is_given_is_looked_at(monkeypatch, capsys):
    monkeypatch.setattr("sys.argv", ["irlx", "chek"])
    assert main() == 2
    assert "did you mean 'check'?" in capsys.readouterr().err
