"""Streams of every format that are streams no longer, and executions recorded in them.

Where the sums of a text format are made right again after the damage, what is behind them is met. What is
read must be what the file says: written again, it reads the same; with its old sums it is the undamaged
stream, or its beginning, marked incomplete.
"""

from __future__ import annotations

import hashlib
import re
from contextlib import suppress
from pathlib import Path
from random import Random

import numpy as np

from fuzzing.byte_damage import BINARY, TEXT, damaged
from fuzzing.case import Fault
from fuzzing.reader import Reader
from gantry import Maker
from irlx.blocks import CyclicBlock, FreezeBlock
from irlx.conversion import convert
from irlx.diagnostics import Diagnostic, IrlxError
from irlx.recorded import recorded
from irlx.streams import KNOWN_ENDINGS, JointStream, StreamError, read_stream, write_stream
from irlx.streams.formats import format_of
from irlx.streams.header_plain import header_to_plain
from irlx.verification import verify

_SUM = re.compile(rb"[0-9a-f]{64}")
_TEXTS = (".irdata", ".csv", ".jsonl")
_LARGE = 1e290
_OF_STREAMS = re.compile("IRL70[1-6]")


def small() -> JointStream:
    """A stream of a line and a PTP, with two switches."""
    maker = Maker(np.array([0.1, 0.2, -0.1, 0.3, 0.2, -0.3, 0.1]))
    maker.record(FreezeBlock, joints=(1, 7))
    maker.lin((0.5, 0.1, 0.3), (0.1, 0.2, 0.0), ticks=4)
    maker.record(CyclicBlock, active=True)
    maker.ptp(np.array([0.1, 0.3, -0.1, 0.3, 0.25, -0.3, 0.1]), ticks=3)
    return maker.stream()


def summed(data: bytes) -> bytes:
    """A text with the sum of its last line made right."""
    *above, last = data.splitlines(keepends=True) or [b""]
    digest = hashlib.sha256(b"".join(above)).hexdigest().encode()
    return b"".join([*above, _SUM.sub(digest, last)])


def content_of(stream: JointStream) -> tuple[object, ...]:
    """All that a stream holds, to be compared."""
    arrays = (array.tobytes() for array in (stream.ticks, stream.q, stream.block, stream.tool))
    return (*arrays, str(header_to_plain(stream.header)), repr(stream.records), stream.complete)


def is_beginning(part: JointStream, whole: JointStream) -> bool:
    """Whether a stream is the beginning of another one, and says so."""
    rows, blocks = len(part.ticks), len(part.records)
    return (
        not part.complete
        and np.array_equal(part.q, whole.q[:rows])
        and np.array_equal(part.tool, whole.tool[:rows])
        and np.array_equal(part.ticks, whole.ticks[:rows])
        and part.records == whole.records[:blocks]
        and header_to_plain(part.header) == header_to_plain(whole.header)
    )


class StreamReader(Reader):
    """Stream files of one format; of a folder the file with the rows is damaged, or the one beside it."""

    def __init__(self, folder: Path, ending: str, file: str = "") -> None:
        super().__init__(folder)
        self.ending = ending
        self.kind = f"{ending[1:]}-{Path(file).stem}" if file else ending[1:]
        self._path = folder / f"a{ending}"
        self._file = self._path / file if file else self._path
        self._text = ending in _TEXTS
        self.share = {".parquet": 0.5, ".rosbag": 0.25}.get(ending, 1.0)

    def made(self) -> list[bytes]:
        write_stream(small(), self._path)
        self._whole = read_stream(self._path)
        return [self._file.read_bytes()]

    def damaged(self, content: bytes, chance: Random) -> bytes:
        is_text = self._text or self._file.suffix == ".yaml"
        new = damaged(content, chance, TEXT if is_text else (*BINARY, *TEXT[5:8]))
        return summed(new) if self._text and chance.random() < 0.5 else new

    def read(self, content: bytes, thorough: bool) -> tuple[bool, list[Diagnostic]]:
        original = self.sound[0]
        self._file.write_bytes(content)
        try:
            stream = read_stream(self._path)
        except StreamError as error:
            wrong = [one.code for one in error.diagnostics if not _OF_STREAMS.fullmatch(one.code)]
            if wrong:
                raise Fault("a damaged stream is told of by another code", wrong[0], str(error)) from error
            self._others(thorough)
            return False, list(error.diagnostics)
        if content_of(stream) != content_of(self._whole) and not is_beginning(stream, self._whole):
            self._check_other(stream, content, original)
        self._others(thorough)
        return True, []

    def _check_other(self, stream: JointStream, content: bytes, original: bytes) -> None:
        """A stream that says something else: only with sums that fit, and it is what is read."""
        honest = self._text and summed(content) == content
        if stream.complete and not honest:
            raise Fault("damage goes unseen", self.kind)
        again = self._path.with_name(f"again{self.ending}")
        try:
            write_stream(stream, again)
        except StreamError as error:
            # Values near the largest numbers have rates that are none, which no file may state.
            if error.reason.code != "IRL708" or np.abs(stream.q).max() < _LARGE:
                raise
            return
        if content_of(read_stream(again)) != content_of(stream):
            raise Fault("written again it reads another way", self.kind)

    def _others(self, thorough: bool) -> None:
        """What else reads streams: whatever they hold, there is nothing but coded errors."""
        if format_of(self._path).carries_blocks:
            with suppress(IrlxError):
                recorded(self._path)
        if thorough:
            with suppress(IrlxError):
                convert(self._path, [self.folder / "b.jsonl"])
            with suppress(IrlxError):
                verify(self._path)


def stream_readers(folder: Path) -> list[Reader]:
    """A reader for every format of streams."""
    found: list[Reader] = []
    for ending in KNOWN_ENDINGS:
        files = ("stream.mcap", "metadata.yaml") if ending == ".rosbag" else ("",)
        for file in files:
            inside = folder / f"{ending[1:]}{Path(file).stem}"
            inside.mkdir()
            found.append(StreamReader(inside, ending, file))
    return found
