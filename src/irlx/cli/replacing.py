"""Putting content in the place of a file, or making one: in one step, with its permissions, behind a link."""

from __future__ import annotations

import contextlib
import os
import stat
import tempfile
from pathlib import Path

from irlx.diagnostics import IrlxError, report

__all__ = ["replace_content"]

_PERMISSIONS = 0o666


def replace_content(path: Path, content: bytes) -> None:
    """Replace what a file holds, or make it; nobody ever sees half of it.

    A link stays, what it points to is replaced. Raises IrlxError IRL003 and leaves the file as it was. The
    files of streams have `irlx.streams.atomic`, which loads numpy.
    """
    temporary = ""
    try:
        target = os.path.realpath(path)
        mode = _mode(target)
        handle, temporary = tempfile.mkstemp(prefix=".irlx-", suffix=".part", dir=os.path.dirname(target))
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fchmod(file.fileno(), mode)
            os.fsync(file.fileno())
        os.replace(temporary, target)
    except (OSError, ValueError) as cause:
        with contextlib.suppress(OSError):
            if temporary:
                os.unlink(temporary)
        words = cause.strerror if isinstance(cause, OSError) and cause.strerror else str(cause)
        raise IrlxError(report("IRL003", path=path, cause=words, help="")) from cause


def _mode(target: str) -> int:
    """Permissions of a file, or of one that is made now. Raises ValueError for what is no file."""
    try:
        found = os.stat(target).st_mode
    except FileNotFoundError:
        mask = os.umask(0)
        os.umask(mask)
        return _PERMISSIONS & ~mask
    if not stat.S_ISREG(found):
        raise ValueError("it is not a regular file")
    return found & 0o7777
