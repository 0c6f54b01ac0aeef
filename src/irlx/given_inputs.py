"""What a caller says that inputs are: a CSV file, traces or a function, with what the cell says."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from itertools import pairwise
from math import inf, isfinite
from pathlib import Path
from typing import Any

from irlx.cell.cell import Cell
from irlx.cell.input_file import read_input_file
from irlx.diagnostics import IrlxError, Place, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.language.input_names import InputNames, input_names
from irlx.pacing.inputs import InputFunction, Inputs, Trace
from irlx.program import Program
from irlx.recorded import Recorded

InputsGiven = InputFunction | Mapping[str, Sequence[tuple[float, float]]] | str | os.PathLike[str] | None
"""A function of name and time (s), traces by name (times in s with the value from each on), or a CSV file."""


def inputs_of(program: Program | Recorded, cell: Cell, given: InputsGiven) -> Inputs:
    """What inputs say: first `given`, a function, traces by name or a CSV, of the others what the cell says.

    Raises CellError for a file that is no such CSV, IrlxError: IRL006 for what says nothing of inputs, IRL649
    for a name that is none of an input of the program or the cell. A recording knows its inputs by their
    ports only, and those alone that were read: names that it does not know are none of its business.
    """
    if callable(given):
        return Inputs({}, given, cell.inputs)
    if isinstance(given, str | os.PathLike):
        file = read_input_file(Path(given))
        _check_names(file.places, program, cell)
        return Inputs(file.traces, others=cell.inputs)
    traces: Any = {} if given is None else given
    if not (isinstance(traces, Mapping) and all(isinstance(name, str) for name in traces)):
        cause = "a path, a function of name and time, or traces by name"
        raise IrlxError(report("IRL006", option="inputs=", value=repr(given), cause=cause))
    own = {name.casefold(): _trace(name, trace) for name, trace in traces.items()}
    _check_names(dict.fromkeys(traces), program, cell)
    return Inputs(own, others=cell.inputs)


def _check_names(given: Mapping[str, Place | None], program: Program | Recorded, cell: Cell) -> None:
    """Raises IrlxError, IRL649, with every name, with its place, that no input of program or cell has."""
    if not given or isinstance(program, Recorded):
        return
    found = input_names([program.tree, *(module.tree for module in program.modules)])
    spelt = {name.casefold() for name in found.names}
    known = InputNames((*found.names, *(name for name in cell.inputs if name not in spelt)), found.computed)
    listed = ", ".join(known.names) or "none"
    faults = [
        report("IRL649", place, name=name, near=near_matches(name, known.names), known=listed)
        for name, place in given.items()
        if not known.has(name)
    ]
    if faults:
        raise IrlxError(faults)


def _trace(name: str, given: Sequence[tuple[float, float]]) -> Trace:
    """Times and values of an input. Raises IrlxError, IRL006."""
    try:
        trace = tuple((float(at), float(value)) for at, value in given)
    except (TypeError, ValueError):
        trace = ((inf, inf),)
    times = [at for at, _ in trace]
    rising = all(earlier < later for earlier, later in pairwise(times))
    if rising and all(isfinite(value) and 0.0 <= at < inf for at, value in trace):
        return trace
    cause = "pairs of a time in s, 0 or more and rising, and of a value"
    raise IrlxError(report("IRL006", option="inputs=", value=name, cause=cause))
