"""Documents to lines: which groups are broken, and where comments at line ends stand."""

from __future__ import annotations

from dataclasses import dataclass, field

from irlx.language.format.document import HARD, Doc, Fill, Group, Hard, Here, Indent, Line, Pad, Remark

__all__ = ["WIDTH", "Row", "render", "shifted"]

WIDTH = 110
"""Columns that a line may have where it can be broken."""

_CLOSING = tuple(",;:.)]")


@dataclass
class Row:
    """One line, and the comments that stand behind it."""

    code: str
    remarks: list[Remark] = field(default_factory=list)


@dataclass(frozen=True)
class _Rest:
    """The items of a Fill that are still to come."""

    items: tuple[Doc, ...]
    index: int


_Entry = tuple[int, bool, "Doc | _Rest"]
"""Indentation, whether lines are line ends, and what is to be printed."""


def render(doc: Doc) -> list[Row]:
    """Choose the lines of a document."""
    renderer = _Renderer()
    renderer.run(doc)
    return renderer.rows


def shifted(remark: Remark, column: int) -> str:
    """Text of a comment that begins at `column` now; its further lines move along as far as they can."""
    first, *others = remark.text.split("\n")
    by = column - remark.column
    moved = [first]
    for line in others:
        bare = line.lstrip(" ")
        moved.append(" " * max(len(line) - len(bare) + by, 0) + bare if bare else line)
    return "\n".join(moved)


class _Renderer:
    def __init__(self) -> None:
        self.rows: list[Row] = []
        self._code = ""
        self._ends: list[Remark] = []
        self._column = 0
        self._blank_due = False
        self._stack: list[_Entry] = []

    def run(self, doc: Doc) -> None:
        stack = self._stack
        stack.append((0, True, doc))
        while stack:
            indent, broken, top = stack.pop()
            if isinstance(top, str):
                self._text(top)
            elif isinstance(top, tuple):
                stack.extend([(indent, broken, part) for part in reversed(top)])
            elif isinstance(top, Indent):
                stack.append((indent + 2, broken, top.doc))
            elif isinstance(top, Here):
                stack.append((self._column, broken, top.doc))
            elif isinstance(top, Group):
                flat = not top.broken and self._fits(top.doc, len(stack))
                stack.append((indent, not flat, top.doc))
            elif isinstance(top, Fill):
                stack.append((indent, broken, _Rest(top.items, 0)))
            elif isinstance(top, _Rest):
                self._fill(indent, top)
            else:
                self._leaf(indent, broken, top)
        self._new_line(0)

    def _leaf(self, indent: int, broken: bool, leaf: Line | Hard | Pad | Remark) -> None:
        if isinstance(leaf, Pad):
            self._text(" " * leaf.width)
        elif isinstance(leaf, Remark):
            self._remark(leaf, indent)
        elif isinstance(leaf, Line) and not broken:
            self._text(leaf.flat)
        else:
            self._new_line(indent)

    def _fill(self, indent: int, rest: _Rest) -> None:
        item = rest.items[rest.index]
        last = rest.index + 1 == len(rest.items)
        fits = self._fits((" ", item) if rest.index else item, len(self._stack) if last else 0)
        if rest.index and (self._ends or not fits):
            self._new_line(indent)
            fits = self._fits(item, len(self._stack) if last else 0)
        elif rest.index:
            self._text(" ")
        if not last:
            self._stack.append((indent, True, _Rest(rest.items, rest.index + 1)))
        self._stack.append((indent, not fits, item))

    def _text(self, text: str) -> None:
        if not text:
            return
        if self._blank_due and (text == ":=" or not text.startswith((*_CLOSING, " "))):
            text = f" {text}"
        self._blank_due = False
        self._code = (self._code or " " * self._column) + text
        self._column = len(self._code)

    def _new_line(self, indent: int) -> None:
        if self._code or self._ends or self.rows:
            self.rows.append(Row(self._code.rstrip(), self._ends))
        self._code, self._ends, self._column, self._blank_due = "", [], indent, False

    def _remark(self, remark: Remark, indent: int) -> None:
        if remark.where == "end":
            self._ends.append(remark)
            return
        waiting, self._ends = self._ends, []
        for one in waiting:
            self._inline(one)
        if remark.where == "line":
            self._comment(remark)
        elif remark.where == "own" and not self._code:
            self._comment(remark)
            self._new_line(indent)
        else:
            self._inline(remark)

    def _inline(self, remark: Remark) -> None:
        if self._code and not self._code.endswith((" ", "(", "[")):
            self._text(" ")
        self._comment(remark)
        self._blank_due = True

    def _comment(self, remark: Remark) -> None:
        self._blank_due = False
        first, *others = shifted(remark, self._column).split("\n")
        self._text(first)
        for line in others:
            # As it is: what ends a line of a comment belongs to the comment.
            self.rows.append(Row(self._code))
            self._code = line
            self._column = len(line)

    def _fits(self, doc: Doc, rest: int) -> bool:
        """Whether a document fits flat into the rest of the line, with what follows up to a line end.

        `rest` entries of the stack follow it.
        """
        room = WIDTH - self._column
        waiting = bool(self._ends)
        todo: list[tuple[bool, Doc | _Rest]] = [(False, doc)]
        following = False
        while room >= 0:
            if not todo:
                if rest == 0:
                    return True
                rest -= 1
                following = True
                _, broken, after = self._stack[rest]
                todo.append((broken, after))
                continue
            broken, top = todo.pop()
            if isinstance(top, str):
                room -= len(top)
                continue
            if isinstance(top, tuple):
                todo.extend([(broken, part) for part in reversed(top)])
                continue
            parts = _parts(broken, top, following)
            if parts is not None:
                todo.extend(reversed(parts))
            elif isinstance(top, Line):
                if broken or waiting:
                    return broken
                room -= len(top.flat)
            elif _ends_line(top):
                return following
            elif isinstance(top, Remark) and top.where == "end":
                waiting = True
            else:
                room -= _width(top)
        return False


def _parts(broken: bool, doc: Doc | _Rest, following: bool) -> list[tuple[bool, Doc | _Rest]] | None:
    """What a document that holds others consists of, each with whether its lines are line ends."""
    if isinstance(doc, Indent | Here):
        return [(broken, doc.doc)]
    if isinstance(doc, Group):
        return [(False, HARD)] if doc.broken and not following else [(doc.broken, doc.doc)]
    if isinstance(doc, Fill):
        # What follows may be broken at any of its blanks; what is looked at has to fit as a whole.
        parts = [part for item in doc.items for part in (Line(), item)][1:]
        return [(following, part) for part in parts]
    return None


def _ends_line(doc: Doc | _Rest) -> bool:
    if isinstance(doc, Remark):
        return doc.where == "own" or (doc.where != "end" and "\n" in doc.text)
    return isinstance(doc, Hard | _Rest)


def _width(doc: Doc | _Rest) -> int:
    if isinstance(doc, Pad):
        return doc.width
    # A comment, with the blank before it.
    return len(doc.text) + 1 if isinstance(doc, Remark) else 0
