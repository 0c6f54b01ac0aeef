"""irlx: robot programs in an IRL profile with redundancy clauses, turned into verified joint streams.

>>> import irlx
>>> run = irlx.run("square.irl")                        # doctest: +SKIP
>>> run.q.shape, run.summary.duration                   # doctest: +SKIP
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from irlx._version import __version__

if TYPE_CHECKING:
    from irlx.cell.errors import CellError
    from irlx.cell.robot_check.check import check_robot
    from irlx.checking import check
    from irlx.conversion import convert
    from irlx.diagnostics import Diagnostic, IrlxError
    from irlx.language.format import format_source
    from irlx.plotting import plot
    from irlx.program import Program, ProgramError, load
    from irlx.registration import register
    from irlx.report.outcome import Outcome
    from irlx.report.run import Run, RunError, RunInterrupted
    from irlx.reproduction import Reproduction, reproduce
    from irlx.robot.equality import Constraint
    from irlx.running import record, run, stream
    from irlx.streams.error import StreamError
    from irlx.streams.sample import Sample
    from irlx.transform.measures.measure import Measure as Criterion
    from irlx.verification import verify
    from irlx.verifier.findings.report import Report
    from irlx.viewer.view import view

_HOMES = {
    "CellError": "irlx.cell.errors",
    "Constraint": "irlx.robot.equality",
    "Criterion": "irlx.transform.measures.measure:Measure",
    "Diagnostic": "irlx.diagnostics",
    "IrlxError": "irlx.diagnostics",
    "Outcome": "irlx.report.outcome",
    "Program": "irlx.program",
    "ProgramError": "irlx.program",
    "Reproduction": "irlx.reproduction",
    "Report": "irlx.verifier.findings.report",
    "Run": "irlx.report.run",
    "RunError": "irlx.report.run",
    "RunInterrupted": "irlx.report.run",
    "Sample": "irlx.streams.sample",
    "StreamError": "irlx.streams.error",
    "check": "irlx.checking",
    "check_robot": "irlx.cell.robot_check.check",
    "convert": "irlx.conversion",
    "format_source": "irlx.language.format",
    "load": "irlx.program",
    "load_ipython_extension": "irlx.notebook.magic",
    "plot": "irlx.plotting",
    "record": "irlx.running",
    "register": "irlx.registration",
    "reproduce": "irlx.reproduction",
    "run": "irlx.running",
    "stream": "irlx.running",
    "verify": "irlx.verification",
    "view": "irlx.viewer.view",
}
"""Module of each public name; imported on first use, so that looking at a program stays light."""

__all__ = [
    "CellError",
    "Constraint",
    "Criterion",
    "Diagnostic",
    "IrlxError",
    "Outcome",
    "Program",
    "ProgramError",
    "Report",
    "Reproduction",
    "Run",
    "RunError",
    "RunInterrupted",
    "Sample",
    "StreamError",
    "__version__",
    "check",
    "check_robot",
    "convert",
    "format_source",
    "load",
    "plot",
    "record",
    "register",
    "reproduce",
    "run",
    "stream",
    "verify",
    "view",
]


def __getattr__(name: str) -> Any:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'irlx' has no attribute '{name}'")
    module, _, attribute = home.partition(":")
    return getattr(import_module(module), attribute or name)


def __dir__() -> list[str]:
    return __all__
