"""Commands that need more than irlx installs: a missing package is told in one line."""

from __future__ import annotations

from importlib import import_module

from irlx.diagnostics.diagnostic import report
from irlx.diagnostics.error import IrlxError


def require_extra(command: str, extra: str, *modules: str) -> None:
    """Import `modules`, which `command` needs; `extra` of irlx installs their packages.

    Raises IrlxError IRL010 that names the first package that is not installed.
    """
    for module in modules:
        try:
            import_module(module)
        except ImportError as cause:
            package = module.partition(".")[0]
            raise IrlxError(report("IRL010", command=command, extra=extra, package=package)) from cause
