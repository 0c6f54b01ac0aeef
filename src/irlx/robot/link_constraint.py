"""Interface of the conditions that a link has to keep."""

from __future__ import annotations

from abc import abstractmethod

from irlx.robot.equality import Array, Constraint


class LinkConstraint(Constraint):
    """A constraint whose rows are computed together, and that can say in words where its link stands."""

    @abstractmethod
    def rows(self, q: Array) -> tuple[Array, Array]:
        """Phi (k,) and its derivative (k, n) at posture q (n,)."""

    @abstractmethod
    def in_words(self, q: Array) -> str:
        """How far posture q (n,) is from keeping it."""

    def residual(self, q: Array) -> Array:
        """Phi at posture q (n,), shape (k,)."""
        return self.rows(q)[0]

    def derivative(self, q: Array) -> Array:
        """Derivative of Phi by q, shape (k, n)."""
        return self.rows(q)[1]
