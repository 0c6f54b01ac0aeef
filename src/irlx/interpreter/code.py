"""Bodies as steps: what a machine runs, and how one is put together with jumps between its steps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from irlx.diagnostics import SourceText, Span
from irlx.language import tree

Frame: TypeAlias = "list[Any]"
"""Local variables and temporary values of one call, by slot."""

Step: TypeAlias = "Callable[[Frame], int]"
"""One step of a body: does its work and gives the number of the next step, or a signal of the machine."""

MakeStep: TypeAlias = "Callable[..., Step]"
"""Gives a step once the numbers of the next step, and of the labels it was added with, are known."""


@dataclass
class Code:
    """Steps of a body; `spans` tell where in `source` each of them comes from.

    `blank` is a fresh frame; `values` the number of values that its variables hold.
    """

    source: SourceText
    steps: list[Step] = field(default_factory=list)
    spans: list[Span] = field(default_factory=list)
    blank: Frame = field(default_factory=list)
    values: int = 0


class Label:
    """A place in a body that steps may go to."""

    __slots__ = ("at",)

    def __init__(self) -> None:
        self.at = -1


@dataclass(frozen=True)
class _Entry:
    make: MakeStep | None
    labels: tuple[Label, ...]
    span: Span


class Assembler:
    """Puts the steps of a body together. Jumps cost no step of their own: whoever comes before goes there."""

    def __init__(self, code: Code) -> None:
        self.code = code
        self._entries: list[_Entry] = []

    def slot(self, value: object = None) -> int:
        """Number of a new slot of the frame, with what a fresh frame holds there."""
        self.code.blank.append(value)
        return len(self.code.blank) - 1

    def add(self, node: tree.Node, make: MakeStep, *labels: Label) -> None:
        """Add a step that comes from a node."""
        self._entries.append(_Entry(make, labels, node.span))

    def jump(self, node: tree.Node, label: Label) -> None:
        """Go on at a label."""
        self._entries.append(_Entry(None, (label,), node.span))

    def place(self, label: Label) -> None:
        """The next step to be added is where the label points to."""
        label.at = len(self._entries)

    @property
    def mark(self) -> tuple[int, int]:
        """What `undo` needs to forget everything that was added from here on."""
        return len(self._entries), len(self.code.blank)

    def undo(self, mark: tuple[int, int]) -> None:
        """Forget what was added since `mark`."""
        del self._entries[mark[0] :], self.code.blank[mark[1] :]

    def finish(self) -> None:
        """Make the steps; the last one must lead out of the body."""
        numbers, number = [], 0
        for entry in self._entries:
            numbers.append(number)
            number += entry.make is not None

        def target(at: int) -> int:
            while self._entries[at].make is None:
                at = self._entries[at].labels[0].at
            return numbers[at]

        last = len(self._entries) - 1
        for at, entry in enumerate(self._entries):
            if entry.make is not None:
                following = target(at + 1) if at < last else number
                step = entry.make(following, *(target(label.at) for label in entry.labels))
                self.code.steps.append(step)
                self.code.spans.append(entry.span)
