"""Writes what a run executes to files as it goes on; no rows are kept."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Origin
from irlx.diagnostics import Diagnostic
from irlx.report.figures import Figures
from irlx.report.outcome import Outcome
from irlx.report.recorder import Recorder
from irlx.report.replay.writer import PageWriter
from irlx.report.returns import Seen
from irlx.report.segment import Segment
from irlx.report.uninterrupted import uninterrupted
from irlx.streams.error import StreamError
from irlx.streams.formats import open_writer
from irlx.streams.joint_stream import StreamHeader
from irlx.streams.writer import StreamWriter

Array = NDArray[np.float64]


class FileRecording(Recorder):
    """A run whose rows go to the files `outputs` at once; these appear when it is finished.

    Under their own names they only ever appear complete: what was executed of a run that could not be
    finished appears as `partial_name` says. Raises StreamError: IRL003 where a file cannot be written, IRL004
    for an unknown ending.
    """

    def __init__(
        self,
        header: StreamHeader,
        start: Array,
        pose: tuple[Array, Array],
        outputs: Sequence[Path],
        seen: Seen | None = None,
        page: PageWriter | None = None,
    ) -> None:
        """Begin at posture `start` (n,), the tool at `pose`: rotation (3, 3), position (3,) m, world."""
        self._page = page
        try:
            self._figures, self._files = Figures(header, seen), _Files(header, outputs)
        except BaseException:
            if page is not None:
                page.abort()
            raise
        keepers = (self._figures, self._files) if page is None else (self._figures, self._files, page)
        try:
            super().__init__(header, start, *pose, keepers)
        except BaseException:
            self.abort()
            raise

    def say(self, text: str, origin: Origin | None = None) -> None:
        """Take what the program writes for the terminal, by the statement at `origin`."""
        if self._page is not None:
            self._page.say(text, origin)

    def finish(self, complete: bool, diagnostics: tuple[Diagnostic, ...]) -> Outcome:
        """Let the files appear; of a run in which nothing has moved, none.

        Each for itself: what could not be written is an error among the diagnostics, IRL003.
        """
        worth = complete or self.rows > 1
        with uninterrupted():
            files, failures = self._files.close(complete, worth)
        found = Outcome(
            header=self.header,
            summary=self._figures.summary(complete),
            events=self._figures.events,
            diagnostics=(*diagnostics, *failures),
            files=files,
        )
        if self._page is None or not worth:
            return found
        # Behind the streams, which are worth more.
        name = None if complete else partial_name(self._page.path)
        with uninterrupted():
            try:
                page, warnings = self._page.close(found, name)
            except StreamError as failure:
                return replace(found, diagnostics=(*found.diagnostics, *failure.diagnostics))
        return replace(found, page=page, diagnostics=(*found.diagnostics, *warnings))

    def abort(self) -> None:
        """Remove what was written."""
        self._files.abort()
        if self._page is not None:
            self._page.abort()


def partial_name(path: Path) -> Path:
    """Name of a stream that is not complete."""
    return path.with_name(f"{path.stem}.partial{path.suffix}")


class _Files:
    """Writers of one run."""

    def __init__(self, header: StreamHeader, outputs: Sequence[Path]) -> None:
        self._writers: list[StreamWriter] = []
        try:
            for path in outputs:
                self._writers.append(open_writer(path, header))
        except BaseException:
            self.abort()
            raise

    def take(self, segment: Segment) -> None:
        ticks = segment.first_tick + np.arange(len(segment.q), dtype=np.int64)
        for writer in list(self._writers):
            try:
                if segment.record is not None:
                    writer.block(segment.record)
                if len(ticks):
                    writer.samples(ticks, segment.q, segment.block, segment.tool)
            except StreamError:
                # It has given up itself; what the others have is worth keeping.
                self._writers.remove(writer)
                raise

    def close(self, complete: bool, worth: bool) -> tuple[tuple[Path, ...], tuple[Diagnostic, ...]]:
        """Let the files appear where they are `worth` it; their names, and why others did not."""
        if not worth:
            self.abort()
            return (), ()
        names: list[Path] = []
        failures: list[Diagnostic] = []
        # What has been closed has nothing left to be aborted; where memory runs out, the others still do.
        for writer in self._writers:
            name = writer.path if complete else partial_name(writer.path)
            try:
                writer.close(complete, name)
                names.append(name)
            except StreamError as failure:
                failures += failure.diagnostics
        self._writers.clear()
        return tuple(names), tuple(failures)

    def abort(self) -> None:
        for writer in self._writers:
            with suppress(StreamError):
                writer.abort()
        self._writers.clear()
