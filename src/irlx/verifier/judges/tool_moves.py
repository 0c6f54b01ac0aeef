"""Checks of what the tool does in moves: on its path, never backwards, no faster than told, at its goal."""

from __future__ import annotations

from collections import deque
from itertools import pairwise

import numpy as np

from irlx.blocks import MoveKind
from irlx.promises import (
    FOLLOWED_TURN,
    JERK_TICKS,
    PATH_ORIENTATION,
    PATH_POSITION,
    PATH_STEP,
    PROGRAM_EXCESS,
    TICK_SHARE,
    TOLERANCE_BAND,
    rounding_allowance,
)
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.chain_legs import NoCurve, Unplaced, jerk_of, legs_of
from irlx.verifier.demands import Demand
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import Check
from irlx.verifier.geometry.allowance import EXACT, Allowance
from irlx.verifier.geometry.paths import LineWay
from irlx.verifier.geometry.rotations import angle_between
from irlx.verifier.geometry.task_turns import followed_off
from irlx.verifier.judges.chained_moves import HANDS_OVER, ChainRows, ChainTallies
from irlx.verifier.judges.jerk import add_jerk
from irlx.verifier.moves import MoveRows
from irlx.verifier.rows import Rows, Stretch
from irlx.verifier.tools import Pose
from irlx.verifier.way import Course, course_of

_OTHER_FRAME = "targets in other frames than R_BASE cannot be placed"


