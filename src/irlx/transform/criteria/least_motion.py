"""Least motion: every tick moves the joints as little as it can, weighted."""

from __future__ import annotations

from irlx.transform.criteria.criterion import Array, Criterion


class LeastMotion(Criterion):
    """phi = 1/2 S' W S, S the step of the tick, W = diag(weights), one weight a joint (> 0)."""

    name = "least motion"

    def __init__(self, weights: Array) -> None:
        self.weights = weights
        self._inverse: Array = 1.0 / weights

    def value(self, q: Array, step: Array) -> float:
        """1/2 S' W S."""
        return float(0.5 * (self.weights * step) @ step)

    def gradient(self, q: Array, step: Array) -> Array:
        """W S."""
        return self.weights * step

    def hessian(self) -> Array:
        """W."""
        return self.weights

    def pull(self, q: Array, step: Array) -> Array:
        """-S."""
        return -step

    def inverse_hessian(self) -> Array:
        """W^-1."""
        return self._inverse
