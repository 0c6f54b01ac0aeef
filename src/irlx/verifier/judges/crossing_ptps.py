"""PTPs that run from or into a move of the tool: straight between the corners, near the target in them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from irlx.blocks import MoveKind
from irlx.promises import (
    JOINT_LINE,
    PATH_ORIENTATION,
    PATH_POSITION,
    PROGRAM_EXCESS,
    rounding_allowance,
)
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.demands import Demand
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.tally import Tally
from irlx.verifier.geometry.forward import forward
from irlx.verifier.geometry.task_turns import turned_off
from irlx.verifier.rows import Rows, Stretch
from irlx.verifier.tools import Pose

LEAST_LINE = 3
"""Rows that make a line."""

FARTHEST = 100.0
"""A corner is sought so many times as far beside a PTP's straight rows as these are long, at most."""

SAMPLES = 4001
GOLDEN = 0.5 * (5.0**0.5 - 1.0)

FITS = 2.0
"""Times the tolerances of a path's end by which a line may miss a corner: what both moves may be off."""


@dataclass
class _Gathered:
    """Rows of one PTP so far: joint values, their rates, tool positions, indices."""

    q: list[Floats] = field(default_factory=list)
    qd: list[Floats] = field(default_factory=list)
    qdd: list[Floats] = field(default_factory=list)
    positions: list[Floats] = field(default_factory=list)
    rows: list[Integers] = field(default_factory=list)


class _End(NamedTuple):
    """Where a line, followed on, passes a corner: `way` behind its last row, and the tool `off` it by shares
    of the tolerances."""

    way: float
    off: float


