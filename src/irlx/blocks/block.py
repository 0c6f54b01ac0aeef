"""What every function block carries, and the blocks that end a program early or hold it up."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Origin:
    """Where in a program a block comes from: file (no folder), offsets ``[start, end)``, line from 1."""

    file: str
    start: int
    end: int
    line: int


@dataclass(frozen=True, kw_only=True)
class Block:
    """One thing the program asks the machine to do.

    `id` counts the blocks of a run from 1; `robot` and `process` name who it is for.
    """

    id: int
    origin: Origin
    robot: str = "default"
    process: str = "main"


@dataclass(frozen=True, kw_only=True)
class HaltBlock(Block):
    """The program ends here although statements follow."""


@dataclass(frozen=True, kw_only=True)
class PauseBlock(Block):
    """The robot stands for `duration` s, rounded up to whole ticks, which is how long its answer took."""

    duration: float = 0.0
