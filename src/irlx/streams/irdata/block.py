"""Block records <-> records of the groups 3xx to 5xx, without loss.

Nested parts of a block become names with dots (``target.position``); lists of parts are numbered
from 1 (``limits.1.kind``).
"""

from __future__ import annotations

from typing import Any

from irlx.blocks.codec import BlockFormError, block_from_plain, block_to_fields
from irlx.streams.irdata.codes import BLOCK_CODES, BLOCK_OF_CODE
from irlx.streams.irdata.record import Record, RecordError, Value
from irlx.streams.joint_stream import BlockRecord


def block_operands(record: BlockRecord) -> tuple[int, dict[str, Value]]:
    """Code and operands of a block record; raises KeyError for a block that the format does not know."""
    fields = block_to_fields(record.block)
    code = BLOCK_CODES[fields.pop("type")]
    operands: dict[str, Value] = {"tick": int(record.tick)}
    _flatten("", fields, operands)
    return code, operands


def block_of(record: Record) -> BlockRecord:
    """Block record of a record; raises RecordError naming the operand that is wrong."""
    operands = record.fields()
    tick = operands.pop("tick", None)
    if type(tick) is not int or tick < 0:
        raise RecordError("tick: needs a count")
    tree: dict[str, Any] = {"type": BLOCK_OF_CODE[record.code]}
    for name, value in operands.items():
        _plant(tree, name, value)
    try:
        return BlockRecord(tick, block_from_plain(_with_lists(tree)))
    except BlockFormError as cause:
        raise RecordError(str(cause)) from cause


def _flatten(prefix: str, value: Any, into: dict[str, Value]) -> None:
    if isinstance(value, dict):
        for name, part in value.items():
            _flatten(f"{prefix}.{name}" if prefix else name, part, into)
    elif isinstance(value, list) and any(isinstance(part, dict) for part in value):
        for number, part in enumerate(value, 1):
            _flatten(f"{prefix}.{number}", part, into)
    else:
        into[prefix] = value


def _plant(tree: dict[str, Any], name: str, value: Value) -> None:
    *path, leaf = name.split(".")
    for part in path:
        tree = tree.setdefault(part, {})
        if not isinstance(tree, dict):
            raise RecordError(f"{name}: '{part}' is a value and has no parts")
    if leaf in tree:
        raise RecordError(f"{name}: given twice")
    tree[leaf] = value


def _with_lists(tree: Any) -> Any:
    """The tree with every dictionary whose keys are 1, 2, 3.. in order turned into a list."""
    if not isinstance(tree, dict):
        return tree
    parts = {name: _with_lists(part) for name, part in tree.items()}
    numbered = [str(number) for number in range(1, len(parts) + 1)]
    return list(parts.values()) if parts and list(parts) == numbered else parts
