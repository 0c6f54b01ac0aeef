"""Limits whose lower bound lies above the upper one, where the text tells both."""

from __future__ import annotations

from collections.abc import Iterator

from irlx.diagnostics import Diagnostic, Place, SourceText, report, told_apart
from irlx.language.checking.context import Facts
from irlx.language.lints.settled import value_of


def crossed_bounds(facts: Facts, source: SourceText) -> Iterator[Diagnostic]:
    """A warning at the lower bounds of every such limit, for its first joint."""
    for node, lower, upper in facts.limits:
        lows, highs = value_of(lower), value_of(upper)
        if not isinstance(lows, tuple) or not isinstance(highs, tuple):
            continue
        for joint, (low, high) in enumerate(zip(lows, highs, strict=False), 1):
            if isinstance(low, int | float) and isinstance(high, int | float) and low > high:
                place = Place.in_text(source, node.lower.span)
                shown = told_apart(low, high)
                yield report("IRL310", place, joint=joint, low=shown[0], high=shown[1])
                break
