"""The gantry's streams for every test of this folder, and programs and cells that are read once."""

from gantry import gantry_kit, good, robot
from read_once import read_once

__all__ = ["gantry_kit", "good", "read_once", "robot"]