class ToolMoveChecks:
    """Every row of a LIN or CIRCLE against its path and its programmed speeds, the end of every move against
    its goal, and the joints of a PTP against the share of their limits that the program allows."""

    def __init__(self, evidence: Evidence) -> None:
        self._evidence = evidence
        alone = [move for move in evidence.moves if move.block.id not in evidence.chained]
        self._moving = {move.block.id: move for move in alone if move.last > move.start}
        self._resting = deque(move for move in alone if move.last == move.start)
        self._dt = evidence.outline.header.dt
        self._goal = evidence.tally("goal position", "m"), evidence.tally("goal orientation", "rad")
        self._path = evidence.tally("path position", "m"), evidence.tally("path orientation", "rad")
        self._progress = evidence.tally("path progress", "m|rad")
        self._speed, self._acceleration = evidence.joint_rates
        self._jerk = evidence.tally("programmed jerk", "m/s3")
        self._time = evidence.tally("programmed time", "s")
        self._bands = evidence.tally("tolerance bands", "m|rad")
        self._course: Course | None = None
        self._along, self._furthest = np.zeros(3), 0.0
        self._wanted = np.eye(3)[None]
        self._skipped: dict[int, str] = {}
        self._chains = {demand.move.block.id: chain for chain in evidence.chains for demand in chain}
        self._chain: ChainRows | None = None
        self._neighbours = _neighbours(list(evidence.demands.values()))
        self._before = {number: before for before, number in pairwise(evidence.demands)}
        for chain in evidence.chains:
            if chain[0].move.start == chain[-1].move.last:
                self._add_resting_chain(chain)
        for demand in evidence.demands.values():
            self._add_joined_time(demand)

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        while self._resting and (place := rows.place(self._resting[0].start)) is not None:
            move = self._resting.popleft()
            self._add_resting(move, rows.pose(place, move.block.id))
        for stretch in rows.stretches:
            move_here = self._moving.get(stretch.block)
            if move_here is not None:
                self._add(rows, stretch, move_here)
            elif stretch.block in self._chains:
                self._add_chained(rows, stretch, self._chains[stretch.block])

    def _add_chained(self, rows: Rows, stretch: Stretch, chain: tuple[Demand, ...]) -> None:
        """Rows of moves that run into each other, or along a PATH."""
        if stretch.begins and stretch.rows[0] == chain[0].move.start + 1:
            self._chain = self._chain_of(chain)
        if self._chain is None:
            # Where no curve leads, nothing can be on it.
            if chain[0].move.block.id not in self._skipped:
                self._path[0].add(stretch.rows, np.full(len(stretch.rows), np.inf), PATH_POSITION)
            return
        here = stretch.after
        final = int(stretch.rows[-1]) == chain[-1].move.last
        self._chain.take((rows.positions[here], rows.attitudes[here]), stretch.rows, stretch.block, final)

    def _chain_of(self, chain: tuple[Demand, ...]) -> ChainRows | None:
        tallies = ChainTallies(
            self._goal, self._path, self._progress, self._speed, self._acceleration, self._jerk
        )
        try:
            return ChainRows(chain, legs_of(chain, self._dt), self._dt, tallies, self._start_reach(chain[0]))
        except Unplaced as error:
            self._skipped |= {demand.move.block.id: str(error) for demand in chain}
        except NoCurve:
            pass
        return None

    def _start_reach(self, demand: Demand) -> float:
        """How far from its start a move of the tool may be off its way: as far as the PTP before it led."""
        if not demand.crosses[0]:
            return 0.0
        return self._evidence.reaches.get(-self._before[demand.move.block.id], np.inf)

    def _add_resting_chain(self, chain: tuple[Demand, ...]) -> None:
        """A chain without rows must have no way to go."""
        rows = self._chain_of(chain)
        start = chain[0].start.pose
        if rows is not None and start is not None:
            nothing = np.zeros((0, 3)), np.zeros((0, 3, 3))
            rows.take(nothing, np.zeros(0, dtype=np.int64), chain[0].move.block.id, True)

    def _add_resting(self, move: MoveRows, pose: Pose) -> None:
        """A move without rows must have no way to go."""
        course = course_of(self._evidence, move, self._start(pose, move))
        self._add_goal(course, pose)
        if course.way is not None and move.finished:
            row, missing = np.array([move.last]), np.array([course.way.length])
            self._progress.add(row, missing, PATH_POSITION, rank=missing / PATH_POSITION)

    def _start(self, pose: Pose, move: MoveRows) -> Pose:
        """Where the path of a move starts: the pose in the row before, or that off which the tool stands."""
        start = self._evidence.demands[move.block.id].start.pose
        return pose if start is None or move.block.tolerance is None else start

    def _add(self, rows: Rows, stretch: Stretch, move: MoveRows) -> None:
        if stretch.begins or self._course is None:
            before = stretch.before.start
            self._course = course_of(
                self._evidence, move, self._start(rows.pose(before, move.block.id), move)
            )
            self._along, self._furthest = np.zeros(3), 0.0
        course = self._course
        demand = self._evidence.demands[move.block.id]
        if stretch.ends and move.finished and not (demand.passes or demand.follows):
            self._add_time(rows, stretch, course)
        if move.block.kind is MoveKind.PTP:
            # Beside a move of the tool its rows are judged by `CrossingPtps`.
            if not any(demand.crosses):
                self._add_joint_rates(rows, stretch, move)
        elif course.way is not None:
            allowance, wanted = demand.allowance, None
            if allowance.hides(course.way):
                self._add_shifted(rows, stretch, course, allowance)
            else:
                wanted = self._add_path(rows, stretch, course, allowance)
            self._add_tool_speed(rows, stretch, course, allowance, wanted)
        elif course.goal is None:
            self._skipped[move.block.id] = _OTHER_FRAME
        else:
            # Points that make no circle: nothing can be on it.
            endless = np.full(len(stretch.rows), np.inf)
            self._path[0].add(stretch.rows, endless, PATH_POSITION)
        if stretch.ends:
            last = stretch.after.stop - 1
            self._add_goal(course, (rows.positions[last], rows.rotations[last]))

    def _add_goal(self, course: Course, reached: Pose) -> None:
        move, goal = course.move, course.goal
        demand = self._evidence.demands[move.block.id]
        if not move.finished or demand.passes:
            return
        if demand.follows:
            goal = demand.end.pose
        if goal is None:
            self._skipped[move.block.id] = _OTHER_FRAME
            return
        row = np.array([move.last])
        allowance = demand.allowance
        # In the frame of the goal, where there is anything to allow.
        apart = (reached[0] - goal[0])[None]
        attitude = self._evidence.placer.attitude(reached[1], self._evidence.posture(move.last))
        frame = allowance.frames(attitude, goal[1][None])[0]
        left = allowance.shifted_off(apart @ frame) if allowance.shifts else apart
        self._goal[0].add(row, np.linalg.norm(left, axis=1), PATH_POSITION)
        self._goal[1].add(row, allowance.turned_off(attitude, goal[1][None]), PATH_ORIENTATION)
        if demand.gives_orientation:
            self._goal[1].add_other(row, followed_off(attitude, goal[1]), FOLLOWED_TURN, PATH_ORIENTATION)
        self._add_bands(row, allowance, (reached[0][None], attitude), (goal[0][None], goal[1][None]))

    def _add_bands(self, rows: Integers, allowance: Allowance, tool: Pose, asked: Pose) -> None:
        """Positions (R, 3) and attitudes (R, ..) of the tool within the bands about the poses asked for."""
        if allowance is not EXACT:
            passed = allowance.excess(*tool, asked)
            unit = "m|rad" if allowance.shifts and allowance.turns else "m" if allowance.shifts else "rad"
            self._bands.add(rows, passed, TOLERANCE_BAND, rank=passed / TOLERANCE_BAND, unit=unit)

    def _add_shifted(self, rows: Rows, stretch: Stretch, course: Course, allowance: Allowance) -> None:
        """Rows of a move whose tool may stand beside its path: what of it is beyond the bands.

        The place on the path is sought off which the tool stands within them. Of several nobody can tell
        which was asked for, so that speeds along the path are not judged, and its progress up to that.
        """
        assert course.way is not None
        here = stretch.after
        positions, attitudes = rows.positions[here], rows.attitudes[here]
        asked = allowance.asked(course.way, positions, attitudes)
        frames = allowance.frames(attitudes, asked[1])
        left = allowance.shifted_off(np.einsum("rji,rj->ri", frames, positions - asked[0]))
        self._path[0].add(stretch.rows, np.linalg.norm(left, axis=1), PATH_POSITION)
        self._path[1].add(stretch.rows, allowance.turned_off(attitudes, asked[1]), PATH_ORIENTATION)
        self._add_bands(stretch.rows, allowance, (positions, attitudes), asked)
        self._add_shifted_progress(stretch, course, positions, allowance.farthest + PATH_POSITION)

    def _add_shifted_progress(
        self, stretch: Stretch, course: Course, positions: Floats, aside: float
    ) -> None:
        """Never backwards and to the end, but for what a tool up to `aside` m beside its path may pretend."""
        assert course.way is not None
        along, off = course.way.travelled(positions, aside)
        if not np.isfinite(off):
            return
        furthest = np.maximum.accumulate(np.concatenate([[self._furthest], along]))
        back = furthest[:-1] - along
        self._furthest = float(furthest[-1])
        self._progress.add(stretch.rows, back, 2.0 * off, rank=back / (2.0 * off), unit="m")
        if stretch.ends and course.move.finished:
            missing = np.array([course.way.length - along[-1]])
            self._progress.add(stretch.rows[-1:], missing, off, rank=missing / off, unit="m")

    def _add_path(self, rows: Rows, stretch: Stretch, course: Course, allowance: Allowance) -> Floats | None:
        """Judge rows against their path; the path's own orientation there where not all turns count."""
        assert course.way is not None
        if allowance.turns:
            tool = rows.positions[stretch.after], rows.attitudes[stretch.after]
            self._add_bands(stretch.rows, allowance, tool, allowance.asked(course.way, *tool))
        found = course.way.deviation(rows.positions[stretch.after], rows.attitudes[stretch.after])
        self._path[0].add(stretch.rows, found.position, PATH_POSITION)
        self._path[1].add(stretch.rows, found.orientation, PATH_ORIENTATION)
        along = np.concatenate([self._along, found.along])
        unit = "rad" if found.by_angle else "m"
        # Against the furthest row so far: small steps back must not add up.
        furthest = np.maximum.accumulate(np.concatenate([[self._furthest], found.along]))
        back = furthest[:-1] - found.along
        self._furthest = float(furthest[-1])
        self._progress.add(stretch.rows, back, PATH_STEP, rank=back / PATH_STEP, unit=unit)
        if stretch.ends and course.move.finished:
            # A full circle ends where it began: its goal does not tell whether it was run.
            missing = np.array([found.length - found.along[-1]])
            share = missing / PATH_POSITION
            self._progress.add(stretch.rows[-1:], missing, PATH_POSITION, rank=share, unit=unit)
        # An arc too short to be one goes by its chord, perhaps by the angle.
        short_arc = found.by_angle and not isinstance(course.way, LineWay)
        bound = course.move.law.acc_ori if short_arc else course.bounds[1]
        self._add_acceleration(stretch, along[1:], bound, "rad/s2" if found.by_angle else "m/s2")
        if not found.by_angle:
            self._add_jerk(stretch, along, course.move)
        self._along = along[-3:]
        return found.wanted

    def _add_acceleration(self, stretch: Stretch, along: Floats, bound: float, unit: str) -> None:
        rates = np.abs(np.diff(along, n=2)) / self._dt**2
        high = bound * (1.0 + PROGRAM_EXCESS) + 4.0 * PATH_STEP / self._dt**2
        self._acceleration.add(stretch.rows, rates, bound, ~(rates <= high), rates / high, unit)

    def _add_jerk(self, stretch: Stretch, along: Floats, move: MoveRows) -> None:
        rows, bound = stretch.rows, jerk_of(move.law)
        if move.last - move.start > JERK_TICKS:
            return
        if stretch.ends and move.finished:
            # Behind its end the tool stands.
            along, rows = np.append(along, along[-1]), np.append(rows, rows[-1])
        add_jerk(self._jerk, rows, along, np.full(len(along), bound), self._dt)

    def _add_tool_speed(
        self, rows: Rows, stretch: Stretch, course: Course, allowance: Allowance, wanted: Floats | None
    ) -> None:
        """No faster than programmed, in what no band leaves to the robot."""
        here = stretch.after
        positions, rotations = rows.before(stretch)
        moved = np.linalg.norm(rows.positions[here] - positions, axis=1)
        if wanted is None:
            turned = angle_between(rows.rotations[here], rotations)
        else:
            # What of a turn does not count may make the rest of it any faster: the path itself is judged.
            begins = self._evidence.demands[course.move.block.id].start.pose
            start = begins[1][None] if stretch.begins and begins is not None else self._wanted
            passed = np.concatenate([start, wanted])
            self._wanted, turned = passed[-1:], angle_between(passed[1:], passed[:-1])
        for way, bound, unit, is_free in (
            (moved, course.speed, "m/s", allowance.shifts),
            (turned, course.move.law.speed_ori, "rad/s", allowance.turns),
        ):
            if is_free:
                continue
            rates = way / self._dt
            high = bound * (1.0 + PROGRAM_EXCESS) + 2.0 * PATH_STEP / self._dt
            self._speed.add(stretch.rows, rates, bound, ~(rates <= high), rates / high, unit)

    def _add_time(self, rows: Rows, stretch: Stretch, course: Course) -> None:
        """From its start to its hold tick a move takes at least what TIME, or SPEED and ACC, ask for."""
        move, due = course.move, course.shortest
        last = stretch.part.stop
        held = np.array_equal(rows.postures[last], rows.postures[last - 1])
        short = np.array([due - (move.last - move.start - held) * self._dt])
        allowed = TICK_SHARE * self._dt + PROGRAM_EXCESS * due
        self._time.add(stretch.rows[-1:], short, allowed, rank=short / allowed)

    def _add_joined_time(self, demand: Demand) -> None:
        """A joined move, or one along a PATH, takes its TIME from hand-over to hand-over, in ticks."""
        move, due = demand.move, demand.move.law.duration
        joined = demand.passes or demand.follows
        if due is None or not move.finished or not (joined or move.block.id in self._chains):
            return
        short = np.array([due - (move.last - move.start) * self._dt])
        allowed = (HANDS_OVER if joined else TICK_SHARE) * self._dt + PROGRAM_EXCESS * due
        self._time.add(np.array([move.last]), short, allowed, rank=short / allowed)

    def _add_joint_rates(self, rows: Rows, stretch: Stretch, move: MoveRows) -> None:
        """A PTP uses at most its share of every joint's limits, where these are finite."""
        limits = self._evidence.limits
        shares = self._shares(move, stretch)
        allowances = rounding_allowance(np.array([self._evidence.outline.largest]), self._dt)
        for kind, values, share, allowance, tally in (
            ("speed", rows.qd, shares[0], allowances[0], self._speed),
            ("acceleration", rows.qdd, shares[1], allowances[1], self._acceleration),
        ):
            lower, upper = limits.bounds(kind, int(stretch.rows[0]), len(stretch.rows))
            rates = values[stretch.part]
            bound = np.where(rates > 0.0, upper, -lower) * share[:, None]
            high = bound * (1.0 + PROGRAM_EXCESS) + allowance
            finite = np.isfinite(bound)
            use = np.where(finite, np.abs(rates) / high, -np.inf)
            tally.add(stretch.rows, np.abs(rates), bound, finite & ~(np.abs(rates) <= high), use)

    def _shares(self, move: MoveRows, stretch: Stretch) -> Floats:
        """Shares (2, R) of the speed and acceleration limits; where a PTP hands over, the larger."""
        found = np.tile(np.array([[move.law.speed_ptp], [move.law.acc_ptp]]), len(stretch.rows))
        before, behind = self._neighbours.get(move.block.id, (None, None))
        for other, near in (
            (before, stretch.rows - move.start <= HANDS_OVER + 1),
            (behind, move.last - stretch.rows < HANDS_OVER),
        ):
            if other is not None:
                shares = np.array([[other.law.speed_ptp], [other.law.acc_ptp]])
                found = np.where(near, np.maximum(found, shares), found)
        return found

    def checks(self) -> list[Check]:
        """Goals, paths, programmed speed, acceleration and time."""
        tallies = (*self._goal, *self._path, self._progress, self._speed, self._acceleration, self._jerk)
        reason = "; ".join(sorted(set(self._skipped.values())))
        if self._skipped:
            for tally in tallies:
                tally.detail = f"{len(self._skipped)} moves not checked: {reason}"
        of_tool = [tally.check(f"the stream's {reason}" if self._skipped else "") for tally in tallies]
        return [*of_tool, self._time.check(), self._bands.check()]


def _neighbours(demands: list[Demand]) -> dict[int, tuple[MoveRows | None, MoveRows | None]]:
    """For moves that run into each other, the one before and the one behind, None where it stands."""
    moves = [None, *(demand.move for demand in demands), None]
    return {
        demand.move.block.id: (
            moves[number] if demand.follows else None,
            moves[number + 2] if demand.passes else None,
        )
        for number, demand in enumerate(demands)
        if demand.follows or demand.passes
    }
