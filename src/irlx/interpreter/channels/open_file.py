"""The value of a FILE variable whose file is open."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from irlx.diagnostics import Place
from irlx.interpreter.channels.files import Mode, Sink
from irlx.interpreter.channels.text_reader import TextReader


@dataclass(frozen=True, eq=False)
class OpenFile:
    """A file by the name that OPEN got, who opened it where, and how it is read or written."""

    name: str
    mode: Mode
    variable: str
    place: Place
    identity: Hashable
    reader: TextReader | None
    sink: Sink | None
