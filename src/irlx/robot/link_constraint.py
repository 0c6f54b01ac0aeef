"""Interface of the conditions that a link has to keep."""

from __future__ import annotations

from abc import abstractmethod

from irlx.robot.equality import Array, Constraint


class LinkConstraint(Constraint):
    """A constraint that can say in words where its link stands."""

    @abstractmethod
    def in_words(self, q: Array) -> str:
        """How far posture q (n,) is from keeping it."""
