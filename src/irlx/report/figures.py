"""The figures of a run, gathered while it goes on; rows are not kept."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from irlx.blocks import MoveBlock, ReconfigureBlock
from irlx.promises import PATH_POSITION
from irlx.report.clearances import SmallestClearance, clearances
from irlx.report.events import ActiveSpans, LimitActive, Slowed
from irlx.report.returns import Returns, Seen
from irlx.report.segment import Segment
from irlx.report.summary import Closure, LimitUse, Summary, closure, limit_uses
from irlx.streams.joint_stream import StreamHeader
from irlx.streams.rates import Rates


class Figures:
    """Gathers events and the summary of a run from its segments."""

    def __init__(self, header: StreamHeader, seen: Seen | None = None) -> None:
        self._header = header
        self._rates = Rates(header)
        self._spans = ActiveSpans(header.joint_names, header.dt)
        self._returns = Returns(header.joint_names, seen)
        self._slowed: list[Slowed] = []
        self._worst: dict[str, LimitUse] = {}
        self._rows = self._moves = self._iterations = self._planned = 0
        self._path_error = (0.0, 0.0)
        self._first: Segment | None = None
        self._last: Segment | None = None
        self._clearance: SmallestClearance | None = None

    def take(self, segment: Segment) -> None:
        """Take the next segment."""
        record = segment.record
        self._moves += record is not None and isinstance(record.block, MoveBlock | ReconfigureBlock)
        self._returns.take(segment)
        if not len(segment.q):
            return
        self._first = self._first or segment
        self._last = segment._replace(q=segment.q[-1:], tool=segment.tool[-1:])
        self._spans.take(segment.active)
        self._slowed += segment.slowed
        self._iterations += segment.iterations
        self._planned += segment.planned
        (position, orientation), (before, turned) = segment.path_error, self._path_error
        self._path_error = max(position, before), max(orientation, turned)
        self._note_use(segment)
        self._note_clearance(segment)
        self._rows += len(segment.q)

    @property
    def events(self) -> tuple[LimitActive | Slowed, ...]:
        """Spans in which a limit held a joint, then those in which the tool was slowed."""
        return (*self._spans.events, *self._slowed)

    def summary(self, complete: bool) -> Summary:
        """The figures as they stand."""
        header, kinds = self._header, ("position", "speed", "acceleration")
        return Summary(
            program=header.program_name,
            complete=complete,
            duration=(self._rows - 1) * header.dt,
            samples=self._rows,
            moves=self._moves,
            path_position_error=self._path_error[0],
            path_orientation_error=self._path_error[1],
            limit_use=tuple(self._worst[kind] for kind in kinds if kind in self._worst),
            active=self._spans.events,
            slowed=tuple(self._slowed),
            planned=self._planned,
            closure=self._closure,
            iterations_per_tick=self._iterations / max(self._rows - 1, 1),
            returns=self._returns.found,
            clearance=self._clearance,
            joint_names=header.joint_names,
            joint_units=header.joint_units,
        )

    @property
    def _closure(self) -> Closure | None:
        if self._first is None or self._last is None or self._rows < 2:
            return None
        q = np.vstack([self._first.q[:1], self._last.q])
        tool = np.vstack([self._first.tool[:1], self._last.tool])
        return closure(q, tool, self._header.joint_names, PATH_POSITION)

    def _note_use(self, segment: Segment) -> None:
        """Largest use of each kind of limit, each row judged by the limits in force at it."""
        ticks = segment.first_tick + np.arange(len(segment.q), dtype=np.int64)
        rates = self._rates.of(ticks, segment.q)
        names = self._header.joint_names
        for use in limit_uses(segment.q, rates.qd, rates.qdd, segment.limits, names):
            if use.kind not in self._worst or use.share > self._worst[use.kind].share:
                self._worst[use.kind] = replace(use, tick=use.tick + segment.first_tick)

    def _note_clearance(self, segment: Segment) -> None:
        found = clearances([(len(segment.q), segment.nearest)]).smallest
        if found is None:
            return
        known = self._clearance
        if known is None or found.distance - found.margin < known.distance - known.margin:
            self._clearance = replace(found, tick=found.tick + segment.first_tick)
