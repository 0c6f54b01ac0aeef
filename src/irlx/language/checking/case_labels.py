"""Values after WHEN that are empty or chosen already."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeAlias

from irlx.diagnostics import Place, Related
from irlx.language import tree
from irlx.language.checking.names import Constant

Label: TypeAlias = "tuple[tree.Expression | tree.Range, Constant | None, Constant | None]"
"""A label with the lowest and highest value that it chooses, as far as the text tells."""


def twice_chosen(
    labels: list[Label], text_of: Callable[[tree.Node], str], place_of: Callable[[tree.Node], Place]
) -> Iterator[tuple[str, tree.Node, dict[str, Any], tuple[Related, ...]]]:
    """Code, label, data and second place of every finding on the labels of a CASE."""
    known: list[Label] = []
    for label, low, high in labels:
        if type(low) is not type(high) or not isinstance(low, int | str) or not isinstance(high, int | str):
            continue
        if low > high:  # type: ignore[operator]
            yield "IRL508", label, {"low": low, "high": high}, ()
        else:
            known.append((label, low, high))
    for later, first in _overlaps(known):
        related = (Related("chosen here first", place_of(first)),)
        yield "IRL252", later, {"label": text_of(later)}, related


def _overlaps(labels: list[Label]) -> list[tuple[tree.Node, tree.Node]]:
    """Pairs of labels, the later and the earlier of each, that choose a value both."""
    found = []
    widest: Label | None = None
    kind = type(labels[0][1]) if labels else None
    for label in sorted((one for one in labels if type(one[1]) is kind), key=lambda one: one[1]):  # type: ignore[arg-type, return-value]
        if widest is not None and label[1] <= widest[2]:  # type: ignore[operator]
            pair = sorted((label[0], widest[0]), key=lambda node: node.span.start)
            found.append((pair[1], pair[0]))
        if widest is None or label[2] > widest[2]:  # type: ignore[operator]
            widest = label
    return sorted(found, key=lambda pair: pair[0].span.start)
