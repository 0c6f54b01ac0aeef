"""How a motion runs and ends: its time law, and how it passes its target, latched when the statement runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import radians
from typing import Any

from irlx.blocks import Blend, MotionLaw, Profile
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.parameters import Parameters, not_negative, positive, share, word
from irlx.interpreter.types import BOOL, REAL, STRING, Type
from irlx.language import tree

_LAW: Mapping[str, Type] = {
    **dict.fromkeys(("time", "speed", "acc", "speed_ori", "acc_ori", "speed_ptp", "acc_ptp"), REAL),
    "jerk": REAL,
    "override": REAL,
    "profile": STRING,
}
_PASSING: Mapping[str, Type] = {"c_cp": REAL, "c_ptp": REAL, "c_pass": BOOL}


class Law:
    """Time law of a motion: parameters of its MOVE, and system variables for those that it does not give."""

    def __init__(self, node: tree.Move | tree.Reconfiguration, expressions: Expressions) -> None:
        self._given, self._source = Parameters(node, expressions, _LAW), expressions.source
        self.parts = self._given.parts
        """Expressions that `latched` needs the values of, in this order."""

    def latched(self, values: Sequence[Any]) -> MotionLaw:
        """The law of the values of `parts`. Raises InterpreterError, IRL505, for values out of range."""
        take, source = self._given.latched(values), self._source

        def real(key: str) -> float:
            return positive(take(key), source)

        def part(key: str) -> float:
            real(key)
            return share(take(key), source)

        jerk = not_negative(take("jerk"), source)
        return MotionLaw(
            speed=real("speed") * 1e-3,
            acc=real("acc") * 1e-3,
            speed_ori=radians(real("speed_ori")),
            acc_ori=radians(real("acc_ori")),
            speed_ptp=part("speed_ptp"),
            acc_ptp=part("acc_ptp"),
            duration=real("time") if self._given.gives("time") else None,
            profile=Profile(word(take("profile"), [one.value for one in Profile], source)),
            jerk=jerk * 1e-3 if jerk > 0.0 else None,
            override=part("override"),
        )


class Passing:
    """How a MOVE passes its target: C_CP, C_PTP and C_PASS, and their defaults."""

    def __init__(self, node: tree.Move, expressions: Expressions) -> None:
        self._given, self._source = Parameters(node, expressions, _PASSING), expressions.source
        self._is_ptp = node.kind == "PTP"
        self.parts = self._given.parts
        """Expressions that `latched` needs the values of, in this order."""

    def latched(self, values: Sequence[Any]) -> Blend | None:
        """The blend of the values of `parts`; None where nothing asks for one, or C_PASS := FALSE forbids it.

        Raises InterpreterError, IRL505, for values out of range.
        """
        take, source = self._given.latched(values), self._source
        distance = not_negative(take("c_cp"), source) * 1e-3
        not_negative(take("c_ptp"), source)
        part, passes = share(take("c_ptp"), source), take("c_pass").value
        if self._given.gives("c_pass") and not passes:
            return None
        amount = part if self._is_ptp else distance
        if amount > 0.0:
            return Blend(share=amount) if self._is_ptp else Blend(distance=amount)
        return Blend() if passes else None
