"""Speed of the front end: lines/s of lexing, parsing, analysis and formatter, and the time of a cold check.

    python benchmarks/front_end.py [--lines N] [--rounds N] [--json]

The program is long and as people write them (`tests/support/long_programs.py`). The stages take turns
within a round, so that a drift of the machine's speed meets all alike; best and median of the rounds are
given. Lines/s count the time that the process computes; `parse` contains the lexing and the tree, `analysis`
the types too, `with lints` all that `irlx check` does without a cell, `formatter` that it makes sure of its
result. The cold check is a process of its own, from start to end, on 1,000 lines.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import perf_counter, process_time

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "support"))

from irlx.language.analysis import analyse
from irlx.language.format import format_source
from irlx.language.lexing import lex
from irlx.language.parser import parse
from irlx.language.source import source_text
from long_programs import long_program

COLD_LINES = 1000


def seconds(work: Callable[[], object]) -> float:
    """Computing time of a piece of work."""
    start = process_time()
    work()
    return process_time() - start


def cold_check(folder: Path) -> float:
    """Wall time of `irlx check` on a program, in s."""
    program = folder / "cold.irl"
    program.write_text(long_program(COLD_LINES), encoding="utf-8")
    start = perf_counter()
    # An installed irlx has its bytecode on disk, whatever is set here.
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    command = [sys.executable, "-m", "irlx", "check", str(program)]
    subprocess.run(command, capture_output=True, check=True, env=environment)
    return perf_counter() - start


def main() -> None:
    """Measure all stages and print them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--lines", type=int, default=10_000)
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of a table")
    asked = parser.parse_args()
    source = source_text("long.irl", long_program(asked.lines))
    stages: dict[str, Callable[[], object]] = {
        "lex": lambda: lex(source),
        "parse": lambda: parse(source),
        "analysis": lambda: analyse(source),
        "with lints": lambda: analyse(source, lints=True),
        "formatter": lambda: format_source(source.text),
    }
    times: dict[str, list[float]] = {name: [] for name in stages}
    cold = []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(asked.rounds + 1):
            for name, work in stages.items():
                times[name].append(seconds(work))
            cold.append(cold_check(Path(folder)))
    lines = source.line_count
    result = {
        # The first round warms up: it fills the tables of the parser and writes the grammar's cache.
        name: {"best": round(lines / min(found[1:])), "median": round(lines / median(found[1:]))}
        for name, found in times.items()
    }
    cold_result = {"best": round(min(cold[1:]), 3), "median": round(median(cold[1:]), 3)}
    if asked.json:
        figures = {"lines": lines, "rounds": asked.rounds, "lines_per_s": result, "cold_s": cold_result}
        print(json.dumps(figures, indent=2))
        return
    print(f"{'':22}{'best':>10}{'median':>10}")
    for name, row in result.items():
        print(f"{name + ', lines/s':22}{row['best']:>10,}{row['median']:>10,}")
    print(f"{f'cold, {COLD_LINES:,} lines, s':22}{cold_result['best']:>10}{cold_result['median']:>10}")


if __name__ == "__main__":
    main()
