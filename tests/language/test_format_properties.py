"""What the formatter promises of every text: same tree, every comment, nothing left to format."""

from collections import Counter
from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from irlx.language.format import format_source
from irlx.language.format.render import WIDTH
from irlx.language.lexing import lex
from irlx.language.parser import parse
from irlx.language.source import source_text
from random_programs import PROGRAMS, spaced

ROOT = Path(__file__).parents[2]
FILES = [
    *sorted((ROOT / "programs").rglob("*.irl")),
    *sorted((ROOT / "programs").rglob("*.dat")),
    *sorted((ROOT / "tests" / "language" / "data").glob("*.irl")),
]


def every_fourth(first):
    """The files for `parametrize`; those between every fourth one, from `first` on, are marked slow."""
    return [
        pytest.param(path, marks=pytest.mark.slow if (place - first) % 4 else ())
        for place, path in enumerate(FILES)
    ]


RELAXED = settings(suppress_health_check=list(HealthCheck), deadline=None, derandomize=True)


def comments_of(source, lexed):
    """The comments without blanks, which may move."""
    return Counter("".join(source.text[span.start : span.end].split()) for span in lexed.comments)


def judge(text):
    """Format a text without errors and compare, independently of what the formatter compares itself."""
    source = source_text("t.irl", text)
    before = parse(source)
    formatted = format_source(text)
    again = source_text("t.irl", formatted)
    after = parse(again)
    assert after.tree == before.tree
    assert not [finding for finding in after.findings if finding.code in ("IRL103", "IRL104", "IRL105")]
    old, new = lex(source), lex(again)
    assert comments_of(source, old) == comments_of(again, new)
    spelled = ("NAME", "INT", "REAL", "STRING")
    assert [str(t) for t in new.tokens if t.type in spelled] == [
        str(t) for t in old.tokens if t.type in spelled
    ]
    assert format_source(formatted) == formatted
    assert formatted.endswith("\n")
    assert not formatted.endswith("\n\n")
    return formatted


@pytest.mark.req("LANG-74")
@settings(RELAXED, max_examples=40)
@given(PROGRAMS)
def test_random_programs(text):
    judge_random(text)


@pytest.mark.slow
@settings(RELAXED, max_examples=1000)
@given(PROGRAMS)
def test_many_random_programs(text):
    judge_random(text)


def judge_random(text):
    source = source_text("t.irl", text)
    # Where a name that MOVE does not know begins a line, the text is another one than was meant.
    assume(not any(finding.is_error for finding in parse(source).findings))
    assume("SPEED" not in text or not out_of_order(text))
    judge(text)


def out_of_order(text):
    from irlx.language.analysis import analyse

    return any(finding.code == "IRL114" for finding in analyse(source_text("t.irl", text)).diagnostics)


@pytest.mark.req("LANG-74")
@pytest.mark.parametrize("path", every_fourth(0), ids=lambda path: path.name)
@settings(RELAXED, max_examples=2)
@given(data=st.data())
def test_programs_with_other_blanks_and_more_comments(path, data):
    judge_with_other_blanks(path, data)


@pytest.mark.slow
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
@settings(RELAXED, max_examples=40)
@given(data=st.data())
def test_programs_with_many_other_blanks_and_more_comments(path, data):
    judge_with_other_blanks(path, data)


def judge_with_other_blanks(path, data):
    text = path.read_text(encoding="utf-8")
    words = [str(token) for token in lex(source_text("t.irl", text)).tokens]
    judge(data.draw(spaced(words)))


@pytest.mark.req("LANG-74")
@pytest.mark.parametrize("path", every_fourth(1), ids=lambda path: path.name)
@settings(RELAXED, max_examples=2)
@given(data=st.data())
def test_blanks_alone_do_not_show(path, data):
    judge_blanks(path, data)


@pytest.mark.slow
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
@settings(RELAXED, max_examples=20)
@given(data=st.data())
def test_many_blanks_do_not_show(path, data):
    judge_blanks(path, data)


def judge_blanks(path, data):
    """However many blanks stand between the words, the same text comes out, within the margin."""
    text = path.read_text(encoding="utf-8")
    words = [str(token) for token in lex(source_text("t.irl", text)).tokens]
    blanks = data.draw(st.lists(st.sampled_from([" ", "  ", "\t"]), min_size=len(words), max_size=len(words)))
    mixed = "".join(word + blank for word, blank in zip(words, blanks, strict=True))
    assume(not any(finding.is_error for finding in parse(source_text("t", mixed)).findings))
    formatted = judge(mixed)
    assert formatted == judge(" ".join(words))
    assert max(len(line) for line in formatted.splitlines()) <= WIDTH
