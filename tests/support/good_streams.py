"""Random programs with their cells that use every statement irlx executes, for streams that must verify.

A case is drawn by its seed alone: robot and tick go round with it, its motions are dealt from `MOTIONS` so
that any 16 seeds in a row have each of them at least three times, switches and clauses come at random.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from irlx.cell.robot_data import robot_data_folder
from machines import Machine, machine

ROBOTS = ["koch11", "arm7", "rail6", *(["panda"] if robot_data_folder() is not None else [])]
TICKS = [50.0, 4.0, 1.0, 10.0, 0.25]
SIZES = {"koch11": 6.0, "arm7": 1.0, "rail6": 1.0, "panda": 1.0}
"""How much wider and faster than an ordinary arm a robot moves."""

KINDS = ("POSITION", "SPEED", "ACCELERATION")
WORDS = {"POSITION": "JOINTLIMIT", "SPEED": "JOINTSPEEDLIMIT", "ACCELERATION": "JOINTACCELLIMIT"}
TYPES = {"POSITION": "MAIN_JOINT", "SPEED": "MAIN_JOINT_SPEED", "ACCELERATION": "MAIN_JOINT_ACCEL"}
MOTIONS_EACH, LEAST_SPAN = 6, 0.15

Pair = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Case:
    """A program and its cell as texts; `motions` says in words what the program was dealt."""

    seed: int
    robot: str
    tick: float
    cell: str
    program: str
    motions: tuple[str, ...]

    def write(self, folder: Path) -> Path:
        """Write drawn.irl and drawn.toml; returns the program's path."""
        (folder / "drawn.toml").write_text(self.cell, encoding="utf-8")
        program = folder / "drawn.irl"
        program.write_text(self.program, encoding="utf-8")
        return program

    def __str__(self) -> str:
        return (
            f"seed {self.seed}, robot {self.robot}, tick {self.tick} ms\n"
            f"--- drawn.toml\n{self.cell}--- drawn.irl\n{self.program}"
        )


def number(value: float) -> str:
    return repr(float(value))


def join(values) -> str:
    return ", ".join(map(number, values))


def drawn_case(seed: int) -> Case:
    """The case of a seed."""
    name, tick = ROBOTS[seed % len(ROBOTS)], TICKS[seed % len(TICKS)]
    drawing = Drawing(np.random.default_rng(seed), name, tick)
    dealt = [list(MOTIONS)[(MOTIONS_EACH * seed + i) % len(MOTIONS)] for i in range(MOTIONS_EACH)]
    cell = drawing.cell(NEED_LIMITS.isdisjoint(dealt))
    for motion in drawing.rng.permutation(dealt):
        if drawing.rng.random() < 0.4:
            drawing.switch()
        MOTIONS[str(motion)](drawing)
    return Case(seed, name, tick, cell, drawing.text(), tuple(dealt))


