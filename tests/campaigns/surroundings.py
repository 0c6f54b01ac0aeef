"""What surrounds a run goes wrong: disks, kills, Ctrl-C, other processes, limits, locales, odd inputs.

    python tests/campaigns/surroundings.py                      all parts, some twenty minutes
    python tests/campaigns/surroundings.py --only kills,disk --count 30 --seed 7

Each part prints one line with what it tried and what broke; the exit code is 1 where anything did. What must
hold everywhere: the exit code is a documented one, messages carry codes, there is no traceback and no
internal error (out of memory aside); a name that was asked for holds nothing, what it held before, or all of
what an undisturbed run writes; what a killed process leaves is readable as far as the reference says.
"""

from __future__ import annotations

import argparse
import os
import random
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "src")]

from surrounded import outside, places, unusual  # noqa: E402
from surrounded.inside import disk, kills, twice  # noqa: E402
from surrounded.place import Place, Trial  # noqa: E402

PARTS: dict[str, tuple[Callable[[Place, random.Random, int], Iterator[Trial]], int]] = {
    "disk": (disk, 200),
    "kills": (kills, 200),
    "twice": (twice, 40),
    "interrupts": (outside.interrupts, 100),
    "terminal": (outside.terminal, 20),
    "memory": (outside.memory, 25),
    "settings": (unusual.settings, 40),
    "inputs": (unusual.inputs, 60),
    "channels": (unusual.channels, 60),
    "programs": (unusual.programs, 40),
    "places": (places.places, 200),
    "names": (places.names, 60),
    "clocks": (places.clocks, 15),
    "masses": (places.masses, 6),
}
"""Every part, and how many trials it makes by default; from `settings` on at most, they may have fewer."""


def main() -> int:
    """Carry out the parts that are asked for."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--only", default=",".join(PARTS), help="parts, with commas between them")
    parser.add_argument("--count", type=int, help="trials of each part")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    broken = 0
    for name in options.only.split(","):
        part, count = PARTS[name]
        broken += carried_out(name, part, count if options.count is None else options.count, options.seed)
    print(f"surroundings: seed {options.seed}, {broken} broken")
    return 1 if broken else 0


def carried_out(name: str, part: Callable[..., Iterator[Trial]], count: int, seed: int) -> int:
    """Carry out a part, print its faults and its figures; how many trials broke something."""
    began, trials, codes, faults = time.monotonic(), 0, {}, 0
    with tempfile.TemporaryDirectory(prefix="irlx-surroundings-") as folder:
        for trial in part(Place.made(Path(folder)), random.Random(f"{name} {seed}"), count):
            trials += 1
            codes[trial.code] = codes.get(trial.code, 0) + 1
            if trial.faults:
                faults += 1
                print(f"BROKEN {name}: {trial.what}: {'; '.join(trial.faults)}", flush=True)
    ended = ", ".join(f"{number} x {code}" for code, number in sorted(codes.items(), key=str))
    took = time.monotonic() - began
    print(f"{name:<11}{trials} trials, {faults} broken, exit codes {ended}, {took:.0f} s", flush=True)
    return faults


if __name__ == "__main__":
    sys.exit(main())
