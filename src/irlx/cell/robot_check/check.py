"""`irlx.check_robot`: everything odd in a URDF at once."""

from __future__ import annotations

import os
from pathlib import Path

from irlx.cell.errors import CellError
from irlx.cell.load import read_bytes
from irlx.cell.robot_check.bodies import check_bodies
from irlx.cell.robot_check.findings import ModelFindings, joint_key, length_of
from irlx.cell.robot_check.joints import check_joints, check_lengths
from irlx.cell.robot_check.model_text import JointText, ModelText, model_text
from irlx.diagnostics import Diagnostic, Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.robot.urdf import read_urdf
from irlx.robot.urdf_values import RobotModelError

_WHOLE = 6
_XACRO = "<xacro:"


def check_robot(path: str | os.PathLike[str], tip: str | None = None) -> list[Diagnostic]:
    """Findings on a URDF file: what irlx cannot use, what is missing, what looks like a mistake.

    `tip` is the link that programs are to move, by default the only one at an end; where there are several,
    IRL666 lists them and all joints are looked at. Errors come first: IRL612, what no cell could use, of
    which the first is told; then warnings and notes, IRL650 to IRL668. Raises CellError for a file that
    cannot be read: IRL001, IRL002, IRL007.
    """
    file = Path(path)
    text = _text(file)
    findings = ModelFindings(str(file))
    model = model_text(text)
    ends = model.ends
    tip = ends[0] if tip is None and len(ends) == 1 else tip
    # Several ends are no fault of the file: it is read with no joint before the tip then.
    _check_readable(text, model.root if tip is None and len(ends) > 1 else tip, findings)
    joints = model.joints if tip is None else model.chain(tip)
    if tip is None and len(ends) > 1:
        told = ", ".join(f"{end} ({_axes_of(model, end)} axes)" for end in ends)
        findings.tell("IRL666", ends=told, count=len(ends))
    check_joints(joints, findings)
    check_lengths(joints, findings)
    axes = [joint for joint in joints if _is_axis(joint)]
    check_bodies(model, [joint.name for joint in axes], file.parent, findings)
    if tip is not None:
        _check_chain(joints, axes, tip, findings)
    return findings.found


def _text(path: Path) -> str:
    try:
        return read_bytes(path).decode()
    except UnicodeDecodeError as cause:
        raise CellError(report("IRL002", Place(str(path)), path=path, cause=str(cause))) from cause


def _check_readable(text: str, tip: str | None, findings: ModelFindings) -> None:
    """IRL612 as a cell would tell it, with a word on files that a URDF has yet to be made of."""
    try:
        read_urdf(text, tip)
    except RobotModelError as cause:
        near = near_matches(cause.subject, cause.known)
        if _XACRO in text:
            near += f"; it has macros of xacro, which makes a URDF of it: xacro {findings.file} > robot.urdf"
        findings.tell("IRL612", model=findings.file, cause=str(cause), near=near)


def _is_axis(joint: JointText) -> bool:
    return joint.moves and joint.mimics is None


def _axes_of(model: ModelText, tip: str) -> int:
    return sum(map(_is_axis, model.chain(tip)))


def _check_chain(
    joints: tuple[JointText, ...], axes: list[JointText], tip: str, findings: ModelFindings
) -> None:
    """Whether there are axes for a whole pose (IRL668), and a foot off the root frame (IRL655)."""
    if len(axes) < _WHOLE:
        findings.tell("IRL668", tip=tip, found=len(axes))
    if not axes:
        return
    before = joints[: joints.index(axes[0])]
    fixed = [joint for joint in before if length_of(joint.xyz) > 0.0]
    if fixed:
        data = {"root": joints[0].parent, "joint": fixed[0].name}
        x, y, z = (1e3 * part for part in fixed[0].xyz)
        findings.tell("IRL655", joint_key(fixed[0].name), found=f"({x:g}, {y:g}, {z:g}) mm", **data)