class CrossingPtps:
    """Judges PTPs alone between stops or moves of the tool, and tells how far their corners may reach."""

    def __init__(self, evidence: Evidence, straight: Tally, progress: Tally) -> None:
        self._evidence, self._straight, self._progress = evidence, straight, progress
        self._demands = {
            number: demand for number, demand in evidence.demands.items() if is_lone_crossing(demand)
        }
        self._gathered = _Gathered()

    def take(self, rows: Rows, stretch: Stretch) -> None:
        """Gather the rows of a block, and judge it behind its last one."""
        demand = self._demands.get(stretch.block)
        if demand is None or self._evidence.robot is None:
            return
        if stretch.begins:
            self._gathered = _Gathered()
        found, part = self._gathered, stretch.part
        found.q.append(rows.q[part].copy())
        found.qd.append(rows.qd[part].copy())
        found.qdd.append(rows.qdd[part].copy())
        found.positions.append(rows.positions[stretch.after].copy())
        found.rows.append(stretch.rows)
        if stretch.ends and demand.move.finished:
            self._judge(demand)

    def _judge(self, demand: Demand) -> None:
        found = self._gathered
        q, positions = np.concatenate(found.q), np.concatenate(found.positions)
        rows: Integers = np.concatenate(found.rows)
        first, last = _line(q, self._evidence.posture(demand.move.start), demand)
        if last - first + 1 < LEAST_LINE:
            self._straight.add(rows[:1], np.array([np.inf]), JOINT_LINE)
            return
        off, along = _off_line(q[first : last + 1])
        self._straight.add(rows[first : last + 1], off, JOINT_LINE)
        furthest = np.maximum.accumulate(along)
        self._progress.add(rows[first : last + 1], furthest - along, JOINT_LINE)
        begin = self._corner(demand, q[last], q[first], demand.start.pose) if demand.crosses[0] else None
        end = self._corner(demand, q[first], q[last], demand.end.pose) if demand.crosses[1] else None
        stood = q[first] if demand.crosses[0] else self._evidence.posture(demand.move.start)
        length = float(np.linalg.norm(q[last] - stood))
        whole = length + sum(corner.way for corner in (begin, end) if corner is not None)
        blend = demand.move.block.blend
        share = 1.0 if blend is None or blend.share is None else blend.share
        for corner, row, most in ((begin, rows[first], 0.5), (end, rows[last], 0.5 * share)):
            if corner is not None:
                late = corner.way - most * whole
                miss = max(corner.off * JOINT_LINE / FITS, late)
                self._straight.add(np.array([row]), np.array([miss]), JOINT_LINE)
        self._add_zones(demand, (q, rows, positions), (first, last), end, 0.5 * share * whole)
        self._add_rates(demand, rows, first, last)

    def _corner(self, demand: Demand, start: Floats, end: Floats, corner: Pose | None) -> _End:
        """Where the line from a posture to another one, followed on, first has its tool in a corner.

        Where it never has, where the tool comes nearest. Once a joint has turned round it is there again.
        """
        step = end - start
        length = float(np.linalg.norm(step))
        if corner is None or length == 0.0:
            return _End(0.0, 0.0)

        def off(shares: Floats) -> Floats:
            return self._off(demand, end + shares[:, None] * step, corner)

        shares = np.linspace(0.0, 1.0, SAMPLES) ** 2 * FARTHEST
        sampled = np.concatenate([[np.inf], off(shares), [np.inf]])
        dips = np.flatnonzero((sampled[1:-1] <= sampled[:-2]) & (sampled[1:-1] <= sampled[2:]))
        low, high = shares[np.maximum(dips - 1, 0)], shares[np.minimum(dips + 1, SAMPLES - 1)]
        for _ in range(60):
            inner = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
            before, behind = np.split(off(np.concatenate(inner)), 2)
            falls = before <= behind
            low, high = np.where(falls, low, inner[0]), np.where(falls, inner[1], high)
        ways = np.concatenate([[0.0], 0.5 * (low + high)])
        found = off(ways)
        fits = np.flatnonzero(found <= FITS)
        best = int(fits[0] if fits.size else np.argmin(found))
        return _End(float(ways[best]) * length, float(found[best]))

    def _poses(self, demand: Demand, q: Floats) -> Pose:
        tools, robot = self._evidence.placer.tools, self._evidence.robot
        assert robot is not None
        number = np.full(len(q), tools.number(demand.move.block.id), dtype=np.int64)
        return tools.placed(forward(robot, q), number)

    def _off(self, demand: Demand, q: Floats, corner: Pose) -> Floats:
        """How far tools of postures (R, n) are off a pose, in tolerances."""
        position, rotation = self._poses(demand, q)
        away = np.linalg.norm(position - corner[0], axis=1) / PATH_POSITION
        attitudes = self._evidence.placer.attitudes(rotation, q)
        return np.asarray(np.maximum(away, turned_off(attitudes, corner[1]) / PATH_ORIENTATION))

    def _add_zones(
        self,
        demand: Demand,
        of_rows: tuple[Floats, Integers, Floats],
        line: tuple[int, int],
        end: _End | None,
        most: float,
    ) -> None:
        """In its corners the tool stays as near to them as the path before may be left, or the line, of which
        the corner takes at `most` so much, rad or m."""
        (q, rows, positions), (first, last) = of_rows, line
        number = demand.move.block.id
        if demand.crosses[0] and demand.start.pose is not None:
            reach = self._evidence.reaches.get(number, np.inf)
            self._add_near(rows[:first], positions[:first], demand.start.pose, reach)
        if end is not None and demand.end.pose is not None:
            step = (q[last] - q[first]) / float(np.linalg.norm(q[last] - q[first]))
            beyond = q[last] + (end.way - np.linspace(0.0, most, 257))[:, None] * step
            away = np.linalg.norm(self._poses(demand, beyond)[0] - demand.end.pose[0], axis=1)
            # Between samples it may be a little farther.
            reach = float(np.max(away)) * (1.0 + 1e-3) + PATH_POSITION
            self._evidence.reaches[-number] = reach
            self._add_near(rows[last + 1 :], positions[last + 1 :], demand.end.pose, reach)

    def _add_near(self, rows: Integers, positions: Floats, corner: Pose, reach: float) -> None:
        away = np.linalg.norm(positions - corner[0], axis=1)
        rank = away / max(reach, PATH_POSITION) * JOINT_LINE
        allowed = reach + PATH_POSITION
        self._straight.add(rows, away, allowed, ~(away <= allowed), rank, unit="m")

    def _add_rates(self, demand: Demand, rows: Integers, first: int, last: int) -> None:
        """Between its corners a PTP uses at most its share of every joint's finite limits."""
        limits, law = self._evidence.limits, demand.move.law
        header = self._evidence.outline
        allowances = rounding_allowance(np.array([header.largest]), header.header.dt)
        qd, qdd = (np.concatenate(part) for part in (self._gathered.qd, self._gathered.qdd))
        begin = first + 2 if demand.crosses[0] else first
        for kind, values, share, allowance, tally in (
            ("speed", qd, law.speed_ptp, allowances[0], self._evidence.joint_rates[0]),
            ("acceleration", qdd, law.acc_ptp, allowances[1], self._evidence.joint_rates[1]),
        ):
            if begin > last:
                continue
            lower, upper = limits.bounds(kind, int(rows[begin]), last - begin + 1)
            rates = values[begin : last + 1]
            bound = np.where(rates > 0.0, upper, -lower) * share
            high = bound * (1.0 + PROGRAM_EXCESS) + allowance
            finite = np.isfinite(bound)
            use = np.where(finite, np.abs(rates) / high, -np.inf)
            offends = finite & ~(np.abs(rates) <= high)
            tally.add(rows[begin : last + 1], np.abs(rates), bound, offends, use)


