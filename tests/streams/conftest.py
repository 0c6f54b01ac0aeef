"""The gantry's streams for every test of this folder."""

from gantry import gantry_kit, good, robot

__all__ = ["gantry_kit", "good", "robot"]
