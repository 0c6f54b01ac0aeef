"""Posture: every tick draws the joints towards a reference posture, as far as the tool allows."""

from __future__ import annotations

from irlx.transform.criteria.criterion import Array, Criterion


class Posture(Criterion):
    """phi = 1/2 (q + S - r)' W (q + S - r), r the reference posture, W = diag(weights) (> 0).

    CYCLICSTART uses it with the posture of that moment as reference: on a closed path the tool
    pose alone then decides the posture, so each cycle ends in the posture it began with.
    """

    name = "posture"

    def __init__(self, weights: Array, reference: Array, inverse: Array | None = None) -> None:
        """`inverse` is 1 / weights, where that is known."""
        self.weights = weights
        self.reference = reference
        self._inverse = 1.0 / weights if inverse is None else inverse

    def towards(self, reference: Array) -> Posture:
        """The same towards another posture (n,)."""
        return Posture(self.weights, reference, self._inverse)

    def value(self, q: Array, step: Array) -> float:
        """1/2 (q + S - r)' W (q + S - r)."""
        away = q + step - self.reference
        return float(0.5 * (self.weights * away) @ away)

    def gradient(self, q: Array, step: Array) -> Array:
        """W (q + S - r)."""
        return self.weights * (q + step - self.reference)

    def hessian(self) -> Array:
        """W."""
        return self.weights

    def pull(self, q: Array, step: Array) -> Array:
        """r - (q + S)."""
        return self.reference - (q + step)

    def inverse_hessian(self) -> Array:
        """W^-1."""
        return self._inverse
