"""The formats that findings can be printed in for other programs, by name."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import TypeAlias

from irlx.diagnostics.concise import render_concise
from irlx.diagnostics.diagnostic import Diagnostic
from irlx.diagnostics.github import render_github
from irlx.diagnostics.plain import plain_diagnostic
from irlx.diagnostics.sarif import sarif_log

__all__ = ["MACHINE_FORMATS", "Rendering"]

Rendering: TypeAlias = Callable[[Sequence[Diagnostic]], str]
"""Findings to text; ends without a line end, and is empty where there is nothing to print."""


def _lines(render: Callable[[Diagnostic], str]) -> Rendering:
    return lambda diagnostics: "\n".join(render(diagnostic) for diagnostic in diagnostics)


def _json(diagnostics: Sequence[Diagnostic]) -> str:
    return json.dumps([plain_diagnostic(diagnostic) for diagnostic in diagnostics], indent=2)


def _sarif(diagnostics: Sequence[Diagnostic]) -> str:
    return json.dumps(sarif_log(diagnostics), indent=2)


MACHINE_FORMATS: Mapping[str, Rendering] = MappingProxyType(
    {"concise": _lines(render_concise), "json": _json, "sarif": _sarif, "github": _lines(render_github)}
)
"""Every format but ``text``, which goes to people and therefore to stderr."""
