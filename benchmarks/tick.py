"""Time of a tick of a LIN: everything from the demand to the row with its tool pose and path error.

    python benchmarks/tick.py [--rounds N] [--json]

Runs lines there and back through the pacer, no joint at a bound, and prints for each case the least
and the median time in microseconds per emitted tick over the rounds, and the Newton steps per tick. The
cases take turns within a round, so that a drift of the machine's speed meets all of them alike.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np

from irlx.blocks import CyclicBlock, MotionLaw, MoveBlock, MoveKind, Origin, PoseTarget
from irlx.cell.load import load_cell
from irlx.cell.made_constraints import constrained
from irlx.diagnostics import Place, SourceText, Span
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.robot.description import Joint, JointKind, RobotDescription
from irlx.robot.kinematics import Kinematics
from irlx.robot.limits import JointLimits
from irlx.robot.urdf import read_urdf

ORIGIN = Origin("benchmark", 0, 1, 1)
TEXT = SourceText("benchmark", "-\n")
WAY = 0.3
"""Length of the line, in m at n = 7; the large robot goes farther in proportion to its speed."""


@dataclass(frozen=True)
class Robot:
    """A robot at rest in an ordinary posture: kinematics, limits, start (n,), way (3,) m, speed m/s."""

    kinematics: Kinematics
    limits: JointLimits
    start: np.ndarray
    way: np.ndarray
    speed: float


def arm7() -> Robot:
    """Seven revolute axes of a table-top arm; positions, speeds and accelerations are limited."""
    right = 1.5707963267948966
    placed = [((0, 0, 0.333), 0), ((0, 0, 0), -right), ((0, -0.316, 0), right), ((0.0825, 0, 0), right)]
    placed += [((-0.0825, 0.384, 0), -right), ((0, 0, 0), right), ((0.088, 0, 0), right)]
    joints = [
        Joint(f"a{i + 1}", JointKind.REVOLUTE, f"l{i}", f"l{i + 1}", xyz, (roll, 0.0, 0.0), (0.0, 0.0, 1.0))
        for i, (xyz, roll) in enumerate(placed)
    ]
    joints.append(Joint("flange", JointKind.FIXED, "l7", "l8", (0.0, 0.0, 0.107)))
    upper = np.array([2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973])
    lower = np.array([-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973])
    speed = np.array([2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61])
    acceleration = np.array([15.0, 7.5, 10.0, 12.5, 15.0, 20.0, 20.0])
    limits = JointLimits(lower, upper, -speed, speed, -acceleration, acceleration)
    start = np.array([0.1, -0.6, 0.2, -2.2, 0.1, 1.7, 0.8])
    kinematics = Kinematics(RobotDescription("arm7", "l0", "l8", tuple(joints)))
    return Robot(kinematics, limits, start, np.array([0.05, 0.25, 0.15]), 0.25)


def koch11() -> Robot:
    """The packaged robot of eleven joints, with speed and acceleration limits that it keeps."""
    text = (files("irlx.cell") / "robots" / "koch11.urdf").read_text()
    description = read_urdf(text, "tcp")
    degrees = [-0.05, -75.0, -102.0, 146.65, -80.6, -8.34, 55.4, 24.8, 106.1]
    start = np.concatenate([np.radians(degrees), [-0.46], np.radians([58.99])])
    lower, upper = (np.array([getattr(j, side) for j in description.axes]) for side in ("lower", "upper"))
    speed, acceleration = np.full(11, 2.0), np.full(11, 8.0)
    limits = JointLimits(lower, upper, -speed, speed, -acceleration, acceleration)
    return Robot(Kinematics(description), limits, start, np.array([-2.0, 0.0, 0.0]), 1.0)


def packaged(name: str, way: tuple[float, float, float], speed: float, constraint: str = "") -> Robot:
    """A packaged robot with its own start and limits, links free to touch, with a constraint of its cell."""
    with TemporaryDirectory() as folder:
        path = Path(folder) / "cell.toml"
        path.write_text(f'[robot]\nmodel = "{name}"\n{constraint}', encoding="utf-8")
        cell = load_cell(path)
    kinematics = constrained(Kinematics(cell.robot), cell)
    return Robot(kinematics, cell.limits, cell.start, np.array(way), speed)


AISLE = """[[constraint]]
name = "aisle"
link = "platform"
path = [[-1000, 0], [0, 0], [1000, 100], [2000, -100]]
"""


def robots() -> dict[str, Robot]:
    """The robots that are measured, by what the table calls them."""
    return {
        "n=7 arm7": arm7(),
        "n=9 mobile9": packaged("mobile9", (0.2, 0.1, 0.0), 0.1),
        "n=9 mobile9 on its path": packaged("mobile9", (0.2, 0.1, 0.0), 0.1, AISLE),
        "n=11 koch11": koch11(),
        "n=20 snake20": packaged("snake20", (0.05, 0.1, 0.05), 0.1),
    }


def there_and_back(
    robot: Robot, dt: float, cyclic: bool, clock: Callable[[], float] = perf_counter
) -> tuple[float, float]:
    """Time (us) and Newton steps per emitted tick of a line and its way back, at a tick of `dt` s."""
    weights = np.arange(float(robot.start.size), 0.0, -1.0)
    setup = PacingSetup(robot.kinematics, robot.limits, weights, robot.start, dt)
    pacer = Pacer(setup, lambda origin: Place.in_text(TEXT, Span(origin.start, origin.end)))
    if cyclic:
        pacer.execute(CyclicBlock(id=1, origin=ORIGIN, active=True))
    _, position = robot.kinematics.tool_pose(robot.start)
    law = MotionLaw(speed=robot.speed, acc=4.0 * robot.speed, speed_ori=1.0, acc_ori=4.0)
    time, ticks, steps = 0.0, 0, 0
    for number, goal in enumerate((position + robot.way, position), start=2):
        target = PoseTarget(tuple(float(c) for c in goal), None)
        block = MoveBlock(id=number, origin=ORIGIN, kind=MoveKind.LIN, target=target, law=law, limits=())
        before = clock()
        rows = pacer.execute(block)
        time += clock() - before
        if rows is None or np.any(rows.active):
            raise SystemExit("a joint stands on a bound: this is not the walk to be measured")
        ticks += len(rows)
        steps += rows.iterations
    return time / ticks * 1e6, steps / ticks


def main() -> None:
    """Measure all cases and print them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of a table")
    asked = parser.parse_args()
    cases = [
        (f"{name}, {'cyclic' if cyclic else 'least motion'}, {dt * 1000:g} ms", robot, dt, cyclic)
        for name, robot in robots().items()
        for cyclic in (False, True)
        for dt in (0.001, 0.004)
    ]
    found: dict[str, list[tuple[float, float]]] = {name: [] for name, *_ in cases}
    for _ in range(asked.rounds + 1):
        for name, *case in cases:
            found[name].append(there_and_back(*case))
    result = {}
    for name, measured in found.items():
        times = [time for time, _ in measured[1:]]  # The first round warms up.
        result[name] = {
            "least": round(min(times), 1),
            "median": round(median(times), 1),
            "newton_steps": round(measured[0][1], 2),
        }
    if asked.json:
        print(json.dumps({"unit": "us per tick", "rounds": asked.rounds, "cases": result}, indent=2))
        return
    print(f"{'case':42}{'least us':>10}{'median us':>11}{'Newton steps':>14}")
    for name, row in result.items():
        print(f"{name:42}{row['least']:>10}{row['median']:>11}{row['newton_steps']:>14}")


if __name__ == "__main__":
    main()
