"""Notes of a run: each told once, however often a loop comes by."""

from __future__ import annotations

from irlx.diagnostics import Diagnostic


class Notes:
    """Adds notes to the findings of a run; the same one, with the same places, is not added again."""

    def __init__(self, found: list[Diagnostic]) -> None:
        self._found = found
        self._told: set[object] = set()

    def add(self, note: Diagnostic) -> None:
        """Add a note, if it is a new one."""
        key = (note.code, note.place, tuple(related.place for related in note.related))
        if key not in self._told:
            self._told.add(key)
            self._found.append(note)
