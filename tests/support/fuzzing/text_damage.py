"""Damage of program texts: by token, by line, by character, by byte."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import lru_cache
from random import Random

from fuzzing.known_texts import known_texts
from irlx.language.builtins import FUNCTIONS, PROCEDURES, SYSTEM_VARIABLES, TYPES
from irlx.language.keywords import keyword_table

Tokens = list[str]
TOKEN = re.compile(
    r"\{[^{}]*\}|\(\*.*?\*\)|'[^'\n]*'|\"[^\"\n]*\"|[^\W\d]\w*|\d+(?:\.\d+)?(?:[eE][+-]?\d+)?"
    r"|:=|<=|>=|<>|\.\.|[ \t]+|\r?\n|.",
    re.DOTALL,
)
NUMBERS = (
    *(
        "0",
        "-0",
        "1",
        "-1",
        "2",
        "007",
        "1.",
        ".5",
        "1..2",
        "1e",
        "1e400",
        "1E-400",
        "1E+308",
        "1e9999999999",
    ),
    *("9223372036854775807", "9223372036854775808", "-9223372036854775808", "99999999999999999999999999"),
    *(
        "9" * 400,
        "0." + "0" * 400 + "1",
        "1" * 5000,
        "0x10",
        "1_000",
        "١٢",
        "1,5",
        "nan",
        "inf",
        "360",
        "1E15",
    ),
)
SIGNS = (
    *(";", ":", ":=", "=", ",", ".", "..", "(", ")", "[", "]", "+", "-", "*", "/", "@", "<", ">", "<=", ">="),
    *(
        "<>",
        "{",
        "}",
        "(*",
        "*)",
        "'",
        '"',
        "^",
        "&",
        "|",
        "!",
        "#",
        "$",
        "~",
        "\\",
        "%",
        "`",
        "?",
        "//",
        "==",
    ),
)
CHARACTERS = (
    *("\0", "\x01", "\x07", "\x0b", "\x0c", "\x1a", "\x1b[31m", "\x7f", "\x85", "\xa0", "\u2028", "\u2029"),
    *("\ufeff", "\u200b", "\u200d", "\u202e", "\u2066", "\ufffd", "\uffff", "\U0001f600", "\U0010ffff"),
    *(
        "\u0301",
        "e\u0301",
        "ś",
        "ß",
        "İ",
        "ı",
        "ſ",
        "K",
        "Å",
        "ﬁ",
        "；",
        "：",
        "（",
        "）",
        "＝",
        "‘",
        "’",
        "“",
        "−",
    ),
    *("–", "×", "·", "…", "≤", "≠", "\r", "\r\n", "\n\r", "\t", "日本語", "א", "०", "²", "½", "Ⅷ", "ª"),
)
LOOK_ALIKES = str.maketrans("AaBEeHiIKMoOpPcCTxXyS", "АаВЕеНіІКМоОрРсСТхХуЅ")
WORDS = (
    *sorted(set(keyword_table().values())),
    *sorted({*map(str.upper, FUNCTIONS), *map(str.upper, PROCEDURES), *map(str.upper, SYSTEM_VARIABLES)}),
    *sorted(map(str.upper, TYPES)),
    *(
        "x",
        "i",
        "p",
        "OUT_1",
        "IN_2",
        "AOUT_3",
        "INOUT_99999999999999999999",
        "R_TOOL",
        "joint",
        "TRUE",
        "WEIGHT",
    ),
)
DEEP = (
    ("(", "x", ")"),
    ("-", "1", ""),
    ("NOT ", "TRUE", ""),
    ("a[", "1", "]"),
    ("f(", "1", ")"),
    ("(1, ", "2", ")"),
)
DEEP_STATEMENTS = (
    ("IF TRUE THEN ", "", " ENDIF;"),
    ("WHILE x < 1 DO ", "", " ENDWHILE;"),
    ("FOR i := 1 TO 2 DO ", "", " ENDFOR;"),
    ("REPEAT ", "", " UNTIL TRUE;"),
    ("CASE i OF WHEN 1: ", "", " ENDCASE;"),
    ("IF TRUE THEN ", "", " ELSE "),
    ("VAR RECORD REAL: x; ", "", " ENDRECORD: r;"),
    ("ARRAY [1..2] OF ", "REAL", ""),
    ("PROCEDURE p; BEGIN ", "", " ENDPROC;"),
    ("{", "", "}"),
    ("(*", "", "*)"),
)


@lru_cache(maxsize=4096)
def tokens_of(text: str) -> tuple[str, ...]:
    """Pieces of a text, blanks included; together they are the text."""
    return tuple(TOKEN.findall(text))


def known_tokens(chance: Random) -> tuple[str, ...]:
    """Tokens of a known text; the shortest of three that are drawn, for it is quickly checked."""
    texts = known_texts()
    return tokens_of(min((chance.choice(texts) for _ in range(3)), key=len))


def place(tokens: Tokens, chance: Random) -> int:
    """Index of a token that is no blank, if one is soon found."""
    for _ in range(4):
        index = chance.randrange(len(tokens))
        if not tokens[index].isspace():
            break
    return index


def delete(tokens: Tokens, chance: Random) -> None:
    """Some tokens beside each other are left out."""
    at = place(tokens, chance)
    del tokens[at : at + (1 if chance.random() < 0.7 else chance.randint(2, 12))]


def swap(tokens: Tokens, chance: Random) -> None:
    """Two tokens change places."""
    at, to = place(tokens, chance), place(tokens, chance)
    tokens[at], tokens[to] = tokens[to], tokens[at]


def duplicate(tokens: Tokens, chance: Random) -> None:
    """Some tokens come twice or many times."""
    at = place(tokens, chance)
    piece = tokens[at : at + chance.choice((1, 1, 1, 2, 5, 20))]
    times = 1 if chance.random() < 0.95 else chance.randint(2, 40)
    tokens[at:at] = piece * times


def replace(tokens: Tokens, chance: Random) -> None:
    """A token becomes one of another text, mostly of the same sort."""
    at, other = place(tokens, chance), known_tokens(chance)
    alike = [token for token in other if _sort(token) == _sort(tokens[at])]
    tokens[at] = chance.choice(alike if alike and chance.random() < 0.85 else other or ("x",))


def renamed(tokens: Tokens, chance: Random) -> None:
    """A name becomes another name of the same text, or a word of the language."""
    at = place(tokens, chance)
    words = [token for token in tokens if token[0].isalpha()] if chance.random() < 0.6 else WORDS
    tokens[at] = chance.choice(words or WORDS)


def insert_word(tokens: Tokens, chance: Random) -> None:
    """A word, sign or number more."""
    tokens.insert(place(tokens, chance), f" {chance.choice(chance.choice((WORDS, SIGNS, NUMBERS)))} ")


def number(tokens: Tokens, chance: Random) -> None:
    """A number becomes an extreme one."""
    places = [at for at, token in enumerate(tokens) if token[0].isdigit()]
    tokens[chance.choice(places) if places else place(tokens, chance)] = chance.choice(NUMBERS)


def strange(tokens: Tokens, chance: Random) -> None:
    """A character that does not belong there, inside a token or beside it."""
    at = place(tokens, chance)
    cut = chance.randint(0, len(tokens[at]))
    tokens[at] = tokens[at][:cut] + chance.choice(CHARACTERS) + tokens[at][cut:]


def look_alike(tokens: Tokens, chance: Random) -> None:
    """Letters become others that look the same."""
    at = place(tokens, chance)
    tokens[at] = tokens[at].translate(LOOK_ALIKES)


def spelling(tokens: Tokens, chance: Random) -> None:
    """A letter of a word is left out, doubled or exchanged; or the word is in other case."""
    at = place(tokens, chance)
    word = tokens[at]
    cut = chance.randrange(len(word))
    tokens[at] = chance.choice(
        (word[:cut] + word[cut + 1 :], word[:cut] + word[cut] + word[cut:], word.swapcase(), word[::-1])
    )


def deep(tokens: Tokens, chance: Random) -> None:
    """A token becomes something deeply nested."""
    times = chance.choice((3, 10, 30, 95, 105, 300)) if chance.random() < 0.9 else chance.choice((1000, 4000))
    opened, inside, closed = chance.choice(chance.choice((DEEP, DEEP_STATEMENTS)))
    closing = times if chance.random() < 0.8 else chance.randrange(times)
    tokens[place(tokens, chance)] = opened * times + inside + closed * closing


def splice(tokens: Tokens, chance: Random) -> None:
    """The beginning of this text, and the end of another one."""
    other = known_tokens(chance)
    if other:
        tokens[place(tokens, chance) :] = other[chance.randrange(len(other)) :]


def graft(tokens: Tokens, chance: Random) -> None:
    """Some lines of another text come in."""
    lines = "".join(known_tokens(chance)).splitlines(keepends=True)
    if lines:
        at = chance.randrange(len(lines))
        tokens.insert(place(tokens, chance), "\n" + "".join(lines[at : at + chance.choice((1, 1, 2, 4, 8))]))


def lines(tokens: Tokens, chance: Random) -> None:
    """Lines change places, are left out or come twice."""
    parts = "".join(tokens).splitlines(keepends=True)
    at, to = chance.randrange(len(parts)), chance.randrange(len(parts))
    change = chance.randrange(3)
    if change == 0:
        parts[at], parts[to] = parts[to], parts[at]
    elif change == 1:
        parts.pop(at)
    else:
        parts.insert(to, parts[at])
    tokens[:] = tokens_of("".join(parts))


def cut_off(tokens: Tokens, chance: Random) -> None:
    """The text ends somewhere."""
    text = "".join(tokens)
    tokens[:] = tokens_of(text[: chance.randrange(len(text) + 1)])


def line_ends(tokens: Tokens, chance: Random) -> None:
    """Lines end in another way, all of them or some."""
    new, share = chance.choice(("\r\n", "\r", "\n\r", "\u2028", "")), chance.choice((1.0, 0.3))
    tokens[:] = [new if token == "\n" and chance.random() < share else token for token in tokens]


DAMAGES: tuple[Callable[[Tokens, Random], None], ...] = (
    *(
        delete,
        delete,
        swap,
        duplicate,
        replace,
        replace,
        replace,
        replace,
        renamed,
        renamed,
        renamed,
        renamed,
    ),
    *(insert_word, insert_word, number, number, number, strange, look_alike, spelling, deep, splice),
    *(graft, graft, lines, lines, cut_off, line_ends),
)


def damaged(text: str, chance: Random) -> str:
    """A text damaged in some places."""
    tokens = list(tokens_of(text))
    for _ in range(1 + int(min(chance.expovariate(1.0), 7.0))):
        if not tokens:
            tokens = list(known_tokens(chance)) or ["x"]
        chance.choice(DAMAGES)(tokens, chance)
        tokens = [token for token in tokens if token]
    return "".join(tokens)


def random_tokens(chance: Random) -> str:
    """Words, signs and numbers without sense, mostly where they might have some."""
    start = chance.choice(
        ("", "PROGRAM t;\n", "PROGRAM t; BEGIN\n", "MODULE m;", "DATALIST d;", "PROGRAM t; VAR ")
    )
    pools = chance.choices((WORDS, SIGNS, NUMBERS, CHARACTERS), (10, 10, 3, 0.5), k=chance.randint(0, 40))
    return start + " ".join(chance.choice(pool) for pool in pools)


def damaged_bytes(content: bytes, chance: Random) -> bytes:
    """Bytes flipped, cut, exchanged, or of no sense at all."""
    change = chance.randrange(6)
    if change == 0 or not content:
        return chance.randbytes(chance.randint(0, 300))
    data = bytearray(content)
    if change == 1:
        return content[: chance.randrange(len(content))]
    if change == 2:
        return (
            chance.choice((b"\xef\xbb\xbf", b"\xff\xfe", b"\xfe\xff", b"\xef\xbb\xbf\xef\xbb\xbf")) + content
        )
    if change == 3:
        return content.decode("utf-8", "replace").encode(
            chance.choice(("utf-16", "cp1252", "utf-32")), "replace"
        )
    for _ in range(chance.randint(1, 8)):
        at = chance.randrange(len(data))
        if change == 4:
            data[at] ^= 1 << chance.randrange(8)
        else:
            data[at] = chance.choice((0, 255, 0xC0, 0xED, 0x80, chance.randrange(256)))
    return bytes(data)


def _sort(token: str) -> str:
    first = token[0]
    return (
        "word" if first.isalpha() else "number" if first.isdigit() else "blank" if first.isspace() else "sign"
    )
