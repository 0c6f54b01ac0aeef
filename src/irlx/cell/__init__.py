"""Cells: a cell file and a robot model become robot, limits, start, frames and motion defaults."""
