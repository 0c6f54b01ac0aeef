"""The magic `%%irl`: a program in a cell of a notebook."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from IPython.core.error import UsageError
from IPython.display import display

from irlx.diagnostics import Diagnostic, IrlxError
from irlx.notebook.findings import Findings
from irlx.notebook.not_begun import NotBegun
from irlx.notebook.options import magic_parser
from irlx.notebook.typed_input import TypedInput

if TYPE_CHECKING:
    import argparse

    from irlx.job import CellGiven
    from irlx.program import Program
    from irlx.report.run import Run

_FILE = Path("notebook.irl")
"""Where the text would stand, in the working folder: its name is that of messages, notebook.toml a cell."""


def load_ipython_extension(shell: Any) -> None:
    """Make `%%irl` known to an IPython shell: what `%load_ext irlx` calls."""
    parser = magic_parser()

    def irl(line: str, body: str) -> Run | None:
        return _irl(shell, parser.parse_argstring(line), body)

    irl.__doc__ = parser.format_help()
    shell.register_magic_function(irl, "cell", "irl")


def _irl(shell: Any, options: argparse.Namespace, body: str) -> Run | None:
    """What the program in a cell has come to, None where nobody wants it; raises NotBegun."""
    if options.name is not None and not options.name.isidentifier():
        raise UsageError(f"%%irl --name {options.name}: no name of a variable")
    # The line of the magic is the first one of the cell: lines count as the notebook counts them.
    text = "\n" + body
    try:
        if options.check:
            _show(_checked(text, options))
            return None
        run = _run(text, options)
    except IrlxError as error:
        raise NotBegun(tuple(map(_in_a_notebook, error.diagnostics))) from None
    if options.name is not None:
        shell.push({options.name: run})
    return None if options.quiet else run


def _show(diagnostics: tuple[Diagnostic, ...]) -> None:
    if diagnostics:
        display(Findings(diagnostics))  # type: ignore[no-untyped-call]


def _in_a_notebook(found: Diagnostic) -> Diagnostic:
    """The finding, with what helps here."""
    return replace(found, help=_NO_CELL) if found.code == "IRL609" else found


_NO_CELL = "write %%irl --robot NAME (koch11, arm7, ..; irlx robots has all), or %%irl --cell C.toml"


def _checked(text: str, options: argparse.Namespace) -> tuple[Diagnostic, ...]:
    """Warnings of a text, lints as well. Raises IrlxError where there are errors."""
    from irlx.program import analyse_text

    found = analyse_text(text, _FILE, _cell(options)).diagnostics
    if any(one.is_error for one in found):
        raise IrlxError(found)
    if not found:
        print(f"{_FILE}: 0 errors, 0 warnings")
    return found


def _run(text: str, options: argparse.Namespace) -> Run:
    """The run, also one that ended in an error, which has been shown; raises IrlxError before it begins."""
    from irlx.report.run import RunError, RunInterrupted
    from irlx.running import run

    cell = _cell(options)
    program = _loaded(text, cell)
    try:
        finished = run(
            program,
            cell,
            options.tick,
            max_slow=options.max_slow,
            inputs=options.inputs,
            files=options.files,
            input=cast("Any", TypedInput()),
            output=sys.stdout,
        )
    except RunError as error:
        _show(error.diagnostics)
        return cast("Run", error.run)
    except RunInterrupted as interrupt:
        print("irlx: interrupted", file=sys.stderr)
        return cast("Run", interrupt.run)
    _show(finished.diagnostics)
    return finished


def _loaded(text: str, cell: CellGiven) -> Program:
    """The program; where its cell is at fault, that is told first: names of the cell are unknown then."""
    from irlx.cell.load import load_cell
    from irlx.program import ProgramError, load_text

    try:
        return load_text(text, _FILE, cell)
    except ProgramError:
        if isinstance(cell, str):
            load_cell(Path(cell))
        raise


def _cell(options: argparse.Namespace) -> CellGiven:
    if options.robot is None:
        return cast("CellGiven", options.cell)
    from irlx.cell.load import own_cell

    return own_cell(options.robot)
