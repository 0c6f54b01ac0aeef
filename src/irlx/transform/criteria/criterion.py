"""Interface of every criterion."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from irlx.transform.metric import inverse, solved

Array = NDArray[np.float64]


class Criterion(ABC):
    """A function phi of the whole step of a tick that the inverse transform makes small.

    `step` (n,) is the step since the start of the tick, `q` (n,) the posture at that start. The
    Hessian does not depend on the step and must be positive; a diagonal one is given as such, (n,), another
    one whole, (n, n).
    """

    name: str

    def begun(self, q: Array) -> Criterion:
        """The criterion of a tick that begins at posture q (n,): what depends on that is computed once."""
        return self

    def asking_at_most(self, size: float) -> Criterion:
        """The criterion of a tick that has begun, what it adds to a posture term held to a `size`, for plans
        in which a step may be paid for by slowing down: 1/2 size^2 is what phi may gain by it."""
        return self

    @abstractmethod
    def value(self, q: Array, step: Array) -> float:
        """phi at a step."""

    @abstractmethod
    def gradient(self, q: Array, step: Array) -> Array:
        """Derivative of phi by the step, shape (n,)."""

    @abstractmethod
    def hessian(self) -> Array:
        """Second derivative of phi by the step: its diagonal (n,), or all of it (n, n)."""

    def pull(self, q: Array, step: Array) -> Array:
        """Way from a step to the one that makes phi smallest where no path is asked for: -H^-1 g, (n,)."""
        return -solved(self.hessian(), self.gradient(q, step))

    def inverse_hessian(self) -> Array:
        """H^-1, as a diagonal (n,) or whole (n, n)."""
        return inverse(self.hessian())
