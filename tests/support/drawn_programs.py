"""Programs of every kind of move, joined and not, drawn around the start of a robot."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import irlx

ROBOTS = ("arm7", "koch11", "rail6")
MIXED = (
    "LIN",
    "LIN",
    "LIN",
    "PTP",
    "JOINTS",
    "JOINTS",
    "JOINTS",
    "JOINTS",
    "CIRCLE",
    "PATH",
    "SPLINE",
    "INC",
    "OUT",
)
"""Kinds of which PTPs stand beside moves along paths most of the time."""
KINDS = ("LIN", "LIN", "LIN", "CIRCLE", "PTP", "PATH", "SPLINE", "INC", "OUT", "WAIT")
SIZE = {"arm7": 0.12, "koch11": 1.0, "rail6": 0.15}
"""Ways of this many m are long for the robot."""
KOCH_SPEEDS = "[robot.limits]\nspeed = [60, 60, 60, 60, 60, 60, 60, 60, 60, 600, 60]\n"


def text(values: np.ndarray) -> str:
    return "(" + ", ".join(f"{value:.6f}" for value in values) + ")"


class Writer:
    """Draws the statements of one program around a pose (mm)."""

    def __init__(
        self, rng: np.random.Generator, at: np.ndarray, size: float, kinds: tuple[str, ...] = KINDS
    ) -> None:
        self.kinds = kinds
        self.start = self.steps = np.zeros(0)
        """Joint values of the start and ways of the joints, deg or mm."""
        self.rng, self.at, self.size = rng, at, size * 1e3
        self.first = at.copy()

    def way(self) -> np.ndarray:
        scale = self.rng.choice([0.0, 1e-6, 0.01, 0.3, 1.0], p=[0.02, 0.03, 0.1, 0.25, 0.6])
        return scale * self.size * self.rng.normal(size=3) * 0.5

    def point(self) -> np.ndarray:
        """Near the last one, in a ball about the first; sometimes exactly one of them."""
        if self.rng.random() < 0.05:
            return self.first
        found = self.at + self.way()
        off = found - self.first
        length = float(np.linalg.norm(off))
        return self.first + off * min(1.0, self.size / length) if length > 0.0 else found

    def go(self) -> str:
        self.at = self.point()
        if self.rng.random() < 0.4:
            turned = self.rng.choice([1e-8, 3.0, 15.0]) * self.rng.normal(size=3)
            return f"({text(self.at)}, o @ ORIZYX{text(turned)})"
        return f"POSITION{text(self.at)}"

    def posture(self) -> str:
        """Joint values about those of the start, in the program's units."""
        rng = self.rng
        scale = rng.choice([0.0, 1e-6, 0.02, 1.0], p=[0.05, 0.05, 0.2, 0.7]) * rng.normal(
            size=len(self.start)
        )
        return "MAIN_JOINT" + text(self.start + scale * (rng.random(len(self.start)) < 0.7) * self.steps)

    def params(self, kind: str) -> str:
        rng, found = self.rng, []
        if kind == "PTP" and rng.random() < 0.7:
            found.append(f"C_PTP := {rng.choice([0.0, 1e-7, 5.0, 50.0, 100.0]):.7f}")
        if kind != "PTP" and rng.random() < 0.6:
            found.append(f"C_CP := {rng.choice([0.0, 1e-7, 2.0, 20.0, 500.0]):.7f}")
        if rng.random() < 0.2:
            found.append(f"C_PASS := {rng.choice(['TRUE', 'FALSE'])}")
        if rng.random() < 0.4:
            found.append(f"SPEED := {rng.uniform(20, 600):.3f}")
        if rng.random() < 0.3:
            found.append(f"ACC := {rng.uniform(100, 3000):.3f}")
        if rng.random() < 0.2:
            found.append("PROFILE := 'S_CURVE'")
        if rng.random() < 0.15:
            found.append(f"OVERRIDE := {rng.uniform(10, 100):.3f}")
        if rng.random() < 0.08 and kind != "PTP":
            found.append(f"TIME := {rng.choice([0.01, 2.0, 4.0])}")
        return " ".join(found)

    def statement(self) -> str:
        kind = str(self.rng.choice(self.kinds))
        if kind == "OUT":
            return f"lamp := {self.rng.choice(['TRUE', 'FALSE'])};"
        if kind == "WAIT":
            return "WAIT 0.02 SEC;"
        if kind == "CIRCLE":
            via = self.go()
            angle = f" ANGLE := {self.rng.choice([30, 360, -200])}" if self.rng.random() < 0.3 else ""
            return f"MOVE CIRCLE {via}, {self.go()}{angle} {self.params(kind)};"
        if kind in ("PATH", "SPLINE"):
            points = ", ".join(self.go() for _ in range(int(self.rng.integers(2, 5))))
            word = "LIN PATH" if kind == "PATH" else "SPLINE PATH"
            return f"MOVE {word} ({points}) {self.params(kind)};"
        if kind == "INC":
            way = self.way()
            self.at = self.at + way
            return f"MOVE_INC LIN POSITION{text(way)} {self.params(kind)};"
        if kind == "JOINTS":
            return f"MOVE PTP {self.posture()} {self.params('PTP')};"
        return f"MOVE {kind} {self.go()} {self.params(kind)};"


def write_program(folder: Path, seed: int, kinds: tuple[str, ...] = KINDS) -> None:
    rng = np.random.default_rng(seed)
    print(f"seed {seed}")
    robot = ROBOTS[seed % len(ROBOTS)]
    tick = rng.choice([4, 10, 20])
    own = KOCH_SPEEDS if robot == "koch11" else ""
    (folder / "drawn.toml").write_text(f'[robot]\nmodel = "{robot}"\n{own}[motion]\ntick_ms = {tick}\n')
    (folder / "drawn.irl").write_text("PROGRAM drawn;\nBEGIN\nENDPROGRAM;\n")
    run = irlx.run(folder / "drawn.irl")
    start = run.tool[0]
    turns = np.array([unit == "rad" for unit in run.stream.header.joint_units])
    writer = Writer(rng, start[:3] * 1e3, SIZE[robot], kinds)
    writer.start = np.where(turns, np.degrees(run.q[0]), run.q[0] * 1e3)
    writer.steps = np.where(turns, 8.0, 0.1 * writer.size)
    statements = [writer.statement() for _ in range(int(rng.integers(3, 8)))]
    declared = f"VAR OUTPUT BOOL: lamp AT 1; ORIENTATION: o := ORIQUAT{text(np.roll(start[3:], 1))};"
    body = "\n".join(statements)
    (folder / "drawn.irl").write_text(f"PROGRAM drawn;\n{declared}\nBEGIN\n{body}\nENDPROGRAM;\n")
