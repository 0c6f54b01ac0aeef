"""Draws docs/pictures/motion_*.png: path, speed and acceleration of every construct of MOVE, run on `arm7`.

python docs/pictures/draw_motion.py [NAME]...    (needs matplotlib)
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import irlx

HERE = Path(__file__).resolve().parent
COLOURS = ("#14566e", "#c2571a", "#8a8a8a")
MARK = "#a02040"
STYLE = {
    "font.family": "DejaVu Sans",
    "font.size": 8.0,
    "axes.linewidth": 0.6,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "axes.unicode_minus": True,
}
START = "MOVE PTP POSITION(441, 200, 324);"
A, B, C = "(441, 100, 324)", "(541, 100, 324)", "(541, 200, 324)"


@dataclass(frozen=True)
class Figures:
    """What one figure shows: variants of statements, each with its name; `points` (mm) are marked."""

    variants: dict[str, str]
    points: tuple[tuple[float, float], ...] = ()
    turning: bool = False


CORNER = ((441.0, 200.0), (441.0, 100.0), (541.0, 100.0))
SQUARE = (*CORNER, (541.0, 200.0))
FIGURES = {
    "lin": Figures(
        {
            "PROFILE 'TRAPEZOID'": f"MOVE LIN POSITION{A};",
            "PROFILE 'S_CURVE'": f"MOVE LIN POSITION{A} PROFILE := 'S_CURVE';",
        },
        CORNER[:2],
    ),
    "law": Figures(
        {
            "SPEED 250, ACC 1000": f"MOVE LIN POSITION{A};",
            "TIME := 1": f"MOVE LIN POSITION{A} TIME := 1;",
            "OVERRIDE := 50": f"MOVE LIN POSITION{A} OVERRIDE := 50;",
        },
        CORNER[:2],
    ),
    "circle": Figures(
        {
            "via and end point": f"MOVE CIRCLE POSITION{A}, POSITION{B};",
            "ANGLE := 360": f"MOVE CIRCLE POSITION{A}, POSITION{B} ANGLE := 360;",
        },
        CORNER,
    ),
    "blend": Figures(
        {
            "C_CP := 20": f"MOVE LIN POSITION{A} C_CP := 20; MOVE LIN POSITION{B};",
            "C_CP := 50": f"MOVE LIN POSITION{A} C_CP := 50; MOVE LIN POSITION{B};",
            "none": f"MOVE LIN POSITION{A}; MOVE LIN POSITION{B};",
        },
        CORNER,
    ),
    "pass": Figures(
        {
            "C_PASS, SPEED := 250": f"MOVE LIN POSITION{A} C_PASS := TRUE; MOVE LIN POSITION{B};",
            "C_PASS, SPEED := 120": "R_SPEED := 120;"
            f"MOVE LIN POSITION{A} C_PASS := TRUE; MOVE LIN POSITION{B};",
        },
        CORNER,
    ),
    "path": Figures(
        {
            "LIN PATH, C_CP := 25": f"MOVE LIN PATH (POSITION{A}, POSITION{B}, POSITION{C}) C_CP := 25;",
            "SPLINE PATH": f"MOVE SPLINE PATH (POSITION{A}, POSITION{B}, POSITION{C});",
        },
        SQUARE,
    ),
    "mixed": Figures(
        {
            "LIN, CIRCLE, LIN with C_CP := 15": "R_C_CP := 15;"
            f"MOVE LIN POSITION{A}; MOVE CIRCLE POSITION(491, 60, 324), POSITION{B}; MOVE LIN POSITION{C};",
        },
        (*SQUARE, (491.0, 60.0)),
    ),
    "ptp": Figures(
        {
            "PTP": f"MOVE PTP POSITION{B};",
            "PTP, PROFILE 'S_CURVE'": f"MOVE PTP POSITION{B} PROFILE := 'S_CURVE';",
        },
        (CORNER[0], CORNER[2]),
    ),
    "slow": Figures(
        {
            "free": f"MOVE LIN POSITION{A}; MOVE LIN POSITION{B};",
            "SPEED := 120 on the second, C_CP := 30": f"MOVE LIN POSITION{A} C_CP := 30;"
            f"MOVE LIN POSITION{B} SPEED := 120;",
        },
        CORNER,
    ),
}


def run(statements: str) -> irlx.Run:
    """The run of statements from a common start, at a tick of 1 ms."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "figure.irl"
        path.with_suffix(".toml").write_text('[robot]\nmodel = "arm7"\n[motion]\ntick_ms = 1\n')
        path.write_text(f"PROGRAM figure;\nBEGIN\n{START}\n{statements}\nENDPROGRAM;\n")
        return irlx.run(path)


def draw(name: str, figures: Figures) -> None:
    """Write one figure: the path from above, speed and acceleration of the tool over time."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(9.0, 2.6), layout="constrained")
        above, speed, acceleration = figure.subplots(1, 3, width_ratios=(1.0, 1.4, 1.4))
        for (label, statements), colour in zip(figures.variants.items(), COLOURS, strict=False):
            found = run(statements)
            rows = found.block > 1
            t, at = found.t[rows], found.tool[rows, :3] * 1e3
            t = t - t[0]
            velocity = np.gradient(at, t, axis=0)
            rate = np.linalg.norm(velocity, axis=1)
            above.plot(at[:, 0], at[:, 1], color=colour, linewidth=1.2)
            speed.plot(t, rate, color=colour, linewidth=1.1, label=label)
            bend = np.linalg.norm(np.gradient(velocity, t, axis=0), axis=1)
            acceleration.plot(t, bend, color=colour, linewidth=0.9)
        for x, y in figures.points:
            above.plot(x, y, "o", color=MARK, markersize=3.0)
        labelled(above, "x, mm", "y, mm")
        above.set_aspect("equal", adjustable="datalim")
        labelled(speed, "t, s", "speed, mm/s")
        labelled(acceleration, "t, s", "acceleration, mm/s²")
        speed.legend(loc="best", frameon=False, fontsize=7.0)
        figure.savefig(HERE / f"motion_{name}.png", dpi=110)


def labelled(axes: Axes, x: str, y: str) -> None:
    """Names of both axes, and a faint grid."""
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.grid(linewidth=0.3, color="#d8d8d8")


def main() -> None:
    """Draw the figures that the command line names, or all."""
    for name in sys.argv[1:] or FIGURES:
        draw(name, FIGURES[name])


if __name__ == "__main__":
    main()
