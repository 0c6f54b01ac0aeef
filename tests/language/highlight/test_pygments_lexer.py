"""The lexer of Pygments: the text comes out as it went in, and whoever asks by name finds it."""

import sys
from importlib import import_module
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pygments import highlight, lexers
from pygments.formatters import HtmlFormatter
from pygments.token import STANDARD_TYPES, Error, Keyword, Name

from irlx.language.highlight import Kind, pieces
from irlx.language.highlight.pygments_lexer import TOKENS, IrlLexer

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[3]
AS_IT_IS = {"stripnl": False, "ensurenl": False}


def test_every_program_comes_out_as_it_went_in(sources):
    lexer = IrlLexer(**AS_IT_IS)
    for text in sources.values():
        assert "".join(piece for _, piece in lexer.get_tokens(text)) == text.replace("\r\n", "\n")
        found = list(lexer.get_tokens_unprocessed(text))
        assert [text[start : start + len(piece)] for start, _, piece in found] == [
            piece for *_, piece in found
        ]
        assert [token for _, token, _ in found] == [TOKENS[piece.kind] for piece in pieces(text)]


@settings(max_examples=100, deadline=None, derandomize=True)
@given(st.text())
def test_any_text_comes_out_as_it_went_in(text):
    found = list(IrlLexer().get_tokens_unprocessed(text))
    assert "".join(piece for *_, piece in found) == text


def test_every_kind_has_a_token_that_styles_know():
    assert set(TOKENS) == set(Kind)
    assert set(TOKENS.values()) <= set(STANDARD_TYPES)
    assert [kind for kind, token in TOKENS.items() if token is Error] == [Kind.WRONG]


def test_a_page():
    page = highlight("MOVE lin p1 Speed := R_SPEED;", IrlLexer(), HtmlFormatter(nowrap=True))
    assert '<span class="kr">MOVE</span><span class="w"> </span><span class="kr">lin</span>' in page
    assert '<span class="na">Speed</span>' in page
    assert '<span class="vm">R_SPEED</span>' in page


def test_pygments_knows_it_by_the_entry_point():
    (entry,) = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"][
        "pygments.lexers"
    ].items()
    module, _, name = entry[1].partition(":")
    assert getattr(import_module(module), name) is IrlLexer
    # Nobody else has these names.
    taken = {alias for _, aliases, _, _ in lexers.get_all_lexers(plugins=False) for alias in aliases}
    assert taken.isdisjoint(IrlLexer.aliases)
    patterns = {one for *_, names, _ in lexers.get_all_lexers(plugins=False) for one in names}
    assert patterns.isdisjoint(IrlLexer.filenames)


@pytest.mark.parametrize(
    ("text", "least"),
    [
        ("{ a square }\nPROGRAM square;\nBEGIN\nENDPROGRAM\n", 0.8),
        ("DATALIST points;\nENDDATALIST", 0.8),
        ("program hello;\nbegin\n  writeln('Pascal');\nend.\n", 0.0),
        ("def f():\n    return 1\n", 0.0),
    ],
)
def test_guessing(text, least):
    assert least <= IrlLexer.analyse_text(text) <= least + 0.25


def test_words_have_families():
    found = {
        text: token
        for token, text in IrlLexer().get_tokens("IF TRUE THEN p := POSE(a, b) @ INV(q.ORI); ENDIF")
    }
    assert all(found[word] in Keyword for word in ("IF", "TRUE", "THEN", "POSE", "ENDIF"))
    assert found["INV"] in Name.Builtin
    assert found["ORI"] in Name.Property
