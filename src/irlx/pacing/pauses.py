"""How long each PAUSE of a program lasts: a time that is given before, or what somebody answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite

from irlx.blocks import AskPause, Origin
from irlx.diagnostics import Place, report
from irlx.pacing.errors import PacingError

PauseFunction = Callable[[Place], float | None]
"""Called at each PAUSE with its place; returns when to go on, with the time, s, to stand, or None."""


class PauseAborted(Exception):
    """Whoever was asked at a PAUSE raised `error` instead of an answer."""

    def __init__(self, error: Exception) -> None:
        super().__init__(str(error))
        self.error = error


@dataclass(frozen=True)
class Pauses:
    """A pause lasts `seconds`, unless `function` is there and says something else."""

    seconds: float = 0.0
    function: PauseFunction | None = None

    def answer(self, question: AskPause, locate: Callable[[Origin], Place]) -> tuple[float, ...]:
        """How long a pause lasts, s; returns once `function` has.

        Raises PacingError, IRL505, for an answer that is no time, PauseAborted where `function` raises.
        """
        if self.function is None:
            return (self.seconds,)
        place = locate(question.origin)
        try:
            said: object = self.function(place)
        except Exception as error:
            raise PauseAborted(error) from error
        if said is None:
            return (self.seconds,)
        if isinstance(said, bool) or not isinstance(said, int | float) or not is_time(float(said)):
            expected = "a time in s, 0 or more, or None"
            raise PacingError(
                report("IRL505", place, param="the answer to PAUSE", expected=expected, value=repr(said))
            )
        return (float(said),)


def is_time(seconds: float) -> bool:
    """Whether a robot can stand so long, s."""
    return isfinite(seconds) and seconds >= 0.0
