"""What a corrected stream must keep, judged from its samples: limits in force, poses, programmed rows.

Poses come from the verifier's own forward kinematics, limits from differences of neighbouring rows; the
programmed rows are those of the same program planned with the share of the limits that corrections leave.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

import irlx
from irlx.job import prepare
from irlx.pacing.correction.report import CorrectionReport
from irlx.pacing.executed import Executed
from irlx.pipeline import Execution
from irlx.promises import rounding_allowance
from irlx.robot.limits import JointLimits
from irlx.verifier.geometry.forward import forward

PLANNED = 0.75
POSE = 1e-6
ARM = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = {tick}\n'
Tools = dict[int, tuple[np.ndarray, Rotation]]
"""Position (3,) m and rotation in the frame of the tip, by id of a block."""


@dataclass
class Corrected:
    """A corrected stream: arrays of its samples, its report, and the programmed row of each sample."""

    q: np.ndarray
    tool: np.ndarray
    correction: np.ndarray
    block: np.ndarray
    report: CorrectionReport
    dt: float
    planned: np.ndarray = field(default_factory=lambda: np.empty(0))

    @property
    def offset(self) -> np.ndarray:
        return self.q - self.planned


def files(folder: Path, body: str, cell: str, declared: str = "") -> Path:
    (folder / "p.toml").write_text(cell, encoding="utf-8")
    text = f"PROGRAM p; {declared}\nBEGIN\n{body}\nENDPROGRAM"
    (folder / "p.irl").write_text(text, encoding="utf-8")
    return folder / "p.irl"


def corrected(path: Path, sensor: Callable, tools: Tools | None = None, **given) -> Corrected:
    """A stream corrected by `sensor`, every row judged; `tools` where the program has others than the tip."""
    stream = irlx.stream(path, correct=sensor, **given)
    samples = list(stream)
    found = Corrected(
        *(np.array([getattr(one, name) for one in samples]) for name in ("q", "tool", "correction", "block")),
        report=stream.corrections,
        dt=prepare(path).tick_ns / 1e9,
    )
    judge(found, samples, path, tools or {})
    return found


def judge(found: Corrected, samples: list, path: Path, by_block: Tools) -> None:
    assert [one.tick for one in samples] == list(range(len(samples)))
    job = prepare(path)
    _keeps_limits(found, job)
    tools = _poses(job, found.q, found.block, by_block)
    np.testing.assert_allclose(found.tool[:, :3], tools[0], rtol=0, atol=1e-9)
    away = Rotation.from_matrix(tools[1]).inv() * Rotation.from_quat(found.tool[:, 3:])
    assert np.max(away.magnitude()) < 1e-9
    speeds = np.diff(found.q, axis=0, prepend=found.q[:1]) / found.dt
    np.testing.assert_allclose([one.qd for one in samples], speeds, rtol=0, atol=1e-9)
    assert not np.any(speeds[-1])
    _goes_with_program(found, tools, job, by_block)


def _poses(job, q: np.ndarray, blocks: np.ndarray, tools: Tools) -> tuple[np.ndarray, np.ndarray]:
    """Positions (N, 3) and rotations (N, 3, 3) of the tool that each block has."""
    places, turns = forward(job.cell.robot, q)
    for block, (position, turn) in tools.items():
        rows = blocks == block
        places[rows] += turns[rows] @ position
        turns[rows] = turns[rows] @ turn.as_matrix()
    return places, turns


def carried_out(job, share: float = 1.0) -> list[Executed]:
    """What moves or stands in a program that imports nothing, without a sensor; once for all that it gets."""
    key = job.program.sha256, job.making.cell_sha256, job.tick_ns, share
    if key not in _known:
        execution = Execution(job, planned_share=share)
        _known[key] = [one for one in execution if one.rows is not None]
    return _known[key]


_known: dict[tuple, list[Executed]] = {}


def limits_by_block(job) -> dict[int, JointLimits]:
    """The whole limits in force of each block that moves or stands."""
    executed = carried_out(job)
    return {one.block.id: one.rows.limits or job.cell.limits for one in executed}


def _keeps_limits(found: Corrected, job) -> None:
    q, dt = found.q, found.dt
    qd = np.diff(q, axis=0, prepend=q[:1]) / dt
    qdd = np.diff(qd, axis=0, prepend=qd[:1]) / dt
    speed, acceleration = rounding_allowance(q, dt)
    known = limits_by_block(job)
    for block in np.unique(found.block[1:]):
        rows, limits = np.flatnonzero(found.block == block), known[int(block)]
        rows = rows[rows > 0]
        for kind, values, extra in (
            ("position", q, 0.0),
            ("speed", qd, speed),
            ("acceleration", qdd, acceleration),
        ):
            lower, upper = limits.pair(kind)
            over = np.maximum(values[rows] - upper, lower - values[rows])
            assert np.all(over <= extra), (kind, block, rows[np.argmax(np.max(over, axis=1))], np.max(over))


def _goes_with_program(found: Corrected, tools: tuple[np.ndarray, np.ndarray], job, by_block: Tools) -> None:
    """Each row is the next programmed one, or stands at the last, corrected by what it says."""
    executed = carried_out(job, PLANNED)
    base = np.vstack([job.cell.start[None], *(one.rows.q for one in executed)])
    blocks = np.array([0] + [one.block.id for one in executed for _ in one.rows.q])
    places, turns = _poses(job, base, blocks, by_block)
    at, held, chosen = 0, 0, [0]
    corrections = Rotation.from_rotvec(found.correction[:, 3:]).as_matrix()
    for k in range(1, len(found.q)):

        def off(b: int, k: int = k) -> float:
            place = places[b] + turns[b] @ found.correction[k, :3]
            turned = _angle(tools[1][k], turns[b] @ corrections[k])
            return max(float(np.linalg.norm(place - tools[0][k])), turned)

        if at + 1 < len(base) and blocks[at + 1] == found.block[k] and off(at + 1) <= POSE:
            at += 1
        else:
            assert off(at) <= POSE, (k, at, off(at))
            held += 1
        chosen.append(at)
    assert at == len(base) - 1
    assert held == found.report.held_ticks
    found.planned = base[chosen]


def _angle(one: np.ndarray, other: np.ndarray) -> float:
    """Between two rotations (3, 3), rad: their Frobenius distance is 2 sqrt(2) sin(angle / 2)."""
    return 2.0 * float(np.arcsin(min(1.0, float(np.linalg.norm(one - other)) / np.sqrt(8.0))))
