"""`[[obstacle]]` tables of a cell -> obstacles and groups, SI units, in the world."""

from __future__ import annotations

from math import radians
from pathlib import Path
from unicodedata import normalize

from irlx.cell.findings import Findings
from irlx.cell.obstacle_shape import sizes_fit, solid_shape
from irlx.cell.schema import CellFile, FrameSection, ObstacleSection, WaypointSection
from irlx.diagnostics import Diagnostic, told_apart
from irlx.diagnostics.diagnostic import near_matches
from irlx.language.keywords import is_name
from irlx.scene.obstacle import Obstacle, Waypoint
from irlx.solids.placement import Placement, Vector3
from irlx.solids.shape import Solid

Frames = dict[str, tuple[str, FrameSection]]
"""Frames of a cell by casefolded name, each with the name as the cell writes it."""
WORLD = "world"
"""Frame of obstacles that name no other: the root frame of the robot, as for `[frames]`."""


def read_obstacles(
    content: CellFile, file: str, errors: list[Diagnostic], warnings: list[Diagnostic]
) -> tuple[dict[str, Obstacle], dict[str, tuple[str, ...]]]:
    """Obstacles by casefolded name, and the casefolded names of the members of each group.

    Faults go to `errors`: IRL630 to IRL641; IRL642 to `warnings`.
    """
    _check_names(content.obstacle, file, errors)
    frames = {name.casefold(): (name, section) for name, section in content.frames.items()}
    obstacles: dict[str, Obstacle] = {}
    for index, section in enumerate(content.obstacle):
        findings = Findings(file, f"obstacle[{index + 1}]", errors, warnings)
        _check_margin(section, findings)
        if sizes_fit(section, findings) and section.shape != "group":
            obstacle = _obstacle(section, frames, Path(file).parent, findings)
            obstacles.setdefault(obstacle.name.casefold(), obstacle)
    return obstacles, _groups(content.obstacle, file, errors)


def _obstacle(section: ObstacleSection, frames: Frames, folder: Path, findings: Findings) -> Obstacle:
    """An obstacle; where something is wrong with it, without what is: `findings` tells then."""
    base = base_of(section, frames, findings)
    _check_times(section.trajectory or [], findings)
    shape = solid_shape(section, folder, findings)
    trajectory = tuple(
        Waypoint(waypoint.time, base.of(_pose(waypoint))) for waypoint in section.trajectory or ()
    )
    return Obstacle(
        normalize("NFC", section.name),
        () if shape is None else (Solid(shape),),
        trajectory[0].placement if trajectory else base.of(_pose(section)),
        section.margin * 1e-3,
        section.influence * 1e-3,
        trajectory,
    )


def base_of(section: ObstacleSection, frames: Frames, findings: Findings) -> Placement:
    """Where the frame that an obstacle is placed in lies in the world; IRL636, IRL646 go to `findings`."""
    name = section.frame
    if name is None:
        return Placement()
    frame = frames.get(name.casefold())
    if frame is not None and frame[1].link is not None:
        findings.error("IRL646", "frame", name=frame[0], link=frame[1].link)
        return Placement()
    if frame is not None:
        return _pose(frame[1])
    if name.casefold() != WORLD:
        known = (*(written for written, _ in frames.values()), WORLD)
        findings.error("IRL636", "frame", name=name, near=near_matches(name, known), known=", ".join(known))
    return Placement()


def _pose(section: FrameSection | ObstacleSection | WaypointSection) -> Placement:
    """Pose of a table with xyz in mm and rpy in degrees."""
    x, y, z = (value * 1e-3 for value in section.xyz)
    turns: Vector3 = (radians(section.rpy[0]), radians(section.rpy[1]), radians(section.rpy[2]))
    return Placement.from_rpy((x, y, z), turns)


def _check_margin(section: ObstacleSection, findings: Findings) -> None:
    if section.shape != "group" and section.margin > section.influence:
        margin, influence = told_apart(section.margin, section.influence)
        findings.error("IRL633", "margin", margin=margin, influence=influence)


def _check_times(waypoints: list[WaypointSection], findings: Findings) -> None:
    for index in range(1, len(waypoints)):
        before, found = waypoints[index - 1].time, waypoints[index].time
        if found <= before:
            key = f"trajectory[{index + 1}].time"
            at, earlier = told_apart(found, before)
            findings.error("IRL638", key, found=at, before=earlier)


def _check_names(sections: list[ObstacleSection], file: str, errors: list[Diagnostic]) -> None:
    """Names that programs cannot write (IRL635) or cannot tell apart (IRL634)."""
    first: dict[str, str] = {}
    for index, section in enumerate(sections):
        findings = Findings(file, f"obstacle[{index + 1}]", errors)
        name = normalize("NFC", section.name)
        if not is_name(name):
            findings.error("IRL635", "name", name=name)
        elif name.casefold() in first:
            findings.error("IRL634", "name", name=name, other=first[name.casefold()])
        first.setdefault(name.casefold(), name)


def _groups(
    sections: list[ObstacleSection], file: str, errors: list[Diagnostic]
) -> dict[str, tuple[str, ...]]:
    """Members of each group. Those that are none go to `errors`, IRL637."""
    names = {normalize("NFC", section.name).casefold(): section for section in sections}
    single = tuple(section.name for section in sections if section.shape != "group")
    groups: dict[str, tuple[str, ...]] = {}
    for index, group in enumerate(sections):
        if group.shape != "group" or not group.members:
            continue
        findings = Findings(file, f"obstacle[{index + 1}]", errors)
        members = [normalize("NFC", name).casefold() for name in group.members]
        for position, (name, key) in enumerate(zip(group.members, members, strict=True)):
            found = names.get(key)
            cause = "no obstacle of the cell"
            if found is not None:
                cause = "a group itself" if found.shape == "group" else ""
            if not cause and key in members[:position]:
                cause = "named twice"
            if cause:
                near = near_matches(name, single) if found is None else ""
                data = {"cause": cause, "near": near, "known": ", ".join(single) or "none"}
                findings.error("IRL637", f"members[{position + 1}]", name=name, **data)
        groups.setdefault(normalize("NFC", group.name).casefold(), tuple(members))
    return groups
