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


Question = AskPosture
