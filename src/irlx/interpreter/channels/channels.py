"""Everything that a running program reads and writes."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from io import StringIO
from typing import Any, Literal

from irlx.blocks import Origin
from irlx.diagnostics import Diagnostic, Place, Related, report
from irlx.interpreter.channels.fault import STANDARD_IN, STANDARD_OUT, ChannelFault, cannot
from irlx.interpreter.channels.files import Files, Mode
from irlx.interpreter.channels.memory_files import MemoryFiles
from irlx.interpreter.channels.open_file import OpenFile
from irlx.interpreter.channels.pieces import once
from irlx.interpreter.channels.text_reader import TextReader

MOST_OPEN = 64
"""Files that may be open together."""
MOST_WRITTEN = 1_000_000_000
"""Bytes that a run may write to files."""
MOST_SHOWN = 100_000_000
"""Characters that a run may write to STANDARD_OUT; they are kept for `Run.output`."""

Listener = Callable[[str, Origin | None], None]
"""Called with each text for STANDARD_OUT and the statement that writes it, None where that is not known."""

Told = Callable[[str | None, str], None]
"""Called with the name of the file, None for STANDARD_OUT, and each text that is written."""


class Channels:
    """The open files of one run, and its standard channels, read by `pull` and told to `told`.

    `bound` are variables of type FILE that the program has put in the place of a standard channel.
    """

    def __init__(
        self, files: Files | None = None, pull: Callable[[], str] | None = None, told: Told | None = None
    ) -> None:
        self.files = files or MemoryFiles()
        self._input = TextReader(STANDARD_IN, pull or once(""))
        self._told = told
        self._listener: Listener | None = None
        self._open: list[OpenFile] = []
        self._shown = StringIO()
        self._show_left, self._write_left = MOST_SHOWN, MOST_WRITTEN
        self.bound: dict[Literal["IN", "OUT"], Any] = {}

    @property
    def output(self) -> str:
        """What was written to STANDARD_OUT so far."""
        return self._shown.getvalue()

    def heard_by(self, listener: Listener) -> None:
        """Have each text for STANDARD_OUT told to somebody else as well."""
        self._listener = listener

    def open(self, name: str, mode: Mode, variable: str, place: Place) -> OpenFile:
        """Open a file for a variable.

        Raises ChannelFault: IRL544 where it is open already and one of both writes, IRL552 for too many,
        and what `Files.open` raises.
        """
        if len(self._open) >= MOST_OPEN:
            raise ChannelFault("IRL552", name=name, most=MOST_OPEN)

        def busy(identity: Hashable) -> None:
            for other in self._open:
                if other.identity == identity and not other.mode == mode == "READ":
                    raise ChannelFault(
                        "IRL544", _opened_here(other), name=name, variable=other.variable, mode=other.mode
                    )

        found = self.files.open(name, mode, busy)
        reader = TextReader(f"'{name}'", found.pull) if found.pull is not None else None
        opened = OpenFile(name, mode, variable, place, found.identity, reader, found.sink)
        self._open.append(opened)
        return opened

    def close(self, file: OpenFile) -> None:
        """Close a file. Raises ChannelFault, IRL548."""
        self._open.remove(file)
        if file.sink is not None:
            file.sink.close()

    def reader(self, file: OpenFile | None) -> TextReader:
        """What a file, or without one the standard channel, is read by. Raises ChannelFault, IRL545."""
        if file is None:
            return self._input
        if file.reader is None:
            raise _other_mode(file, "read", "READ")
        return file.reader

    def write(self, file: OpenFile | None, text: str, origin: Origin | None = None) -> None:
        """Write to a file, or without one to the standard channel; `origin` is the statement that does.

        Raises ChannelFault: IRL545 for a file that is read, IRL548, IRL553 for too much.
        """
        if file is None:
            self._show(text, origin)
            return
        if file.sink is None:
            raise _other_mode(file, "written", "WRITE' or 'APPEND")
        data = text.encode("utf-8", "backslashreplace")
        self._write_left -= len(data)
        if self._write_left < 0:
            raise ChannelFault("IRL553", what="files", most=f"{MOST_WRITTEN:,} bytes")
        file.sink.write(data)
        if self._told is not None:
            self._told(file.name, text)

    def finish(self) -> list[Diagnostic]:
        """Close what is still open: IRL549 for each file, or IRL548 for one whose end cannot be written."""
        warnings = []
        for file in tuple(self._open):
            warnings.append(report("IRL549", file.place, name=file.name, variable=file.variable))
            try:
                self.close(file)
            except ChannelFault as fault:
                warnings.append(report(fault.code, file.place, **fault.data))
        return warnings

    def _show(self, text: str, origin: Origin | None) -> None:
        self._show_left -= len(text)
        if self._show_left < 0:
            raise ChannelFault("IRL553", what=STANDARD_OUT, most=f"{MOST_SHOWN:,} characters")
        self._shown.write(text)
        if self._listener is not None:
            self._listener(text, origin)
        if self._told is not None:
            try:
                self._told(None, text)
            except OSError as cause:
                raise cannot(STANDARD_OUT, "written", cause) from None


def _opened_here(file: OpenFile) -> tuple[Related, ...]:
    return (Related("opened here", file.place),)


def _other_mode(file: OpenFile, done: str, needed: str) -> ChannelFault:
    data = {"name": file.name, "mode": file.mode, "done": done, "needed": needed}
    return ChannelFault("IRL545", _opened_here(file), **data)
