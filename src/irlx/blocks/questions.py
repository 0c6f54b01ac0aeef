"""Questions of the interpreter to the machine; the answer is sent back into the generator."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.blocks.block import Origin


@dataclass(frozen=True)
class AskPosture:
    """Which posture does the robot stand in, all blocks so far executed?

    Answer: tuple of joint values, rad or m.
    """

    origin: Origin


@dataclass(frozen=True)
class AskPostureOf:
    """Which posture of this pose would MOVE PTP end in, all blocks so far executed?

    `position` in m; `orientation` as unit quaternion (x, y, z, w), or None for that of the tool at this
    moment. Answer: tuple of joint values, rad or m.
    """

    origin: Origin
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float] | None


Question = AskPosture | AskPostureOf
