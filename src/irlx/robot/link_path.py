"""A condition that keeps a link on a curve of the floor, as plain data."""

from __future__ import annotations

from dataclasses import dataclass

Point = tuple[float, float]


@dataclass(frozen=True)
class LinkPath:
    """The origin of the link, seen from above, stays on a curve through `points`, m, in the root frame.

    One equation: where on its curve the link stands is free, and so is its height. The curve goes on straight
    beyond its ends, or is `closed`. With `heading` the x axis of the link, seen from above, points along
    the curve, the way its points come: one equation more. `name` and `key`, its place in the cell file,
    are for messages.
    """

    name: str
    link: str
    points: tuple[Point, ...]
    closed: bool = False
    heading: bool = False
    key: str = ""