def is_lone_crossing(demand: Demand) -> bool:
    """Whether a PTP runs from or into a move of the tool and is joined to no other PTP."""
    begins, ends = demand.crosses
    if demand.move.block.kind is not MoveKind.PTP:
        return False
    return (begins or ends) and demand.follows is begins and demand.passes is ends


def _line(q: Floats, start: Floats, demand: Demand) -> tuple[int, int]:
    """First and last of the rows q (R, n) that lie on one line: up to where it stops, or from where it stood,
    and where it does neither the longest stretch that goes straight from row to row."""
    begins, ends = demand.crosses
    count = len(q)
    if not ends:
        return _searched(count, lambda first: _is_straight(q[first:])), count - 1
    if not begins:
        whole = np.concatenate([start[None], q])
        return 0, count - 1 - _searched(count, lambda cut: _is_straight(whole[: len(whole) - cut]))
    first, last = _longest_straight(q)
    while last - first + 1 >= LEAST_LINE and not _is_straight(q[first : last + 1]):
        first, last = first + 1, last - 1
    return first, last


def _searched(count: int, holds: Callable[[int], bool]) -> int:
    """Least number from 0 on for which something holds that then holds for all larger ones."""
    low, high = 0, count - 1
    while low < high:
        middle = (low + high) // 2
        if holds(middle):
            high = middle
        else:
            low = middle + 1
    return low


def _off_line(q: Floats) -> tuple[Floats, Floats]:
    """Deviation (R, n) of postures (R, n) from the line from the first to the last, and way (R,) on it."""
    step = q[-1] - q[0]
    length = float(np.linalg.norm(step))
    offsets = q - q[0]
    if length == 0.0:
        return np.abs(offsets), np.zeros(len(q))
    along = offsets @ (step / length)
    return np.abs(offsets - along[:, None] * (step / length)), along


def _is_straight(q: Floats) -> bool:
    return len(q) < LEAST_LINE or bool((_off_line(q)[0] <= JOINT_LINE).all())


def _longest_straight(q: Floats) -> tuple[int, int]:
    """First and last row of the longest stretch in which each row lies between its neighbours."""
    if len(q) < LEAST_LINE:
        return 0, -1
    chord = q[2:] - q[:-2]
    length = np.linalg.norm(chord, axis=1)
    unit = chord / np.where(length > 0.0, length, 1.0)[:, None]
    off = q[1:-1] - q[:-2]
    bent = np.abs(off - np.sum(off * unit, axis=1)[:, None] * unit).max(axis=1) > JOINT_LINE
    edges = np.flatnonzero(np.concatenate([[True], bent, [True]]))
    widest = int(np.argmax(np.diff(edges)))
    return int(edges[widest]), int(edges[widest + 1])