@dataclass
class Drawing:
    """A program in the making: where the tool will be, what is frozen, and the text so far."""

    rng: np.random.Generator
    name: str
    tick: float
    frozen: tuple[int, ...] = ()
    variables: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        rng, robot = self.rng, self.robot
        self.units = np.array([1e3 if axis.is_prismatic else np.degrees(1.0) for axis in robot.robot.axes])
        self.at, rotation = robot.pose(robot.start)
        self.home = self.at
        self.rotation = self.upright = Rotation.from_matrix(rotation)
        # Some ten rows for a motion at the longest tick, a thousand at the shortest.
        self.span = min(max(0.1 * self.tick, LEAST_SPAN), 0.5)
        self.v = SIZES[self.name] * rng.uniform(0.1, 0.4)
        self.way = 0.7 * self.v * self.span
        self.speed = np.minimum(rng.uniform(0.3, 2.5, robot.n), robot.limits.speed_upper)
        self.acceleration = self.speed * rng.uniform(3.0, 20.0, robot.n)

    @property
    def robot(self) -> Machine:
        return machine(self.name)

    def cell(self, may_be_unlimited: bool) -> str:
        """Limits of the robot's own, drawn ones, speeds only, or, where no PTP needs them, neither."""
        kind = self.rng.choice(["own", "drawn", "speed", "none" if may_be_unlimited else "drawn"])
        if kind == "own" and not np.isfinite(self.robot.limits.speed_upper).all():
            kind = "speed"
        limits = ["[robot.limits]"] if kind != "own" else []
        if kind == "none":
            limits.append("speed = false")
        elif kind != "own":
            limits.append(f"speed = [{join(self.speed * self.units)}]")
        if kind == "drawn":
            limits.append(f"acceleration = [{join(self.acceleration * self.units)}]")
        elif kind != "own":
            limits.append("acceleration = false")
        acc = 1e3 * self.v / (0.3 * self.span)
        law = {"speed": 1e3 * self.v, "acc": acc, "speed_ori": 90.0, "acc_ori": 90.0 / (0.3 * self.span)}
        return "\n".join(
            [
                "[robot]",
                f'model = "{self.name}"',
                f"start = [{join(self.robot.start * self.units)}]",
                *limits,
                "[motion]",
                f"tick_ms = {number(self.tick)}",
                *(f"{key} = {number(value)}" for key, value in law.items()),
                "",
            ]
        )

    def text(self) -> str:
        """The program; now and then it halts before a statement that is never reached."""
        if self.rng.random() < 0.15:
            self.lines += ["HALT;", "MOVE LIN (0, 0, 0);"]
        body = [f"  {line}" for line in self.lines]
        variables = ["VAR", *(f"  {line}" for line in self.variables)] if self.variables else []
        return "\n".join(["PROGRAM drawn;", *variables, "BEGIN", *body, "ENDPROGRAM;", ""])

    def variable(self, type_: str, value: str | None = None) -> str:
        name = f"v{len(self.variables)}"
        self.variables.append(f"{type_}: {name}{'' if value is None else f' := {value}'};")
        return name

    def add(self, *lines: str) -> None:
        self.lines += lines

    # ---- Poses and postures

    def pose(self, position: np.ndarray, rotation: Rotation) -> str:
        """Text of a pose, which the tool is taken to have from now on; quaternions of any sign."""
        self.at, self.rotation = position, rotation
        x, y, z, w = self.rng.choice([-1.0, 1.0]) * rotation.as_quat()
        return f"(({join(1e3 * position)}), ORIQUAT({join([w, x, y, z])}))"

    def near(self) -> tuple[np.ndarray, Rotation]:
        """A pose near that of the start, turned as there or otherwise."""
        way = self.rng.normal(size=3) * self.rng.choice([1.0, 1.0, 0.0], size=3)
        position = self.home + 0.5 * self.way * way
        return position, self.upright * self.small_turn()

    def small_turn(self) -> Rotation:
        size = self.rng.choice([0.0, 0.0, 0.4, 1.0]) * np.radians(40.0 * self.span)
        return Rotation.from_rotvec(size * self.rng.normal(size=3))

    def posture(self, spread: float = 0.15) -> np.ndarray:
        """Joint values near the start, the frozen ones as they stand there."""
        away = spread * self.span**0.5 * self.rng.normal(size=self.robot.n)
        away[[number - 1 for number in self.frozen]] = 0.0
        limits = self.robot.limits
        lower, upper = np.maximum(limits.position_lower, -1e3), np.minimum(limits.position_upper, 1e3)
        return np.clip(self.robot.start + away, lower, upper)

    def joints(self, spread: float = 0.15) -> str:
        """Text of a posture; the tool is taken to be there from now on."""
        values = self.posture(spread)
        self.at, rotation = self.robot.pose(values)
        self.rotation = Rotation.from_matrix(rotation)
        return self.variable("MAIN_JOINT", f"({join(values * self.units)})")

    def konf(self) -> str:
        return self.variable("MAIN_JOINT", f"({join(self.posture(0.4) * self.units)})")

    # ---- Options

    def bounds(self, kind: str) -> str:
        """Two variables with bounds of a kind."""
        n, start = self.robot.n, self.robot.start
        if kind == "POSITION":
            pair = start - self.rng.uniform(0.3, 1.2, n), start + self.rng.uniform(0.3, 1.2, n)
        else:
            size = (self.speed if kind == "SPEED" else self.acceleration) * self.rng.uniform(0.2, 1.0, n)
            pair = -size * self.rng.uniform(0.7, 1.0), size
        names = [
            self.variable(f"{TYPES[kind]}_{side}", f"({join(values * self.units)})")
            for side, values in zip(("MIN", "MAX"), pair, strict=True)
        ]
        return ", ".join(names)

    def switch(self) -> None:
        """One option on or off."""
        kind = str(self.rng.choice(["cyclic", "freeze", *KINDS]))
        on = self.rng.random() < 0.6
        if kind == "cyclic":
            self.add("CYCLICSTART;" if on else "CYCLICEND;")
        elif kind == "freeze":
            self.freeze() if on else self.free()
        else:
            self.add(f"{WORDS[kind]} {self.bounds(kind)};" if on else f"{WORDS[kind]}END;")

    def freeze(self) -> None:
        count = self.rng.integers(1, self.robot.n - 5)
        self.frozen = tuple(int(joint) + 1 for joint in self.rng.choice(self.robot.n, count, replace=False))
        self.add(f"FREEZESTART {', '.join(map(str, self.frozen))};")

    def free(self) -> None:
        self.frozen = ()
        self.add("FREEZEEND;")

    def usually_free(self) -> None:
        """A PTP to a pose is mostly refused where a joint is frozen; now and then it may be."""
        if self.frozen and self.rng.random() < 0.9:
            self.free()

    def parameters(self) -> str:
        """Bounds of the path's law, and sometimes a duration that is long enough."""
        v = 1e3 * self.v * self.rng.uniform(0.5, 2.0)
        words = {
            "SPEED": v,
            "ACC": v / (self.span * self.rng.uniform(0.1, 0.5)),
            "SPEED_ORI": self.rng.uniform(30.0, 150.0),
            "ACC_ORI": self.rng.uniform(100.0, 400.0) / self.span,
        }
        chosen = [f"{word} := {number(value)}" for word, value in words.items() if self.rng.random() < 0.4]
        return f" {', '.join(chosen)}" if chosen else ""


