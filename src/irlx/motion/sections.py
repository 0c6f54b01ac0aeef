"""Sections of a path, each with bounds of its own on the rate of the path parameter."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MotionLaw

Array = NDArray[np.float64]

RISE_TIME = 0.05
"""Time in which an S curve reaches its acceleration where the program gives no jerk, s."""

_TURN_SHARE = 0.5
"""Part of ACC_ORI that a changing turn may use up by its speed alone; the rest is left for gaining speed."""


@dataclass(frozen=True)
class Shape:
    """What N sections of a path ask of its time law, each array (N,).

    `lengths` in units of s; largest `curvature` of each, 1/m, `turn_rate`, rad/m, and `turn_bend`, rad/m2.
    """

    lengths: Array
    curvature: Array
    turn_rate: Array
    turn_bend: Array

    @classmethod
    def joined(cls, parts: Sequence[Shape]) -> Shape:
        """Several one after another."""
        columns = zip(
            *((part.lengths, part.curvature, part.turn_rate, part.turn_bend) for part in parts), strict=True
        )
        return cls(*(np.concatenate(column) for column in columns))

    def part(self, chosen: slice) -> Shape:
        """Some of the sections."""
        return Shape(
            self.lengths[chosen], self.curvature[chosen], self.turn_rate[chosen], self.turn_bend[chosen]
        )


@dataclass(frozen=True)
class Sections:
    """Bounds of N sections in a row, each array (N,), all > 0: on ds/dt, |d2s/dt2| and |d3s/dt3|."""

    lengths: Array
    speed: Array
    acc: Array
    jerk: Array

    @classmethod
    def joined(cls, parts: Sequence[Sections]) -> Sections:
        """Several one after another."""
        columns = zip(*((part.lengths, part.speed, part.acc, part.jerk) for part in parts), strict=True)
        return cls(*(np.concatenate(column) for column in columns))


def bounds_of(shape: Shape, law: MotionLaw) -> Sections:
    """Bounds by which a path of this shape keeps a law whose OVERRIDE is in force.

    ACC bounds s'' and, by itself, s'^2 curvature; ACC_ORI the whole change of the turn's speed,
    s'^2 turn_bend + |s''| turn_rate: at most half of it goes into the first term. The jerk keeps its ratio
    to ACC where the turn leaves less acceleration.
    """
    with np.errstate(divide="ignore"):
        speed = np.minimum.reduce(
            [
                np.full_like(shape.lengths, law.speed),
                np.sqrt(law.acc / shape.curvature),
                law.speed_ori / shape.turn_rate,
                np.sqrt(_TURN_SHARE * law.acc_ori / shape.turn_bend),
            ]
        )
        acc = np.minimum(law.acc, (law.acc_ori - speed**2 * shape.turn_bend) / shape.turn_rate)
    jerk = acc / rise_time(law)
    scale = law.override
    return Sections(shape.lengths, speed * scale, acc * scale**2, jerk * scale**3)


def rise_time(law: MotionLaw) -> float:
    """Time in which an S curve reaches its acceleration, s, before OVERRIDE."""
    return RISE_TIME if law.jerk is None else law.acc / law.jerk
