"""Positions, speeds and accelerations against the limits in force at their ticks, and the start posture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from irlx.promises import LIMIT_EXCESS, SAME_NUMBER, rounding_allowance
from irlx.streams.joint_stream import Floats, Integers
from irlx.verifier.evidence import Evidence
from irlx.verifier.findings.finding import Check
from irlx.verifier.findings.tally import Tally
from irlx.verifier.rows import Rows

_UNITS = {"position": "rad|m", "speed": "rad/s|m/s", "acceleration": "rad/s2|m/s2"}


class StartCheck:
    """The start posture lies inside the robot's own position limits and is that of the cell, if any."""

    def __init__(self, evidence: Evidence) -> None:
        self._tally = evidence.tally("start", "rad|m")
        self._own = evidence.outline.header.limits.pair("position")
        self._due = evidence.start

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        if rows.first == 0:
            lower, upper = self._own
            _add_positions(self._tally, np.arange(1), rows.q[:1], lower[None], upper[None])
            self._compare(rows.q[:1])

    def _compare(self, q: Floats) -> None:
        if self._due is None:
            return
        due = self._due[None]
        elsewhere = ~(np.abs(q - due) <= SAME_NUMBER * np.maximum(1.0, np.abs(due)))
        if elsewhere.any():
            self._tally.detail = "the cell has the robot start elsewhere"
            rank = np.where(elsewhere, np.inf, -np.inf)
            self._tally.add(np.arange(1), q, due, elsewhere, rank)

    def checks(self) -> list[Check]:
        """Start."""
        return [self._tally.check()]


class LimitChecks:
    """Positions must hold exactly, speeds and accelerations up to what is promised.

    Allowed are bound (1 + LIMIT_EXCESS) + `rounding_allowance` of the largest value of the stream.
    """

    def __init__(self, evidence: Evidence) -> None:
        self._limits = evidence.limits
        outline = evidence.outline
        self._tallies = {kind: evidence.tally(f"{kind} limits", unit) for kind, unit in _UNITS.items()}
        allowances = rounding_allowance(np.array([outline.largest]), outline.header.dt)
        self._allowance = dict(zip(("speed", "acceleration"), allowances, strict=True))
        if not outline.records and outline.ids.any():
            for tally in self._tallies.values():
                tally.detail = "the robot's own limits only: the stream carries no blocks"

    def take(self, rows: Rows) -> None:
        """Add a portion."""
        for kind, values in (("position", rows.q), ("speed", rows.qd), ("acceleration", rows.qdd)):
            bounds = self._limits.bounds(kind, rows.first, len(rows))
            if kind == "position":
                _add_positions(self._tallies[kind], rows.rows, values, *bounds)
            else:
                _add_rates(self._tallies[kind], rows.rows, values, bounds, self._allowance[kind])

    def checks(self) -> list[Check]:
        """Position, speed and acceleration limits."""
        return [tally.check() for tally in self._tallies.values()]


def _add_positions(tally: Tally, rows: Integers, q: Floats, lower: Floats, upper: Floats) -> None:
    """Add positions q (R, n) with their bounds; the worst is nearest to a bound or furthest beyond."""
    beyond_upper, beyond_lower = q - upper, lower - q
    allowed = np.where(beyond_upper >= beyond_lower, upper, lower)
    inside: NDArray[np.bool_] = (q <= upper) & (q >= lower)
    tally.add(rows, q, allowed, ~inside, np.maximum(beyond_upper, beyond_lower))


def _add_rates(
    tally: Tally, rows: Integers, rates: Floats, bounds: tuple[Floats, Floats], allowance: float
) -> None:
    """Add speeds or accelerations (R, n); the worst is the one that uses most of its bound."""
    lower, upper = bounds
    high = upper + LIMIT_EXCESS * np.abs(upper) + allowance
    low = lower - LIMIT_EXCESS * np.abs(lower) - allowance
    inside: NDArray[np.bool_] = (rates <= high) & (rates >= low)
    # An allowance is tiny but never zero, so that a joint limited to 0 has a use of its bound as well.
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        use = np.where(rates > 0.0, rates / high, rates / low)
    allowed = np.where(rates > 0.0, upper, lower)
    use[np.isinf(allowed)] = -np.inf
    tally.add(rows, rates, allowed, ~inside, use)
