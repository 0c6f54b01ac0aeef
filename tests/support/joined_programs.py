"""Short programs of moves that pass into each other, and what the verifier says of their runs."""

from __future__ import annotations

import tempfile
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

import irlx

ROBOTS = {
    "arm7": ('model = "arm7"', 80.0, 8.0),
    "planar4": ('model = "planar4"', 80.0, 8.0),
    "free": ('model = "arm7"\nfree = ["rx"]', 80.0, 8.0),
    "panda": ('model = "panda"', 80.0, 8.0),
}
"""Lines of the cell, and by how many mm and degrees targets lie about the start."""
WAYS = [0.0, 1e-6, 0.01, 0.3, 1.0]
"""Shares of that by which a target lies beside the one before: the same, next to it, near it, anywhere."""
RADII = [5e-4, 0.01, 0.03, 0.1, 0.3]
TIGHT = 10_000
REFUSALS = {
    "IRL345",
    "IRL421",
    "IRL422",
    "IRL428",
    "IRL434",
    "IRL435",
    *(f"IRL{code}" for code in range(520, 526)),
    "IRL560",
}


@dataclass(frozen=True)
class Start:
    """Where a robot stands: position (3,) mm, rotation, posture in degrees and mm."""

    position: np.ndarray
    rotation: Rotation
    values: np.ndarray


@cache
def start_of(robot: str) -> Start:
    with tempfile.TemporaryDirectory() as name:
        run = irlx.run(*written(Path(name), robot, "", "tick_ms = 10"))
    units = [180.0 / np.pi if unit == "rad" else 1e3 for unit in run.stream.header.joint_units]
    return Start(run.tool[0, :3] * 1e3, Rotation.from_quat(run.tool[0, 3:]), run.q[0] * units)


def written(folder: Path, robot: str, body: str, motion: str) -> tuple[Path, Path]:
    """Program and cell in a folder."""
    program, cell = folder / "p.irl", folder / "p.toml"
    program.write_text(f"PROGRAM p;\nBEGIN\n{body}\nENDPROGRAM;\n", encoding="utf-8")
    cell.write_text(f"[robot]\n{ROBOTS[robot][0]}\n[motion]\n{motion}\n", encoding="utf-8")
    return program, cell


class Drawing:
    """Draws the moves of one program."""

    def __init__(self, seed: int) -> None:
        self.rng = np.random.default_rng([29, seed])
        self.robot = str(self.rng.choice(list(ROBOTS), p=[0.5, 0.2, 0.2, 0.1]))
        self.start, self.flat = start_of(self.robot), self.robot == "planar4"
        self.at = np.zeros(2 if self.flat else 3)
        self.turns = self.rng.random() < 0.4

    def motion(self) -> str:
        tick, speed, acc = (
            self.rng.choice(values) for values in ([1, 4, 10, 20], [50, 200, 800], [500, 4000, 40000])
        )
        return f"tick_ms = {tick}\nspeed = {speed}\nacc = {acc}"

    def body(self) -> str:
        return "\n".join(self.move() for _ in range(self.rng.integers(2, 6)))

    def move(self) -> str:
        kinds = (self.circle, self.circle, self.line, self.ptp, self.line_path, self.spline)
        statement = kinds[self.rng.integers(len(kinds))]()
        if self.rng.random() < 0.2:
            statement += f" SPEED := {self.rng.uniform(5.0, 900.0):.6g}" if "PTP" not in statement else ""
        if self.rng.random() < 0.85:
            ways = ["C_PASS := TRUE", "C_CP := 100", f"C_CP := {self.rng.uniform(0, 10):.6g}", "C_CP := 0.01"]
            joints = ["C_PASS := TRUE", f"C_PTP := {self.rng.uniform(0, 100):.6g}"]
            statement += f" {self.rng.choice(joints if 'PTP' in statement else ways)}"
        return f"{statement};"

    def line(self) -> str:
        return f"MOVE LIN {self.target()}"

    def line_path(self) -> str:
        return f"MOVE LIN PATH ({self.points(5)})"

    def spline(self) -> str:
        return f"MOVE SPLINE PATH ({self.points(6)})"

    def ptp(self) -> str:
        if self.rng.random() < 0.2:
            return f"MOVE PTP {self.target()}"
        off = ROBOTS[self.robot][2] * self.rng.uniform(-1.0, 1.0, self.start.values.size)
        return f"MOVE PTP MAIN_JOINT({numbers(self.start.values + off)})"

    def circle(self) -> str:
        rng = self.rng
        radius = rng.choice(RADII) * rng.uniform(0.5, 1.0)
        if rng.random() < 0.4:
            self.at = rng.uniform(-0.3, 0.3, self.at.size)
        side, forward = np.linalg.qr(rng.normal(size=(self.at.size, 2)))[0].T
        points = (self.at + radius * (side + forward), self.at + 2.0 * radius * side)
        angles = [rng.uniform(-720, 720), rng.uniform(-60, 60), rng.choice([360, -360, 180, 400, -400, 350])]
        angle = f" ANGLE := {rng.choice(angles):.9g}" if rng.random() < 0.7 else ""
        via, goal = (self.written_position(point) for point in points)
        self.at = points[1] if not angle else self.at
        return f"MOVE CIRCLE {via}, {goal}{angle}"

    def points(self, most: int) -> str:
        """Targets of a PATH, whose neighbours must differ."""
        return ", ".join(self.target(WAYS[2:]) for _ in range(self.rng.integers(2, most)))

    def target(self, ways: Sequence[float] = WAYS) -> str:
        far = self.rng.choice(ways)
        fresh = self.rng.uniform(-0.4, 0.4, self.at.size)
        self.at = fresh if far == 1.0 else self.at + far * fresh
        position = self.written_position(self.at)
        if not self.turns or self.rng.random() < 0.3:
            return position
        axis = np.array([0.0, 0.0, 1.0]) if self.flat else self.rng.normal(size=3)
        turned = Rotation.from_rotvec(self.rng.choice([0.0, 1e-9, 0.02, 0.3]) * axis) * self.start.rotation
        x, y, z, w = turned.as_quat()
        return f"POSE({position}, ORIQUAT({numbers(np.array([w, x, y, z]))}))"

    def written_position(self, at: np.ndarray) -> str:
        off = np.zeros(3)
        off[: at.size] = at
        return f"POSITION({numbers(self.start.position + ROBOTS[self.robot][1] * off)})"


