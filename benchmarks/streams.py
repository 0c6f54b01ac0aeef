"""Time and memory of writing and reading long streams, in every format.

    python benchmarks/streams.py [--rows N] [--formats .csv,.irdata] [--json]

Rows of 7 joints at 1 kHz, smooth in time, come in portions of 1,000 as those of motions do. Each format is
written and read in a process of its own; the table has processor time in microseconds a row, the size of the
file, and the most memory that the process ever had beyond that of the imports. The default, 3,600,000 rows,
is an hour.
"""

from __future__ import annotations

import argparse
import json
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from time import process_time

import numpy as np

from irlx.robot.limits import JointLimits
from irlx.streams import (
    FORMAT_VERSION,
    KNOWN_ENDINGS,
    RowBatch,
    StreamEnd,
    StreamHeader,
    open_writer,
    scan_stream,
)

JOINTS = 7
PORTION = 1000
HOUR = 3_600_000


def main() -> None:
    """Measure all formats and print them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--rows", type=int, default=HOUR)
    parser.add_argument("--formats", default=",".join(KNOWN_ENDINGS))
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of a table")
    parser.add_argument("--one", help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.one:
        print(json.dumps(measured(asked.one, asked.rows)))
        return
    found = {}
    if not asked.json:
        print(f"{'format':10}{'write us':>10}{'read us':>10}{'MB':>10}{'memory MB':>12}")
    for ending in asked.formats.split(","):
        command = [sys.executable, __file__, "--one", ending, "--rows", str(asked.rows)]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        found[ending] = row = json.loads(done.stdout)
        if not asked.json:
            columns = f"{row['write']:>10.2f}{row['read']:>10.2f}{row['size']:>10.1f}{row['memory']:>12.1f}"
            print(f"{ending:10}{columns}", flush=True)
    if asked.json:
        print(json.dumps({"rows": asked.rows, "formats": found}, indent=2))


def measured(ending: str, rows: int) -> dict[str, float]:
    """Microseconds a row to write and to read, size and additional memory in MB."""
    folder = Path(tempfile.mkdtemp())
    try:
        before = memory()
        path = folder / f"hour{ending}"
        write = written(path, rows)
        begin = process_time()
        count, complete = 0, False
        for item in scan_stream(path):
            count += len(item.ticks) if isinstance(item, RowBatch) else 0
            complete = complete or (isinstance(item, StreamEnd) and item.complete)
        read = process_time() - begin
        if count != rows or not complete:
            raise SystemExit(f"{ending}: {count} rows of {rows} were read")
        files = [path] if path.is_file() else path.rglob("*")
        size = sum(file.stat().st_size for file in files)
        return {
            "write": write / rows * 1e6,
            "read": read / rows * 1e6,
            "size": size / 1e6,
            "memory": memory() - before,
        }
    finally:
        shutil.rmtree(folder)


def written(path: Path, rows: int) -> float:
    """Processor time (s) of writing, without that of making the rows."""
    rng = np.random.default_rng(0)
    slopes, phases = rng.uniform(1e-4, 1e-3, JOINTS + 7), rng.uniform(0.0, 6.0, JOINTS + 7)
    writer, time = open_writer(path, header()), 0.0
    for first in range(0, rows, PORTION):
        ticks = np.arange(first, min(first + PORTION, rows), dtype=np.int64)
        values = np.sin(ticks[:, None] * slopes + phases)
        begin = process_time()
        writer.samples(ticks, values[:, :JOINTS], np.full(len(ticks), 1, np.int64), values[:, JOINTS:])
        time += process_time() - begin
    begin = process_time()
    writer.close()
    return time + process_time() - begin


def header() -> StreamHeader:
    """Of a robot with seven joints, at 1 kHz."""
    names = tuple(f"joint_{number}" for number in range(1, JOINTS + 1))
    texts = ("0", "hour.irl", "ab" * 32, "cell.toml", "arm", "arm", "cd" * 32, "tcp")
    units, weights = ("rad",) * JOINTS, (1.0,) * JOINTS
    return StreamHeader(
        FORMAT_VERSION, *texts, names, units, 1_000_000, JointLimits.unlimited(JOINTS), weights
    )


def memory() -> float:
    """The most memory that this process ever had, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0


if __name__ == "__main__":
    main()
