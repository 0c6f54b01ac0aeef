"""Files that are written in memory only."""

from __future__ import annotations

from collections.abc import Callable, Hashable

from irlx.interpreter.channels.fault import ChannelFault
from irlx.interpreter.channels.files import Files, Mode, Opened
from irlx.interpreter.channels.folder import Folder, parts_of, refuse_kind
from irlx.interpreter.channels.folder_files import read_found
from irlx.interpreter.channels.pieces import once, text_of


class MemoryFiles(Files):
    """What is written stays here, and is what is read from then on; the rest is read from a folder, if any.

    `written` are the contents by name, in the order in which the files were first opened for writing.
    """

    def __init__(self, folder: Folder | None = None) -> None:
        self._folder = folder
        self._content: dict[Hashable, bytearray] = {}
        self.written: dict[str, bytearray] = {}

    def open(self, name: str, mode: Mode, busy: Callable[[Hashable], None]) -> Opened:
        """Open a file; see `Files`."""
        if self._folder is None:
            return self._opened(tuple(_plain(name)), name, mode, busy, b"", exists=False)
        with self._folder.locate(name) as located:
            found = located.found
            if found is not None:
                refuse_kind(name, found)
            if mode != "READ":
                self._folder.refuse_protected(name, located)
            identity = located.identity
            old = b""
            if found is not None and mode != "WRITE" and identity not in self._content:
                old = read_found(name, located)
            return self._opened(identity, name, mode, busy, old, exists=found is not None)

    def _opened(
        self,
        identity: Hashable,
        name: str,
        mode: Mode,
        busy: Callable[[Hashable], None],
        old: bytes,
        *,
        exists: bool,
    ) -> Opened:
        known = self._content.get(identity)
        if mode == "READ":
            if known is None and not exists:
                raise self._missing(name)
            busy(identity)
            return Opened(identity, once(text_of(bytes(old if known is None else known), name)))
        busy(identity)
        if known is None:
            known = self._content[identity] = self.written[name] = bytearray(old)
        if mode == "WRITE":
            known.clear()
        return Opened(identity, sink=_Memory(known))

    def _missing(self, name: str) -> ChannelFault:
        if self._folder is not None:
            return self._folder.missing(name)
        return ChannelFault("IRL541", name=name, folder="memory", near="")


def _plain(name: str) -> list[str]:
    """Parts of a name without ``..``."""
    plain: list[str] = []
    for part in parts_of(name):
        if part != "..":
            plain.append(part)
        elif plain:
            plain.pop()
        else:
            raise ChannelFault("IRL540", name=name, cause="it leads out of the folder")
    return plain


class _Memory:
    """A file in memory."""

    def __init__(self, content: bytearray) -> None:
        self._content = content

    def write(self, data: bytes) -> None:
        """Write all of it."""
        self._content += data

    def close(self) -> None:
        """Nothing is to be let go of."""
