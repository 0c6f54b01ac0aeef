"""Lists with a value too many because a number in them has a comma: ``(500,5, 0, 400)``."""

from __future__ import annotations

from collections.abc import Container, Sequence

from irlx.language import tree


def numbers_with_commas(items: Sequence[tree.Argument], wanted: Container[int], text: str) -> str:
    """Help on a wrong number of values where commas without a blank behind them, in numbers, make it wrong.

    `wanted` are the numbers of values that would do. '' where other values are too many or missing.
    """
    numbers = []
    index = 1
    while index < len(items):
        before, after = items[index - 1], items[index]
        together = text[before.span.end : after.span.start] == ","
        if together and _whole(before) and isinstance(after, tree.IntLiteral):
            numbers.append(text[before.span.start : after.span.end].replace(",", "."))
            index += 1
        index += 1
    if not numbers or len(items) - len(numbers) not in wanted:
        return ""
    return f"numbers are written with a decimal point: {', '.join(numbers)}"


def _whole(node: tree.Argument) -> bool:
    """Whether an expression is a whole number, with a sign or without."""
    return isinstance(node.operand if isinstance(node, tree.Unary) else node, tree.IntLiteral)
