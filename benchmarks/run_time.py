"""Time of whole runs: `irlx run P.irl -o P.csv` as a process, start-up and verification included.

    python benchmarks/run_time.py [WORD]... [--rounds N] [--json | --markdown]

Runs a program of a minute for the Panda (lines, circles, PTP) at 1 ms, with its links kept off each other, as
the robot comes, and free to touch; the square of koch11 at 1 ms; the programs of `programs/koch` at the tick
of their cells. Programs take turns within a round; given are the medians of the time by the clock and of the
processor, each with the share of the simulated time that it is, and the largest memory. On a machine that
does other work the processor's is the one to look at. WORD: only cases in whose names one of them occurs. The
Panda wants the extra `robots`.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

from beside.machine import machine
from beside.tables import aligned, piped

KOCH = Path(__file__).resolve().parents[1] / "programs" / "koch"

MINUTE = """PROGRAM minute;
VAR
  INT: lap;
  MAIN_JOINT: ready := (0, -45, 0, -135, 0, 90, 45), aside := (40, -30, 0, -120, 0, 90, 45);
BEGIN
  FOR lap := 1 TO 10 DO
    MOVE_INC LIN POSITION(150, 200, -187.5);
    MOVE_INC CIRCLE POSITION(58, 58, 0), POSITION(0, 116, 0) ANGLE := 360;
    MOVE_INC LIN POSITION(-150, -200, 187.5);
    MOVE PTP aside SPEED_PTP := 60;
    MOVE PTP ready SPEED_PTP := 60;
  ENDFOR;
ENDPROGRAM;
"""

CELL = """[robot]
model = "panda"
[robot.self_collision]
active = {watched}
[motion]
speed = 250
acc = 1000
"""


@dataclass(frozen=True)
class Case:
    """A program to be run; its cell where it does not name it, its tick, ms, where that is not the cell's."""

    name: str
    program: Path
    cell: Path | None = None
    tick: float | None = None

    def command(self, csv: Path) -> list[str]:
        """The command that runs it."""
        command = [sys.executable, "-m", "irlx", "run", str(self.program), "-o", str(csv), "--json"]
        command += [] if self.cell is None else ["--cell", str(self.cell)]
        return command + ([] if self.tick is None else ["--tick", f"{self.tick:g}"])


def cases(folder: Path) -> list[Case]:
    """All cases; what is not in the checkout is written into the folder."""
    minute = folder / "minute.irl"
    minute.write_text(MINUTE, encoding="utf-8")
    for name, watched in (("free", "false"), ("watched", "true")):
        (folder / f"{name}.toml").write_text(CELL.format(watched=watched), encoding="utf-8")
    return [
        Case("Panda, a minute, links watched", minute, folder / "watched.toml", 1.0),
        Case("Panda, a minute, links free", minute, folder / "free.toml", 1.0),
        Case("koch11, square, 1 ms", KOCH / "square.irl", tick=1.0),
        *(Case(f"koch11, {program.stem}", program) for program in sorted(KOCH.glob("*.irl"))),
    ]


def run(case: Case, folder: Path) -> dict[str, float]:
    """One run: time by the clock and of the processor (s), memory (MB), simulated time (s)."""
    told, complaints = folder / "summary.json", folder / "stderr.txt"
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    # An installed irlx has its bytecode on disk, whatever is set here.
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    with told.open("wb") as out, complaints.open("wb") as err:
        begin = perf_counter()
        process = subprocess.Popen(case.command(folder / "out.csv"), stdout=out, stderr=err, env=environment)
        _, status, used = os.wait4(process.pid, 0)
        wall = perf_counter() - begin
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise SystemExit(f"{case.name}: exit code {process.returncode}\n{complaints.read_text('utf-8')}")
    simulated = json.loads(told.read_text(encoding="utf-8"))["summary"]["duration"]
    cpu = used.ru_utime + used.ru_stime
    return {"wall_s": wall, "cpu_s": cpu, "memory_mb": used.ru_maxrss / 1024, "simulated_s": simulated}


def measured(words: Sequence[str], rounds: int) -> dict[str, Any]:
    """Figures of all rounds, as `--json` prints them."""
    found: dict[str, list[dict[str, float]]] = {}
    with TemporaryDirectory() as name:
        folder = Path(name)
        asked = [case for case in cases(folder) if not words or any(word in case.name for word in words)]
        for number in range(rounds + 1):
            print(f"round {number} of {rounds}", file=sys.stderr, flush=True)
            for case in asked:
                found.setdefault(case.name, []).append(run(case, folder))
    kept = {name: runs[1:] for name, runs in found.items()}  # The first round warms up.
    return {"date": date.today().isoformat(), "machine": machine(), "rounds": rounds, "cases": kept}


HEADINGS = ("", "simulated s", "clock s", "share", "processor s", "share", "memory MB")


def rows(found: dict[str, Any]) -> list[tuple[str, ...]]:
    """A table, its headings first."""
    table: list[tuple[str, ...]] = [HEADINGS]
    for name, runs in found["cases"].items():
        simulated, memory = runs[0]["simulated_s"], max(run["memory_mb"] for run in runs)
        times: list[str] = []
        for clock in ("wall_s", "cpu_s"):
            time = median(run[clock] for run in runs)
            times += [f"{time:.2f}", f"1/{simulated / time:.1f}"]
        table.append((name, f"{simulated:.2f}", *times, f"{memory:.0f}"))
    return table


def main(arguments: Sequence[str] | None = None) -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("words", metavar="WORD", nargs="*", help="only cases in whose names one occurs")
    parser.add_argument("--rounds", type=int, default=3)
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print one JSON object instead of a table")
    form.add_argument("--markdown", action="store_true", help="print what docs/performance.md holds")
    asked = parser.parse_args(arguments)
    found = measured(asked.words, asked.rounds)
    if asked.json:
        print(json.dumps(found, indent=2))
        return
    rounds = f"{found['rounds']} round{'s' if found['rounds'] > 1 else ''}"
    print(f"{found['date']}, {found['machine']}; {rounds}.\n")
    print(piped(rows(found)) if asked.markdown else aligned(rows(found)))


if __name__ == "__main__":
    main()
