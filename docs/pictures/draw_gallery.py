"""Draws docs/pictures/gallery_*.png: robots of every kind, each while it runs a program.

python docs/pictures/draw_gallery.py [NAME]...    (needs matplotlib)

The arm is drawn at a few instants, the later the darker, with the way of the tool and what the cell has put
there. A picture more is a line more in PICTURES, and its name in the table of the README.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pinocchio as pin
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from mpl_toolkits.mplot3d.axes3d import Axes3D
from mpl_toolkits.mplot3d.proj3d import proj_transform
from scipy.spatial import ConvexHull

import irlx
from irlx.cell.load import load_cell
from irlx.robot.description import JointKind
from irlx.robot.kinematics import Kinematics
from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Shape, Sphere

HERE = Path(__file__).resolve().parent
PROGRAMS = HERE.parents[1] / "programs"
TRAIL, OBSTACLE, FLOOR, INK, SKIN = "#c2571a", "#a02040", "#d9dde3", "#222222", "#1f6f8b"
FIRST, LAST = np.array([0.80, 0.88, 0.91]), np.array([0.05, 0.25, 0.34])
"""Colours of the arm at the start and at the end."""


FILLED, MIDDLE = np.array([0.90, 0.82]), np.array([0.5, 0.46])
"""Room for the scene below the title, as shares of the picture, and its middle."""


@dataclass(frozen=True)
class Picture:
    """What one picture shows; seen from `elevation` and `azimuth`, degrees, at `instants` of the run.

    `hands` are links whose ways are drawn beside that of the tool.
    """

    name: str
    program: str
    cell: str
    title: str
    elevation: float = 22.0
    azimuth: float = -60.0
    instants: int = 5
    hands: tuple[str, ...] = ()


PICTURES = (
    Picture(
        "koch11", "koch/square_cyclic.irl", "koch/square.toml", "koch11: a closed square, the posture returns"
    ),
    Picture("window", "window/window.irl", "window/window.toml", "arm7: through a window", 18.0, -125.0, 4),
    Picture(
        "two_walls", "two_walls/two_walls.irl", "two_walls/two_walls.toml", "planar4: between two walls", 62.0
    ),
    Picture("mobile8", "combined/combined.irl", "combined/combined.toml", "mobile8: every option at once"),
    Picture(
        "two_arms",
        "two_arms/two_arms.irl",
        "two_arms/two_arms.toml",
        "dual14: a pipe in one hand, a torch in the other",
        25.0,
        10.0,
        hands=("left_hand",),
    ),
    Picture("mobile9", "mobile/mobile.irl", "mobile/mobile.toml", "mobile9: a platform on its own path"),
    Picture("gantry9", "gantry/gantry.irl", "gantry/gantry.toml", "gantry9: three slides and an arm"),
    Picture("rail6", "rail/rail.irl", "rail/rail.toml", "rail6: an arm on a rail"),
    Picture("snake20", "snake/snake.irl", "snake/snake.toml", "snake20: twenty joints"),
    Picture("irb6", "five_axes/five_axes.irl", "five_axes/five_axes.toml", "irb6: five axes"),
    Picture(
        "free_turn", "free_turn/free_turn.irl", "free_turn/free_turn.toml", "six axes, the tool free to turn"
    ),
)


def main() -> None:
    """Draw the pictures that are named, all without a name."""
    asked = sys.argv[1:] or [picture.name for picture in PICTURES]
    for picture in PICTURES:
        if picture.name in asked:
            draw(picture)


def draw(picture: Picture) -> None:
    """Run the program and write its picture."""
    cell = load_cell(PROGRAMS / picture.cell)
    run = irlx.run(PROGRAMS / picture.program, cell=PROGRAMS / picture.cell)
    kinematics = Kinematics(cell.robot)
    with mpl.rc_context({"font.family": "DejaVu Sans", "font.size": 9.0}):
        figure = Figure(figsize=(8.0, 6.0), dpi=100)
        axes = figure.add_axes((-0.12, -0.12, 1.24, 1.2), projection="3d", computed_zorder=False)
        axes.view_init(elev=picture.elevation, azim=picture.azimuth)
        axes.set_axis_off()
        rows = np.linspace(0, len(run.q) - 1, picture.instants).round().astype(int)
        drawn = [run.tool[:, :3]]
        for number, row in enumerate(rows):
            share = number / max(len(rows) - 1, 1)
            drawn.append(draw_arm(axes, kinematics, run.q[row], share))
        drawn += [draw_solids(axes, kinematics, run.q[-1])]
        drawn += [
            draw_obstacle(axes, solid.shape, obstacle.placement.of(solid.placement))
            for obstacle in cell.scene.obstacles.values()
            for solid in obstacle.solids
        ]
        ways = [run.tool[:, :3], *(way_of(kinematics, run.q, link) for link in picture.hands)]
        for way in ways:
            draw_trail(axes, way)
        fit(axes, np.vstack([points for points in drawn if len(points)]))
        figure.text(0.03, 0.94, picture.title, fontsize=15.0, color=INK)
        figure.savefig(HERE / f"gallery_{picture.name}.png")


def link_frames(kinematics: Kinematics, q: np.ndarray) -> dict[str, pin.SE3]:
    """Pose of every link of the tree in the world, in posture q."""
    pin.forwardKinematics(kinematics.model, kinematics.data, kinematics.expanded(q))
    robot = kinematics.description
    found = {}
    for link in (robot.root, *(joint.child for joint in robot.joints)):
        number, within = kinematics.body_of(link)
        found[link] = kinematics.data.oMi[number] * within
    return found


def draw_arm(axes: Axes3D, kinematics: Kinematics, q: np.ndarray, share: float) -> np.ndarray:
    """Lines from joint to joint of the whole tree, dots on those that move; returns the points (N, 3)."""
    frames = {link: pose.translation for link, pose in link_frames(kinematics, q).items()}
    robot = kinematics.description
    colour = tuple((1.0 - share) * FIRST + share * LAST)
    lines = [(frames[joint.parent], frames[joint.child]) for joint in robot.joints]
    # A slide is a way, not a part of the arm.
    widths = [0.8 if joint.is_prismatic else 2.2 + 1.3 * share for joint in robot.joints]
    drawn = Line3DCollection(lines, colors=[colour], linewidths=widths, capstyle="round", zorder=3 + share)
    axes.add_collection3d(drawn)
    moving = np.array([frames[joint.child] for joint in robot.joints if joint.kind is not JointKind.FIXED])
    axes.scatter(*moving.T, s=18.0 + 14.0 * share, color=[colour], depthshade=False, zorder=4 + share)
    return np.array([point for line in lines for point in line])


def draw_solids(axes: Axes3D, kinematics: Kinematics, q: np.ndarray) -> np.ndarray:
    """Shapes of the links in posture q, nearly transparent; returns their corners (N, 3)."""
    frames, corners = link_frames(kinematics, q), []
    for link, solids in kinematics.description.solids.items():
        for solid in solids:
            place = placed(solid.placement)
            corners.append(draw_hull(axes, solid.shape, frames[link] * place, SKIN, 0.10))
    return np.vstack(corners) if corners else np.zeros((0, 3))


def draw_obstacle(axes: Axes3D, shape: Shape, placement: Placement) -> np.ndarray:
    """An obstacle of the cell, translucent; returns its corners (N, 3)."""
    return draw_hull(axes, shape, placed(placement), OBSTACLE, 0.16)


def placed(placement: Placement) -> pin.SE3:
    """A placement as Pinocchio keeps it."""
    x, y, z, w = placement.orientation
    return pin.SE3(pin.Quaternion(w, x, y, z).toRotationMatrix(), np.array(placement.position))


def draw_hull(axes: Axes3D, shape: Shape, pose: pin.SE3, colour: str, alpha: float) -> np.ndarray:
    """A convex shape, nothing of points, half-spaces and meshes; returns its corners (N, 3)."""
    points = corners_of(shape)
    if not len(points):
        return points
    world = points @ pose.rotation.T + pose.translation
    faces = [world[face] for face in ConvexHull(points).simplices]
    if isinstance(shape, Box):
        faces = [world[list(face)] for face in BOX_FACES]
    edge = {"edgecolors": colour, "linewidths": 0.6} if isinstance(shape, Box) else {"linewidths": 0.0}
    hull = Poly3DCollection(faces, facecolors=colour, alpha=alpha, zorder=2, **edge)
    axes.add_collection3d(hull)
    return world


BOX_FACES = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))
CIRCLE = np.linspace(0.0, 2.0 * np.pi, 28, endpoint=False)


def corners_of(shape: Shape) -> np.ndarray:
    """Points (N, 3) whose hull looks like a shape."""
    ring = np.stack([np.cos(CIRCLE), np.sin(CIRCLE), 0.0 * CIRCLE], axis=1)
    match shape:
        case Box(size):
            return 0.5 * np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * size
        case Sphere(radius):
            return radius * ball()
        case Cylinder(radius, length):
            return np.vstack([radius * ring + [0, 0, side * length / 2] for side in (-1.0, 1.0)])
        case Capsule(radius, length):
            return np.vstack([radius * ball() + [0, 0, side * length / 2] for side in (-1.0, 1.0)])
        case Cone(radius, length):
            return np.vstack([radius * ring - [0, 0, length / 2], [[0, 0, length / 2]]])
    return np.zeros((0, 3))


def ball() -> np.ndarray:
    """Points (N, 3) of the unit sphere."""
    heights = np.cos(np.linspace(0.0, np.pi, 11))
    rings = [(np.sqrt(max(1.0 - z * z, 0.0)), z) for z in heights]
    return np.array([[r * np.cos(a), r * np.sin(a), z] for r, z in rings for a in CIRCLE[::2]])


def way_of(kinematics: Kinematics, q: np.ndarray, link: str) -> np.ndarray:
    """Positions (N, 3) of a link in the postures q (N, n)."""
    return np.array([link_frames(kinematics, row)[link].translation for row in q])


def draw_trail(axes: Axes3D, points: np.ndarray) -> None:
    """The way of the tool."""
    axes.plot(*points.T, color=TRAIL, linewidth=2.0, zorder=6)
    axes.scatter(*points[-1], s=22.0, color=TRAIL, depthshade=False, zorder=6)


def fit(axes: Axes3D, points: np.ndarray) -> None:
    """Show all points (N, 3) at one scale, above a floor with a grid."""
    low, high = points.min(axis=0), points.max(axis=0)
    sides = np.maximum(high - low, 0.25 * float(np.max(high - low)))
    middle, floor = 0.5 * (low + high), float(low[2])
    step = 10.0 ** np.floor(np.log10(0.5 * float(np.max(sides))))
    (left, near), (right, far) = np.floor(low[:2] / step) * step, np.ceil(high[:2] / step) * step
    lines = [[(x, near, floor), (x, far, floor)] for x in np.arange(left, right + step / 2, step)]
    lines += [[(left, y, floor), (right, y, floor)] for y in np.arange(near, far + step / 2, step)]
    axes.add_collection3d(Line3DCollection(lines, colors=FLOOR, linewidths=0.7, zorder=1))
    axes.set_xlim(middle[0] - sides[0] / 2, middle[0] + sides[0] / 2)
    axes.set_ylim(middle[1] - sides[1] / 2, middle[1] + sides[1] / 2)
    axes.set_zlim(middle[2] - sides[2] / 2, middle[2] + sides[2] / 2)
    fill(axes, sides, points)


def fill(axes: Axes3D, sides: np.ndarray, points: np.ndarray) -> None:
    """Choose zoom and place of the axes so that the points (N, 3) fill the picture below its title."""
    figure = axes.figure
    axes.set_box_aspect(sides)
    for _ in range(2):
        figure.draw_without_rendering()
        across, up, _depth = proj_transform(*points.T, axes.get_proj())
        seen = figure.transFigure.inverted().transform(
            axes.transData.transform(np.stack([across, up], axis=1))
        )
        low, high = seen.min(axis=0), seen.max(axis=0)
        left, bottom, wide, tall = axes.get_position().bounds
        scale = min(FILLED / (high - low))
        # Scaled about the middle of what is seen, which goes to the middle of the room for it.
        corner = np.array([left, bottom]) * scale + MIDDLE - scale * 0.5 * (low + high)
        axes.set_position((*corner, wide * scale, tall * scale))


if __name__ == "__main__":
    main()
