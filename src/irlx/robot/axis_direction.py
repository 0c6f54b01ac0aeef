"""A condition on where an axis of a link points, as plain data."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.solids.placement import Vector3


@dataclass(frozen=True)
class AxisDirection:
    """`axis` of the link, a unit vector in the link's frame, points along `direction`, one in the root frame.

    Two equations: the turn about the direction is free. The opposite direction does not keep it. `name` and
    `key`, its place in the cell file, are for messages.
    """

    name: str
    link: str
    axis: Vector3
    direction: Vector3
    key: str = ""
