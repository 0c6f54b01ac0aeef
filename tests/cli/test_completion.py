"""Shells complete the command line by the script that irlx prints: asked of real shells."""

import os
import pty
import re
import select
import shutil
import subprocess
import time

import pytest

from irlx.cli.main import build_parser, main
from irlx.diagnostics import CATALOGUE

FILES = (
    "p.irl",
    "q.irl",
    "c.toml",
    "a.irdata",
    "b.npz",
    "x.csv",
    "points.dat",
    "arm.urdf",
    "mine.py",
    "notes.txt",
)
STREAMS = ["a.irdata", "b.npz", "sub", "x.csv"]
COMMANDS = sorted(build_parser().commands.choices)
LINES = {
    "irlx ": COMMANDS,
    "irlx che": ["check"],
    "irlx run ": ["a.irdata", "b.npz", "p.irl", "q.irl", "sub", "x.csv"],
    "irlx run p": ["p.irl"],
    "irlx run p.irl --cell ": ["c.toml", "sub"],
    "irlx run --reproduce ": STREAMS,
    "irlx verify ": STREAMS,
    "irlx check p.irl ": ["p.irl", "points.dat", "q.irl", "sub"],
    "irlx run p.irl --files ": ["sub"],
    "irlx run p.irl --plugin ": ["mine.py", "sub"],
    "irlx run p.irl --inputs ": ["sub", "x.csv"],
    "irlx new first --urdf ": ["arm.urdf", "sub"],
    "irlx new first --robot arm": ["arm7"],
    "irlx robots koch": ["koch11"],
    "irlx explain IRL2": sorted(code for code in CATALOGUE if code.startswith("IRL2")),
    "irlx check --format s": ["sarif"],
    "irlx convert a.irdata --to r": ["rapid", "robodk"],
    "irlx completion f": ["fish"],
}
"""Beginnings of lines, and what may follow; `sub` is a folder."""
BY_BASH = """
source irlx.bash
while IFS= read -r line; do
  read -ra COMP_WORDS <<< "$line"
  [[ $line == *" " ]] && COMP_WORDS+=("")
  COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) COMP_LINE=$line COMP_POINT=${#line} COMPREPLY=()
  $(complete -p irlx | sed 's/.*-F \\([^ ]*\\) .*/\\1/') irlx
  (IFS=$'\\t'; echo "${COMPREPLY[*]}")
done
"""
BY_FISH = """
source irlx.fish
while read -l line
  complete -C $line | string replace -r '\\t.*' '' | string join \\t
end
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with files of every kind, and the script for each shell."""
    folder = tmp_path_factory.mktemp("shells")
    for name in FILES:
        (folder / name).touch()
    (folder / "sub").mkdir()
    return folder


@pytest.fixture
def script(folder, capsys):
    """Print the script for a shell into the folder; returns the folder and the text."""

    def write(shell, name):
        assert main(["completion", shell]) == 0
        text = capsys.readouterr().out
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return text

    return write


def answers(shell, call, folder, lines):
    """What a shell completes each line to, without the slashes of folders."""
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    done = subprocess.run(
        call,
        cwd=folder,
        input="".join(f"{line}\n" for line in lines),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stderr == ""
    return [sorted(word.rstrip("/") for word in row.split("\t")) for row in done.stdout.splitlines()]


@pytest.mark.parametrize(
    ("shell", "call"),
    [("bash", ["bash", "--norc", "-c", BY_BASH]), ("fish", ["fish", "--no-config", "-c", BY_FISH])],
)
def test_what_bash_and_fish_complete(folder, script, shell, call):
    script(shell, f"irlx.{shell}")
    found = answers(shell, call, folder, LINES)
    assert dict(zip(LINES, found, strict=True)) == LINES


def typed(call, folder, first, keys):
    """What an interactive shell shows after a first line, and then after each of the keys.

    Of the keys, the mapping has what will be shown when the shell is ready with them.
    """
    if shutil.which(call[0]) is None:
        pytest.skip(f"{call[0]} is not installed")
    environment = {"PATH": os.environ["PATH"], "HOME": str(folder), "TERM": "xterm", "COLUMNS": "200"}
    terminal, end = pty.openpty()
    shell = subprocess.Popen(
        call, cwd=folder, env=environment, stdin=end, stdout=end, stderr=end, start_new_session=True
    )
    os.close(end)
    found = {}
    for typed_in, wanted in {f"{first}; echo rea''dy\n": "ready", **keys}.items():
        # What stands on the line goes first.
        os.write(terminal, f"\x15{typed_in}".encode())
        shown, latest, silent = "", time.monotonic() + 20, False
        while time.monotonic() < latest and not (silent and re.search(wanted, shown)):
            silent = not select.select([terminal], [], [], 0.2)[0]
            shown += "" if silent else os.read(terminal, 65536).decode(errors="replace")
        found[typed_in] = shown
    shell.kill()
    shell.wait()
    os.close(terminal)
    return found


ZSH = "fpath=($PWD/functions $fpath); autoload -Uz compinit; compinit -u -D"


KEYS = {"irlx ver\t": "irlx verify", "irlx run --cell c\t": r"c\.toml", "irlx robots koch\t": "koch11"}


def test_what_zsh_completes(folder, script):
    assert script("zsh", "functions/_irlx").startswith("#compdef irlx\n")
    shown = typed(["zsh", "-f", "-i"], folder, ZSH, KEYS)
    for keys, wanted in KEYS.items():
        assert re.search(wanted, shown[keys]), keys


def test_tcsh_takes_its_script(folder, script):
    """It completes for nobody who types nothing; what it was told is all that can be asked of it here."""
    script("tcsh", "irlx.tcsh")
    call = ["tcsh", "-f", "-c", "source irlx.tcsh; complete irlx"]
    if shutil.which("tcsh") is None:
        pytest.skip("tcsh is not installed")
    done = subprocess.run(call, cwd=folder, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert "c/--cell=/f:{*.toml}/" in done.stdout
    assert "koch11" in done.stdout


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish", "tcsh"])
def test_scripts_know_every_option(shell, script):
    text = script(shell, f"irlx.{shell}")
    for name, parser in build_parser().commands.choices.items():
        assert name in text
        for action in parser._actions:
            for option in action.option_strings:
                # fish names them without their dashes.
                assert option.lstrip("-") in text, (name, option)


def test_the_help_needs_no_package_for_it(monkeypatch, capsys):
    monkeypatch.setitem(__import__("sys").modules, "shtab", None)
    with pytest.raises(SystemExit):
        main(["completion", "--help"])
    assert "docs/reference/editors.md" in " ".join(capsys.readouterr().out.split())


def test_without_a_shell_it_says_which_there_are(capsys):
    with pytest.raises(SystemExit):
        main(["completion"])
    assert "required: {bash,zsh,fish,tcsh}" in capsys.readouterr().err
