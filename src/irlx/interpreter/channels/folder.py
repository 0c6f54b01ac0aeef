"""Finding a file below a folder, and nowhere else, however its name and links may lead out of it."""

from __future__ import annotations

import os
import stat
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from irlx.diagnostics.near_files import near_files
from irlx.interpreter.channels.fault import ChannelFault, cannot

_FOLDER = os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC
_MOST_LINKS = 40
_KINDS = (
    (stat.S_ISDIR, "it is a folder"),
    (stat.S_ISFIFO, "it is a FIFO, not a file"),
    (stat.S_ISSOCK, "it is a socket, not a file"),
    (stat.S_ISREG, ""),
)


def parts_of(name: str) -> list[str]:
    """Parts of a name. Raises ChannelFault: IRL554 for what is no name, IRL540 for one from the root."""
    for wrong, cause in (("\0", "it has a NUL in it"), ("\\", "folders are divided by /")):
        if wrong in name:
            raise ChannelFault("IRL554", name=name.replace("\0", "?"), cause=cause)
    if not name.strip("/. ") or name.endswith("/"):
        raise ChannelFault("IRL554", name=name, cause="it names no file")
    if name.startswith("/"):
        raise ChannelFault("IRL540", name=name, cause="it begins with /")
    return [part for part in name.split("/") if part not in ("", ".")]


@dataclass(frozen=True)
class Located:
    """A place for a file: the folder, open, the name in it, and what stands there or None."""

    folder: int
    part: str
    found: os.stat_result | None

    @property
    def identity(self) -> tuple[object, ...]:
        """Equal for the same file, or the same place for one."""
        if self.found is not None:
            return (self.found.st_dev, self.found.st_ino)
        above = os.fstat(self.folder)
        return (above.st_dev, above.st_ino, self.part)


class Folder:
    """Files below `path`; those of `protected`, with what each is to the run, are not to be written.

    Every part of a name is opened by itself, inside of the one before, and never through a link: a link is
    read and followed here, so that none that leads outside is, not even one that was put there meanwhile.
    """

    def __init__(self, path: Path, protected: Mapping[Path, str] | None = None) -> None:
        self.path = path
        self._protected = protected or {}

    @contextmanager
    def locate(self, name: str) -> Iterator[Located]:
        """The place that a name means. Raises ChannelFault: IRL540, IRL541, IRL548, IRL554."""
        pending, stack = parts_of(name), [self._root(name)]
        try:
            yield self._walk(name, pending, stack)
        finally:
            for opened in stack:
                os.close(opened)

    def missing(self, name: str) -> ChannelFault:
        """IRL541 with the files of a like name."""
        near = near_files(self.path / name) if ".." not in name.split("/") else ""
        return ChannelFault("IRL541", name=name, folder=self.path, near=near)

    def refuse_protected(self, name: str, located: Located) -> None:
        """Raises ChannelFault, IRL551, for a file that the run itself reads or writes."""
        above = os.fstat(located.folder)
        place = (above.st_dev, above.st_ino, located.part)
        for path, what in self._protected.items():
            if place == _place(path) or (located.found is not None and located.identity == _file(path)):
                raise ChannelFault("IRL551", name=name, what=what)

    def _root(self, name: str) -> int:
        try:
            return os.open(self.path, _FOLDER)
        except OSError as cause:
            raise cannot(name, "opened", f"{self.path}: {(cause.strerror or '').lower()}") from None

    def _walk(self, name: str, pending: list[str], stack: list[int]) -> Located:
        links = 0
        while pending:
            part = pending.pop(0)
            if part == "..":
                if len(stack) == 1:
                    raise ChannelFault("IRL540", name=name, cause="it leads out of the folder")
                os.close(stack.pop())
                continue
            found = self._looked_at(name, part, stack[-1])
            if found is not None and stat.S_ISLNK(found.st_mode):
                links += 1
                if links > _MOST_LINKS:
                    raise cannot(name, "opened", "too many links lead to each other")
                pending[:0] = self._target(name, part, stack)
            elif not pending:
                return Located(stack[-1], part, found)
            elif found is None:
                raise self.missing(name)
            else:
                stack.append(self._entered(name, part, stack[-1]))
        raise cannot(name, "opened", "it is a folder")

    def _looked_at(self, name: str, part: str, folder: int) -> os.stat_result | None:
        try:
            return os.stat(part, dir_fd=folder, follow_symlinks=False)
        except FileNotFoundError:
            return None
        except (OSError, ValueError) as cause:
            raise cannot(name, "opened", cause if isinstance(cause, OSError) else str(cause)) from None

    def _target(self, name: str, part: str, stack: list[int]) -> list[str]:
        """Parts that a link leads to; from the root of the system only where that is below the folder."""
        try:
            target = os.readlink(part, dir_fd=stack[-1])
        except OSError as cause:
            raise cannot(name, "opened", cause) from None
        if target.startswith("/"):
            root = f"{os.path.realpath(self.path).rstrip('/')}/"
            if not target.startswith(root):
                raise ChannelFault("IRL540", name=name, cause=f"the link {part} leads out of the folder")
            while len(stack) > 1:
                os.close(stack.pop())
            target = target.removeprefix(root)
        return [step for step in target.split("/") if step not in ("", ".")]

    def _entered(self, name: str, part: str, folder: int) -> int:
        try:
            return os.open(part, _FOLDER | os.O_NOFOLLOW, dir_fd=folder)
        except OSError as cause:
            raise cannot(name, "opened", cause) from None


def refuse_kind(name: str, found: os.stat_result) -> None:
    """Raises ChannelFault, IRL548, for what is no regular file."""
    cause = next((words for holds, words in _KINDS if holds(found.st_mode)), "it is a device, not a file")
    if cause:
        raise cannot(name, "opened", cause)


def _file(path: Path) -> tuple[object, ...] | None:
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return (found.st_dev, found.st_ino)


def _place(path: Path) -> tuple[object, ...] | None:
    """Where a file is, or will be: its folder, and its name in it."""
    real = Path(os.path.realpath(path))
    above = _file(real.parent)
    return None if above is None else (*above, real.name)
