"""Checks of what the tool does in moves: on its path, never backwards, no faster than told, at its goal."""

from __future__ import annotations

from collections import deque

import numpy as np

from irlx.blocks import MoveKind
from irlx.promises import (
    PATH_ORIENTATION,
    PATH_POSITION,
    PATH_STEP,
    PROGRAM_EXCESS,
    TICK_SHARE,
    rounding_allowance,
)
from irlx.streams.joint_stream import Floats
from irlx.verifier.evidence import Evidence, Pose
from irlx.verifier.findings.finding import Check
from irlx.verifier.geometry.paths import LineWay
from irlx.verifier.geometry.rotations import angle_between
from irlx.verifier.moves import MoveRows
from irlx.verifier.rows import Rows, Stretch
from irlx.verifier.way import Course, course_of

_OTHER_FRAME = "targets in other frames than R_BASE cannot be placed"
_UNPLACED = f"the stream's {_OTHER_FRAME}"


class ToolMoveChecks:
    """Every row of a LIN or CIRCLE against its path and its programmed speeds, the end of every move against
    its goal, and the joints of a PTP against the share of their limits that the program allows."""

    def __init__(self, evidence: Evidence) -> None:
        self._evidence = evidence
        self._moving = {move.block.id: move for move in evidence.moves if move.last > move.start}
        self._resting = deque(move for move in evidence.moves if move.last == move.start)
        self._dt = evidence.outline.header.dt
        self._goal = evidence.tally("goal position", "m"), evidence.tally("goal orientation", "rad")
        self._path = evidence.tally("path position", "m"), evidence.tally("path orientation", "rad")
        self._progress = evidence.tally("path progress", "m|rad")
        self._speed = evidence.tally("programmed speed", "m/s|rad/s")
        self._acceleration = evidence.tally("programmed acceleration", "m/s2|rad/s2")
        self._time = evidence.tally("programmed time", "s")
        self._course: Course | None = None
        self._along, self._furthest = np.zeros(2), 0.0
        self._skipped: set[int] = set()

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        while self._resting and (place := rows.place(self._resting[0].start)) is not None:
            self._add_resting(self._resting.popleft(), (rows.positions[place], rows.rotations[place]))
        for stretch in rows.stretches:
            move_here = self._moving.get(stretch.block)
            if move_here is not None:
                self._add(rows, stretch, move_here)

    def _add_resting(self, move: MoveRows, pose: Pose) -> None:
        """A move without rows must have no way to go."""
        course = course_of(self._evidence, move, pose)
        self._add_goal(course, pose)
        if course.way is not None and move.finished:
            row, missing = np.array([move.last]), np.array([course.way.length])
            self._progress.add(row, missing, PATH_POSITION, rank=missing / PATH_POSITION)

    def _add(self, rows: Rows, stretch: Stretch, move: MoveRows) -> None:
        if stretch.begins or self._course is None:
            before = stretch.before.start
            self._course = course_of(self._evidence, move, (rows.positions[before], rows.rotations[before]))
            self._along, self._furthest = np.zeros(2), 0.0
        course = self._course
        if stretch.ends and move.finished:
            self._add_time(rows, stretch, course)
        if move.block.kind is MoveKind.PTP:
            self._add_joint_rates(rows, stretch, move)
        elif course.way is not None:
            self._add_path(rows, stretch, course)
            self._add_tool_speed(rows, stretch, course)
        elif course.goal is None:
            self._skipped.add(move.block.id)
        else:
            # Points that make no circle: nothing can be on it.
            endless = np.full(len(stretch.rows), np.inf)
            self._path[0].add(stretch.rows, endless, PATH_POSITION)
        if stretch.ends:
            last = stretch.after.stop - 1
            self._add_goal(course, (rows.positions[last], rows.rotations[last]))

    def _add_goal(self, course: Course, reached: Pose) -> None:
        move, goal = course.move, course.goal
        if not move.finished:
            return
        if goal is None:
            self._skipped.add(move.block.id)
            return
        row = np.array([move.last])
        self._goal[0].add(row, np.linalg.norm((reached[0] - goal[0])[None], axis=1), PATH_POSITION)
        self._goal[1].add(row, angle_between(reached[1], goal[1])[None], PATH_ORIENTATION)

    def _add_path(self, rows: Rows, stretch: Stretch, course: Course) -> None:
        assert course.way is not None
        found = course.way.deviation(rows.positions[stretch.after], rows.rotations[stretch.after])
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
        bound = course.move.block.law.acc_ori if short_arc else course.bounds[1]
        self._add_acceleration(stretch, along, bound, "rad/s2" if found.by_angle else "m/s2")
        self._along = along[-2:]

    def _add_acceleration(self, stretch: Stretch, along: Floats, bound: float, unit: str) -> None:
        rates = np.abs(np.diff(along, n=2)) / self._dt**2
        high = bound * (1.0 + PROGRAM_EXCESS) + 4.0 * PATH_STEP / self._dt**2
        self._acceleration.add(stretch.rows, rates, bound, ~(rates <= high), rates / high, unit)

    def _add_tool_speed(self, rows: Rows, stretch: Stretch, course: Course) -> None:
        here, before = stretch.after, stretch.before
        moved = np.linalg.norm(rows.positions[here] - rows.positions[before], axis=1)
        turned = angle_between(rows.rotations[here], rows.rotations[before])
        for way, bound, unit in (
            (moved, course.speed, "m/s"),
            (turned, course.move.block.law.speed_ori, "rad/s"),
        ):
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

    def _add_joint_rates(self, rows: Rows, stretch: Stretch, move: MoveRows) -> None:
        """A PTP uses at most its share of every joint's limits, where these are finite."""
        limits, law = self._evidence.limits, move.block.law
        allowances = rounding_allowance(np.array([self._evidence.outline.largest]), self._dt)
        for kind, values, share, allowance, tally in (
            ("speed", rows.qd, law.speed_ptp, allowances[0], self._speed),
            ("acceleration", rows.qdd, law.acc_ptp, allowances[1], self._acceleration),
        ):
            lower, upper = limits.bounds(kind, int(stretch.rows[0]), len(stretch.rows))
            rates = values[stretch.part]
            bound = np.where(rates > 0.0, upper, -lower) * share
            high = bound * (1.0 + PROGRAM_EXCESS) + allowance
            finite = np.isfinite(bound)
            use = np.where(finite, np.abs(rates) / high, -np.inf)
            tally.add(stretch.rows, np.abs(rates), bound, finite & ~(np.abs(rates) <= high), use)

    def checks(self) -> list[Check]:
        """Goals, paths, programmed speed, acceleration and time."""
        tallies = (*self._goal, *self._path, self._progress, self._speed, self._acceleration)
        if self._skipped:
            for tally in tallies:
                tally.detail = f"{len(self._skipped)} moves not checked: {_OTHER_FRAME}"
        of_tool = [tally.check(_UNPLACED if self._skipped else "") for tally in tallies]
        return [*of_tool, self._time.check()]
