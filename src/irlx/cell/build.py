"""From a validated cell file to a `Cell`: counts, ranges and units checked against the robot."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import cos, inf, radians, sin
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from irlx.blocks.link_frame import LinkFrame
from irlx.cell.bound_frames import bound_frame_errors, link_frame
from irlx.cell.cell import Cell, MotionDefaults, NamedFrame
from irlx.cell.constraints import read_constraints
from irlx.cell.errors import CellError
from irlx.cell.limit_entry import LimitEntry
from irlx.cell.scene import read_scene
from irlx.cell.schema import CellFile, FrameSection, LimitsSection, RobotSection
from irlx.diagnostics import Diagnostic, Place, report, told_apart
from irlx.diagnostics.diagnostic import near_matches
from irlx.robot.description import RobotDescription
from irlx.robot.limits import JointLimits

Array = NDArray[np.float64]
_KINDS = ("position", "speed", "acceleration")


def build_cell(
    content: CellFile,
    robot_section: RobotSection,
    robot: RobotDescription,
    file: str,
    faults: Sequence[Diagnostic] = (),
) -> Cell:
    """Cell of a robot. Raises CellError with every fault found: IRL604 to IRL606, IRL620, IRL647,
    and those of `read_scene`, behind the `faults` that the file is known to have.

    Lists of wrong length stop the checks that need them, no others; faults those of the start posture.
    """
    errors = [*faults]
    count = len(robot.axes)
    limits = limits_of(robot_section.limits, robot, file, errors)
    start = _joint_list(robot_section.start, "robot.start", [0.0] * count, count, file, errors)
    weights = _joint_list(
        robot_section.weights, "robot.weights", [float(count - i) for i in range(count)], count, file, errors
    )
    _status_joints(robot_section, robot, file, errors)
    q = np.array([to_si(robot, joint, value) for joint, value in enumerate(start[:count])])
    errors += _case_errors("frames", content.frames, file)
    errors += _case_errors("signals.inputs", content.signals.inputs, file)
    errors += bound_frame_errors(content, robot, file)
    scene, scene_warnings = read_scene(content, robot_section, robot, file, errors)
    constraints = read_constraints(content.constraint, robot, q if not errors else None, file, errors)
    if not errors:
        errors += _start_errors(q, limits, robot, file)
    if errors:
        raise CellError(errors)
    motion = content.motion
    return Cell(
        file,
        robot_section.model or "",
        robot,
        limits,
        np.array(weights),
        q,
        round(motion.tick_ms * 1e6),
        MotionDefaults(**motion.model_dump(exclude={"tick_ms"})),
        {name: _frame(section) for name, section in content.frames.items() if section.link is None},
        (*scene_warnings, *_warnings(limits, file)),
        *constraints,
        {name.casefold(): trace for name, trace in content.signals.inputs.items()},
        scene,
        _link_frames(content),
    )


def _link_frames(content: CellFile) -> dict[str, LinkFrame]:
    """Frames that move with a link, by their names."""
    frames = content.frames.items()
    found = (link_frame(name, section, _frame(section).quaternion) for name, section in frames)
    return {frame.name: frame for frame in found if frame is not None}


def to_si(robot: RobotDescription, joint: int, value: float) -> float:
    """Joint value of a cell or program, deg | mm, in rad | m; also for its rates."""
    return value * 1e-3 if robot.axes[joint].is_prismatic else radians(value)


def from_si(robot: RobotDescription, joint: int, value: float) -> float:
    """Joint value rad | m in deg | mm."""
    return value * 1e3 if robot.axes[joint].is_prismatic else float(np.degrees(value))


def _joint_list(
    given: list[float] | None,
    key: str,
    default: list[float],
    count: int,
    file: str,
    errors: list[Diagnostic],
) -> list[float]:
    if given is None:
        return default
    if len(given) != count:
        errors.append(report("IRL604", Place(file, key=key), key=key, joints=count, found=len(given)))
        return default
    return given


def _status_joints(
    section: RobotSection, robot: RobotDescription, file: str, errors: list[Diagnostic]
) -> None:
    for index, name in enumerate(section.status_joints):
        if name not in robot.joint_names:
            key = f"robot.status_joints[{index + 1}]"
            near = near_matches(name, robot.joint_names)
            data: dict[str, Any] = {"key": key, "name": name, "near": near}
            data["known"] = ", ".join(robot.joint_names)
            errors.append(report("IRL606", Place(file, key=key), **data))


def limits_of(
    section: LimitsSection, robot: RobotDescription, file: str, errors: list[Diagnostic]
) -> JointLimits:
    """Limits (SI) of a robot's axes: those of the cell, else of its URDF. Faults go to `errors`."""
    axes = robot.axes
    limits = JointLimits.unlimited(len(axes))
    speed = np.array([joint.speed for joint in axes])
    limits = limits.with_pair(
        "position", np.array([joint.lower for joint in axes]), np.array([joint.upper for joint in axes])
    ).with_pair("speed", -speed, speed)
    for kind in _KINDS:
        given = getattr(section, kind)
        if given is None:
            continue
        pairs = _pairs(given, kind, robot, file, errors)
        limits = limits.with_pair(kind, *(np.array(side) for side in zip(*pairs, strict=True)))
    return limits


