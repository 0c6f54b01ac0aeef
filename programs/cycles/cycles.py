"""Closed paths five times over: what the posture drifts by with each, without and with CYCLICSTART.

python programs/cycles/cycles.py rounds                     a circle of a 7-axis arm: figures and a picture
python programs/cycles/cycles.py triangle --out FOLDER      a triangle of a planar arm with one joint to spare

The picture needs matplotlib (pip install matplotlib), the figures do not.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

import irlx
from irlx.blocks import MoveBlock

HERE = Path(__file__).resolve().parent
MOVES = {"rounds": 1, "triangle": 3}
"""Moves of one cycle; a single move leads to its first point."""
LABELS = ("least motion", "CYCLICSTART")
COLOURS = ("#8a8a8a", "#14566e")


def main() -> int:
    """Run both programs, print, draw; 1 where nothing could draw."""
    parser = argparse.ArgumentParser(description="Drift of the posture over five closed paths.")
    parser.add_argument("path", choices=MOVES)
    parser.add_argument("--out", type=Path, default=Path(), metavar="FOLDER", help="folder of the picture")
    parser.add_argument("--facts", action="store_true", help="print figures only")
    asked = parser.parse_args()
    runs = [irlx.run(HERE / f"{asked.path}{ending}.irl") for ending in ("_drift", "")]
    print(f"largest difference of a joint from the posture before the first cycle, {asked.path}, rad")
    print(f"  {'after cycle':<14}{''.join(f'{k:>12}' for k in range(1, 6))}")
    for label, run in zip(LABELS, runs, strict=True):
        away = np.max(np.abs(ends(run, MOVES[asked.path]) - start(run)), axis=1)
        print(f"  {label:<14}{''.join(f'{value:>12.2g}' for value in away)}")
    if asked.facts:
        return 0
    picture = asked.out / f"cycles_{asked.path}.png"
    if not draw(runs, picture, asked.path):
        print("no picture: matplotlib is missing; pip install matplotlib", file=sys.stderr)
        return 1
    print(f"written  {picture}")
    return 0


def start(run: irlx.Run) -> np.ndarray:
    """Posture (n,) at the first point of the path, which the first move leads to."""
    return run.q[np.flatnonzero(run.block == moves(run)[0])[-1]]


def ends(run: irlx.Run, of_cycle: int) -> np.ndarray:
    """Postures (5, n) after each cycle."""
    last = moves(run)[of_cycle::of_cycle]
    return np.array([run.q[np.flatnonzero(run.block == move)[-1]] for move in last])


def moves(run: irlx.Run) -> list[int]:
    """Ids of the moves in order."""
    return [record.block.id for record in run.stream.records if isinstance(record.block, MoveBlock)]


def draw(runs: list[irlx.Run], picture: Path, path: str) -> bool:
    """Joints that differ most over time, both runs; whether matplotlib is there to draw them."""
    try:
        import matplotlib as mpl
        from matplotlib.figure import Figure
    except ModuleNotFoundError:
        return False
    apart = np.max(np.abs(runs[0].q - runs[1].q), axis=0)
    shown = sorted(np.argsort(-apart)[:3])
    with mpl.rc_context({"font.family": "DejaVu Sans", "font.size": 8.0, "axes.linewidth": 0.6}):
        figure = Figure(figsize=(8.0, 4.2))
        diagrams = figure.subplots(len(shown), 1, sharex=True)
        for axes, joint in zip(diagrams, shown, strict=True):
            for run, colour, label in zip(runs, COLOURS, LABELS, strict=True):
                axes.plot(run.t, np.degrees(run.q[:, joint]), color=colour, linewidth=1.3, label=label)
                for move in moves(run)[:: MOVES[path]]:
                    at = np.flatnonzero(run.block == move)[-1]
                    axes.plot(run.t[at], np.degrees(run.q[at, joint]), "o", color=colour, markersize=3.5)
            axes.set_ylabel(f"{runs[0].joint_names[joint]}, deg")
            axes.set_xlim(0.0, float(runs[0].t[-1]))
            axes.grid(True, color="#eceff3", linewidth=0.5)
        diagrams[0].legend(loc="upper right", ncols=2, frameon=False, bbox_to_anchor=(1.0, 1.3))
        diagrams[0].set_title(f"{path}: five times the same path", loc="left", fontsize=9.5)
        diagrams[-1].set_xlabel("time, s; dots: the tool is back where it began")
        figure.subplots_adjust(0.09, 0.1, 0.985, 0.92, 0.1, 0.14)
        figure.savefig(picture, dpi=110)
    return True


if __name__ == "__main__":
    sys.exit(main())
