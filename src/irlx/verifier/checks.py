"""All checks of a stream in their order, and which of them need what."""

from __future__ import annotations

from collections.abc import Callable

from irlx.robot.description import RobotDescription
from irlx.streams.joint_stream import JointStream
from irlx.verifier.closure import check_closure
from irlx.verifier.evidence import Evidence
from irlx.verifier.geometry import check_goals, check_joint_moves, check_paths, check_tool
from irlx.verifier.limits import check_limits
from irlx.verifier.report import FAILED, NOT_CHECKED, OK, Check, Report
from irlx.verifier.structure import (
    check_blocks,
    check_complete,
    check_finite,
    check_frozen,
    check_robot,
    check_start,
    check_stops,
    check_ticks,
)

_SAMPLES = ("start", "position limits", "speed limits", "acceleration limits", "stops")
_BLOCKS = ("frozen joints", "PTP straight", "PTP progress", "joint goal")
_TOOL = ("tool position", "tool orientation")
_GEOMETRY = (
    "goal position",
    "goal orientation",
    "path position",
    "path orientation",
    "path progress",
    "cyclic closure",
)

CHECKS = ("complete", "ticks", "finite values", "blocks", "robot", *_SAMPLES, *_BLOCKS, *_TOOL, *_GEOMETRY)
"""Names of all checks in the order of a report; every report has all of them."""


def verify_stream(stream: JointStream, robot: RobotDescription | None) -> Report:
    """Check a stream against itself, its blocks, and the robot it is meant for.

    Nothing is taken from whatever made the stream: speeds and accelerations are backward differences
    of the samples, paths are rebuilt from the blocks, tool poses come from a forward kinematics of
    the verifier's own. What cannot be checked - geometry without a robot, moves without blocks,
    anything where the ticks have gaps - is 'not checked', with the reason.
    """
    found = [check_complete(stream), check_ticks(stream), check_finite(stream)]
    if any(check.status == FAILED for check in found[1:]):
        broken = next(check.name for check in found[1:] if check.status == FAILED)
        rest = [_not_checked(name, f"the check '{broken}' failed") for name in CHECKS[3:]]
        return Report((*found, *rest))
    of_robot = check_robot(stream, robot)
    evidence = Evidence(stream, robot if of_robot.status == OK else None)
    of_blocks = check_blocks(evidence)
    found += [of_blocks, of_robot, *_sample_checks(evidence, of_blocks)]
    no_robot = "" if evidence.robot is not None else of_robot.detail
    no_blocks = _why_no_blocks(of_blocks)
    found += _checked(_BLOCKS, lambda: [check_frozen(evidence), *check_joint_moves(evidence)], no_blocks)
    found += _checked(_TOOL, lambda: check_tool(evidence), no_robot)
    found += _checked(
        _GEOMETRY,
        lambda: [*check_goals(evidence), *check_paths(evidence), check_closure(evidence)],
        no_robot or no_blocks,
    )
    return Report(tuple(found))


def _sample_checks(evidence: Evidence, of_blocks: Check) -> list[Check]:
    """Checks that need samples only; limits also need blocks that fit, or none."""
    limits = ("position", "speed", "acceleration")
    units = {"position": "rad|m", "speed": "rad/s|m/s", "acceleration": "rad/s2|m/s2"}
    found = [check_start(evidence)]
    for kind in limits:
        name = f"{kind} limits"
        if of_blocks.status == FAILED:
            found.append(_not_checked(name, _why_no_blocks(of_blocks)))
            continue
        tally = evidence.tally(name, units[kind])
        check_limits(kind, evidence.stream, evidence.limits, tally)
        if of_blocks.status == NOT_CHECKED:
            tally.detail = "the robot's own limits only: the stream carries no blocks"
        found.append(tally.check())
    return [*found, check_stops(evidence)]


def _why_no_blocks(of_blocks: Check) -> str:
    if of_blocks.status == FAILED:
        return "the check 'blocks' failed"
    return of_blocks.detail if of_blocks.status == NOT_CHECKED else ""


def _checked(names: tuple[str, ...], make: Callable[[], list[Check]], why_not: str) -> list[Check]:
    """The checks that `make` gives, or all of these names as not checked."""
    return [_not_checked(name, why_not) for name in names] if why_not else make()


def _not_checked(name: str, why: str) -> Check:
    return Check(name, NOT_CHECKED, detail=why)
