"""The parts of a chain of curves: its legs, and the blends between them as far as corners are known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.promises import PATH_STEP
from irlx.streams.joint_stream import Floats
from irlx.verifier.geometry.blends import Blend
from irlx.verifier.geometry.corners import Corner
from irlx.verifier.geometry.curves import Curve, rounds

On = tuple[Floats, Floats, NDArray[np.bool_]]
"""Of R rows the places (R,) on a part nearest to them, how far they are off it, and which lie behind it."""


@dataclass(frozen=True)
class Leg:
    """One curve of a chain, and how its end is passed; the last leg's corner counts for nothing."""

    curve: Curve
    corner: Corner


@dataclass(frozen=True)
class Part:
    """A leg without its blends, or the blend at its end.

    Places on a leg are ways from the start of its curve, m, those on a blend its parameter.
    """

    leg: int
    blend: bool

    @property
    def order(self) -> int:
        """Parts that are run later have a larger one."""
        return 2 * self.leg + self.blend


class ChainParts:
    """Legs, and the blends at the first corners: those of which it is known how they are passed.

    Corners become known one after another, in order (`settle`). `bases` (known + 1,): the way to the start of
    each leg, its blend before being counted as a part of the leg before, m; `ends` (known,): the way to the
    ends of legs, which are the points of blends nearest to the corners.
    """

    def __init__(self, legs: Sequence[Leg]) -> None:
        self.legs = legs
        self.blends: list[Blend | None] = []
        self.bases = [0.0]
        self.ends: list[float] = []

    def copy(self) -> ChainParts:
        """The same parts, of which other corners may become known."""
        other = ChainParts(self.legs)
        other.blends, other.bases, other.ends = self.blends.copy(), self.bases.copy(), self.ends.copy()
        return other

    # ---- Corners

    @property
    def known(self) -> int:
        """So many corners are known."""
        return len(self.blends)

    def is_open(self, leg: int) -> bool:
        """Whether rows have to tell how the end of a leg is passed, and have not yet."""
        return self.known <= leg < len(self.legs) - 1 and self.legs[leg].corner.is_open

    def settle_told(self, leg: int) -> None:
        """Let the end of a leg be known, where no row has to tell; the corners before it are."""
        if self.known <= leg < len(self.legs) - 1:
            self.settle(self.legs[leg].corner.distance)

    def settle(self, distance: float) -> None:
        """Let the first corner that is not known be passed at a distance, m."""
        leg = self.known
        first, second = self.legs[leg].curve, self.legs[leg + 1].curve
        blend = Blend(first, second, distance) if distance > PATH_STEP else None
        self.blends.append(blend)
        end, cut = self.bases[leg] + first.length, 0.0
        if blend is not None:
            cut = blend.length - 2.0 * blend.distance
            self.ends.append(end - blend.distance + float(blend.way(np.array([blend.corner]))[0]))
        else:
            self.ends.append(end)
        self.bases.append(end + cut)

    # ---- Order

    @property
    def left(self) -> float:
        """Way to the end of the last leg, blends not known yet being counted as corners, m."""
        return self.bases[self.known] + sum(leg.curve.length for leg in self.legs[self.known :])

    def bounds(self, leg: int) -> tuple[float, float]:
        """First and last place on a leg that no blend takes."""
        before = self.blends[leg - 1] if 0 < leg <= self.known else None
        behind = self.blends[leg] if leg < self.known else None
        low = 0.0 if before is None else before.distance
        length = self.legs[leg].curve.length
        return low, max(low, length if behind is None else length - behind.distance)

    def start(self, part: Part) -> float:
        """Way to the start of a part, m."""
        low, high = self.bounds(part.leg)
        return self.bases[part.leg] + (high if part.blend else low)

    def next(self, part: Part) -> Part | None:
        """The part behind a part, None where it is not known."""
        if part.leg >= self.known:
            return None
        if not part.blend and self.blends[part.leg] is not None:
            return Part(part.leg, True)
        return Part(part.leg + 1, False) if part.leg + 1 < len(self.legs) else None

    def before(self, part: Part) -> Part | None:
        """The part before a part."""
        if part.blend:
            return Part(part.leg, False)
        if part.leg == 0:
            return None
        return Part(part.leg - 1, self.blends[part.leg - 1] is not None)

    def blend(self, part: Part) -> Blend | None:
        """The blend that a part is, None where it is a leg."""
        return self.blends[part.leg] if part.blend else None

    def is_sharp_between(self, one: Part, other: Part) -> bool:
        """Whether a corner without a blend lies between two parts."""
        low, high = sorted((one.leg, other.leg))
        return any(self.blends[leg] is None for leg in range(low, high))

    # ---- Rows on parts

    def on(self, part: Part, positions: Floats, near: float) -> On:
        """Where positions (R, 3) are on a part, the row before them being at the place `near`."""
        blend = self.blend(part)
        if blend is not None:
            u = blend.nearest(positions)
            off = np.linalg.norm(positions - blend.points(u), axis=1)
            return u, off, (u >= 1.0) & (blend.behind(positions) > 0.0)
        leg, curve = part.leg, self.legs[part.leg].curve
        low, high = self.bounds(leg)
        way = curve.nearest(positions, near)
        inside = np.clip(way, low, high)
        off = np.linalg.norm(positions - curve.points(inside), axis=1)
        if leg == len(self.legs) - 1:
            return inside, off, np.zeros(len(way), dtype=np.bool_)
        if leg >= self.known or self.blends[leg] is not None:
            return inside, off, way > high
        return inside, off, self._past_sharp(leg, positions, way, off, near)

    def _past_sharp(
        self, leg: int, positions: Floats, way: Floats, off: Floats, near: float
    ) -> NDArray[np.bool_]:
        """Which rows lie behind a sharp corner: nearer to the next leg, or going back on both."""
        following = self.legs[leg + 1].curve
        there = rounds(following, following.nearest_at_start(positions))[:2]
        inside = [np.clip(at, 0.0, following.length) for at in there]
        apart = np.min([np.linalg.norm(positions - following.points(at), axis=1) for at in inside], axis=0)
        furthest = np.maximum.accumulate(np.concatenate([[near], way]))[1:]
        back = (furthest - way > PATH_STEP) & (apart <= off + PATH_STEP)
        # Legs may lie on each other: rounding must not tell which is nearer.
        return np.asarray((apart < off - PATH_STEP) | back)
