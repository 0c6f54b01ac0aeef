"""Figures of streams and runs: what `irlx plot` and `irlx.plot` do."""

from __future__ import annotations

import os
import warnings
from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from irlx.diagnostics import Diagnostic, IrlxError, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.diagnostics.extra import require_extra
from irlx.report.plot.chosen_joints import busiest_joints, joints_named, told_numbers
from irlx.report.plot.curves import Curves
from irlx.report.plot.make_curves import Subject, curves_of
from irlx.report.plot.quantity import JOINT_QUANTITIES, QUANTITIES, Quantity
from irlx.streams.formats import read_stream

if TYPE_CHECKING:
    # Not imported: a run brings along all that made it, matplotlib is an extra, and joints need no cell.
    from matplotlib.figure import Figure

    from irlx.cell.cell import Cell
    from irlx.report.run import Run

PathLike = str | os.PathLike[str]

PICTURES = (".svg", ".png", ".pdf")
"""Endings of the figures that can be written."""
COLUMNS, MILLIMETRES = (20, 1000), (100, 2000)
"""Narrowest and widest diagrams in a terminal, and figures."""
IN_TERMINAL = (Quantity.POSITION, Quantity.SPEED, Quantity.PATH_SPEED)
"""What is drawn in a terminal where nothing is asked for."""


_ORDER = ("first", "second")


@dataclass(frozen=True, eq=False)
class Plotted:
    """Curves of one stream, or of two with the same joints; the `joints` (from 0) to draw, in that order;
    notes on what is left out; `numbers`, in words, by which joints were asked for and which they do not have
    in their names."""

    curves: tuple[Curves, ...]
    joints: tuple[int, ...]
    notes: tuple[Diagnostic, ...]
    numbers: tuple[str, ...] = ()


def plot(
    run_or_path: Run | PathLike,
    other: Run | PathLike | None = None,
    *,
    joints: Sequence[str | int] | str | int | None = None,
    show: Collection[str] | None = None,
    first: float | None = None,
    last: float | None = None,
    cell: PathLike | None = None,
    width: float | None = None,
) -> Figure:
    """Figure of matplotlib of a run, or of a stream file of any format; with `other` both over each other.

    `joints` are names or numbers from 1, by default all; `show` any of 'position', 'speed', 'acceleration',
    'singular', 'clearance' and 'path-speed', by default all that are known; both may be given as in the
    command, '3,7'. `first` and `last` bound the time, s; `cell` names the cell file, looked for as
    `irlx.verify` does without it; `width` in mm, 100 to 2000. What is left out because robot or obstacles
    are not known is told by a warning (IRL019).
    Raises IrlxError: IRL010 where matplotlib is not installed (extra `plot`), IRL006 for what is not there,
    IRL011 where the joints of the two differ; StreamError and CellError for files that cannot be used.
    """
    require_extra("irlx.plot", "plot", "matplotlib")
    from irlx.report.plot.figure import draw_figure

    sources = [run_or_path] if other is None else [run_or_path, other]
    page = checked_width(width, MILLIMETRES, "mm")
    found = plotted(sources, _listed(joints), _listed(show), (first, last), cell)
    for note in found.notes:
        warnings.warn(str(note), stacklevel=2)
    return draw_figure(found.curves, found.joints, page)


def plotted(
    sources: Sequence[Run | PathLike],
    joints: Sequence[str | int] | None = None,
    show: Collection[str] | None = None,
    window: tuple[float | None, float | None] = (None, None),
    cell: PathLike | None = None,
    most_joints: int | None = None,
) -> Plotted:
    """Curves of one or two sources; see `plot`. Of more joints than `most_joints` those that matter most."""
    wanted = QUANTITIES if show is None else quantities_named(show)
    given = None if cell is None else _loaded(Path(cell))
    asks = Quantity.SINGULAR in wanted or Quantity.CLEARANCE in wanted
    subjects = _named_apart([_subject(source, given, asks) for source in sources], sources)
    _check_joints(subjects)
    span = _window(subjects, window)
    names = subjects[0].stream.header.joint_names
    chosen = None if joints is None else joints_named(joints, names)
    made = [curves_of(subject, wanted, span) for subject in subjects]
    curves = tuple(one for one, _ in made)
    notes = tuple(note for _, own in made for note in own)
    has_joints = any(quantity in wanted for quantity in JOINT_QUANTITIES)
    if not has_joints and not any(one.tracks for one in curves):
        cause = notes[0].message if notes else "nothing came within the influence of what is kept clear of"
        shown = ",".join(quantity.value for quantity in wanted)
        raise IrlxError(report("IRL006", option="--show", value=shown, cause=f"nothing to draw: {cause}"))
    if chosen is None:
        count = len(curves[0].joint_names)
        chosen = list(range(count)) if most_joints is None else busiest_joints(curves, most_joints)
    return Plotted(curves, tuple(chosen), notes, tuple(told_numbers(joints or (), names)))


