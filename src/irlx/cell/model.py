"""Which robot a cell names: one that irlx knows by name, or any URDF by path."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

from irlx.cell.errors import CellError
from irlx.cell.external import external_names
from irlx.cell.find import is_file
from irlx.cell.link_meshes import with_mesh_files
from irlx.cell.named import named_section, named_urdf, robot_names, urdf_folder
from irlx.cell.packaged import packaged_names
from irlx.cell.robot_data import robot_data_folder
from irlx.cell.schema import RobotSection, Section, SelfCollisionSection
from irlx.cell.task import with_origins, with_task
from irlx.diagnostics import Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.diagnostics.near_files import near_files
from irlx.diagnostics.whole_file import whole_text
from irlx.robot.description import RobotDescription
from irlx.robot.urdf import read_urdf
from irlx.robot.urdf_values import RobotModelError

_NONE: Mapping[str, str] = MappingProxyType({})


def with_packaged_defaults(asked: RobotSection) -> RobotSection:
    """The cell's robot section, what it leaves out filled in from the robot it names."""
    if asked.model is None or asked.model not in robot_names():
        return asked
    own = named_section(asked.model)
    merged = own.model_copy(update={name: getattr(asked, name) for name in asked.model_fields_set})
    limits = {name: getattr(asked.limits, name) for name in asked.limits.model_fields_set}
    sections = {
        "limits": own.limits.model_copy(update=limits),
        "self_collision": _self_collision(asked.model, own.self_collision, asked.self_collision),
    }
    return merged.model_copy(update=sections)


def _self_collision(
    model: str, own: SelfCollisionSection, asked: SelfCollisionSection
) -> SelfCollisionSection:
    """What a cell asks for, the rest as the robot of that name has it; pairs that may touch add up."""
    given = {name: getattr(asked, name) for name in asked.model_fields_set}
    given["may_touch"] = [*own.may_touch, *asked.may_touch]
    data = robot_data_folder() if model in external_names() else None
    if own.srdf is not None and asked.srdf is None and data is not None:
        given["srdf"] = str(data / own.srdf)
    fields = own.model_fields_set | asked.model_fields_set
    return own.model_copy(update=given) if fields else own


def without_absent_joints(
    section: RobotSection, asked: RobotSection, robot: RobotDescription
) -> RobotSection:
    """The section with lists of the named robot, those `asked` does not give, for the joints of `robot`.

    A named robot has fewer joints than its lists where the cell locks some, or takes another tip.
    """
    if asked.model is None or asked.model not in robot_names():
        return section
    own = named_section(asked.model)
    urdf = named_urdf(asked.model, Place(asked.model))
    names = read_urdf(urdf, own.tip, carriers=own.hands or ()).joint_names
    if any(name not in names for name in robot.joint_names):
        # Nothing is known of the joints of other hands than its own.
        return _without_lists(section, asked)
    kept = [index for index, name in enumerate(names) if name in robot.joint_names]
    lists = _reduced(own, ("start", "weights"), asked, kept)
    limits = _reduced(own.limits, ("position", "speed", "acceleration"), asked.limits, kept)
    return section.model_copy(update={**lists, "limits": section.limits.model_copy(update=limits)})


def _without_lists(section: RobotSection, asked: RobotSection) -> RobotSection:
    """The section without lists that the cell does not give itself."""
    lists = {name: None for name in ("start", "weights") if name not in asked.model_fields_set}
    kinds = ("position", "speed", "acceleration")
    limits = {
        name: None
        for name in kinds
        if name not in asked.limits.model_fields_set and isinstance(getattr(section.limits, name), list)
    }
    return section.model_copy(update={**lists, "limits": section.limits.model_copy(update=limits)})


def _reduced(own: Section, names: tuple[str, ...], asked: Section, kept: list[int]) -> dict[str, object]:
    """Lists of `own` that `asked` does not replace, their entries at `kept`."""
    found: dict[str, object] = {}
    for name in names:
        entries = getattr(own, name)
        if name not in asked.model_fields_set and isinstance(entries, list):
            found[name] = [entries[index] for index in kept]
    return found


