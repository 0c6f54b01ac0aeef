"""Colours, for pictures."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Colour:
    """Red, green and blue, and how opaque, each 0 to 1."""

    red: float
    green: float
    blue: float
    opacity: float = 1.0

    @property
    def code(self) -> str:
        """The colour as #rrggbb, without its opacity."""
        return "#" + "".join(f"{round(255 * part):02x}" for part in (self.red, self.green, self.blue))