# ---- Motions, each with the lines that it takes


def line(d: Drawing) -> None:
    d.add(f"MOVE LIN {d.pose(*d.near())}{d.parameters()};")


def several_lines(d: Drawing) -> None:
    d.add(f"R_SPEED := {number(1e3 * d.v * d.rng.uniform(0.6, 1.2))};")
    d.add(f"MOVE LIN {d.pose(*d.near())}, {d.pose(*d.near())}{d.parameters()};")


def line_to_position(d: Drawing) -> None:
    d.at, _ = d.near()
    d.add(f"MOVE LIN POSITION({join(1e3 * d.at)});")


def line_to_joints(d: Drawing) -> None:
    d.add(f"MOVE LIN {d.joints()}{d.parameters()};")


def turn_on_the_spot(d: Drawing) -> None:
    turn = Rotation.from_rotvec(np.radians(40.0 * d.span) * d.rng.normal(size=3))
    d.add(f"MOVE LIN {d.pose(d.at, d.rotation * turn)}{d.parameters()};")


def tiny_line(d: Drawing) -> None:
    """Ways down to the rounding of a number, without and with a turn."""
    for size in d.rng.choice([1e-16, 1e-13, 1e-9, 1e-7, 1e-6, 1e-5, 1e-3], 2):
        turn = Rotation.from_rotvec(d.rng.choice([0.0, 1e-14, 1e-7, 1e-3]) * d.rng.normal(size=3))
        d.add(f"MOVE LIN {d.pose(d.at + size * d.rng.normal(size=3), d.rotation * turn)};")


def line_to_where_it_is(d: Drawing) -> None:
    here = d.pose(*d.near())
    d.add(f"MOVE LIN {here};", f"MOVE LIN {here};")


def half_turn(d: Drawing) -> None:
    """Nearly or exactly half a turn, which has no axis and is refused."""
    if d.tick < 1.0:
        return line(d)
    angle = np.radians(d.rng.choice([120.0, 175.0, 179.9999, 180.0], p=[0.3, 0.3, 0.3, 0.1]))
    turned = d.rotation * Rotation.from_rotvec([0.0, 0.0, d.rng.choice([-1.0, 1.0]) * angle])
    return d.add(f"MOVE LIN {d.pose(d.home, turned)} SPEED_ORI := 300, ACC_ORI := 1500;")


