"""Modules that a text imports from: what there is to know of them, and what keeps them from being used."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from irlx.diagnostics import Diagnostic, Place, Related, SourceText, Span, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.language import tree
from irlx.language.data_lists import ImportedList

__all__ = ["ImportedModule", "ModuleProblem", "exported", "missing_exports", "no_module"]


@dataclass(frozen=True)
class ImportedModule:
    """A module that a program needs: the casefolded name that FROM uses, its text, tree and data lists."""

    key: str
    source: SourceText
    tree: tree.Module
    data_lists: tuple[ImportedList, ...] = ()


class ModuleProblem(Exception):
    """Why a module cannot be used: a code of the catalogue and its data; told at the FROM."""

    def __init__(self, code: str, **data: Any) -> None:
        super().__init__(code)
        self.code, self.data = code, data


def exported(root: tree.Module) -> list[tree.Name]:
    """Names that a module exports, to whomever."""
    return [name for part in root.declarations if isinstance(part, tree.Export) for name in part.names]


def missing_exports(
    declaration: tree.ImportFrom, root: tree.Module, file: str, source: SourceText
) -> list[Diagnostic]:
    """Findings on names that a text imports and the module `root`, in a file, does not export."""
    exports = exported(root)
    keys = {name.key for name in exports}
    findings = []
    for name in declaration.names:
        if name.key and name.key not in keys:
            near = near_matches(name.name, [export.name for export in exports])
            place = Place.in_text(source, name.span)
            findings.append(report("IRL219", place, name=name.name, file=file, near=near))
    return findings


def no_module(
    declaration: tree.ImportFrom,
    found: SourceText,
    root: tree.Program | tree.Module | tree.DataList | None,
    source: SourceText,
) -> Sequence[Diagnostic]:
    """Findings on a file that holds something else than the module of the name it is asked by."""
    name, here = declaration.module, Place.in_text(source, declaration.module.span)
    related = (Related("imported here", here),)
    if root is None:
        return [report("IRL262", Place(found.name), related=related, found="text that is none")]
    place = Place.in_text(found, root.name.span)
    if not isinstance(root, tree.Module):
        whole = Place.in_text(found, Span(root.span.start, root.name.span.end))
        words = f"{type(root).__name__.upper()} {root.name.name}"
        return [report("IRL262", whole, related=related, found=words)]
    if root.name.key and root.name.key != name.key:
        return [report("IRL263", place, related=related, found=root.name.name, name=name.name)]
    return []
