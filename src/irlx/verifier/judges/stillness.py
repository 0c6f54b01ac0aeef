"""Checks of what must not move: the last row of every move, and frozen joints; both bit by bit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import FreezeBlock, PauseBlock, WaitBlock
from irlx.promises import TICK_SHARE
from irlx.streams.joint_stream import Floats
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import Check
from irlx.verifier.rows import Rows, Stretch


class StopChecks:
    """The last row of every motion repeats the row before it: the robot stands, with a tick to show it. Rows
    before the first motion all repeat the start posture. A move that passes its target does not stop;
    where there are no blocks nothing tells which may."""

    def __init__(self, evidence: Evidence) -> None:
        self._outline = evidence.outline
        self._tally = evidence.tally("stops", "rad|m")
        self._passing = _passing(evidence)
        tells = bool(evidence.outline.records) or not evidence.outline.ids.any()
        self._untold = 0
        if not tells:
            moving = zip(evidence.outline.ids[:-1].tolist(), evidence.outline.held[:-1], strict=True)
            self._passing = frozenset(number for number, held in moving if number and not held)
            self._untold = len(self._passing)

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        outline = self._outline
        for stretch in rows.stretches:
            last = int(stretch.rows[-1])
            unfinished = last == outline.rows - 1 and not outline.complete
            if stretch.block == 0:
                self._add(rows, stretch, 0)
            elif stretch.ends and not unfinished and stretch.block not in self._passing:
                self._add(rows, stretch, len(stretch.rows) - 1)

    def _add(self, rows: Rows, stretch: Stretch, first: int) -> None:
        """Compare the rows of a stretch from its row `first` on each with the row before."""
        here, before = (rows.postures[part][first:] for part in (stretch.after, stretch.before))
        change, offends = np.abs(here - before), _other_bits(here, before)
        rank = np.where(offends, change, -np.inf)
        self._tally.add(stretch.rows[first:], change, 0.0, offends, rank)

    def checks(self) -> list[Check]:
        """Stops."""
        if self._untold:
            self._tally.detail = (
                f"{self._untold} motions run into the next one: without blocks nothing tells whether they may"
            )
        return [self._tally.check()]


class WaitChecks:
    """In waits and pauses the robot stands, bit by bit, and as long as told: whole ticks, not one more."""

    def __init__(self, evidence: Evidence) -> None:
        outline = evidence.outline
        self._outline = outline
        self._still = evidence.tally("waits still", "rad|m")
        self._time = evidence.tally("waiting time", "s")
        self._waits = {
            record.block.id: record.block.duration
            for record in outline.records
            if isinstance(record.block, WaitBlock | PauseBlock)
        }
        lasts = {identity: (first, last) for identity, first, last in outline.segments()}
        for record in outline.records:
            if isinstance(record.block, WaitBlock | PauseBlock):
                self._add_time(record.block, record.tick, lasts)

    def _add_time(self, block: WaitBlock | PauseBlock, tick: int, lasts: dict[int, tuple[int, int]]) -> None:
        first, last = lasts.get(block.id, (tick + 1, tick))
        rows, dt = last - first + 1, self._outline.header.dt
        unfinished = last == self._outline.rows - 1 and not self._outline.complete
        # From one tick less than asked for, which is too short, to one more, which is too long.
        off = block.duration / dt - rows
        wrong = (off > TICK_SHARE and not unfinished) or off <= TICK_SHARE - 1.0
        self._time.add(np.array([last]), np.array([off * dt]), dt * TICK_SHARE, np.array([wrong]))

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        for stretch in rows.stretches:
            if stretch.block in self._waits:
                here, before = (rows.postures[part] for part in (stretch.after, stretch.before))
                change, offends = np.abs(here - before), _other_bits(here, before)
                self._still.add(stretch.rows, change, 0.0, offends, np.where(offends, change, -np.inf))

    def checks(self) -> list[Check]:
        """Waits."""
        return [self._still.check(), self._time.check()]


class FrozenChecks:
    """Frozen joints keep the bits of the value they had when they were frozen."""

    def __init__(self, evidence: Evidence) -> None:
        outline = evidence.outline
        self._tally = evidence.tally("frozen joints", "rad|m")
        blocks = [(record.tick, record.block) for record in outline.records]
        frozen = [(tick, block.joints) for tick, block in blocks if isinstance(block, FreezeBlock)]
        ends = [*(tick for tick, _ in frozen[1:]), outline.rows - 1][: len(frozen)]
        self._spans = [
            (tick, end, np.array(joints, dtype=np.int64) - 1, evidence.posture(tick))
            for (tick, joints), end in zip(frozen, ends, strict=True)
            if joints and end > tick
        ]

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        for start, end, columns, held in self._spans:
            first, last = max(start + 1, rows.first), min(end, rows.first + len(rows) - 1)
            if first > last:
                continue
            q = rows.q[first - rows.first : last - rows.first + 1]
            frozen = np.zeros(q.shape[1], dtype=np.bool_)
            frozen[columns] = True
            offends = _other_bits(q, np.broadcast_to(held, q.shape)) & frozen
            change = np.where(frozen, np.abs(q - held), 0.0)
            self._tally.add(
                np.arange(first, last + 1), change, 0.0, offends, np.where(offends, change, -np.inf)
            )

    def checks(self) -> list[Check]:
        """Frozen joints."""
        return [self._tally.check()]


def _passing(evidence: Evidence) -> frozenset[int]:
    """Ids of the moves that pass their target without a stop."""
    return frozenset(number for number, demand in evidence.demands.items() if demand.passes)


def _other_bits(first: Floats, second: Floats) -> NDArray[np.bool_]:
    """Where two arrays differ in any bit; unlike ``!=`` it tells -0.0 from 0.0."""
    one, other = (np.ascontiguousarray(array).view(np.int64) for array in (first, second))
    return np.asarray(one != other)
