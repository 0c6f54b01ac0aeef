"""`irlx plot`: curves of a written stream, as figures or in the terminal."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

_EXAMPLE = """\
examples:
  irlx plot programs/koch/square.irdata
  irlx plot programs/koch/square.irdata -o square.svg
  irlx plot programs/koch/square.irdata programs/koch/square_cyclic.irdata --joints 7,11 -o compared.svg
"""
_SHOW = ("position", "speed", "acceleration", "singular", "clearance", "path-speed")
_FALLBACK = (80, 24)


def add_parser(commands: Any) -> None:
    """Add the command to the command line."""
    parser = commands.add_parser(
        "plot",
        help="draw the curves of a joint stream, or of two over each other",
        description="Draw joints, limits in force, tool speed, singularity, clearance over time.",
        epilog=_EXAMPLE,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "stream", metavar="OUT", help="stream: .irdata, .npz, .jsonl, .csv, .parquet, .rosbag"
    )
    parser.add_argument("other", metavar="OUT2", nargs="?", help="another stream, drawn over the first one")
    parser.add_argument(
        "-o",
        "--output",
        action="append",
        default=[],
        metavar="F",
        help="figure to write: .svg, .png or .pdf (needs the extra plot); may be given several times. "
        "Without it the curves are drawn in the terminal",
    )
    parser.add_argument(
        "--cell", metavar="C.toml", help="cell file with robot and obstacles (default: as recorded)"
    )
    parser.add_argument(
        "--joints",
        metavar="LIST",
        help="names or numbers from 1, as joint_3,joint_7 or 3,7 (default: all; in the terminal the few "
        "that come nearest to their limits)",
    )
    parser.add_argument(
        "--show",
        metavar="LIST",
        help=f"any of {','.join(_SHOW)} (default: all that is known; in the terminal "
        "position,speed,path-speed)",
    )
    parser.add_argument("--from", dest="first", type=float, metavar="S", help="from this second on")
    parser.add_argument("--to", dest="last", type=float, metavar="S", help="up to this second")
    parser.add_argument(
        "--width",
        type=float,
        metavar="W",
        help="width of a figure in mm (default: 254), in the terminal in columns (default: all there are)",
    )
    parser.set_defaults(command=command)


def command(options: argparse.Namespace) -> int:
    """Write the figures, or print the curves on stdout; notes on what is left out go to stderr."""
    from irlx.cli.output import encodable, print_diagnostics
    from irlx.plotting import COLUMNS, IN_TERMINAL, MILLIMETRES, checked_width, plotted
    from irlx.report.plot.terminal import MOST_JOINTS

    sources = [options.stream] if options.other is None else [options.stream, options.other]
    outputs = _outputs(options)
    width = checked_width(options.width, *((MILLIMETRES, "mm") if outputs else (COLUMNS, "columns")))
    show = _listed(options.show)
    if show is None and not outputs:
        show = [quantity.value for quantity in IN_TERMINAL]
    found = plotted(
        sources,
        _listed(options.joints),
        show,
        (options.first, options.last),
        options.cell,
        None if outputs else MOST_JOINTS,
    )
    print_diagnostics(found.notes)
    if found.numbers:
        words = f"{'joints':<12}{', '.join(found.numbers)}: numbers count all joints from 1"
        print(encodable(words, sys.stderr), file=sys.stderr)
    if outputs:
        _write(outputs, found, width)
    else:
        _print(found, width)
    return 0


def _write(outputs: Sequence[Path], found: Any, width: float | None) -> None:
    from irlx.cli.output import encodable
    from irlx.report.plot.figure import draw_figure, save_figure

    figure = draw_figure(found.curves, found.joints, width)
    for path in outputs:
        save_figure(figure, path)
        print(encodable(f"{'written':<12}{path}", sys.stdout))


def _print(found: Any, width: float | None) -> None:
    from shutil import get_terminal_size

    from irlx.cli.output import coloured, encodable
    from irlx.diagnostics import IrlxError, report
    from irlx.plotting import COLUMNS
    from irlx.report.plot.terminal import terminal_text

    columns = int(width) if width is not None else min(get_terminal_size(_FALLBACK).columns, COLUMNS[1])
    if columns < COLUMNS[0]:
        cause = f"needs {COLUMNS[0]} at least; --width names another width"
        raise IrlxError(report("IRL006", option="a terminal of", value=f"{columns} columns", cause=cause))
    text = terminal_text(found.curves, found.joints, columns, coloured=coloured(sys.stdout))
    print(encodable(text, sys.stdout))


def _outputs(options: argparse.Namespace) -> list[Path]:
    """Figures to write, checked before anything is read.

    Raises IrlxError: IRL004 unknown ending, IRL005 an input would be overwritten, IRL003 not writable, IRL010
    without matplotlib.
    """
    from irlx.diagnostics import IrlxError, report
    from irlx.diagnostics.extra import require_extra
    from irlx.plotting import PICTURES
    from irlx.streams.atomic import check_writable

    paths = [Path(name) for name in options.output]
    inputs = [Path(name) for name in (options.stream, options.other, options.cell) if name is not None]
    for path in paths:
        if path.suffix.lower() not in PICTURES:
            raise IrlxError(report("IRL004", path=path, ending=path.suffix, known=", ".join(PICTURES)))
        if path.exists() and any(given.exists() and path.samefile(given) for given in inputs):
            raise IrlxError(report("IRL005", option="-o", path=path))
    if paths:
        require_extra("irlx plot -o", "plot", "matplotlib")
    for path in paths:
        check_writable(path)
    return paths


def _listed(text: str | None) -> list[str] | None:
    """Entries of a list with commas, None for none."""
    return None if text is None else [entry.strip() for entry in text.split(",")]
