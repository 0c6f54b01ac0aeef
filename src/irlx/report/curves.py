"""Curves over the rows of a stream that figures and pages share: limits in force, tool rates, singularity."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from irlx.robot.description import RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.streams.joint_stream import JointStream
from irlx.streams.scan import scan_of
from irlx.transform.measures.smallest_singular_value import SmallestSingularValue
from irlx.verifier.findings.finding import FAILED
from irlx.verifier.frames import frames_of
from irlx.verifier.limits import LimitsInForce, limits_in_force
from irlx.verifier.moves import check_blocks, moves_of
from irlx.verifier.outline import Outline, outline_of
from irlx.verifier.tools import tools_of

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


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

    `tool` (N, 7) holds x y z in m and a unit quaternion; before the first row the tool rests. The angle
    between two orientations is 4 arcsin(|p - q| / 2) of their quaternions, the nearer sign taken.
    """
    speed, turn = np.zeros(len(tool)), np.zeros(len(tool))
    steps = np.diff(tool, axis=0)
    other = tool[1:, 3:] + tool[:-1, 3:]
    chord = np.minimum(np.linalg.norm(steps[:, 3:], axis=1), np.linalg.norm(other, axis=1))
    speed[1:] = np.linalg.norm(steps[:, :3], axis=1) / dt
    turn[1:] = 4.0 * np.arcsin(np.clip(0.5 * chord, 0.0, 1.0)) / dt
    return speed, turn


def smallest_singular_values(robot: RobotDescription, outline: Outline, q: Array, block: Integers) -> Array:
    """Smallest singular value (K,) of the tool Jacobian in postures q (K, n) of the blocks (K,).

    The tool is the one in force there, seen from the frame in which the block leads it, and the rows are
    those of the robot's task, lengths divided by its reach: `SmallestSingularValue`, without unit. The start
    counts as part of the first motion.
    """
    tools, frames = tools_of(outline.records), frames_of(outline.records, robot).of_block
    set_tools = [record.block for record in outline.records if record.block.id in set(tools.ids.tolist())]
    known: dict[tuple[int, object], SmallestSingularValue] = {}
    world = Kinematics(robot)

    def measure(number: int, block: int) -> SmallestSingularValue:
        frame = frames.get(block)
        key = number, frame
        if key not in known:
            kinematics = world
            if number:
                own = sorted(set_tools, key=lambda item: item.id)[number - 1]
                kinematics = world.with_tool(own.position, own.orientation)  # type: ignore[attr-defined]
            known[key] = SmallestSingularValue(kinematics.relative_to(frame) if frame else kinematics)
        return known[key]

    motions = outline.ids[outline.ids > 0]
    block = np.where(block == 0, motions[:1] if motions.size else 0, block)
    numbers = tools.numbers(block).tolist()
    pairs = zip(q, numbers, block.tolist(), strict=True)
    return np.array([measure(number, own).value(posture) for posture, number, own in pairs])
