"""All checks of a stream in their order, and which of them need what."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Protocol

import numpy as np

from irlx.diagnostics import Diagnostic
from irlx.robot.description import RobotDescription
from irlx.robot.limits import JointLimits
from irlx.streams.error import StreamError
from irlx.streams.joint_stream import JointStream
from irlx.streams.scan import scan_of
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import FAILED, NO_CASE, NOT_CHECKED, OK, Check, Subject
from irlx.verifier.findings.report import Report
from irlx.verifier.judges.clearance import ClearanceChecks
from irlx.verifier.judges.closure import ClosureChecks
from irlx.verifier.judges.conditions import ConditionChecks
from irlx.verifier.judges.joint_moves import JointMoveChecks
from irlx.verifier.judges.limits_kept import LimitChecks, StartCheck
from irlx.verifier.judges.provenance import RateChecks, Reference, ToolChecks, check_robot, check_robot_limits
from irlx.verifier.judges.reconfigurations import ReconfigurationChecks
from irlx.verifier.judges.stillness import FrozenChecks, StopChecks, WaitChecks
from irlx.verifier.judges.tool_moves import ToolMoveChecks
from irlx.verifier.moves import check_blocks
from irlx.verifier.outline import Outline, Scans, check_complete, check_finite, check_ticks, outline_of
from irlx.verifier.remembered import Remembered
from irlx.verifier.rows import Rows, rows_of

ProgramCheck = Callable[[Outline], Check]
"""Compares the blocks of a stream with those of a program."""

CHECKS = (
    "file",
    "complete",
    "ticks",
    "finite values",
    "written rates",
    "blocks",
    "program",
    "robot",
    "robot limits",
    "start",
    "position limits",
    "speed limits",
    "acceleration limits",
    "stops",
    "waits still",
    "waiting time",
    "frozen joints",
    "constraints",
    "clearance",
    "PTP straight",
    "PTP progress",
    "joint goal",
    "tool position",
    "tool orientation",
    "goal position",
    "goal orientation",
    "path position",
    "path orientation",
    "tolerance bands",
    "path progress",
    "programmed speed",
    "programmed acceleration",
    "programmed jerk",
    "programmed time",
    "reconfiguration position",
    "reconfiguration orientation",
    "reconfiguration speed",
    "cyclic closure",
)
"""Names of all checks in the order of a report; every report has all of them."""

_ANYWAY = ("written rates", "start", "stops")
_LIMITS = CHECKS[10:13]
_OF_CELL = ("constraints",)
_CLEARANCE = ("clearance",)
_BLOCKS = ("waits still", "waiting time", "frozen joints", "PTP straight", "PTP progress", "joint goal")
_TOOL = CHECKS[22:24]
_MOVES = CHECKS[24:]

_HEADER_DAMAGE = ("IRL701", "IRL705", "IRL706")


class RowChecks(Protocol):
    """Checks that look at a stream's rows once, in order, portion by portion."""

    def __init__(self, evidence: Evidence) -> None: ...

    def take(self, rows: Rows) -> None:
        """Look at the next portion."""

    def checks(self) -> list[Check]:
        """What was found, all rows having been taken."""


def verify_stream(
    stream: JointStream,
    robot: RobotDescription | None,
    limits: JointLimits | None = None,
    may_lack_blocks: bool = False,
) -> Report:
    """Check a stream in memory against itself, its blocks, and the robot it is meant for; see `verify_scans`.

    With `limits` those that the stream gives as the robot's own must be these.
    """
    reference = None if robot is None else Reference(robot, limits)
    name = stream.header.program_name
    return verify_scans(partial(scan_of, stream), reference, name, may_lack_blocks=may_lack_blocks)


