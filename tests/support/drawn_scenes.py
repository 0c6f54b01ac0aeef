"""Random robots among random obstacles, and blocks that lead them past: all from one seed."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.spatial.transform import Rotation

from irlx.blocks import (
    Block,
    CyclicBlock,
    FreezeBlock,
    JointTarget,
    MotionLaw,
    MoveBlock,
    MoveKind,
    ObstacleBlock,
    Origin,
    PoseTarget,
    ReconfigureBlock,
)
from irlx.cell.cell import Cell
from irlx.cell.load import load_cell
from irlx.pacing.situation import PacingSetup
from irlx.robot.kinematics import Kinematics
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene
from irlx.scene.watched_pair import watched_pairs
from irlx.solids.placement import Placement
from irlx.solids.shape import Box, Capsule, Cone, Cylinder, Halfspace, Mesh, Point, Shape, Solid, Sphere
from mesh_files import CUBE, TRIANGLES, stl

ORIGIN = Origin("drawn.irl", 0, 1, 1)
ROBOTS = {
    "arm7": ("arm7", "", 1.0),
    "mobile8": ("mobile8", "", 1.0),
    "koch11": ("koch11", "", 8.0),
    "koch10": ("koch11", "joint_9 = 106.13017079060668", 8.0),
    "koch9": ("koch11", "joint_9 = 106.13017079060668, joint_8 = 24.76249421168838", 8.0),
    "rail6": ("rail6", "", 1.0),
    "mobile7": ("mobile8", "platform_y = 0", 1.0),
    "planar4": ("planar4", "", 1.0),
}
"""Robot, joints that are locked, and how large it is beside a man, by the name of the case."""

TICKS = (0.005, 0.02, 0.05)
MESH = CUBE * 0.5 - 0.25


@dataclass
class DrawnScene:
    """A robot at its start, what stands around it, and the blocks it has to carry out.

    `told` are the words for what is special about it.
    """

    name: str
    setup: PacingSetup
    blocks: list[Block] = field(default_factory=list)
    told: list[str] = field(default_factory=list)

    @property
    def obstacles(self) -> list[Obstacle]:
        return list(self.setup.scene.obstacles.values())


@cache
def cell_of(name: str) -> tuple[Cell, Kinematics]:
    """The cell of a case, and its model."""
    model, locked, _ = ROBOTS[name]
    with TemporaryDirectory() as folder:
        path = Path(folder) / "cell.toml"
        text = f'[robot]\nmodel = "{model}"\n'
        path.write_text(text + (f"locked = {{ {locked} }}\n" if locked else ""), encoding="utf-8")
        cell = load_cell(path)
    return cell, Kinematics(cell.robot)


@cache
def _folder() -> TemporaryDirectory:
    return TemporaryDirectory()


@cache
def mesh_file() -> str:
    """A cube of half a metre, about the origin, in a file."""
    path = Path(_folder().name) / "cube.stl"
    path.write_bytes(stl(MESH, TRIANGLES))
    return str(path)


def shape_of(rng: np.random.Generator, size: float) -> Shape:
    """Any shape but a half-space, some tenths of `size` (m) large."""

    def length(least: float, most: float) -> float:
        return float(size * rng.uniform(least, most))

    made = (
        Point,
        lambda: Sphere(length(0.03, 0.15)),
        lambda: Box((length(0.05, 0.4), length(0.05, 0.4), length(0.05, 0.4))),
        lambda: Cylinder(length(0.03, 0.1), length(0.1, 0.8)),
        lambda: Capsule(length(0.03, 0.1), length(0.1, 0.6)),
        lambda: Cone(length(0.05, 0.2), length(0.1, 0.4)),
        lambda: Mesh(mesh_file(), (length(0.2, 0.8), length(0.2, 0.8), length(0.2, 0.8))),
    )
    return made[rng.integers(len(made))]()


def turn_of(rng: np.random.Generator) -> tuple[float, float, float, float]:
    """A turn, now and then none or about an axis of the world."""
    chosen = rng.random()
    if chosen < 0.2:
        return (0.0, 0.0, 0.0, 1.0)
    rotation = Rotation.from_euler("z", rng.uniform(-3, 3)) if chosen < 0.4 else Rotation.random(rng=rng)
    return tuple(rotation.as_quat().tolist())


def drawn_scene(seed: int, name: str | None = None, dt: float | None = None) -> DrawnScene:
    """The scene of a seed; a robot and tick of one's own choice where they are given."""
    return _Drawing(np.random.default_rng(seed), name, dt).scene()


