"""The TextMate grammar: what the script makes, and applied to all programs the kinds that irlx itself gives.

With `npm install vscode-textmate vscode-oniguruma`, in a folder that NODE_PATH names, the engine of VS Code
is asked, too.
"""

import json
import runpy
import shutil
import subprocess
from functools import cache
from pathlib import Path
from unicodedata import normalize

import pytest

from irlx.language.highlight import Kind, pieces
from textmate import Grammar

ROOT = Path(__file__).parents[3]
FILE = ROOT / "grammar" / "irl.tmLanguage.json"
ENGINE = ROOT / "tests" / "support" / "textmate_engine.cjs"
OUTER = {None, "source.irl", "meta.block.irl"}
"""Scopes of what has none of its own."""


@pytest.fixture(scope="module")
def script():
    return runpy.run_path(str(ROOT / "grammar" / "make_textmate.py"))


@pytest.fixture(scope="module")
def grammar():
    return Grammar(json.loads(FILE.read_text(encoding="utf-8")))


@cache
def engine():
    """The engine of VS Code as a command, or None."""
    node = shutil.which("node")
    if node is None:
        return None
    asked = "require.resolve('vscode-textmate'); require.resolve('vscode-oniguruma')"
    found = subprocess.run([node, "-e", asked], capture_output=True, check=False)
    return [node, str(ENGINE)] if found.returncode == 0 else None


def by_engine(texts):
    """Scope of each character by the engine of VS Code, for texts of the basic plane only."""
    asked = json.dumps({"grammar": str(FILE), "texts": texts})
    done = subprocess.run(engine(), input=asked, capture_output=True, text=True, check=True)
    for text, lines in zip(texts, json.loads(done.stdout), strict=True):
        scopes = []
        for line, tokens in zip(text.split("\n"), lines, strict=True):
            row = [None] * (len(line) + 1)
            for start, end, scope in tokens:
                row[start:end] = [scope] * (min(end, len(row)) - start)
            scopes += row
        yield scopes[:-1]


def differences(text, scopes, names):
    """Pieces of a text with another scope than that of their kind, with what they have."""
    start = 0
    for kind, piece in pieces(text):
        end = start + len(piece)
        if kind is not Kind.SPACE:
            seen = {scopes[at] for at in range(start, end) if not text[at].isspace()}
            found = {None if scope in OUTER else scope for scope in seen}
            if found != {names.get(kind)}:
                yield piece, kind, found
        start = end


def test_the_file_is_what_the_script_makes(script):
    # If this fails: python grammar/make_textmate.py
    assert FILE.read_text(encoding="utf-8") == script["text"]()


def test_every_kind_has_a_scope_of_its_own(script):
    scopes = script["SCOPES"]
    assert set(Kind) - set(scopes) == {Kind.SPACE, Kind.NAME}
    assert len(set(scopes.values())) == len(scopes)
    assert all(scope.endswith(".irl") for scope in scopes.values())


@pytest.fixture(scope="module")
def texts(sources):
    """The programs in the form that editors hold them in; one in three conformance cases."""
    chosen = [name for name in sources if name.startswith("programs/")]
    chosen += [name for name in sources if name not in chosen][::3]
    return {name: normalize("NFC", sources[name].replace("\r\n", "\n")) for name in {*chosen, *KNOWN}}


KNOWN = {
    "tests/conformance/declarations/missing_end_of_record/program.irl": ["one"],
    "tests/conformance/lexical/comments/program.irl": ["t"],
}
"""A type without the ENDRECORD before it, and a name with a comment before it: no rule sees these."""


@pytest.mark.parametrize("real", [False, True], ids=["python", "vscode"])
def test_programs_have_the_scopes_of_their_kinds(script, grammar, texts, real):
    if real and engine() is None:
        pytest.skip("npm install vscode-textmate vscode-oniguruma, in a folder that NODE_PATH names")
    found = by_engine(list(texts.values())) if real else map(grammar.scopes, texts.values())
    different = {}
    for (name, text), scopes in zip(texts.items(), found, strict=True):
        assert len(scopes) == len(text)
        others = [piece for piece, *_ in differences(text, scopes, script["SCOPES"])]
        different |= {name: others} if others else {}
    assert different == KNOWN


@pytest.mark.parametrize(
    ("text", "word", "scope"),
    [
        ("move Lin p1", "Lin", "keyword.other.motion.irl"),
        ("CyclicStart;", "CyclicStart", "keyword.other.redundancy.irl"),
        ("x := r_speed;", "r_speed", "variable.language.irl"),
        ("x := rec.r_speed;", "r_speed", "variable.other.member.irl"),
        ("{ irlx: ignore IRL205 }", "IRL205", "comment.block.documentation.irl"),
        ("{ a { b } y", "y", None),
        ("(* one\n  two *)", "two", "comment.block.irl"),
        ("a := 'it''s';", "s", "string.quoted.irl"),
        ("a := 'it", "it", "invalid.illegal.irl"),
        ("a := 1..5;", "..", "keyword.operator.irl"),
        ("a := 1.5E-3;", "1.5E-3", "constant.numeric.float.irl"),
        ("a == b", "==", "invalid.illegal.irl"),
        ("BEGIN\n again: MOVE PTP a;", "again", "entity.name.label.irl"),
        ("BEGIN\n MOVE PTP a SPEED := 3;", "SPEED", "variable.parameter.irl"),
        ("BEGIN\n SPEED := 3;", "SPEED", None),
        ("BEGIN\n WAIT sec SEC;", "SEC", "keyword.control.irl"),
        ("BEGIN\n WAIT sec SEC;", "sec", None),
        ("BEGIN\n MOVE LIN a IN FRAME fixture;", "FRAME", "keyword.other.motion.irl"),
        ("VAR POSE: endings;", "POSE", "support.type.irl"),
        ("VAR POSE: endings;", "endings", None),
        ("ściana := a;", "ściana", None),
    ],
)
def test_snippets(grammar, text, word, scope):
    scopes = grammar.scopes(text)
    at = text.index(word)
    assert {None if one in OUTER else one for one in scopes[at : at + len(word)]} == {scope}
