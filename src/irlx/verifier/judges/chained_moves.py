"""Moves of the tool that run into each other, and those along a PATH, against the one way that they make."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from irlx.promises import (
    FOLLOWED_TURN,
    JERK_TICKS,
    PATH_ORIENTATION,
    PATH_POSITION,
    PATH_STEP,
    PROGRAM_EXCESS,
)
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.chain_legs import ChainLegs, end_reach
from irlx.verifier.demands import Demand
from irlx.verifier.findings.tally import Tally
from irlx.verifier.geometry.chains import ChainWay
from irlx.verifier.geometry.placed import Placed
from irlx.verifier.geometry.rotations import angle_between
from irlx.verifier.geometry.task_turns import followed_off, turned_off
from irlx.verifier.judges.chain_end import ways_on_last_circle
from irlx.verifier.judges.chain_start import start_of_chain
from irlx.verifier.judges.jerk import add_jerk
from irlx.verifier.tools import Pose

HANDS_OVER = 2
"""Rows at either end of a block's own that may lie on its neighbour: the nearest tick, and one beside it."""

REACH = 2.0
"""How much further than its speed allows a row may lie from the one before and still be looked for."""


@dataclass(frozen=True)
class ChainTallies:
    """The checks that rows of chains count for."""

    goal: tuple[Tally, Tally]
    path: tuple[Tally, Tally]
    progress: Tally
    speed: Tally
    acceleration: Tally
    jerk: Tally


class _Waiting:
    """Rows of a chain not judged yet: poses (R + 1, ..) from the row before them on, indices, blocks.

    Their `rotations` are attitudes (R + 1, ..).
    """

    def __init__(self, start: Pose) -> None:
        self.positions, self.rotations = start[0][None], start[1][None]
        self.rows = self.blocks = np.zeros(0, dtype=np.int64)

    def add(self, poses: Pose, rows: Integers, block: int) -> None:
        """Rows of one block that come next."""
        self.positions = np.concatenate([self.positions, poses[0]])
        if self.rotations.shape[1] < poses[1].shape[1]:
            # Where a chain starts nothing is judged: no axes are needed.
            lacking = poses[1].shape[1] - self.rotations.shape[1]
            self.rotations = np.pad(self.rotations, ((0, 0), (0, lacking), (0, 0)))
        self.rotations = np.concatenate([self.rotations, poses[1]])
        self.rows = np.concatenate([self.rows, rows])
        self.blocks = np.concatenate([self.blocks, np.full(len(rows), block, dtype=np.int64)])

    def without(self, count: int) -> _Waiting:
        """What is left behind the first rows."""
        left = _Waiting((self.positions[count], self.rotations[count]))
        left.positions, left.rotations = self.positions[count:], self.rotations[count:]
        left.rows, left.blocks = self.rows[count:], self.blocks[count:]
        return left


