"""Checks without motion: what `irlx.check` and `irlx check` say of a program and its cell."""

from __future__ import annotations

import os
from pathlib import Path

from irlx.diagnostics import Diagnostic, IrlxError
from irlx.interpreter.support import unsupported
from irlx.language import tree
from irlx.language.data_lists import in_order
from irlx.language.suppression import unused_finding, without_ignored
from irlx.program import ProgramError, analyse_file

PathLike = str | os.PathLike[str]


def check(program: PathLike, cell: PathLike | None = None) -> list[Diagnostic]:
    """All findings on a program, and on a cell file where one is given; raises nothing for its input.

    Names of frames and the number of joints come from `cell`, or from the cell that a run would find; of that
    one nothing else is looked at. Without `cell` this loads neither numpy nor Pinocchio.
    """
    joints, of_cell = _cell_findings(cell) if cell is not None else (None, [])
    try:
        analysis = analyse_file(program, cell, joints)
    except ProgramError as error:
        return list(error.diagnostics)
    found = list(analysis.diagnostics)
    if isinstance(analysis.tree, tree.Program):
        later = unsupported(analysis.tree, analysis.source, analysis.data_lists, analysis.modules)
        kept, unused = without_ignored(later, analysis.ignores)
        found += kept
        found += [unused_finding(one) for one in unused if one.place.text is analysis.source]
    return [*in_order(found, analysis.source, analysis.data_lists), *of_cell]


def _cell_findings(cell: PathLike) -> tuple[tuple[str, ...], list[Diagnostic]]:
    """Joints of a cell, none where it cannot be used, and the findings on it."""
    # Imported here: validating a cell loads numpy, and most checks have no cell.
    from irlx.cell.load import load_cell

    try:
        loaded = load_cell(Path(cell))
    except IrlxError as error:
        return (), list(error.diagnostics)
    return loaded.robot.joint_names, list(loaded.warnings)
