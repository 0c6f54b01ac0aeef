"""Parameters of MOVE and CRITERION: their ranges, and what they say together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from irlx.blocks import CriterionChoice, CriterionParam
from irlx.diagnostics import SourceText, told_apart
from irlx.interpreter.compiled import Compiled
from irlx.interpreter.errors import fail
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.scope import Variable
from irlx.interpreter.types import REAL, Type
from irlx.language import tree

DEFAULTS = {
    "speed": "R_SPEED",
    "acc": "R_ACC",
    "speed_ori": "R_SPEED_ORI",
    "acc_ori": "R_ACC_ORI",
    "speed_ptp": "R_SPEED_PTP",
    "acc_ptp": "R_ACC_PTP",
    "jerk": "R_JERK",
    "override": "R_OVERRIDE",
    "profile": "R_PROFILE",
    "c_cp": "R_C_CP",
    "c_ptp": "R_C_PTP",
    "c_pass": "R_C_PASS",
}
"""Parameters of MOVE by casefolded name, each with the system variable of its default; others have none."""
_WEIGHT = "weight"


class Latched(NamedTuple):
    """Value of a parameter when its statement runs, what gave it, and the place to blame."""

    value: Any
    name: str
    node: tree.Node


class Parameters:
    """Some parameters of a motion by casefolded name, in the order of their evaluation, with their types.

    What the statement does not give comes from the system variable of its default.
    """

    def __init__(
        self, node: tree.Move | tree.Reconfiguration, expressions: Expressions, types: Mapping[str, Type]
    ) -> None:
        self._node, self._types, self._expressions = node, types, expressions
        params = node.params if isinstance(node, tree.Move) else ()
        told = {param.name.key: param.value for param in params}
        self._given = {key: told[key] for key in types if key in told}

    @property
    def parts(self) -> list[tuple[tree.Node, Callable[[], Compiled]]]:
        """Expressions that `latched` needs the values of, in this order."""
        value = self._expressions.value
        return [(part, partial(value, part, self._types[key])) for key, part in self._given.items()]

    def gives(self, key: str) -> bool:
        """Whether the statement has the parameter itself."""
        return key in self._given

    def latched(self, values: Sequence[Any]) -> Callable[[str], Latched]:
        """What gives each parameter, now that the values of `parts` are known."""
        found = dict(zip(self._given, values, strict=True))

        def take(key: str) -> Latched:
            if key in found:
                return Latched(found[key], key.upper(), self._given[key])
            variable = self._expressions.scope.found(DEFAULTS[key].casefold())
            if not isinstance(variable, Variable):
                raise TypeError("system variables are variables")
            return Latched(variable.value, variable.name, self._node)

        return take


def positive(found: Latched, source: SourceText) -> float:
    """The value where it is greater than 0. Raises InterpreterError, IRL505, at its place."""
    return _within(found, found.value > 0.0, "greater than 0", 0.0, source)


def not_negative(found: Latched, source: SourceText) -> float:
    """The value where it is 0 or more. Raises InterpreterError, IRL505, at its place."""
    return _within(found, found.value >= 0.0, "0 or more", 0.0, source)


def share(found: Latched, source: SourceText) -> float:
    """Percent as a fraction of at most 1. Raises InterpreterError, IRL505, at its place."""
    return _within(found, found.value <= 100.0, "at most 100 %", 100.0, source) / 100.0


def word(found: Latched, words: Sequence[str], source: SourceText) -> str:
    """The value in upper case where it is one of some words. Raises InterpreterError, IRL505."""
    value: str = found.value.upper()
    if value not in words:
        expected = " or ".join(f"'{one}'" for one in words)
        data = {"param": found.name, "expected": expected, "value": f"'{found.value}'"}
        raise fail("IRL505", source, found.node.span, **data)
    return value


def _within(found: Latched, holds: bool, expected: str, bound: float, source: SourceText) -> float:
    if not holds:
        data = {"param": found.name, "expected": expected, "value": told_apart(found.value, bound)[0]}
        raise fail("IRL505", source, found.node.span, **data)
    value: float = found.value
    return value


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
            weight = positive(Latched(value, "WEIGHT", param.value), source)
        else:
            params.append(CriterionParam(param.name.key.upper(), value))
    return CriterionChoice(criterion_name(node.name), weight, tuple(params))


def criterion_name(name: tree.Name) -> str:
    """Name of a criterion as blocks have it, the same for every spelling."""
    return name.key.upper()