class ChainRows:
    """The rows of one chain, given to it in order; `legs` is its geometry.

    Where it comes from a PTP, or leads into one, rows about that corner lie on no path: up to the first one
    on it that is farther from the start than `start_reach` m or half of the first leg, and from the first
    one on that is nearer to the end than the blend. None of them is farther from the corner itself.
    """

    def __init__(
        self,
        chain: tuple[Demand, ...],
        legs: ChainLegs,
        dt: float,
        tallies: ChainTallies,
        start_reach: float = 0.0,
    ) -> None:
        self._chain, self._legs, self._tallies, self._dt = chain, legs, tallies, dt
        # Moves that are joined have none.
        self._allowance = chain[0].allowance
        self._step = REACH * float(np.max(legs.speed)) * dt
        self._way = ChainWay(list(legs.legs), self._step, self._allowance)
        start = chain[0].start.pose
        assert start is not None
        self._waiting = _Waiting(start)
        self._firsts = np.array([demand.move.start + 1 for demand in chain])
        self._lasts = np.array([demand.move.last for demand in chain])
        self._ids = np.array([demand.move.block.id for demand in chain])
        # Of the last rows judged: way, position, bounds. Before the chain the tool stood.
        self._alongs, self._points = np.zeros(3), np.array([start[0], start[0]])
        self._accelerations, self._jerks = np.zeros(2), np.zeros(3)
        self._speeds, self._sharp = np.zeros((3, 1)), np.zeros(1, dtype=np.bool_)
        self._leg = np.zeros(1, dtype=np.int64)
        self._furthest, self._unknown = 0.0, False
        self._fresh = self._cornered = 0
        """So many of the rows judged next have fewer than two known ones before them (`ChainStart`), and
        fewer than three."""
        self._wanted = start[1][None, :3]
        first = legs.legs[0].curve
        self._reaches = min(start_reach, first.room[0]), end_reach(chain[-1])
        self._begun = _Waiting(start) if chain[0].crosses[0] else None
        self._held = _Waiting(start) if chain[-1].crosses[1] else None
        self._hint = 0.0

    def take(self, poses: Pose, rows: Integers, block: int, final: bool) -> None:
        """Look at the next rows, those of one block; `final` are the last ones of the chain."""
        if self._begun is not None:
            poses, rows = self._behind_start(self._begun, poses, rows, block, final)
            if self._begun is not None:
                return
        if self._held is not None:
            poses, rows = self._before_end(self._held, poses, rows, block, final)
        waiting = self._waiting
        waiting.add(poses, rows, block)
        placed = self._way.take(waiting.positions[1:], waiting.rotations[1:], final)
        count = len(placed.along)
        judged = self._known(placed)
        if judged and not self._unknown:
            self._judge(placed.first(judged))
        self._unknown = self._unknown or judged < count
        if final and self._held is not None:
            self._add_corner(self._held)
        elif final and self._chain[-1].move.finished:
            self._add_end(waiting)
        self._waiting = waiting.without(count)

    def _behind_start(
        self, begun: _Waiting, poses: Pose, rows: Integers, block: int, final: bool
    ) -> tuple[Pose, Integers]:
        """The rows behind the corner to the PTP before, and behind those that tell where it ends."""
        begun.add(poses, rows, block)
        taken, reach = (begun.positions[1:], begun.rotations[1:]), self._reaches[0]
        corner, legs = begun.positions[0], self._legs.legs
        end = 0.0 if self._held is None else self._reaches[1]
        start = start_of_chain(taken, legs, corner, reach, self._allowance, final, self._step, end)
        if start is None:
            return (taken[0][:0], taken[1][:0]), rows[:0]
        self._begun = None
        in_it, last = slice(start.corner), start.placed
        away = np.linalg.norm(taken[0][in_it] - corner, axis=1)
        allowed = reach + PATH_POSITION
        rank = away / max(reach, PATH_POSITION) * PATH_POSITION
        self._tallies.path[0].add(begun.rows[in_it], away, allowed, rank=rank)
        left = begun.without(last)
        self._waiting = _Waiting((left.positions[0], left.rotations[0]))
        if self._held is not None:
            self._held = _Waiting((left.positions[0], left.rotations[0]))
        self._alongs, self._points = start.ways[[0, 0, 1]], begun.positions[[max(last - 1, 0), last]]
        self._furthest, self._fresh = float(start.ways[-1]), start.fresh
        self._cornered = start.fresh + 1
        self._hint = self._furthest if len(legs) == 1 else 0.0
        self._way.begin_at(self._furthest)
        way, curve = start.ways[-1:], legs[0].curve
        self._wanted = curve.rotations(way)
        if last > start.corner:
            off = np.linalg.norm(left.positions[:1] - curve.points(way), axis=1)
            self._tallies.path[0].add(begun.rows[last - 1 : last], off, PATH_POSITION)
        return (left.positions[1:], left.rotations[1:]), left.rows

    def _before_end(
        self, held: _Waiting, poses: Pose, rows: Integers, block: int, final: bool
    ) -> tuple[Pose, Integers]:
        """The rows that do not belong to the corner to the PTP behind; others are held."""
        if block != self._ids[-1]:
            if len(rows):
                self._held = _Waiting((poses[0][-1], poses[1][-1]))
            return poses, rows
        held.add(poses, rows, block)
        curve, goal = self._legs.legs[-1].curve, self._chain[-1].end.pose
        assert goal is not None
        if np.isfinite(curve.whole):
            if not final:
                return (poses[0][:0], poses[1][:0]), rows[:0]
            known = self._hint if len(self._legs.legs) == 1 else None
            way = ways_on_last_circle(curve, held.positions[1:], known, self._reaches[1])
        else:
            way = curve.nearest(held.positions[1:], self._hint)
        near = np.linalg.norm(held.positions[1:] - goal[0], axis=1) <= self._reaches[1] + PATH_POSITION
        outside = np.flatnonzero(~((way > curve.length - self._reaches[1]) & near))
        count = int(outside[-1]) + 1 if outside.size else 0
        if count:
            self._hint = float(way[count - 1])
        left = held.without(count)
        freed = held.positions[1 : count + 1], held.rotations[1 : count + 1]
        released = held.rows[:count]
        self._held = left
        return freed, released

    def _add_corner(self, held: _Waiting) -> None:
        """The path has been run up to the corner, and in it the tool keeps to its speed."""
        law = self._chain[-1].move.law
        missing = np.array([self._way.left - self._reaches[1] - float(self._alongs[-1])])
        speed = self._way.stretches_to_end(self._reaches[1]).fastest(law.speed, law.acc)
        allowed = speed * self._dt * (1.0 + PROGRAM_EXCESS) + PATH_POSITION
        self._tallies.progress.add(self._lasts[-1:], missing, allowed, rank=missing / allowed, unit="m")
        moved = np.linalg.norm(np.diff(held.positions, axis=0), axis=1)
        turned = turned_off(held.rotations[1:], held.rotations[:-1, :3])
        for way, bound, unit in ((moved, law.speed, "m/s"), (turned, law.speed_ori, "rad/s")):
            rates = way / self._dt
            high = bound * (1.0 + PROGRAM_EXCESS) + 2.0 * PATH_STEP / self._dt
            self._tallies.speed.add(held.rows, rates, bound, ~(rates <= high), rates / high, unit)

    def _known(self, placed: Placed) -> int:
        """How many rows lie before the corner of a move in which the stream breaks off: whither it goes from
        there, and how, nobody knows."""
        free = self._legs.free_end
        if free is None:
            return len(placed.along)
        last = len(self._legs.legs) - 1
        beyond = (placed.leg == last) & (placed.along > self._way.start_of(last) + free)
        return int(np.argmax(beyond)) if beyond.any() else len(beyond)

    def _judge(self, placed: Placed) -> None:
        count = len(placed.along)
        rows = self._waiting.rows[:count]
        self._tallies.path[0].add(rows, placed.position, PATH_POSITION)
        self._tallies.path[1].add(rows, placed.orientation, PATH_ORIENTATION)
        self._add_progress(rows, placed)
        self._add_labels(rows, placed)
        alongs = np.concatenate([self._alongs, placed.along])
        near = self._near(placed, np.abs(np.diff(alongs[2:])))
        untold = self._untold(placed, np.concatenate([self._leg, placed.leg]))
        self._add_speed(rows, placed, alongs[1:], near)
        self._add_acceleration(rows, placed, alongs[1:], near)
        self._add_jerk(rows, alongs, near, untold)
        self._alongs, self._fresh = alongs[-3:], max(self._fresh - count, 0)
        self._cornered = max(self._cornered - count, 0)

    def _add_progress(self, rows: Integers, placed: Placed) -> None:
        furthest = np.maximum.accumulate(np.concatenate([[self._furthest], placed.along]))
        back = furthest[:-1] - placed.along
        self._furthest = float(furthest[-1])
        self._tallies.progress.add(rows, back, PATH_STEP, rank=back / PATH_STEP, unit="m")

    def _add_labels(self, rows: Integers, placed: Placed) -> None:
        """Rows belong to a block up to the point of the way nearest to its corner, then to the next one."""
        if len(self._chain) == 1:
            return
        block = np.searchsorted(self._ids, self._waiting.blocks[: len(rows)])
        ends = np.full(len(self._legs.legs) + 1, np.inf)
        ends[: len(self._way.ends)] = self._way.ends
        # Behind the last corner that is known nothing lies yet; before the first block there is no corner.
        starts = np.concatenate([[-np.inf], np.minimum(ends[self._legs.last_of], self._way.length)])
        late = placed.along - ends[self._legs.last_of[block]]
        early = starts[block] - placed.along
        late[(block == len(self._chain) - 1) | (self._lasts[block] - rows < HANDS_OVER)] = 0.0
        early[rows - self._firsts[block] < HANDS_OVER] = 0.0
        off = np.maximum(np.maximum(late, early), 0.0)
        self._tallies.progress.add(rows, off, PATH_POSITION, rank=off / PATH_POSITION, unit="m")

    def _near(self, placed: Placed, steps: Floats) -> tuple[Integers, Integers, Integers]:
        """Leg of each row, and those of its neighbours that are no further than its step: where one leg hands
        over to the next, what is allowed on either of them is."""
        ends = np.full(len(self._legs.legs) + 1, np.inf)
        ends[: len(self._way.ends)] = self._way.ends
        leg = placed.leg
        starts = np.where(leg > 0, ends[leg - 1], -np.inf)
        before = np.where(placed.along - steps <= starts, leg - 1, leg)
        behind = np.where(placed.along + steps >= ends[leg], leg + 1, leg)
        return np.maximum(before, 0), leg, np.minimum(behind, len(self._legs.legs) - 1)

    def _add_speed(
        self, rows: Integers, placed: Placed, alongs: Floats, near: tuple[Integers, Integers, Integers]
    ) -> None:
        legs, count, dt = self._legs, len(rows), self._dt
        allowed = np.array(
            [np.max([values[leg] for leg in near], axis=0) for values in (legs.speed, legs.turn, legs.acc)]
        )
        # From one row to the next, the larger of what is allowed at both.
        both = np.concatenate([self._speeds, allowed], axis=1)
        self._speeds = both[:, -1:]
        speed, turn, acc = np.maximum(both[:, 1:], both[:, :-1])
        with np.errstate(divide="ignore"):
            speed = np.minimum(speed, np.sqrt(acc / placed.bend))
        self._slow_between(placed, speed, acc)
        moved = np.linalg.norm(np.diff(self._waiting.positions[: count + 1], axis=0), axis=1)
        turned, told = self._turned(placed), slice(max(self._fresh - 1, 0), None)
        for way, bound, unit in (
            (np.maximum(moved, np.abs(np.diff(alongs[1:]))), speed, "m/s"),
            (turned, np.where(self._allowance.turns, np.inf, turn), "rad/s"),
        ):
            rates = way / dt
            high = bound * (1.0 + PROGRAM_EXCESS) + 2.0 * PATH_STEP / dt
            offends, use = ~(rates <= high), rates / high
            self._tallies.speed.add(rows[told], rates[told], bound[told], offends[told], use[told], unit)

    def _slow_between(self, placed: Placed, speed: Floats, acc: Floats) -> None:
        """Lower bounds of speeds (R,), where the way from the row before leads from one part to others, to
        what all of it allows; acc (R,) bounds it across."""
        legs, since = self._legs, np.concatenate([self._leg, placed.leg])
        self._leg = since[-1:]
        for row, stretches in placed.over.items():
            passed = slice(since[row], since[row + 1] + 1)
            fastest = stretches.fastest(
                float(np.max(legs.speed[passed], initial=speed[row])),
                float(np.max(legs.acc[passed], initial=acc[row])),
            )
            speed[row] = min(float(speed[row]), fastest)

    def _turned(self, placed: Placed) -> Floats:
        """Angles (R,) rad from row to row; where not all turns count, those of the path itself."""
        count = len(placed.along)
        if placed.wanted is None:
            return angle_between(self._waiting.rotations[1 : count + 1], self._waiting.rotations[:count])
        wanted = np.concatenate([self._wanted, placed.wanted])
        self._wanted = wanted[-1:]
        return angle_between(wanted[1:], wanted[:-1])

    def _add_acceleration(
        self, rows: Integers, placed: Placed, alongs: Floats, near: tuple[Integers, Integers, Integers]
    ) -> None:
        """Along the way; where it passes a sharp corner in all: ACC along and ACC across are the most."""
        legs, count = self._legs, len(rows)
        before, leg, behind = near
        allowed = np.where(placed.straight, legs.along[leg], legs.acc[leg])
        for other in (before, behind):
            allowed = np.where(other != leg, np.maximum(allowed, legs.acc[other]), allowed)
        bound = np.concatenate([self._accelerations, allowed])
        bound = np.max([bound[:-2], bound[1:-1], bound[2:]], axis=0)
        self._accelerations = np.concatenate([self._accelerations, allowed])[-2:]
        fresh = self._fresh
        self._add_rates(rows[fresh:], np.abs(np.diff(alongs, n=2))[fresh:], bound[fresh:])
        points = np.concatenate([self._points, self._waiting.positions[1 : count + 1]])
        self._points = points[-2:]
        sharp = np.concatenate([self._sharp, placed.sharp])
        self._sharp = sharp[-1:]
        turns: NDArray[np.bool_] = sharp[1:] | sharp[:-1]
        turns[:fresh] = False
        if turns.any():
            change = np.linalg.norm(np.diff(points, n=2, axis=0), axis=1)
            most = np.maximum(np.maximum(legs.acc[before], legs.acc[leg]), legs.acc[behind])
            self._add_rates(rows[turns], change[turns], sqrt(2.0) * most[turns])

    def _add_rates(self, rows: Integers, changes: Floats, bound: Floats) -> None:
        rates = changes / self._dt**2
        high = bound * (1.0 + PROGRAM_EXCESS) + 4.0 * PATH_STEP / self._dt**2
        self._tallies.acceleration.add(rows, rates, bound, ~(rates <= high), rates / high, "m/s2")

    def _untold(self, placed: Placed, legs: Integers) -> NDArray[np.bool_]:
        """Which rows (R,) lie on blends, or the first ones behind, of which rows tell no better than
        `PATH_POSITION` how long they are: those of C_PASS. `legs` (R + 1,) of the rows and of the one before.
        """
        may_be_less = np.array([False, *(leg.corner.may_be_less for leg in self._legs.legs)])
        passed = np.cumsum(may_be_less)
        on_one = ~placed.straight & (may_be_less[placed.leg] | may_be_less[placed.leg + 1])
        return np.asarray(on_one | (passed[legs[1:]] > passed[legs[:-1]]))

    def _add_jerk(
        self,
        rows: Integers,
        alongs: Floats,
        near: tuple[Integers, Integers, Integers],
        untold: NDArray[np.bool_],
    ) -> None:
        """Along the way, between four rows the most that is allowed at any of them."""
        allowed = np.max([self._legs.jerk[leg] for leg in near], axis=0)
        allowed[untold] = np.inf
        bound = np.concatenate([self._jerks, allowed])
        self._jerks = bound[-3:]
        told = slice(self._cornered, None)
        self._add_jerks(rows[told], alongs[told], bound[told])

    def _add_jerks(self, rows: Integers, alongs: Floats, bound: Floats) -> None:
        if self._lasts[-1] - self._firsts[0] < JERK_TICKS:
            add_jerk(self._tallies.jerk, rows, alongs, bound, self._dt)

    def _add_end(self, waiting: _Waiting) -> None:
        """The chain ends at its last target, all of its way having been run."""
        row, goal = self._lasts[-1:], self._chain[-1].end.pose
        assert goal is not None
        if not self._unknown and not self._cornered:
            # Behind it the tool stands.
            self._add_jerks(row, self._alongs[[0, 1, 2, 2]], self._jerks[[0, 1, 2, 2]])
        off = np.linalg.norm((waiting.positions[-1] - goal[0])[None], axis=1)
        self._tallies.goal[0].add(row, off, PATH_POSITION)
        attitude = waiting.rotations[-1:]
        self._tallies.goal[1].add(row, self._allowance.turned_off(attitude, goal[1][None]), PATH_ORIENTATION)
        if self._chain[-1].gives_orientation:
            self._tallies.goal[1].add_other(
                row, followed_off(attitude, goal[1]), FOLLOWED_TURN, PATH_ORIENTATION
            )
        missing = np.array([self._way.left - float(self._alongs[-1])])
        allowed = max(PATH_POSITION, self._unseen_way())
        self._tallies.progress.add(row, missing, allowed, rank=missing / allowed, unit="m")

    def _unseen_way(self) -> float:
        """How much of the way, m, may be run between two rows: legs that lead back to where the tool is, when
        a tick is enough for them, leave no trace."""
        legs, left = self._legs, slice(self._way.leg, None)
        if self._way.leg == len(legs.legs) - 1:
            return 0.0
        fastest = self._way.stretches_to_end().fastest(
            float(np.max(legs.speed[left])), float(np.max(legs.acc[left]))
        )
        return min(fastest * self._dt, float(np.min(legs.acc[left])) * self._dt**2)
