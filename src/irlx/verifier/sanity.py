"""Whether the numbers in a block fit a robot of n joints and the kind of the block."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from irlx.blocks import (
    Block,
    FreezeBlock,
    InputBlock,
    JointIncrement,
    JointRange,
    JointTarget,
    LimitSwitchBlock,
    LinkFrame,
    MotionLaw,
    MoveBlock,
    MoveKind,
    PauseBlock,
    ReconfigureBlock,
    SignalBlock,
    SignalKind,
    Target,
    ToolBlock,
    WaitBlock,
    WeightsBlock,
)
from irlx.promises import UNIT_LENGTH


def wrong_numbers(block: Block, joints: int) -> str:
    """Why the numbers in a block do not fit a robot of n joints, or ''."""
    for posture in _postures_beside(block):
        if len(posture.values) != joints:
            return f"its posture has {len(posture.values)} values for {joints} joints"
    ranges = _ranges(block)
    if any(len(bounds.lower) != joints or len(bounds.upper) != joints for bounds in ranges):
        return f"its limits are not those of {joints} joints"
    if isinstance(block, MoveBlock | ReconfigureBlock):
        reason = _wrong_law(block.law) or _wrong_frame(block.frame)
        if reason:
            return reason
    find: Callable[[Any, int], str] | None = next(
        (find for kind, find in _OWN.items() if isinstance(block, kind)), None
    )
    return "" if find is None else find(block, joints)


def _wrong_move(block: MoveBlock, joints: int) -> str:
    """Why target and course of a move do not fit a robot of n joints or its kind, or ''."""
    reason = _wrong_arc(block) or _wrong_path(block) or _wrong_blend(block)
    if reason:
        return reason
    targets = block.targets
    return next((words for target in targets if (words := _wrong_target(target, joints))), "")


def _wrong_arc(block: MoveBlock) -> str:
    arc = block.arc
    if (arc is not None) is not (block.kind is MoveKind.CIRCLE):
        return f"a {block.kind.value} {'needs a' if arc is None else 'has no'} course"
    if arc is not None and arc.angle is not None and not 0.0 < abs(arc.angle) < np.inf:
        return f"it cannot turn by {arc.angle} rad"
    if arc is not None and arc.via_reconfiguration is not None and block.reconfiguration is None:
        return "it has a posture for its via point and none for its end"
    return ""


def _wrong_path(block: MoveBlock) -> str:
    path = block.path
    if path is None:
        return "a SPLINE needs points to run through" if block.kind is MoveKind.SPLINE else ""
    if block.kind not in (MoveKind.LIN, MoveKind.SPLINE):
        return f"a {block.kind.value} does not run along a PATH"
    if not path.points:
        return "its PATH has no points before the target"
    if path.reconfigurations and len(path.reconfigurations) != len(path.points):
        return f"it has {len(path.reconfigurations)} postures for the {len(path.points)} points of its PATH"
    return ""


def _wrong_blend(block: MoveBlock) -> str:
    blend = block.blend
    if blend is None:
        return ""
    if blend.distance is not None and not 0.0 <= blend.distance < np.inf:
        return f"it cannot pass its target at {blend.distance} m"
    if blend.share is not None and not 0.0 <= blend.share <= 1.0:
        return f"it cannot pass its target with a share of {blend.share}"
    return ""


_RATES = ("speed", "acc", "speed_ori", "acc_ori", "speed_ptp", "acc_ptp", "duration")


def _wrong_law(law: MotionLaw) -> str:
    values = ((name, getattr(law, name)) for name in _RATES)
    # Written so that what is no number is found: it would pass for no limit at all.
    odd = next((pair for pair in values if pair[1] is not None and not pair[1] >= 0.0), None)
    if odd is not None:
        return f"its {odd[0]} is {odd[1]}"
    if not 0.0 < law.override <= 1.0:
        return f"its override is {law.override}, not above 0 and up to 1"
    if law.jerk is not None and not law.jerk > 0.0:
        return f"its jerk is {law.jerk} m/s3"
    return ""


def _wrong_target(target: Target, joints: int) -> str:
    if isinstance(target, JointTarget | JointIncrement):
        return (
            ""
            if len(target.values) == joints
            else f"its target has {len(target.values)} values for {joints} joints"
        )
    if target.orientation is not None:
        return _wrong_length(target.orientation)
    return ""


def _wrong_length(orientation: tuple[float, ...]) -> str:
    length = float(np.linalg.norm(orientation))
    return (
        "" if abs(length - 1.0) <= UNIT_LENGTH else f"its orientation is a quaternion of length {length:.6g}"
    )


def _wrong_frame(frame: LinkFrame | None) -> str:
    if frame is None:
        return ""
    if not np.isfinite(frame.position).all():
        return f"its frame lies at {frame.position} m"
    return _wrong_length(frame.orientation)


def _wrong_tool(block: ToolBlock, joints: int) -> str:
    if not np.isfinite(block.position).all():
        return f"its tool lies at {block.position} m"
    return _wrong_length(block.orientation)


def _wrong_weights(block: WeightsBlock, joints: int) -> str:
    if len(block.weights) != joints:
        return f"it has {len(block.weights)} weights for {joints} joints"
    odd = next((weight for weight in block.weights if not 0.0 < weight < np.inf), None)
    return "" if odd is None else f"a weight is {odd}"


def _wrong_wait(block: WaitBlock | PauseBlock, joints: int) -> str:
    return "" if 0.0 <= block.duration < np.inf else f"it waits {block.duration} s"


def _wrong_signal(block: SignalBlock | InputBlock, joints: int) -> str:
    if _fits(block.port.kind, block.value):
        return ""
    return f"its {block.port.name} is {block.value}, which is no {block.port.kind.value}"


def _wrong_freeze(block: FreezeBlock, joints: int) -> str:
    fits = all(1 <= joint <= joints for joint in block.joints)
    return "" if fits else f"it freezes a joint outside 1..{joints}"


_OWN: dict[type[Block], Callable[[Any, int], str]] = {
    MoveBlock: _wrong_move,
    ToolBlock: _wrong_tool,
    WeightsBlock: _wrong_weights,
    WaitBlock: _wrong_wait,
    PauseBlock: _wrong_wait,
    SignalBlock: _wrong_signal,
    InputBlock: _wrong_signal,
    FreezeBlock: _wrong_freeze,
}


def _fits(kind: SignalKind, value: float) -> bool:
    if kind is SignalKind.BOOL:
        return value in (0.0, 1.0)
    return abs(value) < np.inf and (kind is SignalKind.REAL or value == round(value))


def _ranges(block: Block) -> list[JointRange]:
    if isinstance(block, MoveBlock):
        return [clause.range for clause in block.limits]
    if isinstance(block, LimitSwitchBlock) and block.range is not None:
        return [block.range]
    return []


def _postures_beside(block: Block) -> list[JointTarget]:
    """Postures of a block other than the targets of a move."""
    if isinstance(block, ReconfigureBlock):
        return [block.target]
    if not isinstance(block, MoveBlock):
        return []
    inner = () if block.path is None else block.path.reconfigurations
    via = None if block.arc is None else block.arc.via_reconfiguration
    return [posture for posture in (via, *inner, block.reconfiguration) if posture is not None]
