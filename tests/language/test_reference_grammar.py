"""The grammar in the language reference is that of the parser."""

import runpy
from pathlib import Path

import pytest

from irlx.language.grammar_text import grammar_text
from irlx.language.keywords import keyword_table

REFERENCE = Path(__file__).parents[2] / "docs" / "reference"


@pytest.fixture(scope="module")
def script():
    return runpy.run_path(str(REFERENCE / "make_grammar.py"))


@pytest.mark.req("LANG-10")
def test_appendix_is_up_to_date(script):
    reference = (REFERENCE / "language.md").read_text(encoding="utf-8")
    # If this fails: python docs/reference/make_grammar.py
    assert script["with_grammar"](reference, grammar_text()) == reference


def test_every_keyword_and_rule_is_there(script):
    text = script["ebnf"](grammar_text())
    for word in keyword_table().values():
        assert f'"{word}"' in text
    assert "move = " in text
    assert "_" not in {line[0] for line in text.splitlines() if line}
    assert "FOREIGN" not in text


def test_forms_of_a_rule(script):
    grammar = 'a: B ("," _c)*\n   | x -> y\n_c: "(" (a | c)? ")" ";"?\nCOMMA: ","\n'
    assert script["ebnf"](grammar).splitlines() == ['a = B ("," c)* | x', 'c = "(" (a | c)? ")" ";"?']
