"""The page on editors is true: its folder for VS Code is whole, its code runs."""

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

from irlx.language.highlight.pygments_lexer import TOKENS

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "reference" / "editors.md").read_text(encoding="utf-8")


def test_the_folder_for_vscode_is_whole(tmp_path):
    section = PAGE.partition("### VS Code")[2]
    commands = re.search(r"```sh\n(.*?)```", section, re.DOTALL)[1]
    home = {"HOME": str(tmp_path), "PATH": "/usr/bin:/bin"}
    subprocess.run(["sh", "-ec", commands], cwd=ROOT, env=home, check=True)
    folder = tmp_path / ".vscode" / "extensions" / "irl"
    manifest = json.loads((folder / "package.json").read_text(encoding="utf-8"))
    (language,), (grammar,) = manifest["contributes"]["languages"], manifest["contributes"]["grammars"]
    assert language["extensions"] == [".irl"]
    assert grammar["language"] == language["id"]
    rules = json.loads((folder / grammar["path"]).read_text(encoding="utf-8"))
    assert rules["scopeName"] == grammar["scopeName"]
    configuration = json.loads((folder / language["configuration"]).read_text(encoding="utf-8"))
    assert configuration["comments"]["blockComment"] == ["{", "}"]


def test_the_table_names_tokens_and_scopes_that_exist():
    scopes = (ROOT / "grammar" / "irl.tmLanguage.json").read_text(encoding="utf-8")
    names = {str(token).removeprefix("Token.").replace("Literal.", "") for token in TOKENS.values()}
    rows = [row.split("|")[2:4] for row in PAGE.splitlines() if re.match(r"\| (?!kind)\w|\| `", row)]
    assert len(rows) == 9
    for tokens, scoped in rows:
        assert set(re.findall(r"`([^`]+)`", tokens)) <= names
        for scope in re.findall(r"`([^`]+)`", scoped):
            assert f'"{scope}.irl"' in scopes, scope


def test_its_files_exist_and_its_commands_are_those_of_irlx(tmp_path):
    from irlx.cli.main import build_parser

    commands = [line for line in PAGE.splitlines() if line.startswith("irlx ")]
    assert {line.split()[2] for line in commands} == {"bash", "zsh", "fish", "tcsh"}
    for line in commands:
        build_parser().parse_args(shlex.split(line.partition(">")[0])[1:])
    for name in re.findall(r"(?:programs|grammar)/[\w/.]+\w", PAGE):
        assert (ROOT / name).exists(), name


def test_its_python_code_is_coloured_by_name(tmp_path):
    """By the entry point of pyproject.toml, whatever is installed here."""
    entry = tmp_path / "irlx_entry-1.dist-info"
    entry.mkdir()
    (entry / "METADATA").write_text("Metadata-Version: 2.1\nName: irlx-entry\nVersion: 1\n")
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    line = re.search(r'\[project\.entry-points\."pygments\.lexers"\]\nirl = "(.*)"', text)[1]
    (entry / "entry_points.txt").write_text(f"[pygments.lexers]\nirl = {line}\n")
    code = re.search(r"```python\n(.*?)```", PAGE, re.DOTALL)[1]
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={"PYTHONPATH": f"{tmp_path}:{ROOT / 'src'}", "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert re.search("\x1b\\[[0-9;]*mMOVE", done.stdout)
