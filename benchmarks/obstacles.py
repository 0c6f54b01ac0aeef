"""Time of a tick of a LIN among obstacles: none, many that are far, some that are felt.

    python benchmarks/obstacles.py [--rounds N] [--pink FOLDER]

Runs lines of the packaged arm7 there and back at 1 kHz, least motion, and prints the least and the median
processor time in microseconds per emitted tick, everything from the demand to the checked row included. Cases
take turns within a round. `--pink` installs Pink (PyPI: pin-pink) with its QP interface into a folder of its
own, where it is not there yet, and has it follow the same line with a barrier over the four nearest pairs of
solids, by DAQP, to the same tolerance of the pose: its solver's loop is timed, no demand, check or row.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import warnings
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import process_time

import numpy as np
import pinocchio as pin

from balls import ball, far
from irlx.blocks import MotionLaw, MoveBlock, MoveKind, ObstacleBlock, Origin, PoseTarget
from irlx.cell.load import load_cell
from irlx.diagnostics import Place, SourceText, Span
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.robot.kinematics import Kinematics
from irlx.scene.collision_shape import collision_shape, pose_of
from irlx.scene.distances import Distances
from irlx.scene.obstacle import Obstacle
from irlx.scene.scene import Scene
from irlx.scene.watched_pair import watched_pairs
from irlx.solids.shape import Solid

ORIGIN = Origin("benchmark", 0, 1, 1)
TEXT = SourceText("benchmark", "-\n")
DT = 0.001
WAY = np.array([0.0, 0.2, 0.1])
LAW = MotionLaw(speed=0.25, acc=1.0, speed_ori=1.0, acc_ori=4.0)
PINK = ["pin-pink", "qpsolvers", "loop-rate-limiters", "daqp"]
MET = 1e-7


def cases() -> dict[str, list[Obstacle]]:
    """Obstacles of each case by its name."""
    near = ((0.1, -0.25, 0.75), (0.45, -0.1, 0.9), (-0.1, 0.4, 0.9), (0.1, 0.15, 1.0))
    return {
        "no obstacles": [],
        "100 far away": far(100),
        "4 felt": [ball(k, np.array(position)) for k, position in enumerate(near)],
    }


class Robot:
    """The packaged arm7 at its start."""

    def __init__(self) -> None:
        with TemporaryDirectory() as folder:
            cell = Path(folder) / "cell.toml"
            cell.write_text('[robot]\nmodel = "arm7"\n', encoding="utf-8")
            self.cell = load_cell(cell)
        self.kinematics = Kinematics(self.cell.robot)
        self.rotation, self.position = self.kinematics.tool_pose(self.cell.start)

    def pacer(self, obstacles: list[Obstacle]) -> Pacer:
        """A pacer that keeps clear of obstacles."""
        scene = Scene({obstacle.name: obstacle for obstacle in obstacles})
        setup = PacingSetup(
            self.kinematics, self.cell.limits, self.cell.weights, self.cell.start, DT, scene=scene
        )
        pacer = Pacer(setup, lambda origin: Place.in_text(TEXT, Span(origin.start, origin.end)))
        for number, obstacle in enumerate(obstacles, start=1):
            pacer.execute(ObstacleBlock(id=number, origin=ORIGIN, name=obstacle.name, active=True))
        return pacer

    def there_and_back(self, pacer: Pacer) -> tuple[float, list[np.ndarray]]:
        """Time (us) of a tick, and the positions (N, 3) of the tool on both ways."""
        time, ticks, ways = 0.0, 0, []
        for number, goal in enumerate((self.position + WAY, self.position), start=200):
            target = PoseTarget(tuple(float(x) for x in goal), None)
            move = MoveBlock(id=number, origin=ORIGIN, kind=MoveKind.LIN, target=target, law=LAW)
            before = process_time()
            rows = pacer.execute(move)
            time += process_time() - before
            if rows is None or np.any(rows.active):
                raise SystemExit("a joint stands on a bound: this is not the walk to be measured")
            ticks += len(rows)
            ways.append(self.kinematics.tool_poses(rows.q)[1])
        return time / ticks * 1e6, ways


class Pink:
    """Pink following the same line with a barrier over four pairs."""

    def __init__(self, robot: Robot, obstacles: list[Obstacle]) -> None:
        self.robot, self.model = robot, robot.kinematics.model
        self.geometry = pin.GeometryModel()
        pairs = watched_pairs(robot.kinematics, obstacles, None)
        distances = Distances(robot.kinematics, pairs)
        found = distances.of(robot.cell.start, np.arange(len(pairs))).distance
        for number in np.argsort(found)[:4].tolist():
            pair = pairs[number]
            joint, frame = robot.kinematics.body_of(pair.link)
            link = self._add(joint, frame * pose_of(pair.solid.placement), pair.solid)
            at = pose_of(pair.obstacle.placement) * pose_of(pair.other_solid.placement)
            self.geometry.addCollisionPair(pin.CollisionPair(link, self._add(0, at, pair.other_solid)))

    def _add(self, joint: int, pose: pin.SE3, solid: Solid) -> int:
        name = f"solid {self.geometry.ngeoms}"
        return self.geometry.addGeometryObject(
            pin.GeometryObject(name, joint, pose, collision_shape(solid.shape))
        )

    def follow(self, way: np.ndarray) -> float:
        """Time (us) of a tick along positions (N, 3)."""
        from pink import Configuration, solve_ik
        from pink.barriers import SelfCollisionBarrier
        from pink.tasks import DampingTask, FrameTask

        configuration = Configuration(
            self.model,
            self.model.createData(),
            self.robot.cell.start,
            collision_model=self.geometry,
            collision_data=pin.GeometryData(self.geometry),
        )
        tool = FrameTask(self.robot.cell.robot.tip, position_cost=1.0, orientation_cost=1.0)
        tasks = [tool, DampingTask(cost=1e-6)]
        barrier = SelfCollisionBarrier(4, gain=20.0, safe_displacement_gain=0.0, d_min=0.01)
        time = 0.0
        for position in way:
            target = pin.SE3(self.robot.rotation, position)
            before = process_time()
            tool.set_target(target)
            for _ in range(5):
                speed = solve_ik(configuration, tasks, DT, solver="daqp", barriers=[barrier])
                configuration.integrate_inplace(speed, DT)
                if np.linalg.norm(tool.compute_error(configuration)) <= MET:
                    break
            time += process_time() - before
        return time / len(way) * 1e6


def pink_from(folder: Path) -> None:
    """Make Pink importable from a folder, installed there where it is not; Pinocchio stays that of irlx."""
    if not (folder / "pink").exists():
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target", str(folder)]
        subprocess.run([*pip, *PINK], check=True)
    sys.path.append(str(folder))


def main() -> None:
    """Measure all cases and print them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--pink", type=Path, help="folder with Pink, or one to install it into")
    asked = parser.parse_args()
    robot = Robot()
    pacers = {name: robot.pacer(obstacles) for name, obstacles in cases().items()}
    found: dict[str, list[float]] = {name: [] for name in pacers}
    pink = None
    if asked.pink is not None:
        pink_from(asked.pink)
        warnings.simplefilter("ignore")
        pink, found["Pink, barrier over 4 pairs"] = Pink(robot, cases()["4 felt"]), []
    for _ in range(asked.rounds + 1):
        ways: list[np.ndarray] = []
        for name, pacer in pacers.items():
            time, ways = robot.there_and_back(pacer)
            found[name].append(time)
        if pink is not None:
            found["Pink, barrier over 4 pairs"].append(pink.follow(ways[0]))
    print(f"{'case':30}{'least us':>10}{'median us':>11}{'of none':>9}")
    none = min(found["no obstacles"][1:])
    for name, times in found.items():
        least = min(times[1:])  # The first round warms up.
        print(f"{name:30}{least:>10.1f}{median(times[1:]):>11.1f}{least / none:>9.2f}")


if __name__ == "__main__":
    main()
