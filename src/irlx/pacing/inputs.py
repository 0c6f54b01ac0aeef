"""What inputs say over time: scripted traces, and functions of the caller's own."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf, isfinite
from typing import Any

from irlx.blocks import AskInput, AskInputChange, Origin, SignalKind
from irlx.diagnostics import Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.pacing.errors import PacingError
from irlx.promises import TICK_SHARE

Trace = Sequence[tuple[float, float]]
"""Times (s, rising) with the value that holds from each on; before the first it is 0."""

Locate = Callable[[Origin], Place]
InputFunction = Callable[[str, float], float | None]
"""Value of an input, by the name that the program or the port gives it, at a time in s; None for unknown."""


@dataclass(frozen=True)
class Inputs:
    """Traces by casefolded name of a port or signal, and a function that is asked first, if any.

    An input of which those say nothing, by any of its names, has its trace among the `others`.
    """

    traces: Mapping[str, Trace] = field(default_factory=dict)
    function: InputFunction | None = None
    others: Mapping[str, Trace] = field(default_factory=dict)

    @property
    def known(self) -> list[str]:
        """Casefolded names of all traces, sorted."""
        return sorted({*self.traces, *self.others})

    def value(self, names: Sequence[str], time: float, slack: float = 0.0) -> float | None:
        """Value of the first of `names` that is known, at a time in s; None where none is.

        A change of a trace that comes no more than `slack` s later counts already.
        """
        if self.function is not None:
            for name in names:
                said = self.function(name, time)
                if said is not None:
                    return float(said)
        trace = self._trace(names)
        if trace is None:
            return None
        index = bisect_right([at for at, _ in trace], time + slack) - 1
        return trace[index][1] if index >= 0 else 0.0

    def knows(self, names: Sequence[str]) -> bool:
        """Whether anybody may have something to say of an input."""
        return self.function is not None or self._trace(names) is not None

    def until_change(
        self, inputs: Sequence[Sequence[str]], time: float, tick: float, slack: float = 0.0
    ) -> float:
        """Time, s, after which one of `inputs`, each by its names, may say something else than at `time`.

        Infinite where none ever does. A function may change its mind at every `tick`, s; changes of traces
        up to `slack` s after `time` have happened already.
        """
        if self.function is not None:
            return tick
        traces = [trace for names in inputs if (trace := self._trace(names)) is not None]
        return min((at - time for trace in traces for at, _ in trace if at > time + slack), default=inf)

    def _trace(self, names: Sequence[str]) -> Trace | None:
        keys = [name.casefold() for name in names]
        tables = (self.traces, self.others)
        return next((traces[key] for traces in tables for key in keys if key in traces), None)


def answer_of_inputs(
    question: AskInput | AskInputChange, inputs: Inputs, time: float, dt: float, locate: Locate
) -> tuple[float, ...]:
    """Answer of inputs at a time, s, of a run with ticks of `dt` s.

    Raises PacingError: IRL530 for an input that nobody gives a value, IRL531 for a value it cannot have.
    """
    # Ticks are multiples of dt but for rounding; a change at a tick counts at that tick.
    slack = TICK_SHARE * dt
    if isinstance(question, AskInputChange):
        change = inputs.until_change(question.inputs, time, dt, slack)
        return () if change == inf else (change,)
    names, port = question.names, question.port
    value = inputs.value(names, time, slack)
    if value is None:
        known = inputs.known
        data: dict[str, Any] = {"name": names[0], "port": port.name, "known": ", ".join(known) or "none"}
        data["near"] = near_matches(names[0], known)
        raise PacingError(report("IRL530", locate(question.origin), **data))
    if not _fits(port.kind, value):
        told: dict[str, Any] = {"name": names[0], "kind": port.kind.value, "value": f"{value:g}"}
        raise PacingError(report("IRL531", locate(question.origin), time=f"{time:.6g}", **told))
    return (value,)


def _fits(kind: SignalKind, value: float) -> bool:
    if kind is SignalKind.BOOL:
        return value in (0.0, 1.0)
    return isfinite(value) and (kind is SignalKind.REAL or value == round(value))
