"""Values from texts: against Python's own conversions, in whatever pieces the text comes."""

import random

import pytest

from irlx.interpreter.channels.fault import ChannelFault
from irlx.interpreter.channels.text_reader import TextReader

READS = {
    "i": TextReader.whole,
    "x": TextReader.real,
    "b": TextReader.truth,
    "c": TextReader.character,
    "s": TextReader.rest_of_line,
}


def reader(text, sizes=(10_000,)):
    """A reader of a text that comes in pieces of these lengths, the last one again and again."""
    pieces, at, lengths = [], 0, list(sizes)
    while at < len(text):
        size = lengths.pop(0) if len(lengths) > 1 else lengths[0]
        pieces.append(text[at : at + size])
        at += size
    source = iter(pieces)
    return TextReader("'t'", lambda: next(source, ""))


def read(text, kinds, sizes=(10_000,)):
    source = reader(text, sizes)
    return [READS[kind](source) for kind in kinds], source.at_end()


GOOD = [
    ("42", "i", [42]),
    ("  -7\n\n+8\t", "ii", [-7, 8]),
    ("9223372036854775807 -9223372036854775808", "ii", [2**63 - 1, -(2**63)]),
    ("000000000000000000000000000012", "i", [12]),
    ("0.1 .5 5. 1e3 -2E-2 7", "xxxxxx", [0.1, 0.5, 5.0, 1000.0, -0.02, 7.0]),
    ("4.9E-324 1.7976931348623157E308 -0.0", "xxx", [5e-324, 1.7976931348623157e308, -0.0]),
    ("true FALSE False", "bbb", [True, False, False]),
    ("ab\n", "ccc", ["a", "b", "\n"]),
    ("one\n\n three ", "sss", ["one", "", " three "]),
    ("5\nhello\n", "is", [5, "hello"]),
    ("5   hello\n", "is", [5, "hello"]),
    ("5\n\nhello\n", "iss", [5, "", "hello"]),
    ("1,2;3", "icici", [1, ",", 2, ";", 3]),
    ("ściana żółć\n", "s", ["ściana żółć"]),
    ("1\x0b2\x0c3\r4", "iiii", [1, 2, 3, 4]),
]


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize("sizes", [(10_000,), (1,), (2,), (3, 1), (1, 7)])
@pytest.mark.parametrize(("text", "kinds", "wanted"), GOOD)
def test_what_is_read(text, kinds, wanted, sizes):
    assert read(text, kinds, sizes) == (wanted, True)


WRONG = [
    ("", "i", "IRL546", (1, 1), "a whole number"),
    (" \n\n  ", "x", "IRL546", (3, 3), "a number"),
    ("1\n", "is", "IRL546", (2, 1), "a text"),
    ("", "c", "IRL546", (1, 1), "a character"),
    ("x1", "i", "IRL547", (1, 1), "'x1'"),
    ("1\n 2 12abc", "iii", "IRL547", (2, 4), "'12abc'"),
    ("1.5", "i", "IRL547", (1, 1), "'1.5'"),
    ("1..5", "x", "IRL547", (1, 1), "'1..5'"),
    ("0x10", "i", "IRL547", (1, 1), "'0x10'"),
    ("1_000", "i", "IRL547", (1, 1), "'1_000'"),
    ("nan", "x", "IRL547", (1, 1), "'nan'"),
    ("inf", "x", "IRL547", (1, 1), "'inf'"),
    ("1E999", "x", "IRL547", (1, 1), "'1E999'"),
    ("٣", "i", "IRL547", (1, 1), "'٣'"),
    ("9223372036854775808", "i", "IRL547", (1, 1), "'9223372036854775808'"),
    (",", "i", "IRL547", (1, 1), "','"),
    ("yes", "b", "IRL547", (1, 1), "'yes'"),
    ("9" * 5000, "i", "IRL547", (1, 1), f"'{'9' * 40}..'"),
]


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize("sizes", [(10_000,), (1,), (5,)])
@pytest.mark.parametrize(("text", "kinds", "code", "where", "words"), WRONG)
def test_what_cannot_be_read(text, kinds, code, where, words, sizes):
    source = reader(text, sizes)
    *good, last = kinds
    for kind in good:
        READS[kind](source)
    with pytest.raises(ChannelFault) as caught:
        READS[last](source)
    data = caught.value.data
    assert (caught.value.code, (data["line"], data["column"])) == (code, where)
    assert data["expected" if code == "IRL546" else "found"] == words
    # Nothing was taken: whoever catches on may look at the same place again.
    assert (source.line, source.column) == where


def test_a_line_has_a_longest_length():
    assert len(reader("a" * 1_000_000 + "\n", (65_536,)).rest_of_line()) == 1_000_000
    with pytest.raises(ChannelFault, match="IRL512"):
        reader("a" * 1_000_001, (65_536,)).rest_of_line()


def test_only_as_much_is_asked_for_as_is_needed():
    """A person who has typed a number and Enter is not asked for more."""
    lines = iter(["5\n", "6 7\n"])
    source = TextReader("STANDARD_IN", lambda: next(lines))
    assert [source.whole() for _ in range(3)] == [5, 6, 7]


def words_by_python(text):
    return [float(word) for word in text.replace(",", " ").split()]


@pytest.mark.req("LANG-42")
@pytest.mark.parametrize("seed", range(8))
def test_numbers_against_python(seed):
    chance = random.Random(seed)
    numbers = [0.0, -0.0, 5e-324, 1.7976931348623157e308, 1.0, 1.0]
    numbers += [chance.uniform(-1, 1) * 10 ** chance.randint(-300, 300) for _ in range(200)]
    forms = (repr, "{:.17e}".format, "{:+.12g}".format, lambda x: f"{x:.6f}"[:300])
    text = "".join(
        chance.choice(forms)(x) + chance.choice([" ", "\n", "\t ", "\n\n"]) for x in numbers
    ).rstrip()
    source = reader(text, (chance.randint(1, 40),))
    found = [source.real() for _ in numbers]
    assert list(map(repr, found)) == list(map(repr, words_by_python(text)))
    assert source.at_end()
