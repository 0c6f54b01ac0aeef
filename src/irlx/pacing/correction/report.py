"""What became of the corrections that a sensor asked for."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.transform.step_bounds import BoundSource


@dataclass(frozen=True)
class Lag:
    """How far a correction was behind its request, `value` in m or rad, at its worst: tick and line.

    `joint` and `bound` ('position', 'speed', 'acceleration', 'braking') are what kept it there; joint '' and
    bound 'tool speed' or 'tool acceleration' where the cell's [motion] did, 'clearance' where something would
    have come too near. Both are '' where the robot had
    to stand first.
    """

    value: float
    tick: int
    line: int
    joint: str
    bound: str


@dataclass(frozen=True)
class CorrectionReport:
    """Corrections of a stream until now.

    `ticks` at which the sensor was asked, `requests` it answered with a correction; `delayed_ticks` at whose
    end the correction was more than 1e-6 m or rad from the request; `refused_ticks`: those of them at which
    the joints could not follow as fast as a correction was meant to run, or something was in the way;
    `held_ticks` that the robot stood longer than programmed so that corrections came to rest.
    `position_lag` and `orientation_lag`: the largest ones, None where there was none.
    """

    ticks: int = 0
    requests: int = 0
    delayed_ticks: int = 0
    refused_ticks: int = 0
    held_ticks: int = 0
    position_lag: Lag | None = None
    orientation_lag: Lag | None = None


BOUND_WORDS = {
    BoundSource.POSITION: "position",
    BoundSource.SPEED: "speed",
    BoundSource.ACCELERATION: "acceleration",
    BoundSource.BRAKING: "braking",
}
