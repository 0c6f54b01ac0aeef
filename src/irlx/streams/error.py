"""The exception of the stream stage, and how failures of the file system become coded ones."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from irlx.diagnostics import IrlxError, Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.diagnostics.whole_file import open_file


class StreamError(IrlxError):
    """A stream file that cannot be read, or a stream that cannot be written; holds coded diagnostics."""


def broken(path: Path, form: str, reason: str, record: str = "") -> StreamError:
    """IRL701: `path` breaks the format `form`; `record` says where, for example ``record 17``."""
    return StreamError(report("IRL701", Place(str(path), key=record), format=form, reason=reason))


def cannot_write(path: Path, cause: OSError | ValueError) -> StreamError:
    """IRL003 for an exception of the file system."""
    return StreamError(report("IRL003", path=path, cause=_words(cause)))


def cannot_read(path: Path, cause: OSError | ValueError) -> StreamError:
    """IRL001, IRL007 or IRL002 for an exception of the file system; a missing file names near ones."""
    if isinstance(cause, FileNotFoundError):
        return StreamError(report("IRL001", path=path, near=_near_files(path)))
    if isinstance(cause, IsADirectoryError):
        return StreamError(report("IRL007", path=path))
    return StreamError(report("IRL002", path=path, cause=_words(cause)))


@contextmanager
def open_to_read(path: Path) -> Iterator[IO[bytes]]:
    """The file `path`, opened to read bytes; failures of the file system become StreamError."""
    try:
        handle = open_file(path)
    except (OSError, ValueError) as cause:
        raise cannot_read(path, cause) from cause
    with handle:
        try:
            yield handle
        except OSError as cause:
            raise cannot_read(path, cause) from cause


def _words(cause: OSError | ValueError) -> str:
    """What went wrong, without errno and file name, which the message has anyway."""
    text = cause.strerror if isinstance(cause, OSError) and cause.strerror else str(cause)
    return text[:1].lower() + text[1:]


def _near_files(path: Path) -> str:
    try:
        entries = [entry for entry in path.parent.iterdir() if entry.is_file() or _is_bag(entry)]
        names = sorted(entry.name for entry in entries)
    except OSError:
        return ""
    return near_matches(path.name, names)


def _is_bag(path: Path) -> bool:
    """Whether a folder is a ROS 2 bag, which is read like a file."""
    return (path / "metadata.yaml").is_file()
