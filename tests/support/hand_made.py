"""A joint stream made by hand: robot, cell, program and stream files by numpy and the pages of the reference.

Nothing of irlx is imported. As a script: `python hand_made.py FOLDER [FAULT]`.

The robot is a gantry: a rail along (3, 4, 0)/5, slides along x, y, z, turns about z, y, x that meet in a
point. For a pose of the tool and a place of the rail its joint values are closed form. All in m, rad and s.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import cos, pi, radians, sin, sqrt
from pathlib import Path
from typing import Any

import numpy as np

Entries = dict[str, Any]

TICK_NS = 8_000_000
DT = TICK_NS / 1e9

# ---- The robot: its description, and forward and inverse kinematics by hand

JOINTS = (
    # name, type, origin xyz and rpy, axis, lower and upper limit, speed, acceleration in mm/s2 or deg/s2
    ("rail", "prismatic", "0 0 0", "0 0 0", "3 4 0", (-1.5, 1.5), 0.8, 2000.0),
    ("x", "prismatic", "0 0 0.4", "0 0 0", "1 0 0", (-2.0, 2.0), 1.0, 3000.0),
    ("y", "prismatic", "0 0 0", "0 0 0", "0 1 0", (-2.0, 2.0), 1.0, 3000.0),
    ("z", "prismatic", "0 0 0", "0 0 0", "0 0 1", (-0.5, 1.0), 1.0, 3000.0),
    ("a", "revolute", "0 0 0", "0 0 0", "0 0 1", (-3.0, 3.0), 2.0, 400.0),
    ("b", "revolute", "0 0 0", "0 0 0", "0 1 0", (-1.5, 1.5), 2.0, 400.0),
    ("c", "revolute", "0 0 0", "0 0 0", "1 0 0", (-3.0, 3.0), 2.0, 400.0),
    ("flange", "fixed", "0.1 0 -0.05", "0 1.5707963267948966 0", "1 0 0", (0.0, 0.0), 0.0, 0.0),
)
AXES = JOINTS[:7]
LINKS = ("base", "carriage", "beam", "bridge", "quill", "yoke", "fork", "hand", "tool")
PLACES = tuple(zip(JOINTS, pairwise(LINKS), strict=True))
UNITS = ["m" if joint[1] == "prismatic" else "rad" for joint in AXES]


def in_si(values: Any) -> list[float]:
    """One value for each axis, mm or degrees, in m or rad."""
    return [v * 1e-3 if unit == "m" else radians(v) for v, unit in zip(values, UNITS, strict=True)]


LIMITS = {
    "position_lower": [joint[5][0] for joint in AXES],
    "position_upper": [joint[5][1] for joint in AXES],
    "speed_lower": [-joint[6] for joint in AXES],
    "speed_upper": [joint[6] for joint in AXES],
    "acceleration_lower": in_si([-joint[7] for joint in AXES]),
    "acceleration_upper": in_si([joint[7] for joint in AXES]),
}


def urdf() -> str:
    """Text of the robot's URDF."""
    lines = ['<robot name="gantry">', *(f'  <link name="{link}"/>' for link in LINKS)]
    for (name, kind, xyz, rpy, axis, (lower, upper), speed, _), (parent, child) in PLACES:
        lines.append(f'  <joint name="{name}" type="{kind}">')
        lines.append(f'    <parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}" rpy="{rpy}"/>')
        lines.append(f'    <axis xyz="{axis}"/><limit lower="{lower}" upper="{upper}" velocity="{speed}"/>')
        lines.append("  </joint>")
    return "\n".join([*lines, "</robot>", ""])


