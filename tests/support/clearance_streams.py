"""Streams of any robot among obstacles, made of rows and switches alone."""

from __future__ import annotations

import hashlib

import numpy as np
from scipy.spatial.transform import Rotation

from irlx.blocks import JointTarget, MotionLaw, MoveBlock, MoveKind, ObstacleBlock, Origin
from irlx.robot.description import RobotDescription
from irlx.robot.limits import JointLimits
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import LinkClearance, Scene
from irlx.solids.placement import Placement
from irlx.solids.shape import Shape, Solid
from irlx.streams import FORMAT_VERSION, BlockRecord, JointStream, StreamHeader
from irlx.streams.scan import scan_of
from irlx.verifier import Check, Reference, verify_scans
from irlx.verifier.geometry.forward import forward

LAW = MotionLaw(speed=30.0, acc=300.0, speed_ori=30.0, acc_ori=500.0)


class StreamMaker:
    """Rows of a robot, motion by motion; a motion's last row is repeated to stand."""

    def __init__(self, robot: RobotDescription, start: np.ndarray, dt: float = 0.004) -> None:
        self.robot, self.dt = robot, dt
        self.rows, self.blocks = [np.array(start, dtype=float)[None]], [np.zeros(1, dtype=np.int64)]
        self.records: list[BlockRecord] = []

    @property
    def tick(self) -> int:
        return sum(map(len, self.rows)) - 1

    def _origin(self) -> tuple[int, Origin]:
        number = len(self.records) + 1
        return number, Origin("near.irl", 10 * number, 10 * number + 5, number + 3)

    def switch(self, name: str, active: bool = True) -> None:
        number, origin = self._origin()
        self.records.append(
            BlockRecord(self.tick, ObstacleBlock(id=number, origin=origin, name=name, active=active))
        )

    def move(self, rows: np.ndarray) -> int:
        """A PTP of these rows; the tick of the first one."""
        number, origin = self._origin()
        first = self.tick + 1
        rows = np.atleast_2d(np.asarray(rows, dtype=float))
        target = JointTarget(tuple(rows[-1].tolist()))
        move = MoveBlock(id=number, origin=origin, kind=MoveKind.PTP, target=target, law=LAW)
        self.records.append(BlockRecord(self.tick, move))
        self.rows.append(np.concatenate([rows, rows[-1:]]))
        self.blocks.append(np.full(len(rows) + 1, number))
        return first

    def stream(self) -> JointStream:
        q, block = np.concatenate(self.rows), np.concatenate(self.blocks)
        position, rotation = forward(self.robot, q)
        tool = np.column_stack([position, Rotation.from_matrix(rotation).as_quat()])
        return JointStream(
            self._header(), tuple(self.records), np.arange(len(q)), q, block, tool, complete=True
        )

    def _header(self) -> StreamHeader:
        robot = self.robot
        free = np.full(len(robot.axes), np.inf)
        return StreamHeader(
            format_version=FORMAT_VERSION,
            irlx_version="0.1.0",
            program_name="near.irl",
            program_sha256=hashlib.sha256(b"").hexdigest(),
            cell_name="cell.toml",
            robot_name=robot.name,
            robot_model=robot.name,
            robot_fingerprint=robot.fingerprint,
            tip=robot.tip,
            joint_names=robot.joint_names,
            joint_units=tuple("m" if joint.is_prismatic else "rad" for joint in robot.axes),
            tick_ns=round(self.dt * 1e9),
            limits=JointLimits(-free, free, -free, free, -free, free),
            weights=(1.0,) * len(robot.axes),
        )


def clearance_of(maker: StreamMaker, scene: Scene | None) -> Check:
    """What the verifier finds of the clearance of a stream in a scene."""
    stream = maker.stream()
    reference = Reference(maker.robot, scene=scene)
    return verify_scans(lambda: scan_of(stream), reference, "near.irl")["clearance"]


def obstacle(
    name: str, shape: Shape | tuple[Solid, ...], xyz=(0.0, 0.0, 0.0), rpy=(0.0, 0.0, 0.0), margin=0.02, **data
) -> Obstacle:
    solids = shape if isinstance(shape, tuple) else (Solid(shape),)
    return Obstacle(name, solids, Placement.from_rpy(xyz, rpy), margin, 10.0 * margin, **data)


def scene_of(*obstacles: Obstacle, links: LinkClearance | None = None, **groups: tuple[str, ...]) -> Scene:
    return Scene({found.name.casefold(): found for found in obstacles}, groups, links)
