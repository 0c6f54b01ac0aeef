"""What the values of a block have to be for a machine to carry it out: programs give no others, files may."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, is_dataclass
from math import isfinite, sqrt
from typing import Any

from irlx.blocks.block import Block, PauseBlock
from irlx.blocks.criterion import CriterionChoice, CriterionParam
from irlx.blocks.link_frame import LinkFrame
from irlx.blocks.move import ArcCourse, Blend, MotionLaw
from irlx.blocks.options import FreezeBlock, JointRange
from irlx.blocks.signal import InputBlock, SignalBlock, WaitBlock
from irlx.blocks.targets import JointIncrement, JointTarget, PoseIncrement, PoseTarget
from irlx.blocks.tolerance import ToleranceClause
from irlx.blocks.tool import ToolBlock, WeightsBlock

__all__ = ["senseless"]

_UNIT = 1e-6
"""How far the length of a quaternion may be from 1."""
_FARTHEST = 1e12
"""Lengths (m), angles (rad) and times (s) lie below; squares of them are numbers still."""


def senseless(block: Block, joints: int) -> str:
    """What of a block nobody could carry out on a robot of so many `joints`, '' where all has sense."""
    return _within(block, "", joints)


def _within(value: Any, where: str, joints: int) -> str:
    """The first thing that is wrong with a value or its parts."""
    if isinstance(value, tuple):
        parts = [(f"{where}.{number}", part) for number, part in enumerate(value, 1) if is_dataclass(part)]
    elif is_dataclass(value):
        check = _CHECKS.get(type(value))
        wrong = check(value, joints) if check is not None else ""
        if wrong:
            return f"{where}.{wrong}" if where else wrong
        parts = [
            (f"{where}.{field.name}" if where else field.name, getattr(value, field.name))
            for field in fields(value)
        ]
    else:
        return ""
    return next(filter(None, (_within(part, name, joints) for name, part in parts)), "")


def _law(law: MotionLaw, joints: int) -> str:
    for name in ("speed", "acc", "speed_ori", "acc_ori"):
        if not getattr(law, name) > 0.0:
            return f"{name}: needs a number above 0"
    for name in ("speed_ptp", "acc_ptp", "override"):
        if not 0.0 < getattr(law, name) <= 1.0:
            return f"{name}: needs a number above 0, at most 1"
    for name in ("duration", "jerk"):
        value = getattr(law, name)
        if value is not None and not 0.0 < value < _FARTHEST:
            return f"{name}: needs a number above 0"
    return ""


def _pose(pose: PoseTarget | PoseIncrement | ToolBlock | LinkFrame, joints: int) -> str:
    if not _all_within(pose.position):
        return "position: needs lengths"
    turn = pose.orientation
    if turn is not None and not abs(sqrt(sum(part * part for part in turn)) - 1.0) <= _UNIT:
        return "orientation: needs a unit quaternion"
    return ""


def _posture(target: JointTarget | JointIncrement, joints: int) -> str:
    sound = len(target.values) == joints and _all_within(target.values)
    return "" if sound else f"values: needs {joints} joint values"


def _range(bounds: JointRange, joints: int) -> str:
    if not len(bounds.lower) == len(bounds.upper) == joints:
        return f"lower: needs {joints} bounds, and as many in upper"
    ordered = all(low <= high for low, high in zip(bounds.lower, bounds.upper, strict=True))
    return "" if ordered else "lower: needs bounds that are not above those in upper"


def _arc(arc: ArcCourse, joints: int) -> str:
    sound = arc.angle is None or (arc.angle != 0.0 and abs(arc.angle) < _FARTHEST)
    return "" if sound else "angle: needs an angle other than 0"


def _blend(blend: Blend, joints: int) -> str:
    if blend.distance is not None and not 0.0 <= blend.distance < _FARTHEST:
        return "distance: needs a length from 0 on"
    return "" if blend.share is None or 0.0 <= blend.share <= 1.0 else "share: needs a number from 0 to 1"


def _tolerance(clause: ToleranceClause, joints: int) -> str:
    return "" if all(band >= 0.0 for band in clause.bands) else "bands: needs numbers from 0 on"


def _frozen(block: FreezeBlock, joints: int) -> str:
    sound = all(1 <= joint <= joints for joint in block.joints)
    return "" if sound else f"joints: needs numbers from 1 to {joints}"


def _weights(block: WeightsBlock, joints: int) -> str:
    sound = len(block.weights) == joints and all(0.0 < weight < _FARTHEST for weight in block.weights)
    return "" if sound else f"weights: needs {joints} numbers above 0"


def _lasting(block: WaitBlock | PauseBlock, joints: int) -> str:
    return "" if 0.0 <= block.duration < _FARTHEST else "duration: needs a time from 0 on"


def _valued(block: SignalBlock | InputBlock | CriterionParam, joints: int) -> str:
    return "" if isfinite(block.value) else "value: needs a finite number"


def _choice(choice: CriterionChoice, joints: int) -> str:
    return "" if isfinite(choice.weight) else "weight: needs a finite number"


def _all_within(values: Sequence[float]) -> bool:
    return all(abs(value) < _FARTHEST for value in values)


_CHECKS: Mapping[type, Callable[[Any, int], str]] = {
    MotionLaw: _law,
    PoseTarget: _pose,
    PoseIncrement: _pose,
    ToolBlock: _pose,
    LinkFrame: _pose,
    JointTarget: _posture,
    JointIncrement: _posture,
    JointRange: _range,
    ArcCourse: _arc,
    Blend: _blend,
    ToleranceClause: _tolerance,
    FreezeBlock: _frozen,
    WeightsBlock: _weights,
    WaitBlock: _lasting,
    PauseBlock: _lasting,
    SignalBlock: _valued,
    InputBlock: _valued,
    CriterionParam: _valued,
    CriterionChoice: _choice,
}
