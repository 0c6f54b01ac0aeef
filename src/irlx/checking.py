"""Checks without motion: what `irlx.check` and `irlx check` say of a program and its cell."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from irlx.diagnostics import Diagnostic, IrlxError
from irlx.interpreter.support import unsupported
from irlx.language import tree
from irlx.language.data_lists import in_order
from irlx.language.suppression import BY_MOTION, unused_finding, without_ignored
from irlx.program import Program, ProgramError, analyse_with_program, faults_of_found_cell

if TYPE_CHECKING:
    from irlx.given_inputs import InputsGiven

PathLike = str | os.PathLike[str]


def check(
    program: PathLike,
    cell: PathLike | None = None,
    motion: bool = False,
    max_steps: int | None = None,
    inputs: InputsGiven = None,
    files: PathLike | None = None,
) -> list[Diagnostic]:
    """All findings on a program, and on a cell file where one is given; raises nothing for its input.

    Names of frames and the number of joints come from `cell`, or from the cell that a run would find; of that
    one is told that it cannot be read, nothing else. With `motion` a program without errors is executed in a
    dry run, at a coarse tick, in the cell that a run would take; `max_steps`, `inputs` and `files` are as in
    `irlx.run`.
    Without `cell` and `motion` this loads neither numpy nor Pinocchio.
    """
    of_cell = [] if cell is None else _cell_findings(cell)
    try:
        analysis, ready = analyse_with_program(program, cell)
    except ProgramError as error:
        return [*error.diagnostics, *of_cell]
    found = list(analysis.diagnostics)
    if isinstance(analysis.tree, tree.Program):
        later = unsupported(analysis.tree, analysis.source, analysis.data_lists, analysis.modules)
        moves = motion and not any(one.is_error for one in (*found, *later, *of_cell))
        if moves and ready is not None:
            in_motion, of_cell = _motion_findings(ready, cell, max_steps, inputs, files)
            later = [*later, *in_motion]
        elif cell is None:
            of_cell = faults_of_found_cell(program, analysis.tree)
        kept, unused = without_ignored(later, analysis.ignores)
        found += kept
        known_later = frozenset() if moves else BY_MOTION
        found += [
            unused_finding(one)
            for one in unused
            if one.place.text is analysis.source and one.code not in known_later
        ]
    return [*in_order(found, analysis.source, analysis.data_lists), *of_cell]


def _motion_findings(
    program: Program,
    cell: PathLike | None,
    max_steps: int | None,
    inputs: InputsGiven,
    files: PathLike | None,
) -> tuple[list[Diagnostic], list[Diagnostic]]:
    """Findings of a dry run, and those on the cell that it took or did not find."""
    # Imported here: motion loads numpy, and most checks have none.
    from irlx.dry_run import dry_run
    from irlx.job import prepare

    try:
        # Nobody is asked at a check: what is read from STANDARD_IN has its end at once.
        job = prepare(program, cell, max_steps=max_steps, inputs=inputs, files=files, input="")
        return dry_run(job), list(job.cell.warnings)
    except IrlxError as error:
        return [], list(error.diagnostics)


def _cell_findings(cell: PathLike) -> list[Diagnostic]:
    """Findings on a cell."""
    # Imported here: validating a cell loads numpy, and most checks have no cell.
    from irlx.cell.load import load_cell

    try:
        return list(load_cell(Path(cell)).warnings)
    except IrlxError as error:
        return list(error.diagnostics)
