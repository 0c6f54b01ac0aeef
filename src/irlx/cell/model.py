"""Which robot a cell names: a packaged one by name, or any URDF by path."""

from __future__ import annotations

from pathlib import Path

from irlx.cell.errors import CellError
from irlx.cell.find import is_file
from irlx.cell.packaged import packaged_cell, packaged_names, packaged_urdf
from irlx.cell.read import read_cell_file
from irlx.cell.schema import RobotSection, Section
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


def without_absent_joints(
    section: RobotSection, asked: RobotSection, robot: RobotDescription
) -> RobotSection:
    """The section with packaged lists, those that `asked` does not give, reduced to the joints of `robot`.

    A packaged robot has fewer joints than its lists where the cell locks some, or takes another tip.
    """
    if asked.model not in packaged_names():
        return section
    own = read_cell_file(packaged_cell(asked.model), f"{asked.model} (packaged)").robot
    names = read_urdf(packaged_urdf(asked.model), own.tip).joint_names
    kept = [index for index, name in enumerate(names) if name in robot.joint_names]
    lists = _reduced(own, ("start", "weights"), asked, kept)
    limits = _reduced(own.limits, ("position", "speed", "acceleration"), asked.limits, kept)
    return section.model_copy(update={**lists, "limits": section.limits.model_copy(update=limits)})


def _reduced(own: Section, names: tuple[str, ...], asked: Section, kept: list[int]) -> dict[str, object]:
    """Lists of `own` that `asked` does not replace, their entries at `kept`."""
    found: dict[str, object] = {}
    for name in names:
        entries = getattr(own, name)
        if name not in asked.model_fields_set and isinstance(entries, list):
            found[name] = [entries[index] for index in kept]
    return found


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
    # Joint kinds decide the units of locked values, so the model is read before they are known.
    try:
        kinds = {joint.name: joint for joint in read_urdf(text, section.tip).joints}
    except RobotModelError as cause:
        raise _unusable(cause, model, Place(file, key=_faulty_key(cause, section))) from cause
    locked = {
        name: value * 1e-3 if name in kinds and kinds[name].is_prismatic else value * _DEGREE
        for name, value in section.locked.items()
    }
    try:
        robot = read_urdf(text, section.tip, locked)
    except RobotModelError as cause:
        key = f"robot.locked.{cause.subject}" if cause.subject in locked else "robot.model"
        raise _unusable(cause, model, Place(file, key=key)) from cause
    if len(robot.axes) < _TASK_ROWS:
        names = ", ".join(robot.joint_names) or "none"
        raise CellError(report("IRL613", place, tip=robot.tip, found=len(robot.axes), names=names))
    return robot


_DEGREE = 0.017453292519943295
_TASK_ROWS = 6


def _faulty_key(cause: RobotModelError, section: RobotSection) -> str:
    """Key of the cell that a robot model cannot be used with: its tip, or the model itself."""
    no_tip = cause.subject == "tip" if section.tip is None else cause.subject == section.tip
    return "robot.tip" if no_tip and cause.known else "robot.model"


def _unusable(cause: RobotModelError, model: str, place: Place) -> CellError:
    near = near_matches(cause.subject, cause.known)
    return CellError(report("IRL612", place, model=model, cause=str(cause), near=near))


def _urdf_file(model: str, folder: Path, place: Place) -> str:
    path = folder / model
    looks_like_a_path = "/" in model or "." in model
    if not looks_like_a_path or not is_file(path):
        near = near_matches(model, packaged_names())
        tried = "" if not looks_like_a_path else f" (looked for {path})"
        known = ", ".join(packaged_names())
        raise CellError(report("IRL611", place, model=model, tried=tried, near=near, known=known))
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as cause:
        raise CellError(report("IRL612", place, model=model, cause=str(cause), near="")) from cause