def quantities_named(names: Collection[str]) -> tuple[Quantity, ...]:
    """Quantities by their names, in the order in which they are drawn. Raises IrlxError, IRL006."""
    known = [quantity.value for quantity in QUANTITIES]
    for name in names:
        if name not in known:
            cause = f"not one of {', '.join(known)}{near_matches(name, known)}"
            raise IrlxError(report("IRL006", option="--show", value=name or "''", cause=cause))
    return tuple(quantity for quantity in QUANTITIES if quantity.value in names)


def checked_width(width: float | None, bounds: tuple[int, int], unit: str) -> float | None:
    """A width within bounds, None for none. Raises IrlxError, IRL006."""
    least, most = bounds
    if width is None or least <= width <= most:
        return width
    cause = f"needs {least} to {most} {unit}"
    raise IrlxError(report("IRL006", option="--width", value=f"{width:g}", cause=cause))


def _listed(given: Collection[Any] | str | int | None) -> Sequence[Any] | None:
    """Names and numbers as a list, however they were given."""
    if given is None:
        return None
    if isinstance(given, str):
        return [entry.strip() for entry in given.split(",")]
    return [given] if isinstance(given, int) else list(given)


def _named_apart(subjects: Sequence[Subject], sources: Sequence[object]) -> list[Subject]:
    """Subjects whose names differ: those of the same name by their paths, or as the first and the second."""
    if len({subject.name for subject in subjects}) == len(subjects):
        return list(subjects)
    paths = [str(source) if isinstance(source, str | os.PathLike) else "" for source in sources]
    if "" in paths or len(set(paths)) < len(paths):
        paths = [f"{subject.name}, {which}" for subject, which in zip(subjects, _ORDER, strict=True)]
    return [replace(subject, name=name) for subject, name in zip(subjects, paths, strict=True)]


def _loaded(path: Path) -> Cell:
    from irlx.cell.load import load_cell

    return load_cell(path)


def _subject(source: Run | PathLike, cell: Cell | None, asks: bool) -> Subject:
    """A source with its robot and scene, as far as they are known and anything `asks` for them."""
    if isinstance(source, str | os.PathLike):
        path = Path(source)
        stream, name, beside, clearances = read_stream(path), path.name, path.parent, None
    else:
        stream, name = source.stream, source.stream.header.program_name
        beside, clearances = Path.cwd(), source.clearances
    if cell is not None:
        from irlx.recorded import check_joints

        check_joints(stream.header, cell)
        return Subject(stream, name, cell.robot, cell.scene, clearances)
    if not asks:
        return Subject(stream, name, clearances=clearances)
    from irlx.verification import looked_up

    try:
        reference = looked_up(stream.header, beside, None)
    except IrlxError as error:
        # A robot whose package is missing: its joints can be drawn all the same.
        return Subject(stream, name, clearances=clearances, why_unknown=error.reason.message)
    if reference is None:
        return Subject(stream, name, clearances=clearances)
    return Subject(stream, name, reference.robot, reference.scene, clearances)


def _check_joints(subjects: Sequence[Subject]) -> None:
    """Raises IrlxError, IRL011, where two streams have not the same joints."""
    if len(subjects) < 2:
        return
    (first, one), (second, other) = ((subject.name, subject.stream.header) for subject in subjects)
    if one.joint_names == other.joint_names and one.joint_units == other.joint_units:
        return
    words = [
        f"only {name} has {', '.join(lone)}"
        for name, own, others in ((first, one, other), (second, other, one))
        if (lone := [joint for joint in own.joint_names if joint not in others.joint_names])
    ]
    if not words and one.joint_names != other.joint_names:
        words = ["their joints come in another order"]
    if not words:
        units = zip(one.joint_names, one.joint_units, other.joint_units, strict=True)
        words = [f"{joint} is in {a} there and in {b} here" for joint, a, b in units if a != b]
    raise IrlxError(report("IRL011", first=first, second=second, cause="; ".join(words)))


def _window(subjects: Sequence[Subject], window: tuple[float | None, float | None]) -> tuple[float, float]:
    """The window of time, s. Raises IrlxError, IRL006, where a stream has nothing in it."""
    first, last = window
    low, high = 0.0 if first is None else first, np.inf if last is None else last
    if not low < high:
        cause = f"the end must lie behind the beginning, {low:g} s"
        raise IrlxError(report("IRL006", option="--to", value=f"{high:g}", cause=cause))
    for subject in subjects:
        t = subject.stream.t
        if not np.any((t >= low) & (t <= high)):
            end = float(t[-1]) if len(t) else 0.0
            where = "from there on" if low > end else f"from there to {high:g} s"
            cause = f"{subject.name} has no sample {where}; it lasts {end:g} s"
            raise IrlxError(report("IRL006", option="--from", value=f"{low:g}", cause=cause))
    return low, high
