"""Time law of a chain: every leg under its own law, and in its own TIME where it has one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from irlx.blocks import MotionLaw, Profile
from irlx.diagnostics import Place, report, told_apart
from irlx.motion.errors import MotionError
from irlx.motion.fastest_law import fastest_s_curves, fastest_trapezoids
from irlx.motion.sections import Sections
from irlx.motion.time_law import LEAST_RATE, TimeLaw
from irlx.motion.trapezoid import Trapezoid

_SAME_TIME = 1e-9
_MOST_SWEEPS = 30


@dataclass(frozen=True)
class Stage:
    """The part of a chain that one leg carries out, from hand-over to hand-over: its bounds and its law."""

    bounds: Sections
    law: MotionLaw
    place: Place

    @property
    def length(self) -> float:
        """Its way, in units of the path."""
        return float(np.sum(self.bounds.lengths))

    @property
    def time(self) -> float | None:
        """Time that it is to take, s, None where it is to be as fast as it can."""
        return None if self.law.duration is None else self.law.duration / self.law.override


def chain_law(stages: Sequence[Stage], length: float) -> TimeLaw:
    """Fastest law through the stages from rest to rest; jerk-limited where one of them is an S curve.

    A stage with TIME gets a lower top speed, so that it takes this time from hand-over to hand-over. Raises
    MotionError, IRL421, where even its programmed speed takes longer.
    """
    bounds = [stage.bounds for stage in stages]
    if min(float(min(np.min(bound.speed), np.min(bound.acc))) for bound in bounds) < LEAST_RATE:
        return Trapezoid(length, 0.0, inf, 0.0)
    law = _fastest(stages, bounds, length)
    timed = [k for k, stage in enumerate(stages) if stage.time is not None]
    ends = np.concatenate([[0.0], np.cumsum([stage.length for stage in stages])])
    capped = list(bounds)
    for _ in range(_MOST_SWEEPS):
        off = [k for k in timed if not _in_time(law, ends[k : k + 2], stages[k])]
        if not off:
            break
        # Each changes what its neighbours have to start from: round by round until all are in time.
        for k in off:
            law = _with_time(stages, bounds, capped, k, ends, length)
    return law


def _with_time(
    stages: Sequence[Stage],
    bounds: Sequence[Sections],
    capped: list[Sections],
    k: int,
    ends: np.ndarray,
    length: float,
) -> TimeLaw:
    """The law with the top speed of stage k set so that it takes its time."""
    stage = stages[k]
    time = stage.time or 0.0
    law: TimeLaw

    def late(cap: float) -> float:
        nonlocal law
        capped[k] = replace(bounds[k], speed=np.minimum(bounds[k].speed, cap))
        law = _fastest(stages, capped, length)
        return _time_of(law, ends[k : k + 2]) - time

    top = float(np.max(bounds[k].speed))
    least = late(top) + time
    if time * (1.0 + _SAME_TIME) >= least >= time:
        return law
    if least > time:
        # Of time on the path, as OVERRIDE is no part of what TIME asks for.
        asked, fastest = told_apart(*(value * stage.law.override for value in (time, least)))
        governor = "the bounds of this move and the speeds of its neighbours"
        raise MotionError(report("IRL421", stage.place, asked=asked, least=fastest, governor=governor))
    slowest = 0.5 * min(stage.length / time, top)
    from scipy.optimize import brentq

    late(float(brentq(late, slowest, top, xtol=1e-15 * top, rtol=1e-14)))
    return law


def _in_time(law: TimeLaw, ends: np.ndarray, stage: Stage) -> bool:
    time = stage.time or 0.0
    return abs(_time_of(law, ends) - time) <= _SAME_TIME * time


def _time_of(law: TimeLaw, ends: np.ndarray) -> float:
    first, last = law.times_at(np.array([ends[0], min(ends[1], law.length)]))
    return float(last - first)


def _fastest(stages: Sequence[Stage], bounds: Sequence[Sections], length: float) -> TimeLaw:
    sections = Sections.joined(bounds)
    if any(stage.law.profile is Profile.S_CURVE for stage in stages):
        return fastest_s_curves(sections, length)
    return fastest_trapezoids(sections, length)
