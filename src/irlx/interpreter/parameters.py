"""Parameters of MOVE and CRITERION: their ranges, and what they say together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from irlx.blocks import CriterionChoice, CriterionParam
from irlx.diagnostics import SourceText
from irlx.interpreter.compiled import Compiled
from irlx.interpreter.errors import fail
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.types import REAL
from irlx.language import tree

_WEIGHT = "weight"


def positive(name: str, value: float, node: tree.Node, source: SourceText) -> float:
    """The value where it is greater than 0. Raises InterpreterError, IRL505, at the node."""
    if not value > 0.0:
        data = {"param": name, "expected": "greater than 0", "value": f"{value:g}"}
        raise fail("IRL505", source, node.span, **data)
    return value


def share(name: str, percent: float, node: tree.Node, source: SourceText) -> float:
    """Percent as a fraction of at most 1. Raises InterpreterError, IRL505, at the node."""
    if percent > 100.0:
        data = {"param": name, "expected": "at most 100 %", "value": f"{percent:g}"}
        raise fail("IRL505", source, node.span, **data)
    return percent / 100.0


def criterion_params(
    node: tree.CriterionStart | tree.WithCriterion, expressions: Expressions
) -> list[tuple[tree.Node, Callable[[], Compiled]]]:
    """Expressions of the parameters of a criterion, in their order."""
    return [(param.value, partial(expressions.value, param.value, REAL)) for param in node.params]


def choice_of(
    node: tree.CriterionStart | tree.WithCriterion, values: Sequence[float], source: SourceText
) -> CriterionChoice:
    """Criterion of a switch or clause: WEIGHT, 1 where it is not given, and the others in their order.

    Raises InterpreterError: IRL505 for a WEIGHT that is not greater than 0.
    """
    weight, params = 1.0, []
    for param, value in zip(node.params, values, strict=True):
        if param.name.key == _WEIGHT:
            weight = positive("WEIGHT", value, param.value, source)
        else:
            params.append(CriterionParam(param.name.key.upper(), value))
    return CriterionChoice(criterion_name(node.name), weight, tuple(params))


def criterion_name(name: tree.Name) -> str:
    """Name of a criterion as blocks have it, the same for every spelling."""
    return name.key.upper()
