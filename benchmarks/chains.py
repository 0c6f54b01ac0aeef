"""Arms of any number of joints, alike in size and work, and one line there and back for all arms."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np

from irlx.blocks import CyclicBlock, MotionLaw, MoveBlock, MoveKind, ObstacleBlock, Origin, PoseTarget
from irlx.cell.load import load_cell
from irlx.diagnostics import Place, SourceText, Span
from irlx.pacing.pacer import Pacer
from irlx.pacing.rows import MotionRows
from irlx.pacing.situation import PacingSetup
from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene

ORIGIN = Origin("benchmark", 0, 1, 1)
TEXT = SourceText("benchmark", "-\n")
REACH, FLANGE = 0.9, 0.1
"""Length of the links together and of the flange, m."""
BEND, TURN = 2.4, 0.25
"""At the start: the sum of the bends, and every turn of a link about itself, rad."""
WAY = (-0.1, 0.15, -0.1)
LAW = MotionLaw(speed=0.25, acc=1.0, speed_ori=1.0, acc_ori=4.0)
SLOW = 0.6
"""Share of the speeds of a free line that a slow arm has."""


@dataclass(frozen=True)
class Arm:
    """An arm in the posture where its line starts, start (n,)."""

    kinematics: Kinematics
    limits: JointLimits
    start: np.ndarray


@dataclass(frozen=True)
class Walked:
    """The rows of the moves, and the computing time of all of them, s."""

    rows: tuple[MotionRows, ...]
    time: float

    @property
    def ticks(self) -> int:
        """How many rows there are."""
        return sum(len(rows) for rows in self.rows)

    @property
    def us_per_tick(self) -> float:
        """Computing time of a row, us."""
        return self.time / self.ticks * 1e6


def chain(joints: int) -> Arm:
    """An arm 1 m long whose joints turn about their links and across them in turns, bent into an arc.

    Its line meets none of its limits.
    """
    link, axes = REACH / joints, ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0))
    made = [
        Joint(f"a{i + 1}", JointKind.REVOLUTE, f"l{i}", f"l{i + 1}", (0.0, 0.0, link), axis=axes[i % 2])
        for i in range(joints)
    ]
    made.append(Joint("flange", JointKind.FIXED, f"l{joints}", "tool", (0.0, 0.0, FLANGE)))
    start = np.where(np.arange(joints) % 2, BEND / (joints // 2), TURN)
    position, speed, acceleration = (np.full(joints, bound) for bound in (2.9, 3.0, 20.0))
    limits = JointLimits(-position, position, -speed, speed, -acceleration, acceleration)
    return Arm(Kinematics(RobotDescription(f"chain{joints}", "l0", "tool", tuple(made))), limits, start)


def arm7() -> Arm:
    """The packaged robot of that name, whose links have shapes."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "cell.toml"
        path.write_text('[robot]\nmodel = "arm7"\n', encoding="utf-8")
        cell = load_cell(path)
    return Arm(Kinematics(cell.robot), cell.limits, cell.start)


def slow(arm: Arm, dt: float) -> Arm:
    """The arm with joints that reach only a part of the speeds of its line."""
    found = np.concatenate([rows.q for rows in there_and_back(arm, dt).rows])
    bound = SLOW * np.abs(np.diff(found, axis=0)).max(axis=0) / dt
    return replace(arm, limits=replace(arm.limits, speed_lower=-bound, speed_upper=bound))


def there_and_back(arm: Arm, dt: float, cyclic: bool = False, obstacles: Sequence[Obstacle] = ()) -> Walked:
    """The line and its way back at a tick of `dt` s, all that a run does for its rows but writing them."""
    weights = np.arange(float(arm.start.size), 0.0, -1.0)
    scene = Scene({obstacle.name: obstacle for obstacle in obstacles})
    setup = PacingSetup(arm.kinematics, arm.limits, weights, arm.start, dt, scene=scene)
    pacer = Pacer(setup, lambda origin: Place.in_text(TEXT, Span(origin.start, origin.end)))
    if cyclic:
        pacer.execute(CyclicBlock(id=1, origin=ORIGIN, active=True))
    for number, obstacle in enumerate(obstacles, start=2):
        pacer.execute(ObstacleBlock(id=number, origin=ORIGIN, name=obstacle.name, active=True))
    _, position = arm.kinematics.tool_pose(arm.start)
    found, time = [], 0.0
    for number, goal in enumerate((position + WAY, position), start=2 + len(obstacles)):
        target = PoseTarget(tuple(float(c) for c in goal), None)
        block = MoveBlock(id=number, origin=ORIGIN, kind=MoveKind.LIN, target=target, law=LAW)
        begin = process_time()
        rows = pacer.execute(block)
        time += process_time() - begin
        assert rows is not None
        found.append(rows)
    return Walked(tuple(found), time)


def is_planned(walked: Walked) -> bool:
    """Whether all moves were planned as a whole, because limits would not have been kept otherwise."""
    return all(rows.path is not None and rows.path.planned for rows in walked.rows)
