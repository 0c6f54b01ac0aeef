"""Records of MCAP, the file format of bags: their codes, and how they are put together."""

from __future__ import annotations

import struct
from enum import IntEnum

_RECORD = struct.Struct("<BQ")


class Code(IntEnum):
    """Codes of the records that a file of irlx has."""

    HEADER = 0x01
    FOOTER = 0x02
    SCHEMA = 0x03
    CHANNEL = 0x04
    MESSAGE = 0x05
    CHUNK = 0x06
    MESSAGE_INDEX = 0x07
    CHUNK_INDEX = 0x08
    STATISTICS = 0x0B
    METADATA = 0x0C
    METADATA_INDEX = 0x0D
    SUMMARY_OFFSET = 0x0E
    DATA_END = 0x0F


RECORD_HEAD = _RECORD.size
"""Length of a record's code and length."""

CHUNK_HEAD = struct.Struct("<QQQIIQ")
"""Head of a chunk without compression: first and last time, length, CRC, length 0 of the compression's name,
length once more."""

FOOTER = struct.Struct("<QQI")
"""Content of a footer: where the summary and its offsets begin, CRC of the summary."""


def record_head(code: Code, length: int) -> bytes:
    """What stands before `length` bytes of a record's content."""
    return _RECORD.pack(code, length)


def parsed_head(head: bytes) -> tuple[int, int]:
    """Code and length of a record."""
    code, length = _RECORD.unpack(head)
    return code, length


def record(code: Code, *parts: bytes) -> bytes:
    """A whole record."""
    content = b"".join(parts)
    return record_head(code, len(content)) + content


def text(words: str) -> bytes:
    """A string."""
    data = words.encode()
    return struct.pack("<I", len(data)) + data


def mapping(pairs: dict[str, str]) -> bytes:
    """A map of strings."""
    content = b"".join(text(key) + text(value) for key, value in pairs.items())
    return struct.pack("<I", len(content)) + content
