"""The shapes that links and obstacles are made of; lengths in m."""

from __future__ import annotations

from dataclasses import dataclass, field

from irlx.solids.placement import Placement, Vector3


@dataclass(frozen=True)
class Point:
    """The origin of its frame alone."""


@dataclass(frozen=True)
class Sphere:
    """About the origin."""

    radius: float


@dataclass(frozen=True)
class Box:
    """About the origin, edges of lengths `size` along x, y, z."""

    size: Vector3


@dataclass(frozen=True)
class Cylinder:
    """About the origin, its axis along z."""

    radius: float
    length: float


@dataclass(frozen=True)
class Capsule:
    """A cylinder of `length` about the origin, its axis along z, with half a sphere on each end."""

    radius: float
    length: float


@dataclass(frozen=True)
class Cone:
    """Axis along z, apex at +length/2, its base of `radius` at -length/2."""

    radius: float
    length: float


@dataclass(frozen=True)
class Halfspace:
    """All of z <= 0."""


@dataclass(frozen=True)
class Mesh:
    """The closed surface in the `file` at that path, its vertices times `scale` along x, y, z."""

    file: str
    scale: Vector3 = (1.0, 1.0, 1.0)


Shape = Point | Sphere | Box | Cylinder | Capsule | Cone | Halfspace | Mesh


@dataclass(frozen=True)
class Solid:
    """A shape, and where its frame lies in that of the body it belongs to."""

    shape: Shape
    placement: Placement = field(default_factory=Placement)