def load_robot(
    section: RobotSection, file: str, folder: Path, bound: Mapping[str, str] = _NONE
) -> RobotDescription:
    """Description of the robot a cell names; paths are relative to `folder`, the cell's own.

    Joints that lead to its other hands and to the links `bound`, by the keys of the cell that name them, are
    axes as well. Raises CellError: IRL610 no model, IRL611 unknown name or missing file, IRL612 a URDF that
    cannot be used, IRL613 fewer axes than its task has coordinates, IRL614 a robot of an extra that is not
    installed, IRL643 a link that the robot does not have; those of `with_origins` and `with_task`.
    """
    place = Place(file, key="robot.model")
    model = section.model
    if model is None:
        raise CellError(report("IRL610", place, **_known()))
    text = named_urdf(model, place) if model in robot_names() else _urdf_file(model, folder, place)
    # Joint kinds decide the units of locked values, so the model is read before they are known.
    held = _read(text, section, dict.fromkeys(section.locked, 0.0), file)
    carriers = _carriers(section, held, file, bound)
    slides = {joint.name for joint in held.joints if joint.is_prismatic}
    locked = {name: value * (1e-3 if name in slides else _DEGREE) for name, value in section.locked.items()}
    again = locked != dict.fromkeys(locked, 0.0) or carriers
    read = _read(text, section, locked, file, carriers) if again else held
    robot = with_mesh_files(read, urdf_folder(model, folder))
    return with_task(with_origins(robot, section, file), _own_task(section), file)


def _own_task(section: RobotSection) -> RobotSection:
    """The section, what it does not say of the task as the robot of that name has it."""
    if section.model not in robot_names():
        return section
    own = named_section(section.model)
    given = {name: getattr(section, name) for name in _OF_TASK if name in section.model_fields_set}
    return section.model_copy(update={name: getattr(own, name) for name in _OF_TASK} | given)


_OF_TASK = ("task", "task_frame", "free")


def _carriers(
    section: RobotSection, robot: RobotDescription, file: str, bound: Mapping[str, str]
) -> tuple[str, ...]:
    """Links whose joints are axes beside those of the tip. Raises CellError, IRL643, for unknown ones."""
    hands = section.hands
    if hands is None and section.model in robot_names():
        hands = named_section(section.model or "").hands
    wanted = {f"robot.hands[{number}]": link for number, link in enumerate(hands or (), 1)} | dict(bound)
    links = (robot.root, *(joint.child for joint in robot.joints))
    known = ", ".join(links)
    unknown = [
        report(
            "IRL643", Place(file, key=key), key=key, name=link, near=near_matches(link, links), known=known
        )
        for key, link in wanted.items()
        if link not in links
    ]
    if unknown:
        raise CellError(unknown)
    return tuple(dict.fromkeys(wanted.values()))


_DEGREE = 0.017453292519943295


def _read(
    text: str,
    section: RobotSection,
    locked: dict[str, float],
    file: str,
    carriers: tuple[str, ...] = (),
) -> RobotDescription:
    """Robot of a URDF with joints held at `locked` (rad or m). Raises CellError, IRL612, at its key."""
    try:
        return read_urdf(text, section.tip, locked, carriers)
    except RobotModelError as cause:
        subject = cause.subject
        key = f"robot.locked.{subject}" if subject in locked else _faulty_key(cause, section)
        raise _unusable(cause, section.model or "", Place(file, key=key)) from cause


def _faulty_key(cause: RobotModelError, section: RobotSection) -> str:
    """Key of the cell that a robot model cannot be used with: its tip, or the model itself."""
    no_tip = cause.subject == "tip" if section.tip is None else cause.subject == section.tip
    return "robot.tip" if no_tip and cause.known else "robot.model"


def _unusable(cause: RobotModelError, model: str, place: Place) -> CellError:
    near = near_matches(cause.subject, cause.known)
    return CellError(report("IRL612", place, model=model, cause=str(cause), near=near))


def _known() -> dict[str, Any]:
    """Names for messages: robots that come with irlx, robots of the extra."""
    return {"known": ", ".join(packaged_names()), "extra": ", ".join(external_names())}


def _urdf_file(model: str, folder: Path, place: Place) -> str:
    path = folder / model
    looks_like_a_path = "/" in model or "." in model
    if not looks_like_a_path or not is_file(path):
        near = near_matches(model, robot_names())
        beside = path if looks_like_a_path else folder / f"{model}.urdf"
        near = near or (near_files(beside) if beside.suffix else "")
        tried = "" if not looks_like_a_path else f" (looked for {path})"
        raise CellError(report("IRL611", place, model=model, tried=tried, near=near, **_known()))
    try:
        return whole_text(path)
    except (OSError, UnicodeDecodeError) as cause:
        raise CellError(report("IRL612", place, model=model, cause=str(cause), near="")) from cause
