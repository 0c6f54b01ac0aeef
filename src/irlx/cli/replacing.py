"""Putting a new content in the place of a file: in one step, with its permissions, behind a link."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path

from irlx.diagnostics import IrlxError, report

__all__ = ["replace_content"]


def replace_content(path: Path, content: bytes) -> None:
    """Replace what a file holds; nobody ever sees half of it.

    A link stays, what it points to is replaced. Raises IrlxError IRL003 and leaves the file as it was. The
    files of streams have `irlx.streams.atomic`, which loads numpy.
    """
    temporary = ""
    try:
        target = os.path.realpath(path)
        mode = os.stat(target).st_mode & 0o7777
        handle, temporary = tempfile.mkstemp(prefix=".irlx-", suffix=".part", dir=os.path.dirname(target))
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fchmod(file.fileno(), mode)
            os.fsync(file.fileno())
        os.replace(temporary, target)
    except OSError as cause:
        with contextlib.suppress(OSError):
            if temporary:
                os.unlink(temporary)
        words = cause.strerror or str(cause)
        raise IrlxError(report("IRL003", path=path, cause=words, help="")) from cause
