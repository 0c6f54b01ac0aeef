"""Checks of the stream as such: complete, ticks, finite values, blocks, robot, rest at the end of moves."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import FreezeBlock
from irlx.robot.description import RobotDescription
from irlx.streams.joint_stream import Floats, JointStream
from irlx.verifier.evidence import Evidence
from irlx.verifier.limits import add_positions
from irlx.verifier.moves import misfit, segments
from irlx.verifier.report import FAILED, NOT_CHECKED, OK, Check, Finding


def check_complete(stream: JointStream) -> Check:
    """The run came to its end."""
    last = f"the run ended early, after {len(stream.ticks)} samples"
    return Check("complete", OK) if stream.complete else Check("complete", FAILED, detail=last)


def check_ticks(stream: JointStream) -> Check:
    """Ticks count 0, 1, 2, .. without a gap."""
    ticks = stream.ticks
    if len(ticks) == 0:
        return Check("ticks", FAILED, detail="the stream has no samples")
    due = np.arange(len(ticks))
    wrong = ticks != due
    if not wrong.any():
        return Check("ticks", OK)
    row = int(np.argmax(wrong))
    found = Finding(float(ticks[row]), float(row), int(ticks[row]), block=int(stream.block[row]))
    detail = f"tick {ticks[row]} stands where tick {row} is due"
    return Check("ticks", FAILED, worst=found, first=found, detail=detail)


def check_finite(stream: JointStream) -> Check:
    """Joint values and tool poses are finite numbers."""
    whole = np.isfinite(stream.q).all(axis=1) & np.isfinite(stream.tool).all(axis=1)
    if whole.all():
        return Check("finite values", OK)
    row = int(np.argmin(whole))
    odd = np.flatnonzero(~np.isfinite(stream.q[row]))
    joint = stream.header.joint_names[odd[0]] if odd.size else None
    value = float(stream.q[row, odd[0]]) if odd.size else float("nan")
    found = Finding(value, np.inf, int(stream.ticks[row]), joint, int(stream.block[row]))
    return Check("finite values", FAILED, worst=found, first=found)


def check_blocks(evidence: Evidence) -> Check:
    """Every sample belongs to a recorded move, which begins right after the row it was recorded at."""
    if not evidence.carries_blocks:
        return Check("blocks", NOT_CHECKED, detail="the stream carries no blocks")
    found = misfit(evidence.stream)
    if found is None:
        return Check("blocks", OK)
    return Check("blocks", FAILED, detail=f"at tick {found[0]}: {found[1]}")


def check_robot(stream: JointStream, robot: RobotDescription | None) -> Check:
    """The stream was made for this robot: same fingerprint, same joints."""
    if robot is None:
        return Check("robot", NOT_CHECKED, detail="no robot was given")
    header = stream.header
    if robot.joint_names != header.joint_names:
        detail = (
            f"its joints are {', '.join(robot.joint_names)}, the stream's {', '.join(header.joint_names)}"
        )
        return Check("robot", FAILED, detail=detail)
    if robot.fingerprint != header.robot_fingerprint:
        detail = (
            f"fingerprint {robot.fingerprint[:12]}..., the stream's is {header.robot_fingerprint[:12]}..."
        )
        return Check("robot", FAILED, detail=detail)
    return Check("robot", OK)


def check_start(evidence: Evidence) -> Check:
    """The start posture lies inside the robot's own position limits."""
    tally = evidence.tally("start", "rad|m")
    lower, upper = evidence.stream.header.limits.pair("position")
    add_positions(tally, np.arange(1), evidence.stream.q[:1], lower[None], upper[None])
    return tally.check()


def check_frozen(evidence: Evidence) -> Check:
    """Frozen joints keep the bits of the value they had when they were frozen."""
    stream = evidence.stream
    tally = evidence.tally("frozen joints", "rad|m")
    frozen = [record for record in stream.records if isinstance(record.block, FreezeBlock)]
    ends = [*(record.tick for record in frozen[1:]), len(stream.ticks) - 1][: len(frozen)]
    for record, end in zip(frozen, ends, strict=True):
        assert isinstance(record.block, FreezeBlock)
        columns = np.zeros(stream.header.joints, dtype=np.bool_)
        columns[[joint - 1 for joint in record.block.joints]] = True
        q = stream.q[record.tick : end + 1]
        offends = _other_bits(q, q[:1]) & columns
        change = np.where(columns, np.abs(q - q[0]), 0.0)
        tally.add(np.arange(record.tick, end + 1), change, 0.0, offends, np.where(offends, change, -np.inf))
    return tally.check()


def check_stops(evidence: Evidence) -> Check:
    """The last row of every move repeats the row before it, bit by bit."""
    stream = evidence.stream
    tally = evidence.tally("stops", "rad|m")
    final = len(stream.ticks) - 1
    for _, _, last in segments(stream.block):
        if last == 0 or (last == final and not stream.complete):
            continue
        pair = stream.q[last - 1 : last + 1]
        change = np.abs(pair[1:] - pair[:1])
        offends = _other_bits(pair[1:], pair[:1])
        tally.add(np.array([last]), change, 0.0, offends, np.where(offends, change, -np.inf))
    return tally.check()


def _other_bits(first: Floats, second: Floats) -> NDArray[np.bool_]:
    """Where two arrays differ in any bit; unlike ``!=`` it tells -0.0 from 0.0."""
    different: NDArray[np.bool_] = np.ascontiguousarray(first).view(np.int64) != np.ascontiguousarray(
        second
    ).view(np.int64)
    return different
