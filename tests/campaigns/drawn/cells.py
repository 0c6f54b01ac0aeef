"""Cells of random robots: limits of every kind, motion defaults, frames, obstacles, conditions, inputs."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from drawn.body import TICKS, Body, join, number, singular
from drawn.robots import Robot
from irlx.cell.cell import Cell
from irlx.cell.load import load_cell
from irlx.robot.kinematics import Kinematics
from irlx.scene.distances import Distances
from irlx.scene.watched_pair import watched_pairs

TICKS_A_MOVE = (8.0, 8.0, 12.0, 12.0, 30.0)
"""Ticks that an ordinary move takes, about; fewer where that would be long."""
LONGEST_SPAN = 0.4


def loaded(robot: Robot, text: str) -> Cell:
    with TemporaryDirectory() as folder:
        for name, content in robot.files.items():
            (Path(folder) / name).write_text(content, encoding="utf-8")
        path = Path(folder) / "cell.toml"
        path.write_text(text, encoding="utf-8")
        return load_cell(path)


class CellDrawing:
    """Draws the cell of one robot."""

    def __init__(self, rng: np.random.Generator, robot: Robot) -> None:
        self.rng, self.robot = rng, robot
        self.special: set[str] = set()
        self.plain = loaded(robot, self.table([]))
        self.units = np.array(
            [1e3 if axis.is_prismatic else np.degrees(1.0) for axis in self.plain.robot.axes]
        )
        self.kinematics = Kinematics(self.plain.robot)
        self.tick = float(rng.choice(TICKS))
        self.span = min(1e-3 * float(rng.choice(TICKS_A_MOVE)) * self.tick, LONGEST_SPAN)
        self.speed = robot.size * float(rng.uniform(0.1, 0.5))
        self.obstacles: list[str] = []
        self.hand_frame, self.relation = "", None

    def table(self, more: list[str]) -> str:
        return "\n".join(["[robot]", f'model = "{self.robot.model}"', *self.robot.lines, *more, ""])

    def body(self) -> Body:
        rng = self.rng
        start = self.start() * self.units
        limits = self.limits(start)
        more = [f"start = [{join(start)}]"]
        if rng.random() < 0.2:
            self.special.add("equal weights")
            more.append(f"weights = [{join(np.ones(len(start)))}]")
        parts = [self.table(more), *limits, *self.motion(), *self.frames(start / self.units)]
        parts += [*self.condition(), *self.signals()]
        obstacles = self.drawn_obstacles(start / self.units)
        text = "\n".join([*parts, *obstacles, ""])
        cell = loaded(self.robot, text)
        if obstacles and (kept := self.clear(cell, obstacles)) != obstacles:
            text = "\n".join([*parts, *kept, ""])
            cell = loaded(self.robot, text)
        given = (self.tick, self.speed, self.span, self.obstacles, self.hand_frame, self.relation)
        return Body(self.robot, cell, text, *given, self.bounds, self.special)

    def start(self) -> np.ndarray:
        """A posture that is not singular, near that of the robot; now and then with zeros in it."""
        rng, home = self.rng, self.plain.start if self.robot.start is None else self.robot.start
        lower, upper = self.plain.limits.pair("position")
        spread = 0.0 if self.robot.model == "dual14" else 0.15
        tried = [np.clip(home + spread * rng.normal(size=home.size), lower, upper) for _ in range(6)]
        if rng.random() < 0.15:
            self.special.add("joints at zero")
            for q in tried:
                q[rng.random(q.size) < 0.3] = 0.0
            tried += [home]
        return np.clip(max(tried, key=lambda q: singular(self.kinematics, q)), *inside(lower, upper))

    def limits(self, start: np.ndarray) -> list[str]:
        """Limits in degrees and mm; `start` alike, which may lie exactly on one."""
        rng, n, own = self.rng, len(start), self.plain.limits
        lines = ["[robot.limits]"]
        lower, upper = (side * self.units for side in own.pair("position"))
        self.bounds = inside(lower, upper)
        if rng.random() < 0.5:
            low = np.maximum(start - rng.uniform(0.6, 2.5, n) * self.units, lower)
            high = np.minimum(start + rng.uniform(0.6, 2.5, n) * self.units, upper)
            if rng.random() < 0.2:
                self.special.add("start on a limit")
                on = rng.random(n) < 0.2
                side = rng.random(n) < 0.5
                low, high = np.where(on & side, start, low), np.where(on & ~side, start, high)
            self.bounds = low, high
            pairs = ", ".join(f"[{number(a)}, {number(b)}]" for a, b in zip(low, high, strict=True))
            lines.append(f"position = [{pairs}]")
        kind = str(rng.choice(["own", "drawn", "speed", "none"], p=[0.25, 0.45, 0.2, 0.1]))
        if kind == "own" and not np.isfinite(own.speed_upper).all():
            kind = "speed"
        self.special.add("no limits" if kind == "none" else f"{kind} limits")
        if kind == "own":
            return lines
        typical = self.speed / self.robot.size
        slide = np.where(self.units == 1e3, self.robot.size, 1.0)
        ease = 1.0 if rng.random() < 0.25 else 5.0
        speed = ease * np.minimum(typical * rng.uniform(1.0, 8.0, n), 4.0) * slide
        self.special.add("tight limits" if ease == 1.0 else "wide limits")
        if rng.random() < 0.04:
            self.special.add("speed limit 0")
            speed[int(rng.integers(n))] = 0.0
        if kind == "none":
            lines.append("speed = false")
        else:
            lines.append(f"speed = [{join(speed * self.units)}]")
        if kind == "drawn":
            acceleration = (speed + 0.01) * rng.uniform(4.0, 20.0, n) / self.span
            sides = zip(acceleration * self.units, rng.uniform(0.6, 1.0, n), strict=True)
            lines.append(
                f"acceleration = [{', '.join(f'[{number(-a * b)}, {number(a)}]' for a, b in sides)}]"
            )
        else:
            lines.append("acceleration = false")
        return lines

    def motion(self) -> list[str]:
        rng, v = self.rng, 1e3 * self.speed
        values = {
            "tick_ms": self.tick,
            "speed": v,
            "acc": v / (0.3 * self.span),
            "speed_ori": 120.0,
            "acc_ori": 120.0 / (0.3 * self.span),
        }
        drawn = {
            "speed_ptp": float(rng.uniform(20, 100)),
            "acc_ptp": float(rng.uniform(20, 100)),
            "c_cp": float(rng.choice([0.0, 100.0 * self.speed * self.span])),
            "c_ptp": float(rng.choice([0.0, 30.0, 100.0])),
            "jerk": float(rng.choice([0.0, v / (0.05 * self.span**2)])),
            "override": float(rng.uniform(40, 100)),
        }
        values |= {key: value for key, value in drawn.items() if rng.random() < 0.15}
        lines = ["[motion]", *(f"{key} = {number(value)}" for key, value in values.items())]
        lines += ["c_pass = true"] * (rng.random() < 0.1) + ['profile = "S_CURVE"'] * (rng.random() < 0.15)
        return lines

    def frames(self, start: np.ndarray) -> list[str]:
        rng = self.rng
        position, _ = self.kinematics.tool_pose(start)[::-1]
        place = 1e3 * (position + 0.2 * self.robot.size * rng.normal(size=3) * (1, 1, not self.robot.flat))
        turn = rng.uniform(-180, 180, 3) * (not self.robot.flat, not self.robot.flat, 1)
        lines = ["[frames]", f"fixture = {{ xyz = [{join(place)}], rpy = [{join(turn)}] }}"]
        if self.robot.hand:
            self.hand_frame = "grip"
            lines.append(
                f'grip = {{ link = "{self.robot.hand}", xyz = [0.0, 20.0, 50.0], rpy = [-90.0, 0.0, 0.0] }}'
            )
        return lines

    def condition(self) -> list[str]:
        """Now and then a relation between two joints that the start keeps."""
        rng, n = self.rng, len(self.units)
        turning = np.flatnonzero(self.units < 1e3)
        if (
            n - len(self.plain.robot.coordinates) < 2
            or len(turning) < 3
            or rng.random() > 0.12
            or self.robot.hand
        ):
            return []
        self.special.add("relation of joints")
        pair = rng.choice(turning, 2, replace=False)
        names, factor = [self.plain.robot.axes[int(j)].name for j in pair], float(rng.choice([-1.0, 2.0]))
        self.relation = (int(pair[0]), int(pair[1]), factor)
        return ["[[constraint]]", 'name = "kept"', f"joints = {{ {names[0]} = 1.0, {names[1]} = {factor} }}"]

    def signals(self) -> list[str]:
        rng = self.rng
        times = np.cumsum(rng.uniform(0.01, 3.0, 4) * self.span)
        values = [str(bool(k % 2 == 0)).lower() for k in range(4)]
        part = ", ".join(f"[{number(t)}, {v}]" for t, v in zip(times, values, strict=True))
        level = ", ".join(f"[{number(t)}, {k}]" for k, t in enumerate(times))
        return ["[signals.inputs]", f"part = [{part}]", f"AIN_1 = [[0.0, 3], {level}]"]

    def drawn_obstacles(self, start: np.ndarray) -> list[str]:
        """Up to three things that stand or move beside the links."""
        rng, size = self.rng, self.robot.size
        if rng.random() < 0.45 or not self.plain.robot.solids:
            return []
        position = self.kinematics.tool_pose(start)[1]
        found = []
        for k in range(int(rng.integers(1, 4))):
            around = position * rng.uniform(0.2, 1.0)
            place = around + rng.normal(size=3) * size * rng.uniform(0.1, 0.35)
            lengths = 1e3 * size * rng.uniform(0.03, 0.2, 3)
            shape, sizes = (
                ("point", ""),
                ("sphere", f"radius = {number(lengths[0])}"),
                ("box", f"size = [{join(lengths)}]"),
                ("cylinder", f"radius = {number(lengths[0])}\nlength = {number(lengths[1])}"),
                ("capsule", f"radius = {number(lengths[0])}\nlength = {number(lengths[1])}"),
                ("cone", f"radius = {number(lengths[0])}\nlength = {number(lengths[1])}"),
                ("halfspace", ""),
            )[int(rng.integers(7))]
            if shape == "halfspace":
                place[2] = -0.5 * size
            turn = rng.uniform(-180, 180, 3) * (shape != "halfspace") * (rng.random() < 0.7)
            where = f"xyz = [{join(1e3 * place)}]\nrpy = [{join(turn)}]"
            if rng.random() < 0.15:
                self.special.add("obstacle that moves")
                there = 1e3 * (place + 0.1 * size * rng.normal(size=3))
                first, last = f"time = 0.0, xyz = [{join(1e3 * place)}]", f"time = 2.0, xyz = [{join(there)}]"
                where = f"trajectory = [{{ {first} }}, {{ {last} }}]"
            margin = float(rng.choice([0.0, 5.0, 15.0])) * size
            lines = [
                "[[obstacle]]",
                f'name = "o{k}"',
                f'shape = "{shape}"',
                *([sizes] if sizes else []),
                where,
            ]
            lines += [
                f"margin = {number(margin)}",
                f"influence = {number(margin + 1e3 * size * rng.uniform(0.03, 0.2))}",
            ]
            found.append("\n".join(lines))
        return found

    def clear(self, cell: Cell, obstacles: list[str]) -> list[str]:
        """The obstacles that the robot does not stand in at the start, and a group of them."""
        kinematics, kept = Kinematics(cell.robot), []
        for text, obstacle in zip(obstacles, cell.scene.obstacles.values(), strict=True):
            pairs = watched_pairs(kinematics, [obstacle], None)
            distances = Distances(kinematics, pairs).of(cell.start, np.arange(len(pairs))).distance
            if len(pairs) and float(distances.min()) > obstacle.margin + 0.02 * self.robot.size:
                kept.append(text)
                self.obstacles.append(obstacle.name)
        if len(kept) > 1 and self.rng.random() < 0.5:
            self.special.add("group of obstacles")
            members = ", ".join(f'"{name}"' for name in self.obstacles[:2])
            kept.append(f'[[obstacle]]\nname = "them"\nshape = "group"\nmembers = [{members}]')
            self.obstacles.append("them")
        return kept


def inside(lower: np.ndarray, upper: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Limits (n,) a hair further inside: in mm and degrees a joint on its limit may lie one bit beyond it."""
    return lower * (1.0 + 1e-12 * np.sign(lower)), upper * (1.0 - 1e-12 * np.sign(upper))
