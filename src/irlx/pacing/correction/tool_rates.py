"""How fast a correction may change, whatever the joints could do."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ToolRates:
    """Most speed (m/s, rad/s) and acceleration (m/s2, rad/s2) of a correction: the cell's [motion]."""

    speed: float
    acceleration: float
    speed_ori: float
    acceleration_ori: float
