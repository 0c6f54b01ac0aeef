"""irlx beside Pink, mink and PlaCo: time of a tick of one task, and how exact it is, in one run.

    python benchmarks/peers.py [--rounds N] [--laps N] [--venv DIR] [--json | --markdown]

A Panda leads its tool along a line, round a circle and back, at 1 kHz and at 250 Hz. Each library follows
the same poses with the same URDF, and each tick goes on until the pose is met to 1e-6 m and 1e-6 rad, with
limits of joint position and speed and the smallest motion; irlx runs the program. Each is a process of its
own in one of two virtual environments, made where they are missing, by default in the user's cache (2 GB),
and all take turns within a round. Given are the least and the median processor time of a tick over the
rounds, and the worst error of all ticks of all rounds by the kinematics of `beside/forward_kinematics.py`.
Ends with exit code 1 where a library does not converge, or anything is off by more than 1e-6 or breaks a
limit.

What is compared, and what is not: docs/performance.md.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from beside.bare_urdf import bare_urdf
from beside.environments import environments, panda_urdf, usual_folder
from beside.judge import Judge, Verdict
from beside.line_and_circle import FINGERS, LAP_TIME, SLOW_JOINT, SLOW_SPEED, cell, program
from beside.machine import machine
from beside.tables import markdown, text
from beside.worker import Worker

PROMISED = 1e-6
"""Largest error, m and rad, of anything that is shown."""

RATES = {"1 kHz": 0.001, "250 Hz": 0.004}


@dataclass(frozen=True)
class Case:
    """What is measured: its row in the table, its worker, what that calls it; the rates it is measured at."""

    label: str
    worker: str
    name: str
    rates: tuple[str, ...] = tuple(RATES)
    judged: str = "ticks"


CASES = (
    Case("irlx, pacer", "irlx", "pacer"),
    Case("irlx, run to CSV", "irlx", "run"),
    Case("irlx, record", "irlx", "record"),
    *(
        Case(f"{library}, {solver}, {form}", worker, f"{solver}, {form}")
        for library, worker in (("Pink", "pink"), ("mink", "mink"))
        for solver in ("daqp", "quadprog")
        for form in ("constraint", "task")
    ),
    Case("PlaCo, constraint", "placo", "constraint"),
    Case("PlaCo, task", "placo", "task"),
    Case("run, cyclic", "irlx", "cyclic", ("1 kHz",)),
    Case("run, slowed", "irlx", "slowed", ("1 kHz",), "path"),
    Case("run, links watched", "irlx", "watched", ("1 kHz",)),
    Case("pacer, n = 7 (arm7)", "irlx", "arm7", ("1 kHz",), "not"),
    Case("pacer, n = 11 (koch11)", "irlx", "koch11", ("1 kHz",), "not"),
)
"""In the order in which they take turns."""


class Measurement:
    """Rounds of all cases: processor time and time by the clock, us a tick, and the errors of each round."""

    def __init__(self, workers: dict[str, Worker], judge: Judge, folder: Path) -> None:
        self._workers, self._judge, self._folder = workers, judge, folder
        self.rows: dict[tuple[str, str], dict[str, Any]] = {}
        for dt in RATES.values():
            np.save(self._targets(dt), judge.targets(dt))

    def round(self, counted: bool) -> None:
        """Let every case do its task once; a round that is not `counted` warms up."""
        for rate, case in turns():
            found = self._measured(case, RATES[rate])
            row = self.rows.setdefault((rate, case.label), {"cpu": [], "wall": [], "errors": []})
            row["errors"].append((found["verdict"].position, found["verdict"].orientation))
            row["solves"], row["ticks"] = found["solves"] / found["ticks"], found["ticks"]
            if counted:
                for clock in ("cpu", "wall"):
                    row[clock].append(found[clock] / found["ticks"] * 1e6)

    def _targets(self, dt: float) -> Path:
        return self._folder / f"targets_{dt * 1e3:g}_ms.npy"

    def _measured(self, case: Case, dt: float) -> dict[str, Any]:
        into = self._folder / "postures.npy"
        request = {"case": case.name, "dt": dt, "into": str(into), "targets": str(self._targets(dt))}
        found = self._workers[case.worker].ask(**request)
        if case.judged == "not":
            return {**found, "verdict": Verdict(0.0, 0.0)}
        q = np.load(into)
        speeds = slowed(self._judge.speeds)
        verdict = (
            self._judge.of_ticks(q, dt) if case.judged == "ticks" else self._judge.of_path(q, dt, speeds)
        )
        if verdict.broken or not max(verdict.position, verdict.orientation) <= PROMISED:
            why = verdict.broken or f"off by {verdict.position:.3g} m, {verdict.orientation:.3g} rad"
            raise SystemExit(f"{case.label}, {dt * 1e3:g} ms: {why}")
        return {**found, "verdict": verdict}


def turns() -> Iterator[tuple[str, Case]]:
    """Rates and cases in the order of a round."""
    yield from ((rate, case) for rate in RATES for case in CASES if rate in case.rates)


def slowed(speeds: np.ndarray) -> np.ndarray:
    """Speed limits (7,), rad/s, with which the task cannot keep its pace."""
    slow: np.ndarray = speeds.copy()
    slow[SLOW_JOINT] = np.radians(SLOW_SPEED)
    return slow


def write_task(folder: Path, urdf: str, speeds: np.ndarray, laps: int) -> None:
    """Programs and cells for irlx, and the URDF for all others."""
    files = {
        "line_and_circle.irl": program(laps),
        "cyclic.irl": program(laps, cyclic=True),
        "free.toml": cell(),
        "slow.toml": cell(speeds=slowed(speeds)),
        "watched.toml": cell(watched=True),
        "bare.urdf": bare_urdf(urdf, FINGERS),
    }
    for name, content in files.items():
        (folder / name).write_text(content, encoding="utf-8")


def measured(venv: Path, rounds: int, laps: int) -> dict[str, Any]:
    """Figures of all cases, as `--json` prints them."""
    ours, theirs = environments(venv)
    urdf = panda_urdf(ours)
    judge = Judge(urdf, laps)
    with TemporaryDirectory() as name:
        folder = Path(name)
        write_task(folder, urdf, judge.speeds, laps)
        pythons = {"irlx": ours, "pink": theirs, "mink": theirs, "placo": theirs}
        workers = {one: Worker(one, python, f"{one}_side", folder) for one, python in pythons.items()}
        measurement = Measurement(workers, judge, folder)
        for number in range(rounds + 1):
            print(f"round {number} of {rounds}", file=sys.stderr, flush=True)
            measurement.round(counted=number > 0)
        for worker in workers.values():
            worker.close()
    about = {
        "date": date.today().isoformat(),
        "machine": machine(),
        "rounds": rounds,
        "simulated_s": laps * LAP_TIME,
        "versions": {one: worker.versions for one, worker in workers.items()},
    }
    return {**about, "rates": figures(measurement)}


def figures(measurement: Measurement) -> dict[str, dict[str, dict[str, Any]]]:
    """Figures of the rows by rate and label."""
    found: dict[str, dict[str, dict[str, Any]]] = {rate: {} for rate in RATES}
    for (rate, label), row in measurement.rows.items():
        position, orientation = np.max(row["errors"], axis=0)
        found[rate][label] = {
            "cpu_us": row["cpu"],
            "wall_us": row["wall"],
            "ticks": row["ticks"],
            "solves_per_tick": row["solves"],
            "position_error_m": float(position),
            "orientation_error_rad": float(orientation),
        }
    return found


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure all cases and print them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--laps", type=int, default=2, help="laps of a round, 5 s each (default: 2)")
    parser.add_argument("--venv", type=Path, default=usual_folder(), help="folder of the environments")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print one JSON object instead of tables")
    form.add_argument("--markdown", action="store_true", help="print what docs/performance.md holds")
    asked = parser.parse_args(arguments)
    found = measured(asked.venv.absolute(), asked.rounds, asked.laps)
    print(json.dumps(found, indent=2) if asked.json else markdown(found) if asked.markdown else text(found))


if __name__ == "__main__":
    main()
