"""Checks of what the tool does in moves: on its path, never backwards, no faster than told, at its goal."""

from __future__ import annotations

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
from irlx.verifier.moves import MoveRows
from irlx.verifier.report import Check
from irlx.verifier.rotations import angle_between
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
        self._resting = [move for move in evidence.moves if move.last == move.start]
        self._dt = evidence.outline.header.dt
        self._goal = evidence.tally("goal position", "m"), evidence.tally("goal orientation", "rad")
        self._path = evidence.tally("path position", "m"), evidence.tally("path orientation", "rad")
        self._progress = evidence.tally("path progress", "m|rad")
        self._speed = evidence.tally("programmed speed", "m/s|rad/s")
        self._acceleration = evidence.tally("programmed acceleration", "m/s2|rad/s2")
        self._time = evidence.tally("programmed time", "s")
        self._course: Course | None = None
        self._along = np.zeros(2)
        self._last_moving = 0
        self._skipped: set[int] = set()

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        while self._resting and (place := rows.place(self._resting[0].start)) is not None:
            move = self._resting.pop(0)
            pose = rows.positions[place], rows.rotations[place]
            self._add_goal(course_of(self._evidence, move, pose), pose)
        for stretch in rows.stretches:
            move_here = self._moving.get(stretch.block)
            if move_here is not None:
                self._add(rows, stretch, move_here)

    def _add(self, rows: Rows, stretch: Stretch, move: MoveRows) -> None:
        if stretch.begins or self._course is None:
            before = stretch.before.start
            self._course = course_of(self._evidence, move, (rows.positions[before], rows.rotations[before]))
            self._along = np.zeros(2)
        course = self._course
        self._add_time(rows, stretch, move)
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
        back = along[1:-1] - along[2:]
        self._progress.add(stretch.rows, back, PATH_STEP, rank=back / PATH_STEP, unit=unit)
        if stretch.ends and course.move.finished:
            # A full circle ends where it began: its goal does not tell whether it was run.
            missing = np.array([found.length - found.along[-1]])
            share = missing / PATH_POSITION
            self._progress.add(stretch.rows[-1:], missing, PATH_POSITION, rank=share, unit=unit)
        bound = course.acceleration(found.length, found.by_angle)
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

    def _add_time(self, rows: Rows, stretch: Stretch, move: MoveRows) -> None:
        """A move with TIME takes at least that, from where it starts to the last row that moves."""
        due = move.block.law.duration
        moving = (rows.postures[stretch.after] != rows.postures[stretch.before]).any(axis=1)
        if moving.any():
            self._last_moving = int(stretch.rows[np.flatnonzero(moving)[-1]])
        if due is not None and stretch.ends and move.finished:
            short = np.array([due - (self._last_moving - move.start) * self._dt])
            allowed = TICK_SHARE * self._dt
            self._time.add(stretch.rows[-1:], short, allowed)

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
