"""Curves over the rows of a stream that figures and pages share: limits in force, rates of the tool."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from irlx.report.turns import angles_between
from irlx.streams.joint_stream import JointStream
from irlx.streams.scan import scan_of
from irlx.verifier.findings.finding import FAILED
from irlx.verifier.limits import LimitsInForce, limits_in_force
from irlx.verifier.moves import check_blocks, moves_of
from irlx.verifier.outline import Outline, outline_of

Array = NDArray[np.float64]


def outline_of_stream(stream: JointStream) -> Outline:
    """What a stream in memory consists of: its blocks, and which rows are theirs."""
    return outline_of(partial(scan_of, stream))


def blocks_fit(outline: Outline) -> bool:
    """Whether the blocks of a stream belong to its rows, so that what they say may be used."""
    return bool(outline.records) and check_blocks(outline, may_lack_blocks=True).status != FAILED


def limits_over(outline: Outline) -> LimitsInForce:
    """Limits of the joints in force in each row: the robot's own, narrowed by the program's clauses.

    A stream without blocks, or with blocks that are not its own, only has the robot's.
    """
    if not blocks_fit(outline):
        return LimitsInForce(np.zeros(1, dtype=np.int64), [outline.header.limits])
    return limits_in_force(outline, moves_of(outline))


def tool_rates(tool: Array, dt: float) -> tuple[Array, Array]:
    """Speed of the tool point (N,), m/s, and of the tool's turn (N,), rad/s, by backward differences.

    `tool` (N, 7) holds x y z in m and a unit quaternion; before the first row the tool rests.
    """
    speed, turn = np.zeros(len(tool)), np.zeros(len(tool))
    speed[1:] = np.linalg.norm(np.diff(tool[:, :3], axis=0), axis=1) / dt
    turn[1:] = angles_between(tool[:-1, 3:], tool[1:, 3:]) / dt
    return speed, turn
