"""A chain of many short blended moves, streamed: simulated time over real time, and memory.

python benchmarks/long_chain.py [--moves N]
"""

from __future__ import annotations

import argparse
import resource
import tempfile
import time
from pathlib import Path

import irlx

PROGRAM = """PROGRAM long;
VAR INT: i; REAL: a;
BEGIN
  R_C_CP := 0.4; R_SPEED := 200;
  MOVE LIN POSITION(461, 200, 324) C_PASS := FALSE;
  FOR i := 1 TO {moves} DO
    a := FLOAT(i) * 2.0;
    MOVE LIN POSITION(441 + 20 * COS(a), 200 + 20 * SIN(a), 324 + 5 * SIN(a * 0.5));
  ENDFOR;
ENDPROGRAM;
"""
CELL = '[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 10\n'


def main() -> None:
    """Stream the chain, and print a line for every tenth of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--moves", type=int, default=100_000)
    moves = parser.parse_args().moves
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "long.irl"
        path.with_suffix(".toml").write_text(CELL)
        path.write_text(PROGRAM.format(moves=moves))
        begin = time.perf_counter()
        told = 0
        for sample in irlx.stream(path):
            if sample.block * 10 >= moves * (told + 1):
                told += 1
                real = time.perf_counter() - begin
                memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
                pace = f"{sample.t:7.2f} s in {real:6.1f} s, {sample.t / real:.2f}x"
                print(f"{sample.block:7d} moves, {pace}, {memory} MB", flush=True)


if __name__ == "__main__":
    main()
