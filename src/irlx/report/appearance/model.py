"""The plain data of a cell's looks."""

from __future__ import annotations

from dataclasses import dataclass, field

from irlx.diagnostics import Diagnostic
from irlx.scene.obstacle import Obstacle
from irlx.solids.colour import Colour
from irlx.solids.placement import Placement, Vector3
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Point, Sphere
from irlx.solids.triangles import Triangles

DrawnShape = Point | Sphere | Box | Cylinder | Capsule | Cone | Halfspace | Triangles


@dataclass(frozen=True, eq=False)
class Part:
    """One shape of a link or obstacle, and where it lies in its frame; `colour` None: the drawer's choice.

    A mesh is a surface of triangles in m, fewer than in its file; parts share the same surface object
    where their files do.
    """

    shape: DrawnShape
    placement: Placement = field(default_factory=Placement)
    colour: Colour | None = None


@dataclass(frozen=True)
class DrawnJoint:
    """How a link moves against its parent: first `placement`, then the joint's own motion.

    That is, for the value `multiplier * q[axis_number] + offset` (rad | m), a turn about (`kind` revolute) or
    a slide along (prismatic) the unit vector `axis`. `axis_number` None: the joint is held at `offset`.
    """

    name: str
    kind: str
    placement: Placement
    axis: Vector3
    axis_number: int | None = None
    multiplier: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, eq=False)
class DrawnLink:
    """A link: `parent` is its place in `RobotAppearance.links`; the root alone has none, and no `joint`."""

    name: str
    parent: int | None
    joint: DrawnJoint | None
    parts: tuple[Part, ...]


@dataclass(frozen=True, eq=False)
class RobotAppearance:
    """Links of a robot, parents before children; `tip` is the place of the one that moves address."""

    name: str
    links: tuple[DrawnLink, ...]
    tip: int
    diagnostics: tuple[Diagnostic, ...] = ()


@dataclass(frozen=True, eq=False)
class DrawnObstacle:
    """An obstacle of the cell, which says where it is, and its shapes in its frame."""

    obstacle: Obstacle
    parts: tuple[Part, ...]


@dataclass(frozen=True, eq=False)
class CellAppearance:
    """Robot and obstacles of a cell; `diagnostics` tell what could not be drawn as it is (IRL721)."""

    robot: RobotAppearance
    obstacles: tuple[DrawnObstacle, ...]

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """What could not be drawn as the model has it, IRL721."""
        return self.robot.diagnostics
