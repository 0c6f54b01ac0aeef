"""`irlx.register`: one word for whatever users add by name."""

from __future__ import annotations

from typing import TypeVar

from irlx.robot.equality import Constraint
from irlx.robot.registered_constraints import register_constraint
from irlx.transform.criteria.library import register as register_criterion
from irlx.transform.measures.measure import Measure

Registered = TypeVar("Registered", type[Measure], type[Constraint])


def register(cls: Registered) -> Registered:
    """Make a criterion or a constraint of your own known under its `name`; may be used as a decorator.

    A `Criterion` is called by programs, in upper case; a `Constraint` by cells, `use = "name"`. Raises
    ValueError for a criterion's name that the library has, or that no program could write, TypeError for
    a class that is neither.
    """
    if isinstance(cls, type) and issubclass(cls, Measure):
        register_criterion(cls)
    elif isinstance(cls, type) and issubclass(cls, Constraint):
        register_constraint(cls)
    else:
        raise TypeError(f"{cls!r} is neither an irlx.Criterion nor an irlx.Constraint")
    return cls
