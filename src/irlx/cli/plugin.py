"""Modules of the user's own that register criteria before a program runs."""

from __future__ import annotations

import sys
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path


def import_plugin(name: str) -> None:
    """Import a module by its name, searched in the working folder too, or a file that ends with .py.

    Raises IrlxError, IRL009, for whatever goes wrong in it.
    """
    from irlx.diagnostics import IrlxError, report

    try:
        if name.endswith(".py"):
            _import_file(Path(name))
        else:
            if "" not in sys.path:
                sys.path.insert(0, "")
            import_module(name)
    except Exception as error:
        # A plugin is anybody's code: all that it may raise is told the same way.
        cause = f"{type(error).__name__}: {error}"
        raise IrlxError(report("IRL009", name=name, cause=cause)) from error


def _import_file(path: Path) -> None:
    spec = spec_from_file_location(path.stem, path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} is no Python file")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
