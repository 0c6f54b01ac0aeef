"""Blocks of signals and of time: outputs set, inputs read, waits."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from irlx.blocks.block import Block


class SignalKind(str, Enum):
    """What a port carries."""

    BOOL = "BOOL"
    INT = "INT"
    REAL = "REAL"


@dataclass(frozen=True)
class Port:
    """A port of the controller, as IN_3 or AOUT_1; `kind` says how its values are to be read."""

    name: str
    kind: SignalKind


@dataclass(frozen=True, kw_only=True)
class SignalBlock(Block):
    """An output takes a value at the tick at which the block begins: 0 or 1 for a BOOL."""

    port: Port
    value: float


@dataclass(frozen=True, kw_only=True)
class InputBlock(Block):
    """The program read an input, and this is what it read."""

    port: Port
    value: float


@dataclass(frozen=True, kw_only=True)
class WaitBlock(Block):
    """The robot stands for `duration` s, rounded up to whole ticks.

    `condition` is what the program waits for, in its words, or empty where it waits for the time alone. It
    looks again after each wait, so that one statement may have several.
    """

    duration: float
    condition: str = ""
