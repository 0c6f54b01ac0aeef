"""Function blocks as text: one line a block, in the units that people write (mm, degrees, seconds)."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import singledispatch
from math import degrees

from irlx.blocks.block import Block, HaltBlock, PauseBlock
from irlx.blocks.criterion import CriterionBlock, CriterionChoice
from irlx.blocks.link_frame import LinkFrame
from irlx.blocks.move import Blend, MotionLaw, MoveBlock, MoveKind, PathCourse, Profile
from irlx.blocks.obstacle import ObstacleBlock
from irlx.blocks.options import CyclicBlock, FreezeBlock, JointRange, LimitKind, LimitSwitchBlock
from irlx.blocks.reconfigure import ReconfigureBlock
from irlx.blocks.signal import InputBlock, Port, SignalBlock, SignalKind, WaitBlock
from irlx.blocks.targets import JointIncrement, JointTarget, PoseIncrement, Target
from irlx.blocks.tool import ToolBlock, WeightsBlock
from irlx.language.builtins import LIMIT_WORDS

NEGLIGIBLE = 1e-12
"""Numbers smaller than this print as 0: they are what sin(180 degrees) leaves behind."""

_SWITCH = {kind: LIMIT_WORDS[kind.value] for kind in LimitKind}


def block_text(block: Block, joint_units: Sequence[str]) -> str:
    """Canonical line of a block, without a line end; equal blocks have equal lines.

    `joint_units` says of each joint of the robot whether its values are 'rad' (printed in degrees)
    or 'm' (printed in mm). Numbers carry ten significant digits. For example
    ``3 MOVE LIN to (9500 1000 3500) (0 0 0 1) in R_BASE speed 1000 mm/s acc 2000 mm/s2 ... line 20``.
    Raises TypeError for a block that has no text form.
    """
    words = [str(block.id), _words(block, joint_units)]
    if block.robot != "default":
        words.append(f"robot {block.robot}")
    if block.process != "main":
        words.append(f"process {block.process}")
    words.append(f"line {block.origin.line}")
    return " ".join(words)


@singledispatch
def _words(block: Block, joint_units: Sequence[str]) -> str:
    raise TypeError(f"no text form for {type(block).__name__}")


@_words.register
def _(block: HaltBlock, joint_units: Sequence[str]) -> str:
    return "HALT"


@_words.register
def _(block: PauseBlock, joint_units: Sequence[str]) -> str:
    return f"PAUSE {number(block.duration)} s" if block.duration else "PAUSE"


@_words.register
def _(block: SignalBlock, joint_units: Sequence[str]) -> str:
    return f"SET {block.port.name} to {_signal(block.port, block.value)}"


@_words.register
def _(block: InputBlock, joint_units: Sequence[str]) -> str:
    return f"READ {block.port.name}: {_signal(block.port, block.value)}"


@_words.register
def _(block: WaitBlock, joint_units: Sequence[str]) -> str:
    return f"WAIT {number(block.duration)} s{f' for {block.condition}' if block.condition else ''}"


def _signal(port: Port, value: float) -> str:
    if port.kind is SignalKind.BOOL:
        return "TRUE" if value else "FALSE"
    return str(int(value)) if port.kind is SignalKind.INT else number(value)


@_words.register
def _(block: MoveBlock, joint_units: Sequence[str]) -> str:
    words = [f"MOVE {block.kind.value}", *_way(block, joint_units), *_frame(block.frame)]
    words.append(_law(block.kind, block.law))
    words += [] if block.blend is None else [_blend(block.kind, block.blend)]
    words += [f"WITH {_SWITCH[clause.kind]} {_range(clause.range, joint_units)}" for clause in block.limits]
    words += _postures(block, joint_units)
    words += [f"WITH CRITERION {_criterion(clause.choice)}" for clause in block.criteria]
    return " ".join(words)


@_words.register
def _(block: ToolBlock, joint_units: Sequence[str]) -> str:
    return f"TOOL {_group(map(_mm, block.position))} {_group(map(number, block.orientation))} in the tip"


@_words.register
def _(block: WeightsBlock, joint_units: Sequence[str]) -> str:
    return f"WEIGHTS {_group(map(number, block.weights))}"


@_words.register
def _(block: ReconfigureBlock, joint_units: Sequence[str]) -> str:
    law = f"speed {_mm(block.law.speed)} mm/s speed_ori {_deg(block.law.speed_ori)} deg/s"
    law += _override(block.law)
    return " ".join([f"RECONFIGURATION to {_target(block.target, joint_units)}", *_frame(block.frame), law])


def _frame(frame: LinkFrame | None) -> list[str]:
    """Words for a frame that moves with a link."""
    if frame is None:
        return []
    pose = f"{_group(map(_mm, frame.position))} {_group(map(number, frame.orientation))}"
    return [f"frame {frame.name} at {pose} of {frame.link}"]


@_words.register
def _(block: LimitSwitchBlock, joint_units: Sequence[str]) -> str:
    name = _SWITCH[block.kind]
    return f"{name}END" if block.range is None else f"{name} {_range(block.range, joint_units)}"


@_words.register
def _(block: FreezeBlock, joint_units: Sequence[str]) -> str:
    if not block.joints:
        return "FREEZEEND"
    return f"FREEZESTART {', '.join(map(str, block.joints))}"


@_words.register
def _(block: CyclicBlock, joint_units: Sequence[str]) -> str:
    return "CYCLICSTART" if block.active else "CYCLICEND"


@_words.register
def _(block: CriterionBlock, joint_units: Sequence[str]) -> str:
    return f"CRITERIONEND {block.name}" if block.choice is None else f"CRITERION {_criterion(block.choice)}"


@_words.register
def _(block: ObstacleBlock, joint_units: Sequence[str]) -> str:
    return f"{'OBSTACLE' if block.active else 'OBSTACLEEND'} {block.name}"


def _criterion(choice: CriterionChoice) -> str:
    params = [f"{param.name.lower()} {number(param.value)}" for param in choice.params]
    return " ".join([choice.name, f"weight {number(choice.weight)}", *params])


def _target(target: Target, joint_units: Sequence[str]) -> str:
    if isinstance(target, JointTarget):
        return f"joints {_joint_values(target.values, joint_units)}"
    if isinstance(target, JointIncrement):
        return f"on by joints {_joint_values(target.values, joint_units)}"
    position = _group(map(_mm, target.position))
    if isinstance(target, PoseIncrement):
        if target.orientation is None:
            return f"on by {position} in {target.frame}"
        return f"on by {position} {_group(map(number, target.orientation))} in the tool"
    orientation = "kept" if target.orientation is None else _group(map(number, target.orientation))
    return f"{position} {orientation} in {target.frame}"


def _way(block: MoveBlock, joint_units: Sequence[str]) -> list[str]:
    """Words for via point, target and travel of a move."""
    words = [f"to {_target(block.target, joint_units)}"]
    if isinstance(block.course, PathCourse):
        return [f"through {_target(point, joint_units)}" for point in block.course.points] + words
    if block.course is not None:
        words.insert(0, f"via {_target(block.course.via, joint_units)}")
        words += ["turning through via"] if block.course.turns_through_via else []
        words += [f"angle {_deg(block.course.angle)} deg"] if block.course.angle is not None else []
    return words


def _postures(block: MoveBlock, joint_units: Sequence[str]) -> list[str]:
    """Words for the postures that a move is drawn to; with one for the via point both are named."""
    end = block.reconfiguration
    if isinstance(block.course, PathCourse):
        all_of_them = [*block.course.reconfigurations, *([] if end is None else [end])]
        words = [_joint_values(posture.values, joint_units) for posture in all_of_them]
        return ["WITH RECONFIGURATION", *words] if words else []
    via = None if block.course is None else block.course.via_reconfiguration
    words = [] if via is None else [f"via {_joint_values(via.values, joint_units)}"]
    if end is not None:
        words.append(f"{'to ' if words else ''}{_joint_values(end.values, joint_units)}")
    return ["WITH RECONFIGURATION", *words] if words else []


def _law(kind: MoveKind, law: MotionLaw) -> str:
    """The bounds that rule this kind of move; the others are carried but change nothing."""
    if kind is MoveKind.PTP:
        parts = [f"speed_ptp {number(law.speed_ptp * 100)} %", f"acc_ptp {number(law.acc_ptp * 100)} %"]
    else:
        parts = [
            f"speed {_mm(law.speed)} mm/s acc {_mm(law.acc)} mm/s2",
            f"speed_ori {_deg(law.speed_ori)} deg/s acc_ori {_deg(law.acc_ori)} deg/s2",
        ]
    if law.duration is not None:
        parts.append(f"time {number(law.duration)} s")
    if law.profile is not Profile.TRAPEZOID:
        parts.append(f"profile {law.profile.value}")
    if law.jerk is not None:
        parts.append(f"jerk {_mm(law.jerk)} mm/s3")
    return " ".join(parts) + _override(law)


def _override(law: MotionLaw) -> str:
    return "" if law.override == 1.0 else f" override {number(law.override * 100)} %"


def _blend(kind: MoveKind, blend: Blend) -> str:
    """Words for how a move passes its target."""
    if kind is MoveKind.PTP:
        return "passing" if blend.share is None else f"passing by {number(blend.share * 100)} %"
    return "passing" if blend.distance is None else f"passing by {_mm(blend.distance)} mm"


def _range(bounds: JointRange, joint_units: Sequence[str]) -> str:
    lower = _joint_values(bounds.lower, joint_units)
    return f"{lower} {_joint_values(bounds.upper, joint_units)}"


def _joint_values(values: Sequence[float], joint_units: Sequence[str]) -> str:
    """Values in parentheses, degrees or mm by joint."""
    shown: dict[str, Callable[[float], str]] = {"rad": _deg, "m": _mm}
    return _group(shown[unit](value) for value, unit in zip(values, joint_units, strict=True))


def _group(words: Iterable[str]) -> str:
    return f"({' '.join(words)})"


def _mm(metres: float) -> str:
    return number(metres * 1000.0)


def _deg(radians: float) -> str:
    return number(degrees(radians))


def number(value: float) -> str:
    """Number with ten significant digits; what is smaller than `NEGLIGIBLE` is 0, never -0."""
    return "0" if abs(value) < NEGLIGIBLE else f"{value:.10g}"