def numbers(values: np.ndarray) -> str:
    return ", ".join(f"{value:.9g}" for value in values)


def program_of(seed: int, folder: Path, smooth: bool = False) -> tuple[Path, Path]:
    """Program and cell of a seed; from `TIGHT` on joints are slow, too, and moves have each its own ACC.

    `smooth`: the same with S curves and their jerk, some moves having another one or none.
    """
    drawing = Drawing(seed)
    motion, body = drawing.motion(), drawing.body()
    if smooth:
        motion, body = smoothed(seed, motion, body)
    if seed >= TIGHT:
        rng = np.random.default_rng([31, seed])
        joints = drawing.start.values.size
        limits = [f"speed = [{numbers(np.exp(rng.uniform(np.log(5.0), np.log(90.0), joints)))}]"]
        if rng.random() < 0.5:
            limits.append(
                f"acceleration = [{numbers(np.exp(rng.uniform(np.log(100.0), np.log(3000.0), joints)))}]"
            )
        motion += "\n[robot.limits]\n" + "\n".join(limits)
        body = "\n".join(
            f"{line[:-1]} ACC := {np.exp(rng.uniform(np.log(30.0), np.log(2e4))):.6g};"
            if "PTP" not in line and rng.random() < 0.7
            else line
            for line in body.splitlines()
        )
    return written(folder, drawing.robot, body, motion)


def smoothed(seed: int, motion: str, body: str) -> tuple[str, str]:
    """Motion of the cell and moves with S curves: ramps that take some ms up to a second."""
    rng = np.random.default_rng([37, seed])
    motion += f'\nprofile = "S_CURVE"\njerk = {np.exp(rng.uniform(np.log(1e3), np.log(1e7))):.6g}'
    lines = []
    for line in body.splitlines():
        words = [
            f"JERK := {np.exp(rng.uniform(np.log(1e3), np.log(1e7))):.6g}",
            "PROFILE := 'TRAPEZOID'",
            "",
            "",
        ]
        word = "" if "PTP" in line else str(rng.choice(words))
        lines.append(f"{line[:-1]} {word};" if word else line)
    return motion, "\n".join(lines)


def judged_smooth(seed: int) -> tuple[str, list[str]]:
    """The same of the program with S curves."""
    return judged(seed, True)


def judged(seed: int, smooth: bool = False) -> tuple[str, list[str]]:
    """How the program of a seed ended, and what the verifier has against its run."""
    warnings.simplefilter("ignore")
    with tempfile.TemporaryDirectory() as name:
        program, cell = program_of(seed, Path(name), smooth)
        end = "complete"
        try:
            run = irlx.run(program, cell)
        except irlx.RunError as error:
            run, end = error.run, error.reason.code
            if end not in REFUSALS:
                return end, [str(error)]
        report = irlx.verify(run, program=program, cell=cell)
    failed = [check for check in report.failed if end == "complete" or check.name != "complete"]
    return end, [f"{check.name}: {check.text}" for check in failed]
