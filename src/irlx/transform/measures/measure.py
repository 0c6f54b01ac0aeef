"""Interface of every measure."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Measure(ABC):
    """A function c(q) of the posture q, shape (n,), rad or m in the order of the robot's axes.

    `sense` is +1 where smaller values are better and -1 where larger ones are: `sense * gradient(q)` always
    leads to worse postures. Value and gradient are those of the plain measure, whatever its sense.
    """

    name: str
    sense: int

    @abstractmethod
    def value(self, q: Array) -> float:
        """c at a posture."""

    @abstractmethod
    def gradient(self, q: Array) -> Array:
        """Derivative of c by q, shape (n,), per rad or m."""
