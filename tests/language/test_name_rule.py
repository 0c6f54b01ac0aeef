"""The rule for names outside of programs is that of the grammar."""

import re

import pytest

from irlx.language.analysis import analyse
from irlx.language.grammar_text import grammar_text
from irlx.language.keywords import is_name, keyword_table
from irlx.language.source import source_text

CANDIDATES = ["a", "ściana_1", "a1", "1a", "_a", "a b", "", "a.b", "Ä", "壁", "x-y", "²", "a²", "\u0301a"]


@pytest.mark.parametrize("name", [*CANDIDATES, *keyword_table().values()])
def test_a_program_can_write_it(name):
    text = f"PROGRAM p;\nBEGIN\n  OBSTACLE {name};\n  OBSTACLEEND {name};\nENDPROGRAM;\n"
    errors = [d for d in analyse(source_text("p.irl", text)).diagnostics if d.code.startswith("IRL1")]
    assert is_name(name) == (not errors)


def test_the_pattern_is_that_of_the_grammar():
    assert re.search(r"^NAME: /\[\^\\W\\d_\]\\w\*/$", grammar_text(), re.MULTILINE)
