"""Fastest time law through sections with bounds of their own, from rest to rest."""

from __future__ import annotations

from itertools import pairwise
from math import inf, sqrt

from irlx.motion.phased_law import PhasedLaw
from irlx.motion.phases import Phases
from irlx.motion.s_curve import add_s_curve, reach
from irlx.motion.sections import Sections

_ON_CAP = 1.0 - 1e-12
"""Share of what bounds a border's rate above which nothing but that bounds it."""


def fastest_trapezoids(sections: Sections, length: float) -> PhasedLaw:
    """Ramps and cruises of constant acceleration: no law within the bounds is faster.

    The squares of the rates where sections meet are cut to what can be reached from the start, then to what
    can be braked down to the end; within a section the rate rises, cruises and falls. Where the bounds of
    sections stand for ones that change steadily, it only goes from one border to the other: a rate that fell
    at each border as late as it may would make the acceleration flicker. A ramp that comes into such a
    section from one border is led on to its end there, then the rate stays what it is at the other border.
    """
    lengths, speed, acc = sections.lengths.tolist(), sections.speed.tolist(), sections.acc.tolist()
    square = [0.0, *(min(a, b) ** 2 for a, b in pairwise(speed)), 0.0]
    for i, (way, bound) in enumerate(zip(lengths, acc, strict=True)):
        square[i + 1] = min(square[i + 1], square[i] + 2.0 * bound * way)
    for i in range(len(lengths) - 1, -1, -1):
        square[i] = min(square[i], square[i + 1] + 2.0 * acc[i] * lengths[i])
    # Which borders lie on a ramp: below what the sections beside them allow.
    caps = [inf, *(min(a, b) ** 2 for a, b in pairwise(speed)), inf]
    ramps = [rate < _ON_CAP * cap for rate, cap in zip(square, caps, strict=True)]
    phases = Phases()
    steadily = sections.steadily
    for i, (way, fastest, bound) in enumerate(zip(lengths, speed, acc, strict=True)):
        first, last = square[i], square[i + 1]
        if way == 0.0:
            continue
        slower = i if first <= last else i + 1
        all_ramp = abs(last - first) >= _ON_CAP * 2.0 * bound * way
        if steadily[i] and max(first, last) > 0.0 and (all_ramp or not ramps[slower]):
            rates = (sqrt(first), sqrt(last))
            phases.add(2.0 * way / (rates[0] + rates[1]), way, rates[1], bound, (last - first) / (2.0 * way))
            continue
        top = min(fastest * fastest, 0.5 * (first + last) + bound * way)
        if steadily[i] and not ramps[2 * i + 1 - slower]:
            top = min(top, max(first, last))
        top = max(top, first, last)
        up, down = min((top - first) / (2.0 * bound), way), min((top - last) / (2.0 * bound), way)
        peak, rates = sqrt(top), (sqrt(first), sqrt(last))
        flat = max(way - up - down, 0.0)
        if up > 0.0:
            phases.add(2.0 * up / (rates[0] + peak), up, peak, bound, bound)
        if flat > 0.0:
            phases.add(flat / peak, flat, peak, bound)
        if down > 0.0:
            phases.add(2.0 * down / (peak + rates[1]), down, rates[1], bound, -bound)
    return phases.law(length)


def fastest_s_curves(sections: Sections, length: float) -> PhasedLaw:
    """Jerk-limited motion that passes from section to section without acceleration.

    For the rates where sections meet see `fastest_trapezoids`; within each section the fastest S curve.
    """
    rows = list(
        zip(
            sections.lengths.tolist(),
            sections.speed.tolist(),
            sections.acc.tolist(),
            sections.jerk.tolist(),
            strict=True,
        )
    )
    rates = [0.0, *(min(a[1], b[1]) for a, b in pairwise(rows)), 0.0]
    for i, (way, _, acc, jerk) in enumerate(rows):
        rates[i + 1] = min(rates[i + 1], reach(rates[i], way, acc, jerk))
    for i in range(len(rows) - 1, -1, -1):
        way, _, acc, jerk = rows[i]
        rates[i] = min(rates[i], reach(rates[i + 1], way, acc, jerk))
    phases = Phases()
    for i, row in enumerate(rows):
        add_s_curve(phases, rates[i], rates[i + 1], *row)
    return phases.law(length)
