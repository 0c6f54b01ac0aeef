"""First pass over a stream: what it consists of, and whether it can be judged row by row at all."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from irlx.diagnostics import Diagnostic
from irlx.promises import LONGEST_TICK, SHORTEST_TICK
from irlx.streams.error import StreamError
from irlx.streams.joint_stream import BlockRecord, Floats, Integers, StreamHeader
from irlx.streams.scan import RowBatch, ScanItem, StreamEnd
from irlx.verifier.findings.finding import FAILED, NOT_CHECKED, OK, Check, Finding

END_DAMAGE = ("IRL702", "IRL704")
"""Damage that is found at the end of a file, all of it having been read."""

Scans = Callable[[], Iterator[ScanItem]]
"""Gives a scan of the same stream, from its beginning, every time it is called."""


@dataclass(frozen=True, eq=False)
class Outline:
    """A stream without its rows: header, block records, stretches of rows of one block id.

    Of S stretches: `ids`, first and last row (S,) each, the posture in the last row, `ends` (S, n), and
    whether that repeats the row before it bit by bit, `held` (S,); row 0 does.
    `rows` in all; `largest` |q|. `damage` is what ended the reading before the stream's end;
    `tick_fault` and `odd_value` are the first tick that is not the next one, and the first value that is
    no number.
    """

    header: StreamHeader
    records: tuple[BlockRecord, ...]
    ids: Integers
    firsts: Integers
    lasts: Integers
    ends: Floats
    held: NDArray[np.bool_]
    rows: int
    largest: float
    complete: bool
    states_rates: bool
    damage: Diagnostic | None
    tick_fault: Finding | None
    odd_value: Finding | None

    @property
    def end_in_doubt(self) -> bool:
        """Whether all was read up to an end record whose checksum or count is another one."""
        return self.damage is not None and self.damage.code in END_DAMAGE

    @cached_property
    def lines(self) -> dict[int, int]:
        """Program line of every recorded block, by id."""
        return {record.block.id: record.block.origin.line for record in self.records}

    def block_at(self, row: int) -> int:
        """Id of the block whose motion a row belongs to."""
        return int(self.ids[np.searchsorted(self.lasts, row)])

    def posture(self, row: int) -> tuple[float, ...]:
        """Joint values of a row in which a block ends: the next one begins where the last one stopped."""
        return tuple(self.ends[np.searchsorted(self.lasts, row)].tolist())

    def stands(self, row: int) -> bool:
        """Whether a row in which a block ends repeats the row before it."""
        return bool(self.held[np.searchsorted(self.lasts, row)])

    def segments(self) -> Iterator[tuple[int, int, int]]:
        """Stretches of rows: (id, first row, last row), in order."""
        return zip(self.ids.tolist(), self.firsts.tolist(), self.lasts.tolist(), strict=True)


class _Draft:
    """An outline in the making."""

    def __init__(self, header: StreamHeader) -> None:
        self.header = header
        self.records: list[BlockRecord] = []
        self.ids: list[int] = []
        self.firsts: list[int] = []
        self.ends: list[Floats] = []
        self.held: list[bool] = []
        self.before: Floats | None = None
        self.rows = 0
        self.largest = 0.0
        self.complete = False
        self.states_rates = False
        self.tick_fault: Finding | None = None
        self.odd_value: Finding | None = None

    def take(self, batch: RowBatch) -> None:
        self.states_rates = self.states_rates or batch.rates is not None
        self._judge(batch)
        block = batch.block
        starts = np.flatnonzero(np.diff(block, prepend=block[:1] - 1))
        if self.ids and self.ids[-1] == block[0]:
            starts = starts[1:]
        ends = [*(starts - 1).tolist(), len(block) - 1]
        stands = self._stands(batch.q)
        if self.ids and ends[0] >= 0:
            self.ends[-1], self.held[-1] = batch.q[ends[0]].copy(), bool(stands[ends[0]])
        for start, end in zip(starts.tolist(), ends[1:], strict=True):
            self.ids.append(int(block[start]))
            self.firsts.append(self.rows + start)
            self.ends.append(batch.q[end].copy())
            self.held.append(bool(stands[end]))
        with np.errstate(invalid="ignore"):
            self.largest = max(self.largest, float(np.max(np.abs(batch.q))) if batch.q.size else 0.0)
        self.rows += len(block)

    def _stands(self, q: Floats) -> NDArray[np.bool_]:
        """Whether rows q (R, n) repeat the row before each of them bit by bit."""
        rows = np.concatenate([q[:1] if self.before is None else self.before, q]).view(np.int64)
        self.before = q[-1:].copy()
        return np.asarray((rows[1:] == rows[:-1]).all(axis=1))

    def _judge(self, batch: RowBatch) -> None:
        due = np.arange(self.rows, self.rows + len(batch.ticks))
        wrong = batch.ticks != due
        if self.tick_fault is None and wrong.any():
            row = int(np.argmax(wrong))
            tick, block = int(batch.ticks[row]), int(batch.block[row])
            self.tick_fault = Finding(float(tick), float(due[row]), tick, block=block)
        whole = np.isfinite(batch.q).all(axis=1) & np.isfinite(batch.tool).all(axis=1)
        if self.odd_value is None and not whole.all():
            row = int(np.argmin(whole))
            odd = np.flatnonzero(~np.isfinite(batch.q[row]))
            joint = self.header.joint_names[odd[0]] if odd.size else None
            value = float(batch.q[row, odd[0]]) if odd.size else float("nan")
            tick, block = int(batch.ticks[row]), int(batch.block[row])
            self.odd_value = Finding(value, np.inf, tick, joint, block)

    def outline(self, damage: Diagnostic | None) -> Outline:
        firsts = np.array(self.firsts, dtype=np.int64)
        lasts = np.append(firsts[1:] - 1, self.rows - 1)[: len(firsts)]
        return Outline(
            self.header,
            tuple(self.records),
            np.array(self.ids, dtype=np.int64),
            firsts,
            lasts,
            np.array(self.ends).reshape(len(firsts), self.header.joints),
            np.array(self.held, dtype=np.bool_),
            self.rows,
            self.largest,
            self.complete,
            self.states_rates,
            damage,
            self.tick_fault,
            self.odd_value,
        )


def outline_of(scans: Scans) -> Outline:
    """Outline of a stream, read once. What ends the reading early is kept as `damage`.

    Raises StreamError where not even the header can be read.
    """
    draft: _Draft | None = None
    try:
        for item in scans():
            if isinstance(item, StreamHeader):
                draft = _Draft(item)
            elif draft is None:
                raise ValueError("a scan begins with the header")
            elif isinstance(item, BlockRecord):
                draft.records.append(item)
            elif isinstance(item, StreamEnd):
                draft.complete = item.complete
            else:
                draft.take(item)
    except StreamError as error:
        if draft is None:
            raise
        return draft.outline(error.reason)
    if draft is None:
        raise ValueError("a scan begins with the header")
    return draft.outline(None)


def check_complete(outline: Outline) -> Check:
    """The run came to its end."""
    if outline.complete:
        return Check("complete", OK)
    if outline.end_in_doubt:
        return Check("complete", NOT_CHECKED, detail="the end record does not fit what stands before it")
    return Check("complete", FAILED, detail=f"the stream ends early, after {outline.rows} samples")


def check_ticks(outline: Outline) -> Check:
    """Ticks count 0, 1, 2, .. without a gap."""
    if outline.rows == 0:
        return Check("ticks", FAILED, detail="the stream has no samples")
    dt = outline.header.dt
    if not SHORTEST_TICK <= dt <= LONGEST_TICK:
        detail = (
            f"a tick of {dt * 1e3:g} ms; {SHORTEST_TICK * 1e3:g} to {LONGEST_TICK * 1e3:g} ms are possible"
        )
        return Check("ticks", FAILED, detail=detail)
    found = outline.tick_fault
    if found is None and outline.damage is not None and outline.damage.code == "IRL703":
        return Check("ticks", FAILED, detail=outline.damage.message)
    if found is None:
        return Check("ticks", OK)
    found = replace(found, line=outline.lines.get(found.block))
    detail = f"tick {found.value:.0f} stands where tick {found.allowed:.0f} is due"
    return Check("ticks", FAILED, worst=found, first=found, detail=detail)


def check_finite(outline: Outline) -> Check:
    """Joint values and tool poses are finite numbers."""
    found = outline.odd_value
    return Check("finite values", FAILED if found else OK, worst=found, first=found)
