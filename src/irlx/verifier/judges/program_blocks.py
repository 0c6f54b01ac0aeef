"""Check of a stream's blocks against those that its program gives."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from irlx.blocks import Block
from irlx.blocks.codec import block_to_plain
from irlx.diagnostics import IrlxError
from irlx.promises import SAME_NUMBER
from irlx.streams.joint_stream import BlockRecord
from irlx.verifier.outline import Outline

_NOTHING = object()


class Unanswerable(Exception):
    """A program asked what no stream can answer: its blocks from here on are not known."""


def blocks_differ(outline: Outline, given: Iterable[Block]) -> str:
    """Words on the first block of a stream that is not the one that the program gives, or ''.

    A stream that ended early may have fewer; behind an `Unanswerable` question nothing is compared.
    `given` is asked for no more blocks than it takes to tell; that it raises an error is a difference only
    where the stream goes on.
    """
    source = iter(given)
    for record in outline.records:
        try:
            due = next(source, None)
        except Unanswerable:
            return ""
        except IrlxError as error:
            return f"{_named(record)}: the program ends before it, in {error.diagnostics[0].code}"
        if due is None:
            return f"{_named(record)}: the program ends before it"
        found = _difference(block_to_plain(record.block), block_to_plain(due))
        if found:
            return f"{_named(record)}: {found}"
    return _missing(outline, source) if outline.complete else ""


def _missing(outline: Outline, source: Iterator[Block]) -> str:
    """Words on a block that the program gives behind the last one of a stream, or ''."""
    last = outline.rows - 1
    try:
        block = next(source, None)
    except Unanswerable:
        return ""
    except IrlxError as error:
        return f"at tick {last}, the end: the program ends in {error.diagnostics[0].code}"
    if block is None:
        return ""
    return f"at tick {last}, the end: the program goes on with block {block.id}, line {block.origin.line}"


def _named(record: BlockRecord) -> str:
    return f"at tick {record.tick}, block {record.block.id}, line {record.block.origin.line}"


def _difference(found: Any, due: Any, path: str = "") -> str:
    """Words on the first part in which two plain forms differ, or ''."""
    if isinstance(found, dict) and isinstance(due, dict):
        for name in {**found, **due}:
            part = f"{path}.{name}" if path else name
            words = _difference(found.get(name, _NOTHING), due.get(name, _NOTHING), part)
            if words:
                return words
        return ""
    if isinstance(found, list) and isinstance(due, list) and len(found) == len(due):
        pairs = enumerate(zip(found, due, strict=True), 1)
        return next((words for i, pair in pairs if (words := _difference(*pair, f"{path}.{i}"))), "")
    if _same(found, due):
        return ""
    return f"{path} is {_text(found)} in the stream, {_text(due)} from the program"


def _same(found: object, due: object) -> bool:
    numbers = isinstance(found, float) and isinstance(due, float)
    if not numbers:
        return type(found) is type(due) and found == due
    assert isinstance(found, float)
    assert isinstance(due, float)
    return found == due or abs(found - due) <= SAME_NUMBER * max(1.0, abs(due))


def _text(value: object) -> str:
    if value is _NOTHING or value is None:
        return "nothing"
    return f"{value:.10g}" if isinstance(value, float) else str(value)
