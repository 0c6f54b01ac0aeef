"""All lints of a text."""

from __future__ import annotations

from irlx.diagnostics import Diagnostic, SourceText
from irlx.language import tree
from irlx.language.checking import TypedText
from irlx.language.lints.bounds import crossed_bounds
from irlx.language.lints.closed_path import open_cycles
from irlx.language.lints.files import open_files
from irlx.language.lints.flow import flow_lints
from irlx.language.lints.unused import unused_names


def lints_of(
    root: tree.Program | tree.Module | tree.DataList, source: SourceText, typed: TypedText
) -> list[Diagnostic]:
    """Warnings on a whole text whose types have been checked."""
    if isinstance(root, tree.DataList):
        return []
    found = [*typed.lints, *flow_lints(root, source), *crossed_bounds(typed.facts, source)]
    found += open_files(root, typed, source)
    if isinstance(root, tree.Program):
        found += unused_names(typed, source)
        found += open_cycles(root, typed.facts, source)
    return found
