"""Folders that appear whole or not at all: a temporary folder beside, renamed at the end."""

from __future__ import annotations

import contextlib
import os
import shutil
from collections.abc import Callable
from itertools import count
from pathlib import Path

from irlx.streams.error import cannot_write

_NUMBERS = count(1)
_LONGEST_ENDING = 16


class AtomicFolder:
    """A folder that stands at `path` when `commit` is called, and leaves no trace otherwise.

    Files are written to `folder`. What stands at `path` before is replaced where `may_replace` says so of
    it, which raises ValueError with the reason for anything else. A link is followed. Every failure of the
    file system raises StreamError IRL003.
    """

    def __init__(self, path: str | os.PathLike[str], may_replace: Callable[[Path], None]) -> None:
        self.path = Path(path)
        self._may_replace = may_replace
        try:
            self._target = self._checked(self.path)
            # With the target's ending, by which what a killed process has left can be read.
            self.folder = self._beside(f"part{self._target.suffix[:_LONGEST_ENDING]}")
            self.folder.mkdir()
        except (OSError, ValueError) as cause:
            raise cannot_write(self.path, cause) from cause

    def commit(self, name: str | os.PathLike[str] | None = None) -> None:
        """Bring all files to disk, then rename the folder, to another `name` than `path` where one is given.

        Nobody ever sees a half-written folder. Where one is replaced, there is none for a moment.
        """
        try:
            for file in self.folder.iterdir():
                _sync(file)
            _sync(self.folder)
            self._target = self._checked(self.path if name is None else Path(name))
            self._put_in_place()
        except (OSError, ValueError) as cause:
            self.discard()
            raise cannot_write(self.path, cause) from cause
        with contextlib.suppress(OSError):
            _sync(self._target.parent)

    def discard(self) -> None:
        """Give up: remove the temporary folder; harmless when called twice."""
        shutil.rmtree(self.folder, ignore_errors=True)

    def _checked(self, path: Path) -> Path:
        """What a path stands for; raises ValueError where something is there that is not to be replaced."""
        target = Path(os.path.realpath(path))
        if target.exists():
            if not target.is_dir():
                raise ValueError("it is a file, a folder is to be written")
            self._may_replace(target)
        return target

    def _beside(self, ending: str) -> Path:
        """A name beside the target that nothing has."""
        return self._target.parent / f".irlx-{os.getpid()}-{next(_NUMBERS)}.{ending}"

    def _put_in_place(self) -> None:
        """Rename the folder; no system has one step that replaces a folder with files in it."""
        if not self._target.exists():
            shutil.move(self.folder, self._target)
            return
        before = self._beside(f"before{self._target.suffix[:_LONGEST_ENDING]}")
        self._target.rename(before)
        try:
            shutil.move(self.folder, self._target)
        except OSError:
            before.rename(self._target)
            raise
        shutil.rmtree(before, ignore_errors=True)


def _sync(path: Path) -> None:
    """Bring a file or a folder to disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
