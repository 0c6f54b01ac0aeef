"""Modules that a text imports from: in which order they come, and circles of imports."""

from __future__ import annotations

from dataclasses import dataclass

from irlx.diagnostics import SourceText
from irlx.language import tree
from irlx.language.data_lists import ImportedList

__all__ = ["ImportedModule"]


@dataclass(frozen=True)
class ImportedModule:
    """A module that a program needs: the casefolded name that FROM uses, its text, tree and data lists."""

    key: str
    source: SourceText
    tree: tree.Module
    data_lists: tuple[ImportedList, ...] = ()
