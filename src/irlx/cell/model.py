"""Which robot a cell names: a packaged one by name, or any URDF by path."""

from __future__ import annotations

from pathlib import Path

from irlx.cell.errors import CellError
from irlx.cell.packaged import packaged_cell, packaged_names, packaged_urdf
from irlx.cell.read import read_cell_file
from irlx.cell.schema import RobotSection
from irlx.diagnostics import Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.robot.description import RobotDescription
from irlx.robot.urdf import RobotModelError, read_urdf


def with_packaged_defaults(asked: RobotSection) -> RobotSection:
    """The cell's robot section, what it leaves out filled in from the packaged robot it names."""
    if asked.model not in packaged_names():
        return asked
    own = read_cell_file(packaged_cell(asked.model), f"{asked.model} (packaged)").robot
    merged = own.model_copy(update={name: getattr(asked, name) for name in asked.model_fields_set})
    limits = {name: getattr(asked.limits, name) for name in asked.limits.model_fields_set}
    return merged.model_copy(update={"limits": own.limits.model_copy(update=limits)})


def load_robot(section: RobotSection, file: str, folder: Path) -> RobotDescription:
    """Description of the robot a cell names; paths are relative to `folder`, the cell's own.

    Raises CellError: IRL610 no model, IRL611 unknown name or missing file, IRL612 a URDF that
    cannot be used, IRL613 fewer than six axes.
    """
    place = Place(file, key="robot.model")
    model = section.model
    if model is None:
        raise CellError(report("IRL610", place, known=", ".join(packaged_names())))
    text = packaged_urdf(model) if model in packaged_names() else _urdf_file(model, folder, place)
    try:
        # Joint kinds decide the units of locked values, so the model is read before they are known.
        kinds = {joint.name: joint for joint in read_urdf(text, section.tip).joints}
        locked = {
            name: value * 1e-3 if name in kinds and kinds[name].is_prismatic else value * _DEGREE
            for name, value in section.locked.items()
        }
        robot = read_urdf(text, section.tip, locked)
    except RobotModelError as cause:
        near = near_matches(cause.subject, cause.known)
        raise CellError(report("IRL612", place, model=model, cause=str(cause), near=near)) from cause
    if len(robot.axes) < _TASK_ROWS:
        names = ", ".join(robot.joint_names) or "none"
        raise CellError(report("IRL613", place, tip=robot.tip, found=len(robot.axes), names=names))
    return robot


_DEGREE = 0.017453292519943295
_TASK_ROWS = 6


def _urdf_file(model: str, folder: Path, place: Place) -> str:
    path = folder / model
    looks_like_a_path = "/" in model or "." in model
    if not looks_like_a_path or not path.is_file():
        near = near_matches(model, packaged_names())
        tried = "" if not looks_like_a_path else f" (looked for {path})"
        known = ", ".join(packaged_names())
        raise CellError(report("IRL611", place, model=model, tried=tried, near=near, known=known))
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as cause:
        raise CellError(report("IRL612", place, model=model, cause=str(cause), near="")) from cause
