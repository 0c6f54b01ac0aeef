"""Files on disk."""

from __future__ import annotations

import os
from collections.abc import Callable, Hashable

from irlx.interpreter.channels.fault import cannot
from irlx.interpreter.channels.files import Files, Mode, Opened
from irlx.interpreter.channels.folder import Folder, Located, refuse_kind
from irlx.interpreter.channels.pieces import MOST_READ, once, text_of

# Without O_NONBLOCK a FIFO that took the place of a file a moment ago would hold the run.
_ALWAYS = os.O_NOFOLLOW | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC
_PIECE = 1 << 20
_FLAGS: dict[Mode, int] = {
    "READ": os.O_RDONLY,
    "WRITE": os.O_WRONLY | os.O_CREAT,
    "APPEND": os.O_WRONLY | os.O_CREAT | os.O_APPEND,
}


class FolderFiles(Files):
    """The files below a folder. What is read is read as a whole; what is written is there at once."""

    def __init__(self, folder: Folder) -> None:
        self._folder = folder

    def open(self, name: str, mode: Mode, busy: Callable[[Hashable], None]) -> Opened:
        """Open a file; see `Files`."""
        with self._folder.locate(name) as located:
            if located.found is None and mode == "READ":
                raise self._folder.missing(name)
            if located.found is not None:
                refuse_kind(name, located.found)
            if mode != "READ":
                self._folder.refuse_protected(name, located)
            busy(located.identity)
            return self._opened(name, mode, located)

    def _opened(self, name: str, mode: Mode, located: Located) -> Opened:
        if mode == "READ":
            return Opened(located.identity, once(text_of(read_found(name, located), name)))
        handle, identity = _regular(name, _FLAGS[mode], located)
        if mode == "WRITE":
            try:
                os.ftruncate(handle, 0)
            except OSError as cause:
                os.close(handle)
                raise cannot(name, "opened", cause) from None
        return Opened(identity, sink=_Disk(handle, name))


def read_found(name: str, located: Located) -> bytes:
    """Content of a file that was found. Raises ChannelFault, IRL548, where it cannot be read whole."""
    handle, _ = _regular(name, _FLAGS["READ"], located)
    try:
        content = bytearray()
        while piece := os.read(handle, _PIECE):
            content += piece
            if len(content) > MOST_READ:
                raise cannot(name, "opened", f"it has more than {MOST_READ:,} bytes")
    except OSError as cause:
        raise cannot(name, "read", cause) from None
    finally:
        os.close(handle)
    return bytes(content)


def _regular(name: str, flags: int, located: Located) -> tuple[int, tuple[int, int]]:
    """A regular file, open, and its identity; looked at again, as it may be another one by now."""
    try:
        handle = os.open(located.part, flags | _ALWAYS, 0o666, dir_fd=located.folder)
    except OSError as cause:
        raise cannot(name, "opened", cause) from None
    try:
        found = os.fstat(handle)
        refuse_kind(name, found)
    except BaseException:
        os.close(handle)
        raise
    return handle, (found.st_dev, found.st_ino)


class _Disk:
    """A file on disk; every text goes to the system at once, so that nothing is lost with the program."""

    def __init__(self, handle: int, name: str) -> None:
        self._handle, self._name = handle, name

    def write(self, data: bytes) -> None:
        """Write all of it."""
        left = memoryview(data)
        try:
            while left:
                left = left[os.write(self._handle, left) :]
        except OSError as cause:
            raise cannot(self._name, "written", cause) from None

    def close(self) -> None:
        """Close it; some systems tell only here that it could not be written."""
        try:
            os.close(self._handle)
        except OSError as cause:
            raise cannot(self._name, "closed", cause) from None
