"""Folders that appear whole or not at all: a temporary folder beside, renamed at the end."""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
from collections.abc import Callable
from pathlib import Path

from irlx.streams.atomic import made_beside
from irlx.streams.error import cannot_write

_IN_THE_WAY = {errno.ENOTEMPTY, errno.EEXIST, errno.ENOTDIR}


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
            self.folder, _ = made_beside(self._target, Path.mkdir)
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
            # What another process takes away at this moment is not in the way.
            with contextlib.suppress(FileNotFoundError):
                self._may_replace(target)
        return target

    def _put_in_place(self) -> None:
        """Rename the folder; no system has one step that replaces a folder with files in it."""
        aside: list[Path] = []
        try:
            while not self._renamed():
                self._checked(self._target)
                aside += self._set_aside()
        except BaseException:
            for before in aside[-1:]:
                with contextlib.suppress(OSError):
                    before.rename(self._target)
            raise
        finally:
            for before in aside:
                shutil.rmtree(before, ignore_errors=True)

    def _renamed(self) -> bool:
        """Rename the folder, unless something is in the way.

        A move would put it into a folder that another process has put there meanwhile.
        """
        try:
            self.folder.rename(self._target)
        except OSError as cause:
            if cause.errno not in _IN_THE_WAY:
                raise
            return False
        return True

    def _set_aside(self) -> list[Path]:
        """Give what stands in the place another name; none where another process was faster."""
        before, _ = made_beside(self._target, Path.mkdir)
        try:
            self._target.rename(before)
        except FileNotFoundError:
            before.rmdir()
            return []
        return [before]


def _sync(path: Path) -> None:
    """Bring a file or a folder to disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
