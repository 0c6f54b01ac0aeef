"""The curves of one stream as plain data, in the units in which they are drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.report.plot.quantity import Quantity

Array = NDArray[np.float64]

_ON = 1e-3
"""Difference, as a part of a bound, up to which a curve lies on it."""


@dataclass(frozen=True, eq=False)
class Bounds:
    """Lower and upper bounds (S, n) of n joints in S spans of time, from `begin` to `end` (S,), s."""

    begin: Array
    end: Array
    lower: Array
    upper: Array

    def steps(self, joint: int) -> tuple[Array, Array, Array]:
        """Corners of both bounds of a joint as lines: times, lower and upper (2 S,); no number where it has
        none."""
        times = np.stack([self.begin, self.end], axis=1).ravel()
        sides = (np.repeat(side[:, joint], 2) for side in (self.lower, self.upper))
        lower, upper = (np.where(np.isfinite(side), side, np.nan) for side in sides)
        return times, lower, upper


@dataclass(frozen=True)
class LimitSpan:
    """A joint (from 0) at its limit of a quantity from `begin` to `end`, s."""

    quantity: Quantity
    joint: int
    begin: float
    end: float


@dataclass(frozen=True)
class MoveMark:
    """A motion of the program that begins at a time, s, and its line."""

    time: float
    line: int


@dataclass(frozen=True, eq=False)
class Track:
    """One curve of the robot as a whole: `values` (K,) at times `t` (K,), s, no number where there is none.

    `bound` (K,), called `bound_name`, is what it is held against: a margin, or what was programmed.
    """

    title: str
    unit: str
    t: Array
    values: Array
    bound: Array | None = None
    bound_name: str = ""
    stepped: bool = False

    @property
    def apart(self) -> Array:
        """The bound where the curve does not lie on it, and at the ends of such stretches; else no number."""
        if self.bound is None:
            return np.full_like(self.values, np.nan)
        with np.errstate(invalid="ignore"):
            off = np.abs(self.bound - self.values) > _ON * np.abs(self.bound)
        beside = off.copy()
        beside[1:] |= off[:-1]
        beside[:-1] |= off[1:]
        return np.where(beside, self.bound, np.nan)


@dataclass(frozen=True, eq=False)
class Curves:
    """What is drawn of one stream: N rows at times `t` (N,), s, of n joints.

    `name` for legends, `title` for headings. `values` (N, n) and `bounds` by the quantity of joints, in deg
    or mm as `units` (n,) say and s; `limit_spans` are those in which a joint is at a limit, `slowed` those in
    which the tool is slower than programmed, s. `tracks` by their quantity, some of which have several.
    """

    name: str
    title: str
    robot: str
    complete: bool
    t: Array
    joint_names: tuple[str, ...]
    units: tuple[str, ...]
    values: Mapping[Quantity, Array]
    bounds: Mapping[Quantity, Bounds]
    limit_spans: tuple[LimitSpan, ...]
    moves: tuple[MoveMark, ...]
    slowed: tuple[tuple[float, float], ...]
    tracks: Mapping[Quantity, tuple[Track, ...]]

    def spans(self, quantity: Quantity, joint: int) -> list[tuple[float, float]]:
        """Times in which a joint is at its limit of a quantity."""
        return [
            (span.begin, span.end)
            for span in self.limit_spans
            if span.quantity is quantity and span.joint == joint
        ]
