"""Cell files, and scripted inputs."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from pathlib import Path
from random import Random

import numpy as np

from fuzzing.byte_damage import TEXT, damaged
from fuzzing.case import Fault
from fuzzing.findings import INTERNAL
from fuzzing.known_texts import ROOT
from fuzzing.reader import Reader
from fuzzing.robot_files import put_beside
from fuzzing.toml_values import confused, each_replaced
from irlx.cell.cell import Cell
from irlx.cell.errors import CellError
from irlx.cell.frame_names import frame_names
from irlx.cell.input_file import read_input_file
from irlx.cell.joint_names import joint_names
from irlx.cell.load import load_cell
from irlx.cell.obstacle_names import obstacle_names
from irlx.diagnostics import Diagnostic, IrlxError
from irlx.job import header_of, kinematics_of, prepare
from irlx.report.appearance.build import appearance_of
from irlx.running import run
from irlx.streams.header_plain import header_to_plain

FULL_CELL = """# every key that a cell may have
[robot]
model = "robot.urdf"
tip = "tool"
locked = { finger = 5 }
origins = { shoulder = { xyz = [0, 0, 300], rpy = [0, 0, 10] } }
task = ["x", "y", "z", "rx", "ry"]
task_frame = "tool"
free = ["rz"]
start = [10, 20, -30, 40, 50, 60, 70]
weights = [7, 6, 5, 4, 3, 2, 1]
status_joints = ["elbow"]
hands = ["tool"]
[robot.limits]
position = [170, [-100, 100], 170, [-170, 170], false, 120, 300]
speed = [90, [-90, 90], 90, 90, false, 90, 90]
acceleration = false
[robot.self_collision]
active = true
may_touch = [["base", "shoulder_link"]]
srdf = "robot.srdf"
margin = 1
influence = 20
[motion]
tick_ms = 10
speed = 250
acc = 1000
speed_ori = 90
acc_ori = 180
speed_ptp = 50
acc_ptp = 50
jerk = 0
c_cp = 10
c_ptp = 20
c_pass = false
profile = "TRAPEZOID"
override = 100
[frames]
fixture = { xyz = [600, 0, 0], rpy = [0, 0, 90] }
camera = { xyz = [0, 0, 50], rpy = [0, 180, 0], link = "elbow_link" }
[[constraint]]
name = "sum"
joints = { wrist = 1, flange = -1 }
value = -10
[[constraint]]
name = "upright"
link = "tool"
axis = [0, 0, 1]
direction = [0, 0, 1]
[[constraint]]
name = "way"
link = "base"
path = [[0, 0], [1000, 0], [1000, 1000], [0, 1000]]
closed = true
heading = false
[[obstacle]]
name = "wall"
shape = "box"
size = [20, 1000, 150]
xyz = [2880, 0, 75]
rpy = [0, 0, 5]
margin = 15
influence = 25
[[obstacle]]
name = "ball"
shape = "sphere"
radius = 20
frame = "fixture"
trajectory = [{ time = 0, xyz = [2000, 0, 0] }, { time = 1, xyz = [2000, 100, 0], rpy = [0, 0, 90] }]
[[obstacle]]
name = "post"
shape = "capsule"
radius = 10
length = 100
xyz = [2000, 2000, 0]
[[obstacle]]
name = "part"
shape = "mesh"
file = "cube.stl"
scale = [100, 100, 100]
xyz = [3000, 0, 0]
[[obstacle]]
name = "all"
shape = "group"
members = ["wall", "ball"]
[signals.inputs]
IN_3 = [[0, false], [2.5, true]]
level = [[0, 1.5]]
"""
_PROGRAM = "PROGRAM p;\nVAR REAL: x;\nBEGIN\n  x := 1;\n  WAIT 0.02 SEC;\nENDPROGRAM\n"
_FILES = re.compile(rb'"[^"]*\.(?:urdf|srdf|stl|obj|ply|dae)"')


class CellReader(Reader):
    """Cell files beside a robot of their own; what is accepted can be executed, drawn and written of."""

    kind = "cell"
    ending = ".toml"
    share = 4.0

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        put_beside(folder)
        self._path = folder / "c.toml"
        self._program = folder / "p.irl"
        self._program.write_text(_PROGRAM, encoding="utf-8")

    def made(self) -> list[bytes]:
        cells = [path.read_bytes() for path in sorted((ROOT / "programs").rglob("*.toml"))]
        for path in sorted((ROOT / "src" / "irlx" / "cell" / "robots").glob("*.toml")):
            model = f'[robot]\nmodel = "{path.stem}"\n'
            cells.append(path.read_text(encoding="utf-8").replace("[robot]\n", model).encode())
        return [FULL_CELL.encode(), *_without_constraints(), *cells]

    def systematic(self) -> Iterable[Callable[[], bytes]]:
        return each_replaced(_without_constraints()[0])

    def damaged(self, content: bytes, chance: Random) -> bytes:
        if chance.random() < 0.7:
            return confused(content, chance)
        return damaged(content, chance, TEXT)

    def read(self, content: bytes, thorough: bool) -> tuple[bool, list[Diagnostic]]:
        self._path.write_bytes(content)
        frames, names = frame_names(self._path), joint_names(self._path)
        obstacle_names(self._path)
        try:
            cell = load_cell(self._path)
        except CellError as error:
            return False, list(error.diagnostics)
        if frames is None or not {*cell.frames, *cell.link_frames} == set(frames):
            raise Fault("names of frames are others without loading the cell")
        if names != cell.robot.joint_names:
            raise Fault("names of joints are others without loading the cell")
        told = list(cell.warnings)
        try:
            used(cell)
        except CellError as error:
            return False, list(error.diagnostics)
        if thorough:
            told += self._executed(cell)
        return True, told

    def _executed(self, cell: Cell) -> list[Diagnostic]:
        """Findings of drawing the cell and of a run in it, however it ends."""
        told = list(appearance_of(cell).robot.diagnostics)
        job = prepare(self._program, self._path)
        header_to_plain(header_of(job))
        try:
            run(self._program, cell=self._path)
        except IrlxError as error:
            told += [one for one in error.diagnostics if one.code == INTERNAL]
        return told


def used(cell: Cell) -> None:
    """Numbers of a cell that was accepted are numbers. Raises CellError, or Fault."""
    kinematics = kinematics_of(cell)
    rotation, position = kinematics.tool_pose(cell.start)
    for name, numbers in (
        ("tool", position),
        ("turn", rotation),
        ("start", cell.start),
        ("weight", cell.weights),
    ):
        if not np.all(np.isfinite(numbers)):
            raise Fault("an accepted cell holds numbers that are none", name)
    for frame in cell.frames.values():
        if not all(map(math.isfinite, (*frame.position, *frame.quaternion))):
            raise Fault("an accepted cell holds numbers that are none", "frame")


class InputsReader(Reader):
    """CSV files of scripted inputs."""

    kind = "inputs"
    ending = ".csv"
    share = 0.5

    def made(self) -> list[bytes]:
        return [
            b"time,input,value\n0,IN_1,FALSE\n0.5,IN_1,TRUE\n0,level,1.5\n2,level,-3e2\n",
            b'time,input,value\r\n0,"IN_1",true\r\n1,"a ""b""",2\r\n',
        ]

    def damaged(self, content: bytes, chance: Random) -> bytes:
        return damaged(content, chance, TEXT)

    def read(self, content: bytes, thorough: bool) -> tuple[bool, list[Diagnostic]]:
        (path := self.folder / "inputs.csv").write_bytes(content)
        try:
            traces = read_input_file(path).traces
        except CellError as error:
            return False, list(error.diagnostics)
        for trace in traces.values():
            times = [at for at, _ in trace]
            if times != sorted(set(times)) or not all(math.isfinite(x) for entry in trace for x in entry):
                raise Fault("an accepted trace does not rise", self.kind)
        return True, []


def _without_constraints() -> list[bytes]:
    """The full cell with none and with each one of its constraints, with which it can be used."""
    parts = re.split(r"(?=^\[\[)|(?=^\[signals)", FULL_CELL, flags=re.MULTILINE)
    rest = [part for part in parts if not part.startswith("[[constraint]]")]
    whole = "".join(rest)
    plain = whole.replace('hands = ["tool"]\n', "").replace('task = ["x", "y", "z", "rx", "ry"]\n', "")
    cells = [plain.replace('free = ["rz"]\n', ""), whole]
    cells += [plain + part for part in parts if part.startswith("[[constraint]]")]
    return [cell.encode() for cell in cells]
