"""Streams and files that pretend: values, block ids and ticks at will, tool poses and checksums to fit."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

import irlx
from irlx.blocks import MoveBlock
from irlx.cell.load import load_cell
from irlx.robot.description import RobotDescription
from irlx.streams import BlockRecord, JointStream, write_stream
from irlx.verifier import Report
from irlx.verifier.geometry.forward import forward

ARM_CELL = """[robot]
model = "arm7"
{limits}[motion]
tick_ms = {tick:g}
speed = 200
acc = 1000
speed_ori = 3000
acc_ori = 100000
"""
NO_LIMITS = "[robot.limits]\nspeed = false\nacceleration = false\n"
KOCH_CELL = """[robot]
model = "koch11"
[robot.limits]
speed = [false, false, false, false, false, false, false, false, false, false, {last}]
[motion]
tick_ms = 50
speed = 1000
acc = 2000
"""
ARM_PLACES = """VAR
  POSITION: s := (441.36507109, 260.96392494, 324.69235666), p := (450, 260, 330), a := (450, 260, 280);
  ORIENTATION: o := ORIQUAT(0.07572374055, -0.31261181804, 0.94668400066, 0.01814300187);
"""
"""Tool pose at the start posture of arm7 (s, o), and places near it."""
KOCH_PLACES = (
    "VAR POSE: p := ((11500, 1000, 3500), ORIZYX(0, 0, 0)), a := ((9500, 1000, 3500), ORIZYX(0, 0, 0));\n"
)


def arm_cell(tick: float = 10, limits: str = "") -> str:
    """Cell of arm7 with ticks in ms."""
    return ARM_CELL.format(tick=tick, limits=limits)


def koch_cell(last: str) -> str:
    """Cell of koch11 without speed limits but that of its last joint: TOML text, mm/s or deg/s."""
    return KOCH_CELL.format(last=last)


SLOW = "JOINTSPEEDLIMIT (-5, -5, -5, -5, -5, -5, -5), (5, 5, 5, 5, 5, 5, 5)"
WEAK = "JOINTACCELLIMIT (-500, -500, -500, -500, -500, -500, -500), (500, 500, 500, 500, 500, 500, 500)"
THERE, FURTHER = "MOVE PTP (30, 30, -10, 90, 10, 50, -10)", "MOVE PTP (30, 20, -10, 90, 10, 50, -10)"
DOWN = "MOVE LIN s + POSITION(0, 0, -20);"
CYCLE = "MOVE LIN p;\nCYCLICSTART;\nMOVE LIN a, p;\nCYCLICEND;"
CYCLE_IDS = np.array([0, 1, 3, 4])
"""Block ids of CYCLE for those of its three moves alone."""


@dataclass(frozen=True)
class Job:
    """A program with its cell, and the stream that irlx makes of it."""

    folder: Path
    robot: RobotDescription
    stream: JointStream

    @property
    def program(self) -> Path:
        return self.folder / "p.irl"

    @property
    def cell(self) -> Path:
        return self.folder / "cell.toml"

    @property
    def ends(self) -> list[int]:
        """Row in which each move ends."""
        begins = [record.tick for record in self.stream.records if isinstance(record.block, MoveBlock)]
        return [*begins[1:], len(self.stream.q) - 1]

    def records_at(self, *ticks: int) -> tuple[BlockRecord, ...]:
        """The block records, at other ticks."""
        return tuple(replace(r, tick=tick) for r, tick in zip(self.stream.records, ticks, strict=True))

    def pretending(
        self,
        q: np.ndarray,
        block: np.ndarray | Sequence[int],
        records: Sequence[BlockRecord] | None = None,
        **header: object,
    ) -> JointStream:
        """Complete stream of postures q (N, n) under block ids (N,), with the tool poses that q gives."""
        q = np.ascontiguousarray(q)
        positions, rotations = forward(self.robot, q)
        return JointStream(
            replace(self.stream.header, **header),
            self.stream.records if records is None else tuple(records),
            np.arange(len(q)),
            q,
            np.asarray(block, dtype=np.int64),
            np.hstack([positions, Rotation.from_matrix(rotations).as_quat()]),
            True,
        )

    def verify(self, stream: JointStream, ending: str = ".irdata", **given: Path | None) -> Report:
        """Report on a stream, as a file, with program and cell unless others are given."""
        write_stream(stream, file := self.folder / f"pretended{ending}")
        return irlx.verify(file, **{"program": self.program, "cell": self.cell, **given})


Make = Callable[..., Job]
"""Runs a program of some statements: its body, its cell, its places."""


def job(folder: Path, body: str, cell: str | None = None, places: str = ARM_PLACES) -> Job:
    """Run a program of some statements, in a folder of its own."""
    (folder / "cell.toml").write_text(arm_cell() if cell is None else cell, encoding="utf-8")
    text = f"PROGRAM p;\nSYSTEM SPECIFICATION cell;\n{places}BEGIN\n{body}\nENDPROGRAM;\n"
    (folder / "p.irl").write_text(text, encoding="utf-8")
    run = irlx.run(folder / "p.irl", cell=folder / "cell.toml")
    return Job(folder, load_cell(folder / "cell.toml").robot, run.stream)


def led_to(
    robot: RobotDescription, q: np.ndarray, positions: np.ndarray, rotations: np.ndarray
) -> np.ndarray:
    """Postures (N, n) near q, the tool at positions (N, 3), m, and rotations (N, 3, 3): by Newton."""
    n, h = q.shape[1], 1e-7
    found = []
    for row, position, rotation in zip(q, positions, rotations, strict=True):
        for _ in range(8):
            ps, rs = forward(robot, np.vstack([row, row + h * np.eye(n), row - h * np.eye(n)]))
            turned = Rotation.from_matrix(rs[1 : n + 1] @ rs[n + 1 :].transpose(0, 2, 1)).as_rotvec()
            jacobian = np.vstack([(ps[1 : n + 1] - ps[n + 1 :]).T, turned.T]) / (2 * h)
            twist = np.r_[position - ps[0], Rotation.from_matrix(rotation @ rs[0].T).as_rotvec()]
            row = row + np.linalg.pinv(jacobian) @ twist  # noqa: PLW2901
        found.append(row)
    return np.array(found)


def with_meta(stream: JointStream, file: Path, change) -> Path:
    """NPZ file of a stream whose meta is another; its checksums are right."""
    write_stream(stream, file)
    arrays = dict(np.load(file))
    meta = json.loads(str(arrays["meta"]))
    change(meta)
    np.savez(file, **{**arrays, "meta": np.array(json.dumps(meta))})
    return file


def with_comment(stream: JointStream, file: Path, key: str, text: str) -> Path:
    """CSV file of a stream with another text under a key of its header; its checksum is right."""
    write_stream(stream, file)
    *lines, _ = file.read_bytes().splitlines(keepends=True)
    place = next(i for i, line in enumerate(lines) if line.startswith(f"# {key}: ".encode()))
    lines[place] = f"# {key}: {text}\n".encode()
    body = b"".join(lines)
    end = {"samples": len(stream.ticks), "complete": True, "sha256": sha256(body).hexdigest()}
    file.write_bytes(body + f"# end: {json.dumps(end)}\n".encode())
    return file


def of_meta(*keys: str | int):
    """Change of a meta: the value at some keys becomes another."""

    def change(value: object):
        def set_it(meta) -> None:
            for key in keys[:-1]:
                meta = meta[key]
            meta[keys[-1]] = value

        return set_it

    return change


def switch_off_too_early(make: Make) -> tuple[Job, JointStream, int, int]:
    """JOINTSPEEDLIMITEND recorded before the rows of the move that it limits: it goes 12 times as fast."""
    fast = make(f"{THERE};\n{FURTHER};")
    claimed = make(f"{SLOW};\n{THERE};\nJOINTSPEEDLIMITEND;\n{FURTHER};")
    records = claimed.records_at(0, 0, 0, fast.ends[0])
    return claimed, claimed.pretending(fast.stream.q, ids(fast, 0, 2, 4), records), 3, fast.ends[0]


def other_switch_off_too_early(make: Make) -> tuple[Job, JointStream, int, int]:
    """The end of a switch of another kind put where it would take the clause away from the move."""
    fast = make(f"{THERE};\n{FURTHER};")
    claimed = make(f"{WEAK};\n{THERE} WITH {SLOW};\nJOINTACCELLIMITEND;\n{FURTHER};")
    records = claimed.records_at(0, 0, 0, fast.ends[0])
    return claimed, claimed.pretending(fast.stream.q, ids(fast, 0, 2, 4), records), 3, fast.ends[0]


def second_move_not_run(make: Make) -> tuple[Job, JointStream, int, int]:
    """A move back to the start recorded as reached before the first one has left it."""
    claimed = make("MOVE PTP (30, 29, -13, 95, 9, 48, -13);\nMOVE PTP (40, 29, -13, 95, 9, 48, -13);")
    end, stream = claimed.ends[0], claimed.stream
    kept = slice(0, end + 1)
    return claimed, claimed.pretending(stream.q[kept], stream.block[kept], claimed.records_at(0, 0)), 2, end


def thawed_too_early(make: Make) -> tuple[Job, JointStream, int, int]:
    """FREEZEEND recorded before the rows of the move in which the frozen joint moves."""
    free, claimed = make(DOWN), make(f"FREEZESTART 7;\n{DOWN}\nFREEZEEND;")
    stream = claimed.pretending(free.stream.q, ids(free, 0, 2), claimed.records_at(0, 0, 0))
    return claimed, stream, 3, free.ends[0]


def cycle_begun_too_early(make: Make) -> tuple[Job, JointStream, int, int]:
    """CYCLICSTART recorded before the move to its pose: the return ends in another posture."""
    free, claimed = left_open(make), make(CYCLE)
    first, second, last = free.ends
    stream = claimed.pretending(
        free.stream.q, ids(free, *CYCLE_IDS), claimed.records_at(0, 0, first, second, last)
    )
    return claimed, stream, 2, first


def left_open(make: Make) -> Job:
    """The moves of CYCLE, but back in another posture."""
    return make("MOVE LIN p;\nMOVE LIN a;\nMOVE LIN p WITH RECONFIGURATION (50, 25, -13, 95, 9, 48, -13);")


def ids(source: Job, *new: int) -> np.ndarray:
    """Block ids of all rows, `new[i]` for i."""
    return np.array(new)[source.stream.block]


TOO_EARLY = (
    switch_off_too_early,
    other_switch_off_too_early,
    second_move_not_run,
    thawed_too_early,
    cycle_begun_too_early,
)
"""Each gives a job, the stream that pretends, the block recorded too early, and the row it is due in."""
