"""Second opinions on many random cases: `python tests/campaigns/differential.py programs --count 20000`.

programs  what programs come to, against an evaluator written from the reference alone
ticks     ticks of the inverse transform, against optimisers and conditions of an optimum by differences
laws      time laws of moves, against integration and closed forms
joined    runs of short programs whose moves pass into each other, against the verifier
smooth    the same with S curves, whose jerk the verifier takes from the rows

Seeds are those of the tests with the same cases. A case that differs is printed with its seed, and the
command ends with 1; Ctrl-C ends it with what was found so far.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))


def judge_of(kind):
    """What judges a seed: gives how the case ended, and lines on what differs."""
    if kind == "programs":
        from reference_evaluator.comparison import judged
    elif kind == "ticks":
        from second_ticks import judged
    elif kind == "laws":
        from second_laws import judged
    elif kind == "joined":
        from joined_programs import judged
    else:
        from joined_programs import judged_smooth as judged
    return judged


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("kind", choices=("programs", "ticks", "laws", "joined", "smooth"))
    parser.add_argument("--first", type=int, default=0, help="first seed, by default 0")
    parser.add_argument("--count", type=int, default=1000, help="number of seeds, by default 1000")
    given = parser.parse_args()
    judged, started = judge_of(given.kind), time.process_time()
    ends: Counter[str] = Counter()
    different = 0
    try:
        for seed in range(given.first, given.first + given.count):
            end, differences = judged(seed)
            ends[end] += 1
            if differences:
                different += 1
                print(f"seed {seed}, {end}:", *differences, sep="\n  ", flush=True)
    except KeyboardInterrupt:
        print("interrupted")
    spent = time.process_time() - started
    last = given.first + sum(ends.values()) - 1
    print(f"seeds {given.first} to {last}: {spent:.0f} s of processor time")
    print("ends: " + ", ".join(f"{count} {end}" for end, count in ends.most_common()))
    print(f"different: {different}")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