def verify_scans(
    scans: Scans,
    reference: Reference | None,
    name: str,
    program: ProgramCheck | None = None,
    is_file: bool = False,
    may_lack_blocks: bool = False,
) -> Report:
    """Check a stream that can be scanned again and again, in portions: memory does not grow with its length.

    Nothing is taken from whatever made the stream: speeds and accelerations are backward differences
    of the samples, paths are rebuilt from the blocks, tool poses come from a forward kinematics of
    the verifier's own. What cannot be checked - geometry without a robot, moves without blocks,
    anything where the ticks have gaps - is 'not checked', with the reason. A damaged file fails the check
    'file'; raises StreamError where there is no file to read. Only a stream that `may_lack_blocks`, its
    format having no place for them, may have none.
    """
    scans = Remembered(scans)
    try:
        outline = outline_of(scans)
    except StreamError as error:
        if error.reason.code not in _HEADER_DAMAGE:
            raise
        found = [_file_check(error.reason)]
        return _report(found, "nothing of the stream can be read", Subject(name))
    header = outline.header
    subject = Subject(name, header.program_name, header.robot_name, outline.rows, header.tick_ns)
    found = [
        _file_check(outline.damage) if is_file else Check("file", NO_CASE, detail="not a file"),
        check_complete(outline),
        check_ticks(outline),
        check_finite(outline),
        check_robot(header, reference),
    ]
    found.append(check_robot_limits(header, reference, found[-1].status == FAILED))
    why_not = _unreadable(outline, found)
    if why_not:
        return _report(found, why_not, subject)
    # Values too large to square are found by what follows: infinite, or no number, they pass no comparison.
    with np.errstate(all="ignore"):
        of_robot = next(check for check in found if check.name == "robot")
        found += _judged(scans, outline, of_robot, reference, program, may_lack_blocks)
    return _report(found, "", subject)


def _judged(
    scans: Scans,
    outline: Outline,
    of_robot: Check,
    reference: Reference | None,
    program: ProgramCheck | None,
    may_lack_blocks: bool,
) -> list[Check]:
    """Checks of blocks and rows, the stream being whole enough for them."""
    robot = reference.robot if reference is not None and of_robot.status == OK else None
    start = None if robot is None or reference is None else reference.start
    relations = () if robot is None or reference is None else reference.relations
    of_blocks = check_blocks(outline, may_lack_blocks)
    scene = None if robot is None or reference is None else reference.scene
    evidence = Evidence(outline, robot, start, relations, of_blocks.status != FAILED, scene)
    no_blocks = "the check 'blocks' failed" if of_blocks.status == FAILED else of_blocks.detail
    no_robot = of_robot.detail if of_robot.status == NOT_CHECKED else "the check 'robot' failed"
    no_robot = "" if robot is not None else no_robot
    groups: list[tuple[tuple[str, ...], str, list[type[RowChecks]]]] = [
        (_ANYWAY, "", [RateChecks, StartCheck, StopChecks]),
        (_LIMITS, no_blocks if of_blocks.status == FAILED else "", [LimitChecks]),
        (_OF_CELL, no_robot, [ConditionChecks]),
        (_CLEARANCE, no_blocks or no_robot, [ClearanceChecks]),
        (_BLOCKS, no_blocks, [WaitChecks, FrozenChecks, JointMoveChecks]),
        (_TOOL, no_robot, [ToolChecks]),
        (_MOVES, no_blocks or no_robot, [ToolMoveChecks, ReconfigurationChecks, ClosureChecks]),
    ]
    judges = [make(evidence) for _, why_not, kinds in groups if not why_not for make in kinds]
    for rows in rows_of(scans, outline, robot):
        for judge in judges:
            judge.take(rows)
    found = [of_blocks, _program(program, outline, of_blocks)]
    found += [check for judge in judges for check in judge.checks()]
    skipped = ((name, why_not) for names, why_not, _ in groups if why_not for name in names)
    return found + [Check(name, NOT_CHECKED, detail=why_not) for name, why_not in skipped]


def _program(program: ProgramCheck | None, outline: Outline, of_blocks: Check) -> Check:
    if program is None:
        return Check("program", NOT_CHECKED, detail="no program is given")
    if of_blocks.status == FAILED:
        return Check("program", NOT_CHECKED, detail="the check 'blocks' failed")
    return program(outline)


def _file_check(damage: Diagnostic | None) -> Check:
    if damage is None:
        return Check("file", OK)
    where = f"{damage.place.key}: " if damage.place is not None and damage.place.key else ""
    return Check("file", FAILED, detail=f"{damage.code}: {where}{damage.message}")


def _unreadable(outline: Outline, found: list[Check]) -> str:
    """Why the rows cannot be judged, or ''."""
    if outline.damage is not None and not outline.end_in_doubt:
        return "the file is damaged"
    needed = ("ticks", "finite values")
    broken = [check.name for check in found if check.name in needed and check.status == FAILED]
    return f"the check '{broken[0]}' failed" if broken else ""


def _report(found: list[Check], why_not: str, subject: Subject) -> Report:
    """Report with all checks in their order; those that were not made have a reason."""
    by_name = {check.name: check for check in found}
    reason = why_not or "the check 'blocks' failed"
    checks = tuple(by_name.get(name, Check(name, NOT_CHECKED, detail=reason)) for name in CHECKS)
    return Report(checks, subject)
