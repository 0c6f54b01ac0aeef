"""What can be drawn over time."""

from __future__ import annotations

from enum import Enum


class Quantity(str, Enum):
    """One thing to draw: of every joint, or of the robot as a whole."""

    POSITION = "position"
    SPEED = "speed"
    ACCELERATION = "acceleration"
    SINGULAR = "singular"
    CLEARANCE = "clearance"
    PATH_SPEED = "path-speed"

    @property
    def per(self) -> str:
        """What follows the unit of a joint."""
        return _PER.get(self, "")


_PER = {Quantity.SPEED: "/s", Quantity.ACCELERATION: "/s²"}
JOINT_QUANTITIES = (Quantity.POSITION, Quantity.SPEED, Quantity.ACCELERATION)
QUANTITIES = tuple(Quantity)
"""All of them, in the order in which they are drawn."""
