"""Draws the pictures of all documents: python docs/pictures [WORD]...

Runs every script of this folder and the commands of the experiments one after another, or those in which
one of the words occurs. Needs `pip install irlx[plot]`; pictures of pages need the extra `browser` and
Chromium, too. Exits 1 where a picture could not be drawn.
"""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
KOCH = "programs/koch/experiments.py"
JOINTS = {
    "6.1": "7 8 11",
    "6.2": "7 8 11",
    "6.3": "6 7 10 11 --window 5 6.2",
    "6.4": "7 9 10 11",
    "6.5": "4 9 10 11",
    "6.6": "4 9 10 11",
}
"""Experiments, and the joints that their pictures show."""


def commands() -> list[list[str]]:
    """Arguments to Python of everything that draws, paths from the root of the project."""
    scripts = [[path.relative_to(ROOT).as_posix()] for path in sorted(HERE.glob("draw_*.py"))]
    experiments = [[KOCH, name, "--joints", *joints.split()] for name, joints in JOINTS.items()]
    cycles = [["programs/cycles/cycles.py", name] for name in ("rounds", "triangle")]
    into = ["--out", HERE.relative_to(ROOT).as_posix()]
    return [*scripts, *([*command, *into] for command in (*experiments, *cycles))]


def main() -> int:
    """Run what is asked for; exit code."""
    failed = []
    for command in commands():
        words = " ".join(command)
        if sys.argv[1:] and not any(word in words for word in sys.argv[1:]):
            continue
        print(words, flush=True)
        began = time.monotonic()
        if subprocess.run([sys.executable, *command], cwd=ROOT, check=False).returncode:
            failed.append(words)
        print(f"  {time.monotonic() - began:.1f} s", flush=True)
    for words in failed:
        print(f"failed: {words}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
