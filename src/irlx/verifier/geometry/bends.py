"""How much a chain bends between two places of it: the least curvature of all that lies between them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.blends import Blend
from irlx.verifier.geometry.chain_parts import ChainParts, Part

PLACES, CELLS = 5, 8
"""Places between two rows on a part, those of the rows included, at which the curvature is looked at; cells
into which each part is cut that lies between two rows."""


class Stretches(NamedTuple):
    """Lengths `ways` (K,) m of stretches run one after another, and the least curvature `bends` (K,) on each,
    1/m."""

    ways: Floats
    bends: Floats

    def fastest(self, speed: float, acc: float) -> float:
        """Largest mean speed, m/s, on all of them: at most `speed` m/s and, by `acc` m/s2 across the way,
        the root of acc over the curvature."""
        least = float(np.sum(self.ways * np.maximum(1.0 / speed, np.sqrt(self.bends / acc))))
        return float(np.sum(self.ways)) / least if least > 0.0 else speed


def stretches_between(parts: ChainParts, start: tuple[Part, float], end: tuple[Part, float]) -> Stretches:
    """The way from a place on a part to one on the same part or one behind it."""
    found = [Stretches(np.zeros(0), np.zeros(0))]
    for order in range(start[0].order, end[0].order + 1):
        leg, is_blend = divmod(order, 2)
        blend = parts.blends[leg] if is_blend and leg < parts.known else None
        if is_blend and blend is None:
            continue
        low, high = (0.0, 1.0) if is_blend else parts.bounds(leg)
        low = start[1] if order == start[0].order else low
        high = max(low, end[1] if order == end[0].order else high)
        found.append(_bent_stretches(parts, leg, blend, low, high))
    return Stretches(*(np.concatenate(every) for every in zip(*found, strict=True)))


def _bent_stretches(parts: ChainParts, leg: int, blend: Blend | None, low: float, high: float) -> Stretches:
    """A leg, or the blend at its end, between two of its places."""
    curve, corner = parts.legs[leg].curve, parts.legs[leg].corner
    if blend is None and curve.is_straight:
        return Stretches(np.array([high - low]), np.zeros(1))
    if blend is not None and corner.may_be_less:
        # Rows need not tell which blend was run, and another one may take less time.
        return Stretches(np.diff(blend.way(np.array([low, high]))), np.zeros(1))
    places = np.linspace(low, high, 2 * CELLS + 1)
    if blend is None:
        ways, bends = places, np.linalg.norm(curve.bends(places), axis=1)
    else:
        ways, bends = blend.way(places), blend.curvature(places)
    cells = np.column_stack([bends[:-2:2], bends[1::2], bends[2::2]])
    return Stretches(np.diff(ways[::2]), _least(cells))


def least_bends(parts: ChainParts, part: Part, before: float | None, at: Floats) -> Floats:
    """Least curvature (R,), 1/m, from the place before to each place `at` (R,) of a part, the first of them
    being `before`; 0 where that is None: on another part."""
    curve = parts.legs[part.leg].curve
    if not part.blend and curve.is_straight:
        return np.zeros(len(at))
    begin = np.concatenate([[at[0] if before is None else before], at[:-1]])
    places = (begin[:, None] + (at - begin)[:, None] * np.linspace(0.0, 1.0, PLACES)).ravel()
    blend = parts.blend(part)
    found = np.linalg.norm(curve.bends(places), axis=1) if blend is None else blend.curvature(places)
    least = _least(found.reshape(-1, PLACES))
    if before is None:
        least[0] = 0.0
    return least


def _least(found: Floats) -> Floats:
    """Least values (R,) of curves sampled evenly (R, K): they may dip by an eighth of a second difference."""
    dip = np.max(np.abs(np.diff(found, 2, axis=1)), axis=1) / 8.0
    return np.asarray(np.maximum(np.min(found, axis=1) - dip, 0.0))
