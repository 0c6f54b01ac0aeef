"""A folder for files that nobody is to keep."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from irlx.streams.error import cannot_write


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """A folder that is gone behind the block. Raises StreamError, IRL003, where there can be none."""
    where: Path | None = None
    try:
        with tempfile.TemporaryDirectory(prefix="irlx-") as folder:
            where = Path(folder)
            yield where
    except OSError as cause:
        # Without a place for temporary files there is not even a name to tell.
        raise cannot_write(Path("a temporary folder") if where is None else where, cause) from cause
