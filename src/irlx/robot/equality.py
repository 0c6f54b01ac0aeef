"""Conditions between the joints that hold beside the tool pose at every tick."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import NDArray

from irlx.robot.relation import JointRelation

Array = NDArray[np.float64]

STILL = 1e-12
"""Derivatives below this, of rad or m by rad or m, are rounding."""


class Constraint(ABC):
    """k equations Phi(q) = 0 between the joints (n,); their rows come after those of the tool pose.

    `name` is for messages. Phi should be of the size of rad or m: it is held to 1e-7 within a tick's
    iterations and to 1e-6 in every row.
    """

    name: str

    @abstractmethod
    def residual(self, q: Array) -> Array:
        """Phi at posture q (n,), shape (k,)."""

    @abstractmethod
    def derivative(self, q: Array) -> Array:
        """Derivative of Phi by q, shape (k, n)."""

    def rows(self, q: Array) -> tuple[Array, Array]:
        """Both at once, for those that have much in common."""
        return self.residual(q), self.derivative(q)

    def breakable(self, postures: Array, free: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Which of the k equations joints `free` (n,) can break, the others standing as in `postures` (P, n).

        Those whose derivative by the free joints is not zero at all of these postures, which were drawn at
        random: right for whatever is not flat in some places and steep in others.
        """
        slopes = np.array([self.derivative(q)[:, free] for q in postures])
        return np.asarray(np.any(np.abs(slopes) > STILL, axis=(0, 2)))


class LinearConstraint(Constraint):
    """A `JointRelation` as a row: Phi = c' q - value."""

    def __init__(self, relation: JointRelation, joint_names: tuple[str, ...]) -> None:
        self.name = relation.name
        self._value = relation.value
        self._row = np.zeros((1, len(joint_names)))
        for joint, factor in relation.factors:
            self._row[0, joint_names.index(joint)] = factor

    def residual(self, q: Array) -> Array:
        """c' q - value, shape (1,)."""
        return np.asarray(self._row @ q - self._value)

    def derivative(self, q: Array) -> Array:
        """c', shape (1, n)."""
        return self._row
