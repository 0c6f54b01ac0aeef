"""Signs ``:=`` that a text has below each other stay so."""

from __future__ import annotations

from irlx.language.format.document import Doc, Fill, Group, Here, Line, Pad

__all__ = ["Alignment"]


class Alignment:
    """A run of lines whose ``:=`` stand below each other in the text."""

    def __init__(self) -> None:
        self._column: int | None = None
        self._members: list[tuple[Pad, int]] = []

    def add(self, target: Doc, column: int | None) -> Pad:
        """Blanks for a line whose sign has this column in the text; another one ends the run.

        None, for a sign that is not to be aligned, ends it as well, and so does a target that holds comments;
        `target` is all that stands before the blanks on its line.
        """
        width = _flat_width(target) if column is not None else None
        if column != self._column or width is None:
            self.close()
        pad = Pad()
        if width is not None:
            self._column = column
            self._members.append((pad, width))
        return pad

    def close(self) -> None:
        """End the run: from now on its blanks are known."""
        widest = max((width for _, width in self._members), default=0)
        for pad, width in self._members:
            pad.width = widest - width
        self._column, self._members = None, []


def _flat_width(doc: Doc) -> int | None:
    """Characters of a target on one line, or None where it holds comments."""
    width, todo = 0, [doc]
    while todo:
        top = todo.pop()
        if isinstance(top, str):
            width += len(top)
        elif isinstance(top, tuple):
            todo.extend(top)
        elif isinstance(top, Here | Group):
            todo.append(top.doc)
        elif isinstance(top, Fill):
            todo.extend(top.items)
            width += len(top.items) - 1
        elif isinstance(top, Line):
            width += len(top.flat)
        else:
            return None
    return width