def _pairs(
    given: list[LimitEntry] | Literal[False],
    kind: str,
    robot: RobotDescription,
    file: str,
    errors: list[Diagnostic],
) -> list[tuple[float, float]]:
    """Lower and upper bound (SI) of every joint."""
    key, count = f"robot.limits.{kind}", len(robot.axes)
    free = [(-inf, inf)] * count
    if not isinstance(given, list):
        return free
    if len(given) != count:
        errors.append(report("IRL604", Place(file, key=key), key=key, joints=count, found=len(given)))
        return free
    pairs = []
    for joint, entry in enumerate(given):
        cause = _no_range(entry, kind)
        if cause:
            place = Place(file, key=f"{key}[{joint + 1}]")
            data: dict[str, Any] = {"joint": robot.axes[joint].name, "kind": kind, "found": entry.written}
            errors.append(report("IRL605", place, cause=cause, **data))
        pairs.append((to_si(robot, joint, entry.lower), to_si(robot, joint, entry.upper)))
    return pairs


def _no_range(entry: LimitEntry, kind: str) -> str:
    """Why an entry is no range of a joint, or ''."""
    if entry.is_negative_number:
        return "a single limit must not be negative"
    if entry.lower > entry.upper:
        return "the lower bound is above the upper one"
    if kind != "position" and not entry.lower <= 0.0 <= entry.upper:
        return "the range does not contain standstill (0)"
    return ""


def _start_errors(q: Array, limits: JointLimits, robot: RobotDescription, file: str) -> list[Diagnostic]:
    errors = []
    for joint in np.flatnonzero((q < limits.position_lower) | (q > limits.position_upper)):
        key = f"robot.start[{joint + 1}]"
        values = (q[joint], limits.position_lower[joint], limits.position_upper[joint])
        found, lower, upper = told_apart(*(from_si(robot, int(joint), float(value)) for value in values))
        unit = "mm" if robot.axes[joint].is_prismatic else "deg"
        data: dict[str, Any] = {"joint": robot.axes[joint].name, "found": found, "unit": unit}
        data |= {"lower": lower, "upper": upper}
        errors.append(report("IRL620", Place(file, key=key), **data))
    return errors


def _case_errors(table: str, names: Iterable[str], file: str) -> list[Diagnostic]:
    """Names of a table that differ in case alone: programs do not tell them apart."""
    errors: list[Diagnostic] = []
    first: dict[str, str] = {}
    for name in names:
        other = first.setdefault(name.casefold(), name)
        if other != name:
            key = f"{table}.{name}"
            expected = f"a name that differs from '{other}' in more than case"
            errors.append(
                report("IRL603", Place(file, key=key), key=key, expected=expected, found=repr(name))
            )
    return errors


def _frame(section: FrameSection) -> NamedFrame:
    """Pose of a frame: turns about the fixed x, y, z axes, in this order (q = qz qy qx)."""
    (cx, sx), (cy, sy), (cz, sz) = ((cos(radians(a) / 2), sin(radians(a) / 2)) for a in section.rpy)
    x, y, z = section.xyz
    return NamedFrame(
        (x, y, z),
        (
            cx * cy * cz + sx * sy * sz,
            sx * cy * cz - cx * sy * sz,
            cx * sy * cz + sx * cy * sz,
            cx * cy * sz - sx * sy * cz,
        ),
    )


def _warnings(limits: JointLimits, file: str) -> tuple[Diagnostic, ...]:
    found = []
    if not np.any(np.isfinite(limits.acceleration_upper)):
        found.append(report("IRL621", Place(file, key="robot.limits.acceleration")))
    return tuple(found)
