"""Damage of files of any format: bytes flipped, cut, moved, exchanged; words and lines of those of text."""

from __future__ import annotations

import re
from collections.abc import Callable
from random import Random

Damage = Callable[[bytes, Random], bytes]
TOKENS = (
    *(
        b"nan",
        b"inf",
        b"-inf",
        b"-1",
        b"0",
        b"1e999",
        b"1e308",
        b"1e-320",
        b"9" * 30,
        b"1" * 5000,
        b"2147483648",
    ),
    *(
        b"9223372036854775808",
        b"\x00",
        b"\xff",
        b"(",
        b")",
        b"[",
        b"]",
        b"{",
        b"}",
        b'"',
        b"'",
        b"\n",
        b"\r",
        b";",
    ),
    *(
        b"none",
        b"null",
        b"true",
        b"{}",
        b"[]",
        b"\\u0000",
        b"\\",
        b",",
        b"=",
        b"\xe2\x80\xa8",
        b"\xed\xa0\x80",
    ),
)
_WORD = re.compile(rb"[A-Za-z_]+|-?[0-9.e+-]+|[^\sA-Za-z0-9]")


def cut(data: bytes, chance: Random) -> bytes:
    """The beginning alone."""
    return data[: chance.randrange(len(data))]


def flipped(data: bytes, chance: Random) -> bytes:
    """Some bits are others."""
    damaged = bytearray(data)
    for _ in range(chance.randint(1, 20)):
        damaged[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    return bytes(damaged)


def noise(data: bytes, chance: Random) -> bytes:
    """Bytes without sense."""
    return chance.randbytes(chance.randrange(2000))


def noise_behind_a_head(data: bytes, chance: Random) -> bytes:
    """The beginning, then bytes without sense."""
    return data[: chance.randrange(len(data))] + chance.randbytes(chance.randrange(300))


def moved(data: bytes, chance: Random) -> bytes:
    """A piece is left out, put in twice, or put in elsewhere."""
    first, last, place = sorted(chance.randrange(len(data) + 1) for _ in range(3))
    piece = data[first : min(last, first + 200)]
    return data[:place] + piece + data[place + chance.randrange(2) * len(piece) :]


def token(data: bytes, chance: Random) -> bytes:
    """A number, word or sign becomes another one."""
    start = chance.randrange(len(data))
    found = _WORD.search(data, start) or _WORD.search(data)
    first, last = found.span() if found else (0, 0)
    return data[:first] + chance.choice(TOKENS) + data[last:]


def lines(data: bytes, chance: Random) -> bytes:
    """Lines change places, are left out or come twice."""
    parts = data.splitlines(keepends=True)
    at, to = chance.randrange(len(parts)), chance.randrange(len(parts))
    change = chance.randrange(3)
    if change == 0:
        parts[at], parts[to] = parts[to], parts[at]
    elif change == 1:
        parts.pop(at)
    else:
        parts.insert(to, parts[at])
    return b"".join(parts)


def number(data: bytes, chance: Random) -> bytes:
    """Four or eight bytes become a length or a number that is extreme, in either order."""
    size = chance.choice((1, 2, 4, 8))
    value = chance.choice((0, 1, (1 << 8 * size) - 1, (1 << 8 * size - 1) - 1, 1 << 8 * size - 1))
    at = chance.randrange(len(data))
    return data[:at] + value.to_bytes(size, chance.choice(("little", "big"))) + data[at + size :]


BINARY: tuple[Damage, ...] = (cut, flipped, flipped, noise, noise_behind_a_head, moved, number, number)
TEXT: tuple[Damage, ...] = (
    cut,
    flipped,
    noise,
    noise_behind_a_head,
    moved,
    token,
    token,
    token,
    lines,
    lines,
)


def damaged(data: bytes, chance: Random, damages: tuple[Damage, ...], most: int = 3) -> bytes:
    """A file damaged in one to `most` ways, mostly in one."""
    for _ in range(min(1 + int(chance.expovariate(1.2)), most)):
        if not data.strip():
            return noise(data, chance)
        data = chance.choice(damages)(data, chance)
    return data
