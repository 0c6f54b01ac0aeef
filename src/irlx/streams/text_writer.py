"""Writers of formats that are text: bytes to one file, with a digest of all that stands before the end."""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

from irlx.streams.atomic import AtomicFile
from irlx.streams.joint_stream import StreamHeader
from irlx.streams.writer import StreamWriter


class TextWriter(StreamWriter):
    """A writer whose file grows by what is put, one whole line after another."""

    def __init__(self, path: str | os.PathLike[str], header: StreamHeader) -> None:
        super().__init__(path, header)
        self._file = AtomicFile(path)
        self._digest = hashlib.sha256()

    def _write(self, data: bytes) -> None:
        self._digest.update(data)
        self._file.write(data)

    def _commit(self, name: Path | None) -> None:
        self._file.commit(name)

    def _discard(self) -> None:
        self._file.discard()
