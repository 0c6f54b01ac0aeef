"""Constraints that users register by name, for cells to use."""

from __future__ import annotations

from collections.abc import Callable

from irlx.robot.equality import Constraint
from irlx.robot.kinematics import Kinematics

Maker = Callable[[Kinematics], Constraint]

_registered: dict[str, Maker] = {}


def register_constraint(constraint: type[Constraint]) -> type[Constraint]:
    """Make a constraint known under its `name`; the class is made once a run, from the robot's kinematics.

    A name that is registered again is replaced.
    """
    _registered[constraint.name] = constraint
    return constraint


def registered_constraints() -> dict[str, Maker]:
    """Every registered constraint by its name."""
    return dict(_registered)
