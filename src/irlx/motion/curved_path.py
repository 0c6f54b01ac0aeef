"""A path of the tool along a polynomial curve: blends and splines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from irlx.motion.largest_values import SAMPLES, largest_values, samples_of, seen_in
from irlx.motion.polynomial_curve import PolynomialCurve
from irlx.motion.pose_path import Poses
from irlx.motion.sections import Shape
from irlx.motion.turn_curve import TurnCurve

Array = NDArray[np.float64]


@dataclass(frozen=True)
class CurvedPath:
    """Position on a curve by its arc length s, orientation by the same s.

    `cuts` (M + 1,): parameters of the curve from its start to its end; between two of them lies a section,
    for which the time law takes the largest bend.
    `end_position` (3,) and `end_rotation` (3, 3) are what the last pose is exactly.
    """

    curve: PolynomialCurve
    turns: TurnCurve
    cuts: Array
    end_position: Array
    end_rotation: Array

    is_pure_turn = False
    is_nothing = False

    @cached_property
    def widest_turn(self) -> float:
        """Angle of the largest turn about one axis between two points, rad."""
        return self.turns.widest

    @property
    def length(self) -> float:
        """Arc length, m."""
        return self.curve.length

    @cached_property
    def shape(self) -> Shape:
        """Largest curvature, turn rate and turn bend between the cuts."""
        low, high = self.cuts[:-1], self.cuts[1:]
        samples = samples_of(low, high)
        s = self.curve.length_at(samples.ravel())
        ends = np.append(s[::SAMPLES], self.length)
        curvature = largest_values(self.curve.curvature, low, high)
        # Turns run evenly by the way: they have no narrow peaks.
        turn_rate, turn_bend = (
            seen_in(np.linalg.norm(values, axis=1).reshape(samples.shape)).most
            for values in self.turns.rates(s)
        )
        varying = np.ones(len(low), dtype=np.bool_)
        return Shape(np.maximum(np.diff(ends), 0.0), curvature, turn_rate, turn_bend, varying)

    @property
    def turn_rate(self) -> float:
        """Largest angle per m, rad/m."""
        return float(np.max(self.shape.turn_rate))

    @property
    def curvature(self) -> float:
        """Largest curvature, 1/m."""
        return float(np.max(self.shape.curvature))

    @property
    def turn_bend(self) -> float:
        """Largest change of the turn's rate, rad/m2."""
        return float(np.max(self.shape.turn_bend))

    def poses(self, s: Array) -> Poses:
        """Poses at s (N,); the one at `length` is the end to the last bit."""
        position = self.curve.points(self.curve.parameters_at(s))
        rotation = self.turns.rotations(s)
        at_end = s >= self.length
        position[at_end], rotation[at_end] = self.end_position, self.end_rotation
        return Poses(position, rotation)

    def derivatives(self, s: Array) -> tuple[Array, Array]:
        """First derivative by s of position (N, 3) and of orientation (N, 3, rotation vector, world)."""
        return self.curve.along(self.curve.parameters_at(s))[0], self.turns.rates(s)[0]

    def second_derivatives(self, s: Array) -> tuple[Array, Array]:
        """Derivatives by s of the two parts of `derivatives`, each (N, 3)."""
        return self.curve.along(self.curve.parameters_at(s))[1], self.turns.rates(s)[1]
