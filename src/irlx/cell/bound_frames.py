"""Frames of a cell that move with a link of its robot."""

from __future__ import annotations

from irlx.blocks.link_frame import LinkFrame
from irlx.cell.schema import CellFile, FrameSection
from irlx.diagnostics import Diagnostic, Place, report
from irlx.robot.description import RobotDescription


def bound_links(content: CellFile) -> dict[str, str]:
    """Links that frames are bound to, by the keys of the cell that name them."""
    frames = content.frames.items()
    return {f"frames.{name}.link": section.link for name, section in frames if section.link is not None}


def bound_frame_errors(content: CellFile, robot: RobotDescription, file: str) -> list[Diagnostic]:
    """Findings, IRL647, on frames in which the tool never moves: no axis is between their link and it."""
    moving = [joint.name for joint in robot.chain if joint in robot.axes]
    found = []
    for key, link in bound_links(content).items():
        own = [joint.name for joint in robot.chain_to(link) if joint in robot.axes]
        if own == moving:
            found.append(report("IRL647", Place(file, key=key), key=key, link=link, tip=robot.tip))
    return found


def link_frame(
    name: str, section: FrameSection, quaternion: tuple[float, float, float, float]
) -> LinkFrame | None:
    """The frame of a table with a link, None of one without; `quaternion` is its turn, scalar first."""
    if section.link is None:
        return None
    (x, y, z), (qw, qx, qy, qz) = section.xyz, quaternion
    return LinkFrame(name, section.link, (x * 1e-3, y * 1e-3, z * 1e-3), (qx, qy, qz, qw))
