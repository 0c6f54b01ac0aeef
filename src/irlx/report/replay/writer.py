"""Writes the page of a run that goes on."""

from __future__ import annotations

from pathlib import Path

from irlx.blocks import Origin
from irlx.diagnostics import Diagnostic
from irlx.report.outcome import Outcome
from irlx.report.replay.gathering import Gathering
from irlx.report.replay.source import ReplaySource
from irlx.report.segment import Segment
from irlx.streams.atomic import AtomicFile
from irlx.streams.joint_stream import StreamHeader


class PageWriter:
    """Keeps the frames of a run, and makes the page `path` of them when it is closed.

    The page appears whole or not at all. Raises StreamError, IRL003, where no file can be written there.
    """

    def __init__(self, path: Path, header: StreamHeader, source: ReplaySource) -> None:
        self.path = path
        self._source = source
        self._gathering = Gathering(header)
        self._file: AtomicFile | None = AtomicFile(path)

    def take(self, segment: Segment) -> None:
        """Take the next segment."""
        self._gathering.take(segment)

    def say(self, text: str, origin: Origin | None = None) -> None:
        """Take what the program writes for the terminal, by the statement at `origin`."""
        self._gathering.say(text, origin)

    def close(self, outcome: Outcome, name: Path | None = None) -> tuple[Path, tuple[Diagnostic, ...]]:
        """Let the page appear, under another `name` where one is given: where, and warnings (IRL721).

        Raises StreamError, IRL003.
        """
        # Imported here: shapes and curves are for this moment alone.
        from irlx.report.replay.data import Replay, replay_json
        from irlx.report.replay.page import page_of

        file, self._file = self._file, None
        assert file is not None
        try:
            replay = Replay(
                outcome.header,
                self._gathering.found,
                self._source,
                outcome.summary,
                outcome.events,
                outcome.diagnostics,
            )
            data, warnings = replay_json(replay)
            file.write(page_of(outcome.header.program_name, data))
            file.commit(name)
        except BaseException:
            file.discard()
            raise
        return name or self.path, warnings

    def abort(self) -> None:
        """Remove what was written; harmless behind `close`."""
        if self._file is not None:
            self._file.discard()
            self._file = None
