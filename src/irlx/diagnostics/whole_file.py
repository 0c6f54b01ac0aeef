"""Reading files of strangers: only what is a file, and as a whole only what somebody may have written."""

from __future__ import annotations

import errno
import os
import stat
from pathlib import Path
from typing import IO

MOST_BYTES = 16_000_000
"""Of a text that is read as a whole: some 400,000 lines."""

_PIECE = 1 << 20
_KINDS = (
    (stat.S_ISFIFO, "it is a FIFO, not a file"),
    (stat.S_ISCHR, "it is a device, not a file"),
    (stat.S_ISBLK, "it is a device, not a file"),
)


def open_file(path: Path) -> IO[bytes]:
    """A file, opened to read its bytes; a pipe without a name, as that of a shell's ``<(command)``, as well.

    Raises OSError for a FIFO, which may never say anything, for a device, which may never end, for a folder,
    and what opening raises.
    """
    # Without O_NONBLOCK a FIFO that nobody writes to would hold the process here.
    handle = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
    try:
        _check_kind(path, os.fstat(handle))
        os.set_blocking(handle, True)
        return os.fdopen(handle, "rb")
    except BaseException:
        os.close(handle)
        raise


def whole_file(path: Path, most: int = MOST_BYTES) -> bytes:
    """Content of a file of at most `most` bytes. Raises OSError for more, and as `open_file`."""
    with open_file(path) as file:
        content = bytearray()
        while piece := file.read(_PIECE):
            content += piece
            if len(content) > most:
                raise OSError(errno.EFBIG, f"it has more than {most:,} bytes")
    return bytes(content)


def whole_text(path: Path, most: int = MOST_BYTES) -> str:
    """Text of a file in UTF-8; raises UnicodeDecodeError, and OSError as `whole_file`."""
    return whole_file(path, most).decode("utf-8")


def _check_kind(path: Path, found: os.stat_result) -> None:
    if stat.S_ISDIR(found.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR))
    for holds, words in _KINDS:
        # A pipe without a name leads to no path.
        if holds(found.st_mode) and os.path.exists(os.path.realpath(path)):
            raise OSError(errno.EINVAL, words)