def fingerprint(longer: float = 0.0) -> str:
    """SHA-256 of the chain's geometry as JSON; `longer` (m) makes another robot's flange."""
    chain = []
    for (name, kind, *texts, _, _, _), (parent, child) in PLACES:
        xyz, rpy, axis = ([float(word) for word in text.split()] for text in texts)
        length = sqrt(sum(part * part for part in axis))
        geometry = {"xyz": xyz, "rpy": rpy, "axis": [part / length for part in axis]}
        known = {"name": name, "kind": kind, "parent": parent, "child": child}
        chain.append({**known, **geometry, "lower": None, "upper": None, "speed": None})
    chain[-1]["xyz"][0] += longer
    text = json.dumps({"tip": LINKS[-1], "chain": chain, "locked": {}}, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def about(axis: Any, angles: np.ndarray) -> np.ndarray:
    """Turns (N, 3, 3) about a unit axis (3,) by angles (N,), by Rodrigues' formula."""
    sine, cosine = np.sin(angles)[:, None, None], np.cos(angles)[:, None, None]
    return cosine * np.eye(3) + sine * np.cross(np.eye(3), axis) + (1.0 - cosine) * np.outer(axis, axis)


X, Y, Z = np.eye(3)
HEIGHT, FLANGE = np.array([0.0, 0.0, 0.4]), np.array([0.1, 0.0, -0.05])
RAIL = np.array([0.6, 0.8, 0.0])
TOOL_IN_HAND = about(Y, np.array([pi / 2.0]))[0]


def forward(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Tool positions (N, 3) and rotations (N, 3, 3) of postures q (N, 7)."""
    hand = about(Z, q[:, 4]) @ about(Y, q[:, 5]) @ about(X, q[:, 6])
    return q[:, 1:4] + np.outer(q[:, 0], RAIL) + HEIGHT + hand @ FLANGE, hand @ TOOL_IN_HAND


def inverse(positions: np.ndarray, rotations: np.ndarray, rail: np.ndarray) -> np.ndarray:
    """Postures (N, 7) for tool positions (N, 3), rotations (N, 3, 3) and places of the rail (N,)."""
    hand = rotations @ TOOL_IN_HAND.T
    slides = positions - hand @ FLANGE - np.outer(rail, RAIL) - HEIGHT
    a = np.arctan2(hand[:, 1, 0], hand[:, 0, 0])
    c = np.arctan2(hand[:, 2, 1], hand[:, 2, 2])
    return np.column_stack([rail, slides, a, -np.arcsin(hand[:, 2, 0]), c])


def times(p: Any, q: Any) -> list[Any]:
    """Product of quaternions (x, y, z, w)."""
    (x, y, z, w), (i, j, k, r) = p, q
    return [
        w * i + x * r + y * k - z * j,
        w * j - x * k + y * r + z * i,
        w * k + x * j - y * i + z * r,
        w * r - x * i - y * j - z * k,
    ]


def turns_zyx(sine: Any, cosine: Any) -> list[Any]:
    """Quaternion (x, y, z, w) of turns about the moving axes z, y, x, by sine and cosine of their halves."""
    (sz, sy, sx), (cz, cy, cx) = sine, cosine
    none = 0.0 * sz
    return times(times([none, none, sz, cz], [none, sy, none, cy]), [sx, none, none, cx])


def tool_columns(q: np.ndarray) -> np.ndarray:
    """Rows (N, 7) x y z qx qy qz qw of the tool in postures q (N, 7)."""
    half = q[:, 4:].T / 2.0
    turned = times(turns_zyx(np.sin(half), np.cos(half)), [0.0, sin(pi / 4.0), 0.0, cos(pi / 4.0)])
    return np.column_stack([forward(q)[0], *turned])


# ---- The program, and what it means block by block

CELL = f"""[robot]
model = "robot.urdf"

[robot.limits]
acceleration = {[joint[7] for joint in AXES]}

[motion]
tick_ms = {TICK_NS / 1e6}
"""
PROGRAM = """PROGRAM work;
{ Every kind of move and switch once. }
SYSTEM SPECIFICATION cell;
CONST
  MAIN_JOINT_SPEED_MIN: slowest := (-60, -400, -400, -400, -90, -90, -90);
  MAIN_JOINT_SPEED_MAX: fastest := (60, 400, 400, 400, 90, 90, 90);
BEGIN
  MOVE PTP (100, 300, -200, 100, 30, 10, -20) SPEED_PTP := 50, ACC_PTP := 50;
  MOVE PTP ((500, 100, 600), ORIZYX(0, 90, 0));
  MOVE LIN ((700, 300, 600), ORIZYX(40, 100, 0)) SPEED := 200, ACC := 500;
  MOVE LIN
    (700, 500, 600),
    (500, 500, 600);
  MOVE CIRCLE (400, 400, 650), ((300, 500, 700), ORIZYX(20, 80, 10)) SPEED := 150;
  JOINTSPEEDLIMIT slowest, fastest;
  MOVE LIN (500, 300, 650);
  JOINTSPEEDLIMITEND;
  FREEZESTART 1;
  MOVE LIN ((300, 400, 650), ORIZYX(90, 90, 0)) SPEED_ORI := 60;
  FREEZEEND;
  CYCLICSTART;
  MOVE LIN
    ((500, 400, 650), ORIZYX(60, 90, 0)),
    (400, 600, 750),
    ((300, 400, 650), ORIZYX(90, 90, 0));
  CYCLICEND;
  RECONFIGURATION (250, 150, 100, 300, 90, 0, 0);
  MOVE PTP (0, 0, 0, 0, 0, 0, 0) TIME := 3;
ENDPROGRAM;
"""
MOVE, RECONFIGURATION, LIMIT, FREEZE, CYCLIC = 300, 310, 410, 420, 430
TYPES = {
    MOVE: "MoveBlock",
    RECONFIGURATION: "ReconfigureBlock",
    LIMIT: "LimitSwitchBlock",
    FREEZE: "FreezeBlock",
    CYCLIC: "CyclicBlock",
}


@dataclass(frozen=True)
class Step:
    """One block: its code and entries; of a motion the ticks it takes, enough to stay below what is
    programmed, and where it leads the rail (None: it stays)."""

    code: int
    entries: Entries
    ticks: int = 0
    rail: float | None = None
    name: str = ""


def pose(position: tuple[float, ...], *angles: float) -> Entries:
    """Pose target from mm and angles about the moving axes z, y, x in degrees, or none."""
    turned = None
    if angles:
        half = [radians(angle) / 2.0 for angle in angles]
        turned = turns_zyx([sin(angle) for angle in half], [cos(angle) for angle in half])
        length = sqrt(sum(part * part for part in turned))
        turned = [part / length for part in turned]
    at = [part * 1e-3 for part in position]
    return {"type": "PoseTarget", "position": at, "orientation": turned, "frame": "R_BASE"}


def joints(*values: float) -> Entries:
    """Joint target from mm and degrees."""
    return {"type": "JointTarget", "values": in_si(values)}


def law(speed: float = 250.0, acc: float = 1000.0, speed_ori: float = 90.0, **more: Any) -> Entries:
    """Time law from mm and degrees per s, s2; what is not given is the cell's default."""
    way = {"speed": speed * 1e-3, "acc": acc * 1e-3}
    shape = {"profile": "TRAPEZOID", "jerk": None, "override": 1.0}
    turning = {"speed_ori": radians(speed_ori), "acc_ori": radians(180.0)}
    return {**way, **turning, "speed_ptp": 1.0, "acc_ptp": 1.0, "duration": None, **shape, **more}


def move(
    kind: str, target: Entries, ticks: int, rail: float | None = None, name: str = "", **laws: Any
) -> Step:
    """The block of a move."""
    course = laws.pop("course", None)
    entries = {"kind": kind, "target": target, "law": law(**laws), "limits": [], "course": course}
    return Step(MOVE, {**entries, "reconfiguration": None, "criteria": [], "blend": None}, ticks, rail, name)


def steps() -> list[Step]:
    """The blocks of the program in order: one for each line of its statements that is not just MOVE LIN."""
    via = {"type": "ArcCourse", "via": pose((400, 400, 650)), "angle": None, "turns_through_via": False}
    course = {**via, "via_reconfiguration": None}
    slowest = in_si((-60, -400, -400, -400, -90, -90, -90))
    narrow = {"lower": slowest, "upper": [-bound for bound in slowest]}
    asked = {"values": in_si((250, 150, 100, 300, 90, 0, 0))}
    posture = joints(100, 300, -200, 100, 30, 10, -20)
    home = pose((300, 400, 650), 90, 90, 0)
    return [
        move("PTP", posture, 150, name="to posture", speed_ptp=0.5, acc_ptp=0.5),
        move("PTP", pose((500, 100, 600), 0, 90, 0), 90, 0.15, "to pose"),
        move("LIN", pose((700, 300, 600), 40, 100, 0), 350, 0.2, speed=200.0, acc=500.0),
        move("LIN", pose((700, 500, 600)), 195, 0.25, "before corner"),
        move("LIN", pose((500, 500, 600)), 195, 0.2, "after corner"),
        move("CIRCLE", pose((300, 500, 700), 20, 80, 10), 530, 0.1, course=course, speed=150.0),
        Step(LIMIT, {"kind": "SPEED", "range": narrow}),
        move("LIN", pose((500, 300, 650)), 280, name="at limit"),
        Step(LIMIT, {"kind": "SPEED", "range": None}),
        Step(FREEZE, {"joints": [1]}),
        move("LIN", home, 330, name="frozen", speed_ori=60.0),
        Step(FREEZE, {"joints": []}),
        Step(CYCLIC, {"active": True}, name="cyclic"),
        move("LIN", pose((500, 400, 650), 60, 90, 0), 200, 0.3),
        move("LIN", pose((400, 600, 750)), 240, 0.35),
        move("LIN", home, 240, name="return"),
        Step(CYCLIC, {"active": False}),
        Step(RECONFIGURATION, {"target": asked, "law": law()}, 50, 0.25, "reconfiguration"),
        move("PTP", joints(0, 0, 0, 0, 0, 0, 0), 375, duration=3.0),
    ]


def blocks() -> list[Entries]:
    """Plain forms of all blocks in order."""
    found: list[Entries] = []
    start = PROGRAM.index("BEGIN")
    lines = PROGRAM[start:].splitlines()[1:-1]
    texts = [line.strip(" ,;") for line in lines if line.strip() != "MOVE LIN"]
    for number, (text, step) in enumerate(zip(texts, steps(), strict=True), 1):
        start = PROGRAM.index(text, start)
        place = {"start": start, "end": start + len(text), "line": PROGRAM.count("\n", 0, start) + 1}
        common = {"id": number, "origin": {"file": "work.irl", **place}}
        found.append({**common, "robot": "default", "process": "main", **step.entries})
        start += len(text)
    return found


# ---- The motion: every move from rest to rest by a quintic


@dataclass(frozen=True, eq=False)
class Made:
    """Rows q (N, 7), block (N,) and ticks (N,) of a stream; of every step the tick at which it begins."""

    q: np.ndarray
    block: np.ndarray
    ticks: np.ndarray
    begins: tuple[int, ...]

    def rows(self, name: str) -> np.ndarray:
        """Rows of the step of a name; the last one is its hold row."""
        return np.flatnonzero(self.block == [step.name for step in steps()].index(name) + 1)


def made(fault: str = "") -> Made:
    """The stream of the program; `fault` may be one of PLAN_FAULTS."""
    q, block, begins = np.zeros((1, 7)), [0], []
    cyclic_rail = 0.0
    for number, step in enumerate(steps(), 1):
        begins.append(len(q) - 1)
        if step.name == "cyclic":
            cyclic_rail = q[-1, 0]
        if step.ticks:
            rail = cyclic_rail if step.name == "return" else step.rail
            rows = motion(replace(step, rail=q[-1, 0] if rail is None else rail), q[-1], fault)
            q = np.vstack([q, rows, rows[-1:]])
            block += [number] * (step.ticks + 1)
    return Made(q, np.array(block), np.arange(len(q)), tuple(begins))


def quintic(ticks: int) -> np.ndarray:
    """Share of the way (ticks,) after each tick of a motion; rate at most 1.875, its change 5.7736."""
    u = np.arange(1, ticks + 1) / ticks
    return u**3 * (10.0 - 15.0 * u + 6.0 * u * u)


def motion(step: Step, start: np.ndarray, fault: str) -> np.ndarray:
    """Rows (ticks, 7) of a step that begins in posture `start` (7,)."""
    share = quintic(step.ticks)[:, None]
    (position,), (rotation,) = forward(start[None])
    target, kind = step.entries["target"], step.entries.get("kind")
    if kind == "PTP":
        return start + share * (ptp_goal(step, fault) - start)
    positions, rotations = np.tile(position, (step.ticks, 1)), np.tile(rotation, (step.ticks, 1, 1))
    if kind is not None and target["orientation"] is not None:
        axis, angle = tool_turn(target["orientation"], start)
        rotations = rotation @ about(axis, share[:, 0] * angle)
    if kind == "LIN":
        positions = position + share * (np.array(target["position"]) - position)
    if kind == "CIRCLE":
        centre, axis, angle = arc(step.entries, position)
        positions = centre + about(axis, share[:, 0] * angle) @ (position - centre)
    missed = 2e-6 if (fault, step.name) == ("closure", "return") else 0.0
    rail = start[0] + share[:, 0] * (step.rail + missed - start[0])
    if step.name == "at limit":
        # The rail is redundant: it runs at its limit of 60 mm/s whatever the tool does, ramps 25 ticks.
        passed = np.arange(step.ticks)
        ramps = np.minimum(np.minimum(passed + 1, step.ticks - passed) / 25.0, 1.0)
        rail = start[0] + np.cumsum(ramps * 0.06 * DT * (1.0 + 1e-8 * (fault == "speed")))
    return inverse(positions, rotations, rail)


def ptp_goal(step: Step, fault: str) -> np.ndarray:
    """Posture (7,) in which a PTP ends."""
    target = step.entries["target"]
    if target["type"] == "JointTarget":
        missed = 2e-9 if (fault, step.name) == ("joint goal", "to posture") else 0.0
        return np.array(target["values"]) + missed * np.eye(7)[3]
    # Its orientation is the flange's own turn about y: the wrist stands at zero.
    position = np.array(target["position"]) + (2e-6 if fault == "goal" else 0.0) * X
    return inverse(position[None], TOOL_IN_HAND[None], np.array([step.rail]))[0]


def tool_turn(goal: list[float], start: np.ndarray) -> tuple[np.ndarray, float]:
    """Axis (3,) in the frame of the tool, and angle of its shortest turn from posture `start` to `goal`."""
    x, y, z, w = tool_columns(start[None])[0, 3:]
    *vector, scalar = times([-x, -y, -z, w], goal)
    size = float(np.linalg.norm(vector))
    axis = np.array(vector) / size if size > 1e-12 else X
    return (axis if scalar > 0.0 else -axis), 2.0 * float(np.arctan2(size, abs(scalar)))


def arc(entries: Entries, start: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Centre (3,), axis (3,) and angle of the arc from `start` (3,) through the via point to the target."""
    one = np.array(entries["course"]["via"]["position"]) - start
    other = np.array(entries["target"]["position"]) - start
    normal = np.cross(one, other)
    out = np.cross((one @ one) * other - (other @ other) * one, normal) / (2.0 * normal @ normal)
    axis = normal / np.linalg.norm(normal)
    angle = float(np.arctan2(axis @ np.cross(-out, other - out), -out @ (other - out))) % (2.0 * pi)
    return start + out, axis, angle


# ---- Faults in the rows


def shifted(stream: Made, rows: Any, joint: int, by: Any) -> Made:
    """The stream with a joint moved by some values in some rows."""
    q = stream.q.copy()
    q[rows, joint] += by
    return replace(stream, q=q)


def lifted_sample(stream: Made) -> Made:
    """One sample in the midst of a horizontal line lifted by 2e-6 m."""
    return shifted(stream, stream.rows("before corner")[97], 3, 2e-6)


def frozen_moved(stream: Made) -> Made:
    """The frozen joint one ulp off in one row."""
    row = stream.rows("frozen")[150]
    return shifted(stream, row, 0, np.spacing(stream.q[row, 0]))


def drifting(stream: Made) -> Made:
    """The tool up to 2e-6 m higher during the reconfiguration."""
    rows = stream.rows("reconfiguration")[:-1]
    return shifted(stream, rows, 3, 2e-6 * np.sin(pi * quintic(len(rows))))


def without_row(stream: Made, row: int) -> Made:
    """The stream without a row, its tick being missing as well."""
    kept = np.delete(np.arange(len(stream.q)), row)
    return replace(stream, q=stream.q[kept], block=stream.block[kept], ticks=stream.ticks[kept])


def without_hold(stream: Made) -> Made:
    """The hold row of a line left out, and everything after it one tick earlier."""
    row = int(stream.rows("before corner")[-1])
    begins = tuple(tick - (tick >= row) for tick in stream.begins)
    return replace(without_row(stream, row), ticks=stream.ticks[:-1], begins=begins)


def corner_cut(stream: Made) -> Made:
    """Two lines of 200 mm run as one, around the corner on an arc of 50 mm."""
    rows = np.concatenate([stream.rows("before corner"), stream.rows("after corner")])
    way = quintic(len(rows)) * (0.3 + 0.025 * pi)
    bend = np.clip((way - 0.15) / 0.05, 0.0, 0.5 * pi)
    positions, rotations = forward(stream.q[rows])
    positions[:, 0] = 0.65 + 0.05 * np.cos(bend) - np.maximum(way - 0.15 - 0.025 * pi, 0.0)
    positions[:, 1] = 0.3 + np.minimum(way, 0.15) + 0.05 * np.sin(bend)
    q = stream.q.copy()
    q[rows] = inverse(positions, rotations, q[rows, 0])
    return replace(stream, q=q)


PLAN_FAULTS = ("speed", "goal", "joint goal", "closure")
ROW_FAULTS: dict[str, Callable[[Made], Made]] = {
    "sample": lifted_sample,
    "frozen": frozen_moved,
    "drift": drifting,
    "tick": lambda stream: without_row(stream, int(stream.rows("before corner")[97])),
    "hold": without_hold,
    "corner": corner_cut,
    "unit": lambda stream: shifted(stream, slice(None), 4, np.degrees(stream.q[:, 4]) - stream.q[:, 4]),
    "order": lambda stream: replace(stream, q=stream.q[:, [0, 2, 1, 3, 4, 5, 6]]),
}
FILE_FAULTS = ("tool", "names", "robot", "checksum")
FAULTS = (*PLAN_FAULTS, *ROW_FAULTS, *FILE_FAULTS)


# ---- The files


def header(fault: str) -> Entries:
    """What a stream says of itself before its rows, by the names of the JSON in NPZ and CSV."""
    names = [joint[0] for joint in AXES]
    if fault == "names":
        names[1:3] = names[2:0:-1]
    return {
        "format_version": 1,
        "irlx_version": "by hand",
        "program_name": "work.irl",
        "program_sha256": hashlib.sha256(PROGRAM.encode()).hexdigest(),
        "cell_name": "cell.toml",
        "robot_name": "gantry",
        "robot_model": "robot.urdf",
        "robot_fingerprint": fingerprint(0.01 if fault == "robot" else 0.0),
        "tip": LINKS[-1],
        "joint_names": names,
        "joint_units": UNITS,
        "tick_ns": TICK_NS,
        "limits": LIMITS,
        "weights": [7.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0],
    }


def end_of(data: bytes, samples: int, fault: str) -> Entries:
    """Entries of the last line of a file."""
    checksum = hashlib.sha256(data).hexdigest()
    checksum = checksum[::-1] if fault == "checksum" else checksum
    return {"samples": samples, "complete": True, "sha256": checksum}


def text_of(value: Any) -> str:
    """A value as records write it."""
    if isinstance(value, list):
        return f"({' '.join(map(text_of, value))})"
    return "none" if value is None else repr(value) if isinstance(value, float) else json.dumps(value)


def flat(entries: Entries, prefix: str = "") -> Entries:
    """Entries of entries under names with dots."""
    found: Entries = {}
    for name, value in entries.items():
        found |= flat(value, f"{prefix}{name}.") if isinstance(value, dict) else {f"{prefix}{name}": value}
    return found


def record(code: int, operands: Entries) -> str:
    """A record without its number."""
    return ", ".join([f"{code}", *(f"{name}={text_of(value)}" for name, value in flat(operands).items())])


def head_records(head: Entries) -> list[str]:
    """The records of groups 1xx and 2xx."""
    robot = {name: head[f"robot_{name}"] for name in ("name", "model", "fingerprint")}
    joint_records = [
        {"name": name, "unit": UNITS[joint], "weight": head["weights"][joint]}
        | {side: values[joint] for side, values in LIMITS.items()}
        for joint, name in enumerate(head["joint_names"])
    ]
    return [
        record(100, {"title": "IRDATA-like joint stream", "version": 1}),
        record(101, {"irlx": head["irlx_version"]}),
        record(110, {"program": head["program_name"], "sha256": head["program_sha256"]}),
        record(120, {"cell": head["cell_name"]}),
        record(200, {"robot": robot.pop("name"), **robot, "tip": head["tip"]}),
        record(201, {"joints": len(AXES), "tick_ns": TICK_NS}),
        *(record(210, operands) for operands in joint_records),
    ]


def irdata(stream: Made, tool: np.ndarray, fault: str) -> bytes:
    """The stream as IRDATA-like records; a block stands after the sample of its tick."""
    lines = head_records(header(fault))
    waiting = list(zip(stream.begins, steps(), blocks(), strict=True))
    table = np.hstack([stream.q, tool]).tolist()
    for tick, block, values in zip(stream.ticks.tolist(), stream.block.tolist(), table, strict=True):
        while waiting and waiting[0][0] < tick:
            begins, step, entries = waiting.pop(0)
            lines.append(record(step.code, {"tick": begins, **entries}))
        lines.append(", ".join(["900", f"{tick}", f"{block}", *(f"{value:.16e}" for value in values)]))
    data = "".join(f"{number}, {line} ;\n" for number, line in enumerate(lines, 1)).encode()
    return data + f"{len(lines) + 1}, {record(999, end_of(data, len(stream.q), fault))} ;\n".encode()


def rates(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Backward differences of rows (N, 7) and of these, from rest."""
    qd = np.diff(q, axis=0, prepend=q[:1]) / DT
    return qd, np.diff(qd, axis=0, prepend=0.0 * q[:1]) / DT


def csv(stream: Made, tool: np.ndarray, fault: str) -> bytes:
    """The stream as CSV, without blocks."""
    head = header(fault)
    columns = [f"{what}_{name}" for what in ("q", "qd", "qdd") for name in head["joint_names"]]
    columns += [f"tool_{part}" for part in ("x", "y", "z", "qx", "qy", "qz", "qw")]
    lines = [f"# {key}: {json.dumps(value)}" for key, value in head.items()]
    lines.append(",".join(["tick", "t", "block", *columns]))
    table = np.hstack([stream.q, *rates(stream.q), tool]).tolist()
    for tick, block, values in zip(stream.ticks.tolist(), stream.block.tolist(), table, strict=True):
        row = [f"{tick}", repr(tick * TICK_NS / 1e9), f"{block}", *(f"{value:.16e}" for value in values)]
        lines.append(",".join(row))
    data = "".join(f"{line}\n" for line in lines).encode()
    return data + f"# end: {json.dumps(end_of(data, len(stream.q), fault))}\n".encode()


def npz_arrays(stream: Made, tool: np.ndarray, fault: str) -> dict[str, np.ndarray]:
    """The stream as arrays, with everything else as JSON."""
    records = [
        {"tick": tick, "block": {"type": TYPES[step.code], **entries}}
        for tick, step, entries in zip(stream.begins, steps(), blocks(), strict=True)
    ]
    starts = np.flatnonzero(np.diff(stream.ticks, prepend=-2) != 1)
    runs = np.stack([stream.ticks[starts], np.diff(starts, append=len(stream.ticks))], axis=1).tolist()
    meta = json.dumps({"header": header(fault), "records": records, "ticks": runs, "complete": True})
    qd, qdd = rates(stream.q)
    arrays = {"t": stream.ticks * TICK_NS / 1e9, "q": stream.q, "qd": qd, "qdd": qdd, "tool": tool}
    names = np.array(header(fault)["joint_names"])
    return {**arrays, "block": stream.block, "joint_names": names, "meta": np.array(meta)}


def write(folder: Path, fault: str = "", endings: tuple[str, ...] = (".irdata", ".csv", ".npz")) -> None:
    """Write robot.urdf, cell.toml, work.irl and work.irdata, .npz, .csv, or those of some endings.

    `fault`, one of FAULTS, is put into the streams; tool column and checksum fit it unless it lies in them.
    """
    if fault and fault not in FAULTS:
        raise ValueError(f"no fault is called {fault!r}")
    stream = ROW_FAULTS.get(fault, lambda whole: whole)(made(fault))
    tool = tool_columns(stream.q)
    if fault == "tool":
        tool[len(tool) // 2, 2] += 2e-9
    for name, text in (("robot.urdf", urdf()), ("cell.toml", CELL), ("work.irl", PROGRAM)):
        (folder / name).write_bytes(text.encode())
    if ".irdata" in endings:
        (folder / "work.irdata").write_bytes(irdata(stream, tool, fault))
    if ".csv" in endings:
        (folder / "work.csv").write_bytes(csv(stream, tool, fault))
    if ".npz" in endings:
        np.savez(folder / "work.npz", **npz_arrays(stream, tool, fault))


if __name__ == "__main__":
    write(Path(sys.argv[1]), *sys.argv[2:3])
