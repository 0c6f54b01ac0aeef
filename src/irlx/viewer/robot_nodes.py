"""The robot in the scene: a node a link, below that of the link that carries it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from irlx.report.appearance.model import DrawnJoint, RobotAppearance
from irlx.solids.placement import Placement
from irlx.viewer.shapes import Look, add_part, wxyz

if TYPE_CHECKING:
    from viser import SceneApi

_LOOKS = (Look((118, 146, 178)), Look((214, 218, 224)))
"""Of links without a colour, by turns, so that each is told from the next."""


class RobotNodes:
    """Nodes of a robot's links in the `scene`: `nodes` by link, and `paths`, their names there."""

    def __init__(self, scene: SceneApi, robot: RobotAppearance) -> None:
        self._robot = robot
        self.paths: dict[str, str] = {}
        self.nodes: dict[str, Any] = {}
        self._moving: list[tuple[DrawnJoint, Any]] = []
        paths: list[str] = []
        shaped = 0
        for number, link in enumerate(robot.links):
            above = "/robot" if link.parent is None else paths[link.parent]
            # Names of links may hold what divides names of nodes.
            path = f"{above}/{number}_{link.name.replace('/', '_')}"
            paths.append(path)
            self.paths[link.name] = path
            pose = Placement() if link.joint is None else _pose(link.joint, 0.0)
            node = scene.add_frame(path, show_axes=False, wxyz=wxyz(pose), position=pose.position)
            self.nodes[link.name] = node
            if link.joint is not None and link.joint.kind != "fixed":
                self._moving.append((link.joint, node))
            look = _LOOKS[shaped % 2]
            shaped += bool(link.parts)
            for count, part in enumerate(link.parts):
                add_part(scene, f"{path}/shape_{count}", part, look)

    def origins(self, q: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where the frames of the links are with the axes at q (n,), (L, 3) m."""
        poses: list[Placement] = []
        for link in self._robot.links:
            if link.joint is None or link.parent is None:
                poses.append(Placement())
            else:
                poses.append(poses[link.parent].of(_pose(link.joint, _value(link.joint, q))))
        return np.array([pose.position for pose in poses])

    def stand(self, q: Sequence[float] | NDArray[np.float64]) -> None:
        """Put the links where they are with the axes at q (n,), rad or m."""
        for joint, node in self._moving:
            pose = _pose(joint, _value(joint, q))
            if joint.kind == "prismatic":
                node.position = pose.position
            else:
                node.wxyz = wxyz(pose)


def _value(joint: DrawnJoint, q: Sequence[float] | NDArray[np.float64]) -> float:
    axis = 0.0 if joint.axis_number is None else float(q[joint.axis_number])
    return joint.multiplier * axis + joint.offset


def _pose(joint: DrawnJoint, value: float) -> Placement:
    """Where a link lies in the one that carries it, its joint at a value, rad or m."""
    if joint.kind == "prismatic":
        x, y, z = (value * part for part in joint.axis)
        return joint.placement.of(Placement((x, y, z)))
    if joint.kind == "fixed":
        return joint.placement
    x, y, z, w = Rotation.from_rotvec(value * np.array(joint.axis)).as_quat().tolist()
    return joint.placement.of(Placement(orientation=(x, y, z, w)))
