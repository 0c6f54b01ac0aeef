"""irlx: the task from its program, by the pacer alone, by a run, and by a run with all that it begins with.

- `pacer`: blocks in, rows out. Planning, time law, demand, bounds, criterion, solver, checks, tool pose and
  path error of every row; the blocks were made before.
- `run`: what `irlx run P.irl -o P.csv` does once all is loaded, but for the verification: interpretation,
  the pacer, figures of the summary, the file of CSV. `cyclic`, `slowed`, `watched` are the same with
  CYCLICSTART, with a joint too slow for the program, with the links of the robot kept off each other.
- `record`: `irlx.record`, from the text of the program and the cell to the file.
- `arm7`, `koch11`: lines of these robots by the pacer, as `tick.py` has them, 7 joints and 11.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from pathlib import Path
from time import process_time

import numpy as np
from numpy.typing import NDArray

import irlx
import tick
from beside.serving import Answer, Stopwatch, serve_standard_input
from irlx.job import Job, kinematics_of, prepare
from irlx.pacing.pacer import Pacer
from irlx.pacing.situation import PacingSetup
from irlx.pipeline import Execution
from irlx.report.outcome import Outcome
from irlx.running import execute_to_files

Array = NDArray[np.float64]

PACKAGES = ("irlx", "pin", "proxsuite", "numpy", "scipy")

RUNS = {
    "run": ("line_and_circle.irl", "free.toml"),
    "cyclic": ("cyclic.irl", "free.toml"),
    "slowed": ("line_and_circle.irl", "slow.toml"),
    "watched": ("line_and_circle.irl", "watched.toml"),
}
"""Program and cell of each kind of run."""

ROBOTS: dict[str, Callable[[], tick.Robot]] = {"arm7": tick.arm7, "koch11": tick.koch11}


def answers(folder: Path) -> Callable[..., Answer]:
    """What answers the requests for irlx; programs and cells are in the folder."""
    robots = cache(lambda name: ROBOTS[name]())

    def answer(case: str, dt: float, into: str, targets: str = "") -> Answer:
        if case in ROBOTS:
            time, steps = tick.there_and_back(robots(case), dt, False, process_time)
            return {"cpu": time * 1e-6, "wall": time * 1e-6, "ticks": 1, "solves": steps}
        program, cell = (folder / name for name in RUNS.get(case, RUNS["run"]))
        csv = folder / "out.csv"
        watch = Stopwatch()
        if case == "pacer":
            q, steps = paced(prepare(program, cell, tick_ms=dt * 1e3), watch)
        else:
            outcome = recorded(case, program, cell, dt, csv, watch)
            q = read_postures(csv)
            steps = outcome.summary.iterations_per_tick * len(q)
        np.save(Path(into), q)
        return {"cpu": watch.cpu, "wall": watch.wall, "ticks": len(q), "solves": steps}

    return answer


def recorded(case: str, program: Path, cell: Path, dt: float, csv: Path, watch: Stopwatch) -> Outcome:
    """Carry out a program to a file; watched is all of it, or what follows when all is loaded."""
    if case == "record":
        with watch:
            return irlx.record(program, csv, cell, tick_ms=dt * 1e3)
    execution = Execution(prepare(program, cell, tick_ms=dt * 1e3))
    with watch:
        return execute_to_files(execution, [csv])


def paced(job: Job, watch: Stopwatch) -> tuple[Array, int]:
    """Postures (N, 7) after the start and Newton steps of the program's blocks; the pacer is timed."""
    cell, dt = job.cell, job.tick_ns / 1e9
    blocks = list(Execution(job).blocks())
    setup = PacingSetup(kinematics_of(cell), cell.limits, cell.weights, cell.start, dt, scene=cell.scene)
    pacer = Pacer(setup, job.program.place)
    with watch:
        motions = [rows for block in blocks if (rows := pacer.execute(block)) is not None]
    return np.vstack([rows.q for rows in motions]), sum(rows.iterations for rows in motions)


def read_postures(csv: Path) -> Array:
    """Postures (N, 7) after the start from a file of CSV."""
    with csv.open(encoding="utf-8") as file:
        lines = [line for line in file if not line.startswith("#")]
    columns = [number for number, name in enumerate(lines[0].split(",")) if name.startswith("q_")]
    return np.loadtxt(lines[2:], delimiter=",", usecols=columns)


if __name__ == "__main__":
    serve_standard_input(answers, PACKAGES)
