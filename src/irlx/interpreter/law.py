"""The time law of a motion: parameters of its MOVE, and system variables for those that it does not give."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import radians
from typing import Any

from irlx.blocks import MotionLaw
from irlx.interpreter.compiled import Compiled
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.parameters import positive, share
from irlx.interpreter.scope import Variable
from irlx.interpreter.support import MOVE_PARAMS
from irlx.interpreter.types import REAL
from irlx.language import tree

_LAW = ("speed", "acc", "speed_ori", "acc_ori", "speed_ptp", "acc_ptp", "time")


def _given(node: tree.Move | tree.Reconfiguration) -> dict[str, tree.Expression]:
    """Parameters of the time law in the order of their evaluation."""
    params = node.params if isinstance(node, tree.Move) else ()
    given = {param.name.key: param.value for param in params}
    return {key: given[key] for key in ("time", *_LAW[:-1]) if key in given}


def law_parts(
    node: tree.Move | tree.Reconfiguration, expressions: Expressions
) -> list[tuple[tree.Node, Callable[[], Compiled]]]:
    """Expressions that `law_of` needs the values of, in this order."""
    return [(part, partial(expressions.value, part, REAL)) for part in _given(node).values()]


def law_of(
    node: tree.Move | tree.Reconfiguration, expressions: Expressions
) -> Callable[[list[Any]], MotionLaw]:
    """Time law of a motion from the values of `law_parts`.

    Raises InterpreterError, IRL505, for values out of range.
    """
    given, source = _given(node), expressions.source
    defaults: dict[str, Variable] = {}
    for param in _LAW[:-1]:
        variable = expressions.scope.found(MOVE_PARAMS[param].casefold())
        if not isinstance(variable, Variable):
            raise TypeError("system variables are variables")
        defaults[param] = variable

    def law(values: list[Any]) -> MotionLaw:
        numbers = dict(zip(given, values, strict=True))

        def real(param: str) -> float:
            if param in numbers:
                return positive(param.upper(), numbers[param], given[param], source)
            variable = defaults[param]
            if not isinstance(variable.value, float):
                raise TypeError("system variables are numbers")
            return positive(variable.name, variable.value, node, source)

        def part(param: str) -> float:
            return share(param.upper(), real(param), given.get(param, node), source)

        duration = positive("TIME", numbers["time"], given["time"], source) if "time" in numbers else None
        return MotionLaw(
            speed=real("speed") * 1e-3,
            acc=real("acc") * 1e-3,
            speed_ori=radians(real("speed_ori")),
            acc_ori=radians(real("acc_ori")),
            speed_ptp=part("speed_ptp"),
            acc_ptp=part("acc_ptp"),
            duration=duration,
        )

    return law
