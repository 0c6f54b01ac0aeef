"""Counts what becomes of corrections, tick by tick."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.correction.approach import TOO_NEAR, TOOL, Governor
from irlx.pacing.correction.report import BOUND_WORDS, CorrectionReport, Lag
from irlx.pacing.correction.tool_offset import parts

Array = NDArray[np.float64]

DELAYED = 1e-6
"""Distance of a correction from its request, m or rad, from which on it counts as delayed."""


class Tally:
    """The report of a stream as it grows."""

    def __init__(self, joint_names: tuple[str, ...]) -> None:
        self._names = joint_names
        self.report = CorrectionReport()

    def asked(self, answered: bool) -> None:
        """Note that the sensor was asked."""
        found = self.report
        self.report = replace(found, ticks=found.ticks + 1, requests=found.requests + answered)

    def held(self) -> None:
        """Note a tick at which the robot stood so that corrections came to rest."""
        self.report = replace(self.report, held_ticks=self.report.held_ticks + 1)

    def ended(
        self, left: Array, tick: int, line: int, governor: Governor | None = None, refused: bool = False
    ) -> None:
        """Note what is left (6,) of a request at the end of a tick, and what kept it so."""
        lags, found = parts(left), self.report
        if max(lags) <= DELAYED:
            return
        joint, bound = self._words(governor)
        position, orientation = (
            kept if kept is not None and kept.value >= lag else Lag(lag, tick, line, joint, bound)
            for kept, lag in zip((found.position_lag, found.orientation_lag), lags, strict=True)
        )
        self.report = replace(
            found,
            delayed_ticks=found.delayed_ticks + 1,
            refused_ticks=found.refused_ticks + refused,
            position_lag=position if position.value > DELAYED else None,
            orientation_lag=orientation if orientation.value > DELAYED else None,
        )

    def _words(self, governor: Governor | None) -> tuple[str, str]:
        if governor is None:
            return "", ""
        if governor == TOO_NEAR:
            return "", "clearance"
        word = BOUND_WORDS[governor.source]
        return ("", f"tool {word}") if governor.joint == TOOL else (self._names[governor.joint], word)
