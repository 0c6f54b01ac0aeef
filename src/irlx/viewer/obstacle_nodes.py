"""Obstacles in the scene, to be seen through, and a handle that moves them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import pinocchio as pin

from irlx.report.appearance.model import DrawnObstacle
from irlx.scene.obstacle import Obstacle
from irlx.scene.trajectory import way_of
from irlx.solids.placement import Placement
from irlx.viewer.shapes import Look, add_part, wxyz

if TYPE_CHECKING:
    from viser import SceneApi

_LOOK = Look((222, 74, 60), 0.4)
_HANDLE = "/handle"


class ObstacleNodes:
    """Nodes of a cell's obstacles, and one handle for the one, or the group, that is being moved.

    `movable` are names of obstacles that stand still, `groups` names of groups with their members. `poses`
    are where the handle has put obstacles, in the world, by name. `told` is called after each change by a
    hand.
    """

    def __init__(
        self,
        scene: SceneApi,
        drawn: Iterable[DrawnObstacle],
        movable: Sequence[str],
        groups: Mapping[str, Sequence[str]],
        told: Callable[[], None],
    ) -> None:
        self.poses: dict[str, Placement] = {}
        self._scene, self._told = scene, told
        self._bodies: dict[str, Any] = {}
        self._obstacles: dict[str, Obstacle] = {}
        for number, one in enumerate(drawn):
            name, pose = one.obstacle.name, one.obstacle.placement
            self._obstacles[name] = one.obstacle
            path = f"/obstacles/{number}_{name}"
            self._bodies[name] = scene.add_frame(
                path, show_axes=False, wxyz=wxyz(pose), position=pose.position
            )
            for count, part in enumerate(one.parts):
                add_part(scene, f"{path}/shape_{count}", part, _LOOK)
        self._sets: dict[str, tuple[str, ...]] = {name: (name,) for name in movable}
        self._sets |= {name: tuple(own) for name, own in groups.items() if own and set(own) <= set(movable)}
        self._handle: Any = None
        self._held = ""

    @property
    def movable(self) -> tuple[str, ...]:
        """Names of the obstacles and groups that can be moved."""
        return tuple(self._sets)

    def hold(self, name: str, size: float) -> None:
        """Show the handle, its arrows so long (m), at an obstacle or group; '' takes it away."""
        self._held = name
        if self._handle is not None:
            self._handle.remove()
            self._handle = None
        if not name:
            return
        members = {one: self._pose(one) for one in self._sets[name]}
        begin = _grip(list(members.values()))
        handle = self._scene.add_transform_controls(
            _HANDLE, scale=size, line_width=3.0, depth_test=False, wxyz=wxyz(begin), position=begin.position
        )
        inner = {one: _inverse(begin).of(pose) for one, pose in members.items()}

        def follow(_: object) -> None:
            grip = _placement(handle)
            for one, pose in inner.items():
                self._put(one, grip.of(pose))
            self._told()

        handle.on_update(follow)
        self._handle = handle

    def place(self, name: str, pose: Placement) -> None:
        """Put an obstacle at a pose in the world; KeyError for one that cannot be moved."""
        if self._sets[name] != (name,):
            raise KeyError(name)
        self._put(name, pose)
        self._let_go()
        self._told()

    def put_back(self) -> None:
        """Put all obstacles back where the cell has them."""
        for name in list(self.poses):
            self._put(name, self._obstacles[name].placement)
        self.poses.clear()
        self._let_go()
        self._told()

    def stand(self, time: float) -> None:
        """Put those that move by themselves where they are at a time, s."""
        for name, obstacle in self._obstacles.items():
            if obstacle.trajectory:
                pose = way_of(obstacle).pose(time)
                x, y, z, w = pin.Quaternion(pose.rotation).coeffs().tolist()
                body = self._bodies[name]
                body.position, body.wxyz = pose.translation, (w, x, y, z)

    def _let_go(self) -> None:
        """The handle goes where what it holds is now."""
        if self._handle is not None:
            self.hold(self._held, float(self._handle.scale))

    def _pose(self, name: str) -> Placement:
        return self.poses.get(name, self._obstacles[name].placement)

    def _put(self, name: str, pose: Placement) -> None:
        body = self._bodies[name]
        body.position, body.wxyz = pose.position, wxyz(pose)
        self.poses[name] = pose


def _grip(poses: Sequence[Placement]) -> Placement:
    """Where the handle is: at the one obstacle, in the middle of several."""
    if len(poses) == 1:
        return poses[0]
    x, y, z = np.mean([pose.position for pose in poses], axis=0).tolist()
    return Placement((x, y, z))


def _placement(node: Any) -> Placement:
    """Where a node is in the world."""
    px, py, pz = (float(value) for value in node.position)
    w, x, y, z = (float(value) for value in node.wxyz)
    return Placement((px, py, pz), (x, y, z, w))


def _inverse(placement: Placement) -> Placement:
    x, y, z, w = placement.orientation
    back = Placement(orientation=(-x, -y, -z, w))
    px, py, pz = back.turned(placement.position)
    return Placement((-px, -py, -pz), back.orientation)