def circle_points(d: Drawing, via: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Points after so many degrees of a circle through where the tool is."""
    u = d.rng.normal(size=3)
    u = u / np.linalg.norm(u)
    w = np.cross(u, d.rng.normal(size=3))
    w = w / np.linalg.norm(w)
    radius = d.rng.uniform(0.2, 0.5) * d.way

    def point(degrees: float) -> np.ndarray:
        angle = np.radians(degrees)
        return d.at + radius * ((1.0 - np.cos(angle)) * u + np.sin(angle) * w)

    return point(via), point(end)


def arc(d: Drawing) -> None:
    """A part of a circle, the orientation of the via point counting or not."""
    via, end = circle_points(d, d.rng.uniform(20.0, 150.0), d.rng.uniform(160.0, 350.0))
    through = d.pose(via, d.rotation * d.small_turn())
    words = " CIRC_ORI := 'VIA'" if d.rng.random() < 0.5 else ""
    d.add(f"MOVE CIRCLE {through}, {d.pose(end, d.rotation * d.small_turn())}{words};")


def rounds(d: Drawing) -> None:
    """By an angle: backwards, whole turns, several rounds."""
    start, angle = d.at, float(d.rng.choice([-400.0, -90.0, 1e-3, 30.0, 360.0, 720.0]))
    via, end = circle_points(d, 80.0, 170.0)
    words = " CIRC_ORI := 'VIA'" if angle > 90.0 and d.rng.random() < 0.3 else ""
    through = d.pose(via, d.rotation * d.small_turn())
    target = d.pose(end, d.rotation * d.small_turn())
    d.add(f"MOVE CIRCLE {through}, {target} ANGLE := {number(angle)}{words};")
    # Where it ends is known for whole turns only.
    d.at = start
    if angle % 360.0:
        line(d)


def ptp_to_joints(d: Drawing) -> None:
    words = ""
    if d.rng.random() < 0.5:
        words = f" SPEED_PTP := {number(d.rng.uniform(10, 100))}, ACC_PTP := {number(d.rng.uniform(10, 100))}"
    d.add(f"MOVE PTP {d.joints()}{words};")


def ptp_to_pose(d: Drawing) -> None:
    d.usually_free()
    d.add(f"MOVE PTP {d.pose(*d.near())};")


def ptp_to_position(d: Drawing) -> None:
    d.usually_free()
    d.at, _ = d.near()
    d.add(f"MOVE PTP POSITION({join(1e3 * d.at)});")


def timed(d: Drawing) -> None:
    d.usually_free()
    duration = d.span * d.rng.uniform(4.0, 8.0)
    kind = d.rng.choice(["LIN", "PTP"])
    d.add(f"MOVE {kind} {d.pose(*d.near())} TIME := {number(duration)};")


def cyclic_loop(d: Drawing) -> None:
    """Twice round a triangle from a pose known to the last digit."""
    d.free()
    d.add(f"MOVE LIN {(corner := d.pose(*d.near()))};", "CYCLICSTART;")
    others = [d.pose(*d.near()) for _ in range(2)]
    d.add(*(f"MOVE LIN {pose};" for pose in [*others, corner] * 2))
    if d.rng.random() < 0.5:
        d.add("CYCLICEND;")


def from_the_posture(d: Drawing) -> None:
    """Joint values of that moment, changed, as a target."""
    name = d.variable("MAIN_JOINT")
    joint = next(j for j in d.rng.permutation(np.arange(1, d.robot.n + 1)) if j not in d.frozen)
    size = d.units[joint - 1] * 0.1 * d.span * d.rng.normal()
    d.add(f"{name} := R_JOINT_ACT.M_JOINT;", f"{name}.A{joint} := {name}.A{joint} + {number(size)};")
    d.add(f"MOVE PTP {name};", f"MOVE LIN {d.pose(*d.near())};")


def law_from_the_posture(d: Drawing) -> None:
    speed = f"{number(1e3 * d.v)} + 0.25 * ABS(R_JOINT_ACT.M_JOINT.A1)"
    d.add(f"MOVE LIN {d.pose(*d.near())} SPEED := {speed};")


def reconfiguration(d: Drawing) -> None:
    d.add(f"RECONFIGURATION {d.konf()};")


def reconfiguration_from_the_posture(d: Drawing) -> None:
    name = d.variable("MAIN_JOINT")
    d.add(f"{name} := R_JOINT_ACT.M_JOINT;", f"{name}.A3 := {name}.A3 + {number(20.0 * d.span)};")
    d.add(f"RECONFIGURATION {name};")


def line_to_a_posture(d: Drawing) -> None:
    d.add(f"MOVE LIN {d.pose(*d.near())} WITH RECONFIGURATION {d.konf()};")


def circle_to_a_posture(d: Drawing) -> None:
    """With a posture for the end point, or one for the via point, too."""
    postures = ", ".join(d.konf() for _ in range(int(d.rng.integers(1, 3))))
    via, end = circle_points(d, 60.0, 150.0)
    through = d.pose(via, d.rotation)
    d.add(f"MOVE CIRCLE {through}, {d.pose(end, d.rotation)} WITH RECONFIGURATION {postures};")


def ptp_to_a_posture(d: Drawing) -> None:
    d.usually_free()
    d.add(f"MOVE PTP {d.pose(*d.near())} WITH RECONFIGURATION {d.konf()};")


def under_clauses(d: Drawing) -> None:
    """A line and a PTP under one clause, a circle under two."""
    kind, *_ = others = [str(k) for k in d.rng.permutation(KINDS)]
    d.add(f"MOVE LIN {d.pose(*d.near())} WITH {WORDS[kind]} {d.bounds(kind)};")
    via, end = circle_points(d, 60.0, 150.0)
    both = " WITH ".join(f"{WORDS[k]} {d.bounds(k)}" for k in others[1:])
    through = d.pose(via, d.rotation)
    d.add(f"MOVE CIRCLE {through}, {d.pose(end, d.rotation)} WITH {both};")
    d.add(f"MOVE PTP {d.joints()} WITH {WORDS[kind]} {d.bounds(kind)};")


def under_switches(d: Drawing) -> None:
    """A fast line that the switched limits slow down."""
    for kind in KINDS[1:]:
        d.add(f"{WORDS[kind]} {d.bounds(kind)};")
    law = f"SPEED := {number(3e3 * d.v)}, ACC := {number(2e4 * d.v / d.span)}"
    if d.tick >= 1.0:
        law += f", PROFILE := 'S_CURVE', JERK := {number(2e5 * d.v / d.span**2)}"
    d.add(f"MOVE LIN {d.pose(*d.near())} {law};")
    d.add(*(f"{WORDS[kind]}END;" for kind in KINDS[1:]))


def under_frozen_joints(d: Drawing) -> None:
    d.freeze()
    d.add(f"MOVE LIN {d.pose(*d.near())};")
    d.free()


CRITERIA = ("MANIPULABILITY", "SMALLEST_SINGULAR_VALUE", "JOINT_CENTRING", "JOINT_BARRIER", "KINETIC_ENERGY")


def under_criteria(d: Drawing) -> None:
    """Lines drawn by one criterion, then by two."""
    one, other = (str(name) for name in d.rng.permutation(CRITERIA)[:2])
    gain = "" if one == "KINETIC_ENERGY" else f", GAIN := {number(d.rng.uniform(1.0, 40.0))}"
    d.add(f"CRITERION {one} WEIGHT := {number(d.rng.uniform(0.2, 3.0))}{gain};")
    d.add(f"MOVE LIN {d.pose(*d.near())}{d.parameters()};")
    d.add(f"MOVE LIN {d.pose(*d.near())} WITH CRITERION {other};", f"CRITERIONEND {one};")


def reconfiguration_to_a_posture_of_the_pose(d: Drawing) -> None:
    """The posture that a PTP to where the tool is would end in: nothing, or next to it."""
    pose = d.pose(*d.near())
    d.add(f"MOVE LIN {pose};", f"RECONFIGURATION POSTURE({pose});")


MOTIONS: dict[str, Callable[[Drawing], None]] = {
    made.__name__.replace("_", " "): made
    for made in (
        line,
        cyclic_loop,
        several_lines,
        line_to_position,
        line_to_joints,
        reconfiguration,
        turn_on_the_spot,
        tiny_line,
        ptp_to_joints,
        line_to_where_it_is,
        half_turn,
        under_clauses,
        arc,
        under_frozen_joints,
        rounds,
        ptp_to_pose,
        line_to_a_posture,
        ptp_to_position,
        under_switches,
        timed,
        from_the_posture,
        law_from_the_posture,
        reconfiguration_from_the_posture,
        circle_to_a_posture,
        ptp_to_a_posture,
        under_criteria,
        reconfiguration_to_a_posture_of_the_pose,
    )
}
"""What a program may be dealt, by its name in words."""

NEED_LIMITS = {"ptp to joints", "ptp to pose", "ptp to position", "timed", "from the posture"}
NEED_LIMITS |= {"ptp to a posture", "under clauses"}
"""Motions that hold a PTP, which is refused where a joint has no speed limit."""
