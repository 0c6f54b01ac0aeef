"""Interface of every criterion."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class Criterion(ABC):
    """A function phi of the whole step of a tick that the inverse transform makes small.

    `step` (n,) is the step since the start of the tick, `q` (n,) the posture at that start. The
    Hessian is diagonal and does not depend on the step; it must be positive.
    """

    name: str

    @abstractmethod
    def value(self, q: Array, step: Array) -> float:
        """phi at a step."""

    @abstractmethod
    def gradient(self, q: Array, step: Array) -> Array:
        """Derivative of phi by the step, shape (n,)."""

    @abstractmethod
    def hessian(self) -> Array:
        """Diagonal of the second derivative of phi by the step, shape (n,)."""

    def pull(self, q: Array, step: Array) -> Array:
        """Way from a step to the one that makes phi smallest where no path is asked for: -H^-1 g, (n,)."""
        return -self.gradient(q, step) / self.hessian()

    def inverse_hessian(self) -> Array:
        """Diagonal of H^-1, shape (n,)."""
        return 1.0 / self.hessian()