class _Drawing:
    """Draws one scene."""

    def __init__(self, rng: np.random.Generator, name: str | None, dt: float | None) -> None:
        self.rng = rng
        drawn, tick = str(rng.choice(list(ROBOTS))), float(rng.choice(TICKS))
        self.name = drawn if name is None else name
        self.dt = tick if dt is None else dt
        self.size = ROBOTS[self.name][2]
        self.cell, self.kinematics = cell_of(self.name)
        self.told: list[str] = []

    def scene(self) -> DrawnScene:
        rng, limits = self.rng, self.cell.limits
        n = self.cell.start.size
        speed = rng.uniform(1.0, 2.5, n) * np.where(self._slides, 0.5 * self.size, 1.0)
        limits = limits.with_pair(
            "speed", np.maximum(limits.speed_lower, -speed), np.minimum(limits.speed_upper, speed)
        )
        free = np.full(n, np.inf)
        if rng.random() < 0.7:
            acceleration = speed * rng.uniform(2.0, 10.0, n)
            limits = limits.with_pair("acceleration", -acceleration, acceleration)
        else:
            self.told.append("no acceleration limits")
            limits = limits.with_pair("acceleration", -free, free)
        self.limits = limits
        self.q = self._start()
        obstacles = self._obstacles()
        groups = {}
        if len(obstacles) > 2 and rng.random() < 0.3:
            self.told.append("group")
            groups["them"] = tuple(obstacle.name for obstacle in obstacles[:2])
        scene = Scene({obstacle.name: obstacle for obstacle in obstacles}, groups)
        setup = PacingSetup(self.kinematics, limits, self.cell.weights, self.q, self.dt, scene=scene)
        names = [name for name in scene.obstacles if name not in groups.get("them", ())] + list(groups)
        return DrawnScene(self.name, setup, self._blocks(names), self.told)

    @property
    def _slides(self) -> np.ndarray:
        return np.array([axis.is_prismatic for axis in self.kinematics.description.axes])

    def _start(self) -> np.ndarray:
        rng, limits = self.rng, self.cell.limits
        q = self.cell.start + rng.uniform(-0.3, 0.3, self.cell.start.size) / np.sqrt(self.size)
        if rng.random() < 0.1:
            self.told.append("joints at zero")
            q[rng.random(q.size) < 0.3] = 0.0
        lower, upper = limits.position_lower, limits.position_upper
        room = np.where(rng.random(q.size) < 0.03, 0.0, 0.05)
        return np.clip(q, lower + room, upper - room)

    def _obstacles(self) -> list[Obstacle]:
        rng, count = self.rng, int(self.rng.integers(1, 11))
        found: list[Obstacle] = []
        for _ in range(40 * count):
            if len(found) == count:
                break
            drawn = self._obstacle(f"o{len(found)}")
            pairs = watched_pairs(self.kinematics, [drawn], None)
            distances = Distances(self.kinematics, pairs)
            near = distances.of(self.q, np.arange(len(pairs))).distance
            apart = float(near.min())
            if apart <= 0.003 * self.size:
                continue
            chosen = rng.random()
            if chosen < 0.04 and apart < 0.2 * self.size:
                self.told.append("on the margin")
                drawn = replace(drawn, margin=apart, influence=max(drawn.influence, 1.5 * apart))
            elif chosen < 0.08 and apart < 0.2 * self.size:
                self.told.append("inside the margin")
                margin = apart + float(rng.uniform(0.001, 0.03)) * self.size
                drawn = replace(drawn, margin=margin, influence=drawn.influence + margin)
            elif chosen < 0.12:
                self.told.append("at the border of influence")
                drawn = replace(drawn, influence=apart, margin=min(drawn.margin, 0.5 * apart))
            elif apart <= drawn.margin + 0.003 * self.size:
                continue
            found.append(drawn)
            if rng.random() < 0.06 and len(found) < count:
                self.told.append("twins")
                found.append(replace(drawn, name=f"o{len(found)}"))
        return found

    def _obstacle(self, name: str) -> Obstacle:
        rng, size = self.rng, self.size
        margin = 0.0 if rng.random() < 0.05 else float(rng.uniform(0.005, 0.03)) * size
        influence = margin + float(rng.uniform(0.03, 0.25)) * size
        if rng.random() < 0.05:
            # A wall or floor beside the robot: all that lies behind a plane through some point.
            turn = Rotation.random(rng=rng)
            behind = self._somewhere() - turn.apply([0.0, 0.0, float(rng.uniform(0.1, 0.5)) * size])
            wall = Placement(tuple(behind.tolist()), tuple(turn.as_quat().tolist()))
            return Obstacle(name, (Solid(Halfspace()),), wall, margin, influence)
        away = rng.normal(size=3) * rng.uniform(0.05, 0.4) * size
        if self.kinematics.task.size == 3 and rng.random() < 0.8:
            away[2] = 0.0
        place = Placement(tuple((self._somewhere() + away).tolist()), turn_of(rng))
        solids = [Solid(shape_of(rng, size))]
        while rng.random() < 0.2:
            beside = Placement(tuple((0.2 * size * rng.normal(size=3)).tolist()), turn_of(rng))
            solids.append(Solid(shape_of(rng, size), beside))
        return Obstacle(name, tuple(solids), place, margin, influence)

    def _somewhere(self) -> np.ndarray:
        """A point of a moved link, the robot near its start: often of the elbow, where null motions lead."""
        links = [link for link in self.kinematics.description.solids if self.kinematics.body_of(link)[0] > 0]
        link = links[len(links) // 2] if self.rng.random() < 0.4 else str(self.rng.choice(links))
        joint, frame = self.kinematics.body_of(link)
        q = self.q + self.rng.uniform(-0.4, 0.4, self.q.size)
        self.kinematics.tool_pose(q)
        return (self.kinematics.data.oMi[joint] * frame).translation.copy()

    def _law(self) -> MotionLaw:
        fast = self.size * float(self.rng.uniform(0.1, 0.35))
        return MotionLaw(speed=fast, acc=4.0 * fast, speed_ori=1.0, acc_ori=3.0, speed_ptp=0.6, acc_ptp=0.6)

    def _blocks(self, names: list[str]) -> list[Block]:
        rng = self.rng
        rotation, position = self.kinematics.tool_pose(self.q)
        blocks: list[Block] = []
        on: list[str] = []

        def switch(name: str, active: bool) -> None:
            blocks.append(ObstacleBlock(id=len(blocks) + 1, origin=ORIGIN, name=name, active=active))

        for name in names:
            if rng.random() < 0.9:
                switch(name, True)
                on.append(name)
        if rng.random() < 0.2:
            self.told.append("cyclic")
            blocks.append(CyclicBlock(id=len(blocks) + 1, origin=ORIGIN, active=True))
        spare = self.q.size - self.kinematics.rows
        if rng.random() < 0.08:
            self.told.append("frozen")
            joints = (int(rng.integers(1, self.q.size + 1)),)
            blocks.append(FreezeBlock(id=len(blocks) + 1, origin=ORIGIN, joints=joints if spare else ()))
        for k in range(int(rng.integers(1, 4))):
            if k and names and rng.random() < 0.5:
                name = str(rng.choice(names))
                switch(name, name not in on)
                on = [other for other in on if other != name] + ([name] if name not in on else [])
            blocks.append(self._move(len(blocks) + 1, position, rotation))
        return blocks

    def _move(self, number: int, position: np.ndarray, rotation: np.ndarray) -> Block:
        rng, law = self.rng, self._law()
        if rng.random() < 0.08:
            joints = JointTarget(tuple((self.q + rng.uniform(-0.2, 0.2, self.q.size)).tolist()))
            if rng.random() < 0.5:
                return ReconfigureBlock(id=number, origin=ORIGIN, target=joints, law=law)
            return MoveBlock(id=number, origin=ORIGIN, kind=MoveKind.PTP, target=joints, law=law)
        # To where the tool is in another posture: most such lines are possible.
        other = self.q + rng.uniform(-0.4, 0.4, self.q.size) / np.sqrt(self.size)
        lower, upper = self.limits.pair("position")
        way = self.kinematics.tool_pose(np.clip(other, lower, upper))[1] - position
        length = float(np.linalg.norm(way))
        way = way * min(1.0, 0.35 * self.size / max(length, 1e-9))
        turn = Rotation.identity()
        planar = self.kinematics.task.size == 3
        if planar:
            way[2] = 0.0
        elif rng.random() < 0.3:
            turn = Rotation.from_rotvec(rng.uniform(-0.3, 0.3, 3))
        goal = (turn * Rotation.from_matrix(rotation)).as_quat()
        target = PoseTarget(tuple((position + way).tolist()), None if planar else tuple(goal.tolist()))
        return MoveBlock(id=number, origin=ORIGIN, kind=MoveKind.LIN, target=target, law=law)
