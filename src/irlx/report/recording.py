"""Collects what a run executes into its joint stream, events and summary."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import Origin
from irlx.diagnostics import Diagnostic
from irlx.report.clearances import clearances
from irlx.report.figures import Figures
from irlx.report.message import Message, message
from irlx.report.recorder import Recorder
from irlx.report.replay.source import ReplaySource
from irlx.report.returns import Seen
from irlx.report.run import Run
from irlx.report.segment import Segment
from irlx.robot.limits import JointLimits, alike
from irlx.streams.joint_stream import JointStream, StreamHeader

Array = NDArray[np.float64]


class Recording(Recorder):
    """All rows of a run, in memory."""

    def __init__(
        self,
        header: StreamHeader,
        start: Array,
        rotation: Array,
        position: Array,
        seen: Seen | None = None,
        source: ReplaySource | None = None,
    ) -> None:
        """Begin at posture `start` (n,), the tool at `rotation` (3, 3), `position` (3,) m, in the world."""
        self._figures, self._kept = Figures(header, seen), _Kept()
        self._source = source
        self._messages: list[Message] = []
        super().__init__(header, start, rotation, position, (self._figures, self._kept))

    def say(self, text: str, origin: Origin | None = None) -> None:
        """Take what the program writes for the terminal, by the statement at `origin`."""
        self._messages.append(message(self.rows, text, origin, self.header.program_name))

    def finish(self, complete: bool, diagnostics: tuple[Diagnostic, ...]) -> Run:
        """The run as it stands."""
        segments = self._kept.segments
        q, block, tool = (np.concatenate([segment[field] for segment in segments]) for field in (2, 3, 4))
        records = tuple(segment.record for segment in segments if segment.record is not None)
        ticks = np.arange(len(q), dtype=np.int64)
        stream = JointStream(self.header, records, ticks, q, block, tool, complete)
        return Run(
            header=self.header,
            summary=self._figures.summary(complete),
            events=self._figures.events,
            diagnostics=diagnostics,
            stream=stream,
            clearances=clearances((len(segment.q), segment.nearest) for segment in segments),
            limits=tuple(self._kept.limits),
            messages=tuple(self._messages),
            source=self._source,
        )


class _Kept:
    """Keeps all segments."""

    def __init__(self) -> None:
        self.segments: list[Segment] = []
        self.limits: list[tuple[int, JointLimits]] = []

    def take(self, segment: Segment) -> None:
        self.segments.append(segment)
        if len(segment.q) and not (self.limits and alike(self.limits[-1][1], segment.limits)):
            self.limits.append((segment.first_tick, segment.limits))
