"""What a program says while it runs."""

from __future__ import annotations

from typing import NamedTuple

from irlx.blocks import Origin


class Message(NamedTuple):
    """A `text` for STANDARD_OUT, the `tick` at which it is written, and the `line` of the program that does.

    The line is None where another file, a module, writes it.
    """

    tick: int
    text: str
    line: int | None = None


def message(rows: int, text: str, origin: Origin | None, program_name: str) -> Message:
    """A text that is written behind so many rows of a run, by the statement at `origin`."""
    own = origin is not None and origin.file == program_name
    return Message(max(rows - 1, 0), text, origin.line if origin is not None and own else None)
