"""Pieces of text from files, streams and texts in memory, for a reader."""

from __future__ import annotations

import codecs
from collections.abc import Callable, Iterator
from typing import IO, TypeAlias

from irlx.interpreter.channels.fault import ChannelFault, cannot

InputGiven: TypeAlias = "str | IO[str] | IO[bytes] | None"
"""What STANDARD_IN reads: a text, a file of text or of bytes in UTF-8 that is open, or None for nothing."""

MOST_READ = 100_000_000
"""Bytes of a file, or characters of an input, that are read."""
_PIECE = 65_536
_MARK = "\ufeff"


def text_of(content: bytes, name: str) -> str:
    """The text of a file. Raises ChannelFault, IRL550, for bytes that are not UTF-8."""
    try:
        text = content.decode("utf-8")
    except UnicodeDecodeError as error:
        raise ChannelFault("IRL550", name=name, offset=error.start) from None
    return text.removeprefix(_MARK).replace("\r\n", "\n")


def once(text: str) -> Callable[[], str]:
    """All of a text as one piece."""
    pieces = iter((text,))
    return lambda: next(pieces, "")


def pieces_of(given: InputGiven, name: str) -> Callable[[], str]:
    """Pieces of what is given as input, a line at a time, so that a person may type it.

    When called, ChannelFault: IRL550 for bytes that are not UTF-8, IRL548 for what cannot be read.
    """
    if given is None or isinstance(given, str):
        return once((given or "").replace("\r\n", "\n"))
    pieces = _whole_line_ends(_decoded(given, name))
    return lambda: next(pieces, "")


def _decoded(given: IO[str] | IO[bytes], name: str) -> Iterator[str]:
    decoder, offset, count = codecs.getincrementaldecoder("utf-8")(), 0, 0
    while True:
        try:
            piece = given.readline(_PIECE)
        except (OSError, ValueError) as cause:
            raise cannot(name, "read", cause if isinstance(cause, OSError) else str(cause)) from None
        held = len(decoder.getstate()[0])
        try:
            text = piece if isinstance(piece, str) else decoder.decode(piece, final=not piece)
        except UnicodeDecodeError as error:
            raise ChannelFault("IRL550", name=name, offset=offset - held + error.start) from None
        offset += len(piece)
        count += len(text)
        if count > MOST_READ:
            raise cannot(name, "read", f"it has more than {MOST_READ:,} characters")
        if text:
            yield text
        if not piece:
            return


def _whole_line_ends(pieces: Iterator[str]) -> Iterator[str]:
    """The same pieces with ``\\r\\n`` as ``\\n``, also where it is split between two of them."""
    held, first = "", True
    for piece in pieces:
        text = held + (piece.removeprefix(_MARK) if first else piece)
        first = False
        held = "\r" if text.endswith("\r") else ""
        ready = text.removesuffix("\r").replace("\r\n", "\n")
        if ready:
            yield ready
    if held:
        yield held
