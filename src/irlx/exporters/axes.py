"""Which joint of a stream is which axis of a target, and its values in the target's units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from irlx.streams.joint_stream import Floats, StreamHeader


@dataclass(frozen=True)
class Axes:
    """The joints of a stream in the order of a target's axes.

    `order` has the columns of the stream, `scale` what each is multiplied by (57.29.. for deg, 1000 for mm).
    Turning joints come first, slides behind them, either in the order of the stream.
    """

    order: tuple[int, ...]
    names: tuple[str, ...]
    slides: tuple[bool, ...]
    scale: tuple[float, ...]

    @property
    def turning(self) -> int:
        """Number of turning joints, which are the first ones."""
        return self.slides.count(False)

    def values(self, q: Floats) -> Floats:
        """Rows of joint values (N, n) in rad or m -> (N, n) in the target's order and units."""
        scaled: Floats = q[:, self.order] * np.array(self.scale)
        return scaled

    def reordered(self, places: tuple[int, ...]) -> Axes:
        """The same axes in another order."""
        parts = (self.order, self.names, self.slides, self.scale)
        return Axes(*(tuple(part[place] for place in places) for part in parts))  # type: ignore[arg-type]


def axes_of(header: StreamHeader, angle: str) -> Axes:
    """Axes of a stream for a target whose turning joints are in `angle`, 'rad' or 'deg'."""
    units = header.joint_units
    order = sorted(range(header.joints), key=lambda joint: (units[joint] == "m", joint))
    slides = tuple(units[joint] == "m" for joint in order)
    turn = np.degrees(1.0).item() if angle == "deg" else 1.0
    return Axes(
        order=tuple(order),
        names=tuple(header.joint_names[joint] for joint in order),
        slides=slides,
        scale=tuple(1000.0 if slide else turn for slide in slides),
    )
