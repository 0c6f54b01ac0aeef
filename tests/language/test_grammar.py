"""The grammar: no conflicts, keywords, tables; lexer and parser beside those of Lark, which are the truth."""

import io
import logging
import subprocess
import sys
from pathlib import Path

import lark
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from compiled_grammar import build_grammar, make_tables
from irlx.language import lexing, tree
from irlx.language.builder import TreeBuilder
from irlx.language.grammar_text import grammar_file, grammar_text
from irlx.language.keywords import NAMES_TOO, keyword_table
from irlx.language.lexing import lex
from irlx.language.parser import parse
from irlx.language.source import source_text


@pytest.mark.req("LANG-04")
def test_grammar_has_no_conflicts():
    log = io.StringIO()
    handler = logging.StreamHandler(log)
    before = lark.logger.level
    lark.logger.addHandler(handler)
    lark.logger.setLevel(logging.DEBUG)
    try:
        build_grammar(debug=True)
        lark.Lark('start: "a" start | "a" start "b" | "a"', parser="lalr", debug=True)
    finally:
        lark.logger.removeHandler(handler)
        lark.logger.setLevel(before)
    conflicts = [line for line in log.getvalue().splitlines() if "conflict" in line.lower()]
    # The second, ambiguous grammar shows that a conflict would be seen.
    assert len(conflicts) == 1


@pytest.mark.req("LANG-04")
def test_keywords_come_from_the_declare_lines():
    table = keyword_table()
    assert table["move_inc"] == "MOVE_INC"
    assert "speed" not in table
    rule = next(line for line in grammar_text().splitlines() if line.startswith("name: "))
    assert {word.strip() for word in rule.removeprefix("name:").split("|")} - {"NAME"} == NAMES_TOO


def test_tables_are_up_to_date():
    written = grammar_file("irl.tables.json").read_text(encoding="utf-8")
    assert written == make_tables.tables(), "python grammar/make_tables.py"


def programs():
    """All programs of the repository, and texts with the mistakes that the lexer takes up."""
    root = Path(__file__).parents[2]
    for folder in ("programs", "tests/conformance"):
        for path in sorted((root / folder).rglob("*.irl")):
            yield source_text(path.name, path.read_text(encoding="utf-8", errors="replace"))
    yield source_text("p", "x := a == b && 'open\ny := “a”; // c\n/* d */ § . .. .5 1..2 1.e { open")


@pytest.fixture(scope="module")
def compiled():
    return build_grammar()


def parts(tokens):
    """All that a token says."""
    return [(one.type, str(one), one.start_pos, one.end_pos, one.line, one.column) for one in tokens]


def all_tokens(text):
    """Tokens of the lexer of irlx, with those that it takes out."""
    lexer = lexing._Lexer(source_text("p", text))
    lexer._taken_out = lexer.tokens.append
    lexer.run(text)
    return lexer.tokens


@pytest.mark.req("LANG-04")
def test_programs_fall_into_the_tokens_that_lark_finds(compiled):
    count = 0
    for source in programs():
        found = all_tokens(source.text)
        count += len(found)
        assert parts(found) == parts(compiled.lex(source.text))
    assert count > 10_000


PIECES = st.sampled_from(
    [
        *"'\"{}()[]*/.,:;=<>&|!+-@ \n\t\u2028e5x§“”é",
        "(*",
        "*)",
        "//",
        "..",
        "1.5e3",
        "ENDIF",
        "x1",
        "0",
        "\r\n",
    ]
)


@settings(max_examples=200, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(PIECES, max_size=25).map("".join))
def test_any_text_falls_into_the_tokens_that_lark_finds(compiled, text):
    assert parts(all_tokens(text)) == parts(compiled.lex(text))


@pytest.mark.req("LANG-04")
def test_trees_are_those_that_lark_builds():
    """Lark's own parser with the same builder is the truth, places included."""
    transforming = build_grammar(transformer=TreeBuilder())
    count = 0
    for source in programs():
        lexed = lex(source)
        parsed = parse(source)
        if parsed.tree is None or not parsed.complete or parsed.findings:
            continue
        interactive = transforming.parse_interactive()
        for token in lexed.tokens:
            interactive.feed_token(token)
        expected = interactive.feed_eof()
        count += 1
        assert list(map(repr, tree.walk(parsed.tree))) == list(map(repr, tree.walk(expected)))
        assert [node.span for node in tree.walk(parsed.tree)] == [node.span for node in tree.walk(expected)]
    assert count > 200


@pytest.mark.req("LANG-76")
def test_front_end_imports_no_numerics():
    loaded = "[m for m in ('numpy', 'pinocchio', 'rich', 'lark') if m in sys.modules]"
    code = f"import irlx.language.analysis; print({loaded})"
    source = Path(__file__).parents[2] / "src"
    done = subprocess.run(
        [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(source)!r}); {code}"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.strip() == "[]"
