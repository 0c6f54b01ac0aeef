"""A frame that moves with a link of the robot."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class LinkFrame:
    """A named frame, rigid with a link: `position` m and unit quaternion (x, y, z, w) in the link's frame."""

    name: str
    link: str
    position: tuple[float, float, float]
    orientation: tuple[float, float, float, float]
