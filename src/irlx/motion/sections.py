"""Sections of a path, each with bounds of its own on the rate of the path parameter."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import MotionLaw

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

RISE_TIME = 0.05
"""Time in which an S curve reaches its acceleration where the program gives no jerk, s."""

_TURN_SHARE = 0.5
"""Part of ACC_ORI that a changing turn may use up by its speed alone; the rest is left for gaining speed."""


@dataclass(frozen=True)
class Shape:
    """What N sections of a path ask of its time law, each array (N,).

    `lengths` in units of s; largest `curvature` of each, 1/m, `turn_rate`, rad/m, and `turn_bend`, rad/m2.
    `varying` (N,): these change within the section; None: nowhere.
    """

    lengths: Array
    curvature: Array
    turn_rate: Array
    turn_bend: Array
    varying: Flags | None = None

    @classmethod
    def joined(cls, parts: Sequence[Shape]) -> Shape:
        """Several one after another."""
        lengths, curvature, turn_rate, turn_bend, varying = (
            np.concatenate(column)
            for column in zip(
                *((p.lengths, p.curvature, p.turn_rate, p.turn_bend, p.flags) for p in parts), strict=True
            )
        )
        return cls(lengths, curvature, turn_rate, turn_bend, varying)

    @property
    def flags(self) -> Flags:
        """`varying` for every section."""
        return _flags(self.varying, self.lengths)

    def part(self, chosen: slice) -> Shape:
        """Some of the sections."""
        return Shape(
            self.lengths[chosen],
            self.curvature[chosen],
            self.turn_rate[chosen],
            self.turn_bend[chosen],
            _flags(self.varying, self.lengths)[chosen],
        )


@dataclass(frozen=True)
class Sections:
    """Bounds of N sections in a row, each array (N,), all > 0: on ds/dt, |d2s/dt2| and |d3s/dt3|.

    Where they are `varying` (N,), sections stand for bounds that change steadily: from one to the next the
    rate is to change steadily too, not to wait for the border. None: nowhere.
    """

    lengths: Array
    speed: Array
    acc: Array
    jerk: Array
    varying: Flags | None = None

    @property
    def steadily(self) -> list[bool]:
        """Whether the rate is to change steadily within each section."""
        return [bool(flag) for flag in _flags(self.varying, self.lengths)]

    @classmethod
    def joined(cls, parts: Sequence[Sections]) -> Sections:
        """Several one after another."""
        lengths, speed, acc, jerk = (
            np.concatenate(column)
            for column in zip(*((p.lengths, p.speed, p.acc, p.jerk) for p in parts), strict=True)
        )
        varying = np.concatenate([_flags(part.varying, part.lengths) for part in parts])
        return cls(lengths, speed, acc, jerk, varying)


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
    return Sections(shape.lengths, speed * scale, acc * scale**2, jerk * scale**3, shape.varying)


def _flags(varying: Flags | None, lengths: Array) -> Flags:
    return np.zeros(len(lengths), dtype=np.bool_) if varying is None else varying


def rise_time(law: MotionLaw) -> float:
    """Time in which an S curve reaches its acceleration, s, before OVERRIDE."""
    return RISE_TIME if law.jerk is None else law.acc / law.jerk
