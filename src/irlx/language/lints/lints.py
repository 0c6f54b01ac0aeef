"""All lints of a text."""

from __future__ import annotations

from collections.abc import Sequence

from irlx.diagnostics import Diagnostic, SourceText
from irlx.language import tree
from irlx.language.checking import TypedText
from irlx.language.lints.blends import lost_blends
from irlx.language.lints.bounds import crossed_bounds
from irlx.language.lints.closed_path import open_cycles
from irlx.language.lints.files import open_files
from irlx.language.lints.flow import flow_lints
from irlx.language.lints.unused import unused_names

_ONCE = frozenset({"IRL312", "IRL313"})
"""Codes of what concerns a whole program: one place is enough."""


def first_of_each(findings: Sequence[Diagnostic]) -> list[Diagnostic]:
    """Findings in their order, of what concerns a whole program only the first."""
    kept, seen = [], set()
    for finding in findings:
        if finding.code not in _ONCE or finding.code not in seen:
            kept.append(finding)
        seen.add(finding.code)
    return kept


def lints_of(
    root: tree.Program | tree.Module | tree.DataList, source: SourceText, typed: TypedText
) -> list[Diagnostic]:
    """Warnings on a whole text whose types have been checked."""
    if isinstance(root, tree.DataList):
        return []
    found = [*typed.lints, *flow_lints(root, source), *crossed_bounds(typed.facts, source)]
    found += lost_blends(root, source)
    found += open_files(root, typed, source)
    if isinstance(root, tree.Program):
        found += unused_names(typed, source)
        found += open_cycles(root, typed.facts, source)
    return found
