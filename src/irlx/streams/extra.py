"""Formats that need more than irlx installs: a missing package is told in one line."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from irlx.diagnostics import report
from irlx.streams.error import StreamError


def require(module: str, extra: str, path: Path, title: str) -> None:
    """Import `module` for the format `title` of `path`; `extra` of irlx installs it.

    Raises StreamError IRL720 where it is not installed.
    """
    try:
        import_module(module)
    except ImportError as cause:
        package, command = module.partition(".")[0], f"pip install 'irlx[{extra}]'"
        raise StreamError(
            report("IRL720", path=path, title=title, package=package, command=command)
        ) from cause
