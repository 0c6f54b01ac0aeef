"""Draws docs/pictures/plot_*.png: what `irlx plot` makes of streams, for docs/reference/plot.md.

python docs/pictures/draw_plots.py     (needs the extra `plot`)
"""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

from irlx.cli.main import main as irlx

HERE = Path(__file__).resolve().parent
PROGRAMS = HERE.parents[1] / "programs"
STREAMS = (
    ("koch/square", "koch/square.toml"),
    ("koch/square_cyclic", "koch/square.toml"),
    ("koch/square_slow", "koch/square_slow.toml"),
    ("window/window", "window/window.toml"),
)
"""Programs that are run, and the cells that their streams are drawn with."""
JOINTS = "position,speed,acceleration"
PICTURES = {
    "plot_compared": ("square.irdata", "square_cyclic.irdata", "--joints", "7,10,11", "--show", JOINTS),
    "plot_slowed": ("square_slow.irdata", "--joints", "7,8", "--show", "position,speed,path-speed"),
    "plot_clearance": (
        "window.irdata",
        "--joints",
        "1,2",
        "--show",
        "position,singular,clearance,path-speed",
    ),
}
"""Arguments of `irlx plot` by the name of the picture."""


def main() -> None:
    """Run the programs, draw the pictures."""
    with TemporaryDirectory() as folder:
        for program, cell in STREAMS:
            name = Path(program).name
            shutil.copy(PROGRAMS / cell, folder)
            stream = Path(folder, f"{name}.irdata")
            call("run", PROGRAMS / f"{program}.irl", "-o", stream, "--quiet", "--no-verify")
        os.chdir(folder)
        for name, arguments in PICTURES.items():
            call("plot", *arguments, "-o", HERE / f"{name}.png")


def call(*arguments: object) -> None:
    """One command of irlx, which must succeed."""
    code = irlx([str(argument) for argument in arguments])
    if code:
        raise SystemExit(code)


if __name__ == "__main__":
    main()
