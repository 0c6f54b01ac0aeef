"""Questions of the interpreter to the machine; the answer is sent back into the generator."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.blocks.block import Origin
from irlx.blocks.signal import Port


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


@dataclass(frozen=True)
class AskNearestPosture:
    """Which posture of this pose, within limits and frozen joints in force, is nearest to `near` (rad, m)?

    Pose and answer as in AskPostureOf.
    """

    origin: Origin
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float] | None
    near: tuple[float, ...]


@dataclass(frozen=True)
class AskPose:
    """Which pose has the tool in this posture (rad, m)?

    Answer: position, m, and unit quaternion x, y, z, w: seven numbers.
    """

    origin: Origin
    posture: tuple[float, ...]


@dataclass(frozen=True)
class AskManipulability:
    """How freely can the tool move in this posture (rad, m)? Answer: one number, as MANIPULABILITY has it."""

    origin: Origin
    posture: tuple[float, ...]


@dataclass(frozen=True)
class AskClearance:
    """How far is the robot in this posture (rad, m) from an obstacle or group, at this moment?

    `name` as the cell writes it. Answer: one number, m, the smallest distance, negative where they overlap.
    """

    origin: Origin
    posture: tuple[float, ...]
    name: str


@dataclass(frozen=True)
class AskAvoidingPosture:
    """Which posture of this pose keeps best clear of an obstacle or group, all blocks so far executed?

    `name` as the cell writes it. Pose and answer as in AskPostureOf.
    """

    origin: Origin
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float] | None
    name: str


@dataclass(frozen=True)
class AskLastMove:
    """How long did the last MOVE take, and where on it does the tool stand, all blocks so far executed?

    Answer: duration, s; length of the path behind the tool and of that before it, m. All are 0 before the
    first MOVE.
    """

    origin: Origin


@dataclass(frozen=True)
class AskJointBounds:
    """Between which values may each joint move now, by the robot and by the limits in force?

    Answer: all lower bounds, then all upper ones, rad or m, infinite where there is none.
    """

    origin: Origin


@dataclass(frozen=True)
class AskInput:
    """What does this input say, all blocks so far executed? Answer: one number, 0 or 1 for a BOOL.

    `names` are what its values may go by, the first that is known counts: the port and what the program
    calls it.
    """

    origin: Origin
    port: Port
    names: tuple[str, ...]


@dataclass(frozen=True)
class AskInputChange:
    """How long until one of these inputs may say something else, all blocks so far executed?

    Answer: one number, s, or none at all where none of them ever changes.
    """

    origin: Origin
    inputs: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class AskPause:
    """How long does this PAUSE last, all blocks so far executed? Answer: one number, s, 0 or more."""

    origin: Origin


@dataclass(frozen=True)
class AskStandstill:
    """Has everything so far been carried out, the robot at rest? Answer: nothing at all, once it has."""

    origin: Origin


MachineQuestion = (
    AskPosture
    | AskPostureOf
    | AskNearestPosture
    | AskPose
    | AskManipulability
    | AskClearance
    | AskAvoidingPosture
    | AskLastMove
    | AskJointBounds
    | AskInput
    | AskInputChange
)
"""What robot and inputs answer."""

Question = MachineQuestion | AskPause | AskStandstill
"""What machine or operator answer."""
