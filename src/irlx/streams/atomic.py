"""Files that appear whole or not at all: a temporary file in the same folder, renamed at the end."""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
from collections.abc import Callable
from itertools import count
from pathlib import Path
from types import TracebackType
from typing import IO, TypeVar

from irlx.streams.error import cannot_write

Made = TypeVar("Made")

_NUMBERS = count(1)
_LONGEST_ENDING = 16


class AtomicFile:
    """A binary file that replaces `path` when `commit` is called, and leaves no trace otherwise.

    Used as a context manager it commits at the end of the block, or discards the temporary file
    where the block raises. A link is followed: what it points to is replaced. Every failure of the
    file system raises StreamError IRL003.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self.handle: IO[bytes]
        try:
            self._target = Path(os.path.realpath(self.path))
            if self._target.is_dir():
                raise IsADirectoryError(None, "it is a folder")
            if self._target.exists() and not self._target.is_file():
                raise ValueError("it is not a regular file")
            self._temporary, self.handle = made_beside(self._target, lambda path: path.open("xb"))
        except (OSError, ValueError) as cause:
            raise cannot_write(self.path, cause) from cause

    def write(self, data: bytes) -> None:
        """Append bytes; on failure the temporary file is removed."""
        try:
            self.handle.write(data)
        except (OSError, ValueError) as cause:
            self.discard()
            raise cannot_write(self.path, cause) from cause

    def commit(self, name: str | os.PathLike[str] | None = None) -> None:
        """Bring everything to disk, then rename, to another `name` than `path` where one is given.

        Nobody ever sees a half-written file, unless that name is on another file system.
        """
        try:
            self.handle.flush()
            os.fsync(self.handle.fileno())
            self.handle.close()
            if name is not None:
                self._target = Path(os.path.realpath(name))
            self._put_in_place()
        except (OSError, ValueError) as cause:
            self.discard()
            raise cannot_write(self.path, cause) from cause
        self._sync_folder()

    def discard(self) -> None:
        """Give up: close and remove the temporary file; harmless when called twice."""
        # A full disk makes close() fail as well; the file must go all the same.
        with contextlib.suppress(OSError):
            self.handle.close()
        with contextlib.suppress(OSError):
            self._temporary.unlink(missing_ok=True)

    def _put_in_place(self) -> None:
        try:
            self._temporary.replace(self._target)
        except OSError as cause:
            if cause.errno != errno.EXDEV:
                raise
            shutil.move(self._temporary, self._target)

    def _sync_folder(self) -> None:
        """Make the rename durable where the file system lets one sync a folder."""
        with contextlib.suppress(OSError):
            folder = os.open(self._target.parent, os.O_RDONLY)
            try:
                os.fsync(folder)
            finally:
                os.close(folder)

    def __enter__(self) -> AtomicFile:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if kind is None:
            self.commit()
            return
        self.discard()
        # zipfile and numpy write to the handle themselves; their OSError is a failure to write, too.
        if isinstance(error, OSError):
            raise cannot_write(self.path, error) from error


def made_beside(target: Path, make: Callable[[Path], Made]) -> tuple[Path, Made]:
    """A path in the folder of `target` that nothing has had, and what `make` makes there. Raises OSError.

    Its name is short and without that of the target, whose length may already be all that is allowed; it has
    the target's ending, by which what a killed process has left can be read.
    """
    while True:
        name = f".irlx-{os.getpid()}-{next(_NUMBERS)}.part{target.suffix[:_LONGEST_ENDING]}"
        path = target.parent / name
        try:
            return path, make(path)
        except FileExistsError:
            # Left by a process that was killed and had this very number, as in containers most have.
            continue


def check_writable(path: str | os.PathLike[str]) -> None:
    """Raise StreamError IRL003 where a file could not be put at `path`; leaves no trace."""
    AtomicFile(path).discard()
