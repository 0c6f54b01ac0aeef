"""What a run did with signals, in the order of time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from irlx.blocks import InputBlock, SignalBlock, SignalKind
from irlx.streams.joint_stream import BlockRecord


@dataclass(frozen=True)
class Signal:
    """An output that was set, or an input that was read (`is_input`), at a tick and its time, s."""

    tick: int
    time: float
    port: str
    value: bool | int | float
    is_input: bool


def signals_of(records: Sequence[BlockRecord], dt: float) -> tuple[Signal, ...]:
    """Signals of recorded blocks."""
    found = []
    for record in records:
        block = record.block
        if isinstance(block, SignalBlock | InputBlock):
            value = _value(block)
            is_input = isinstance(block, InputBlock)
            found.append(Signal(record.tick, record.tick * dt, block.port.name, value, is_input))
    return tuple(found)


def _value(block: SignalBlock | InputBlock) -> bool | int | float:
    if block.port.kind is SignalKind.BOOL:
        return bool(block.value)
    return int(block.value) if block.port.kind is SignalKind.INT else block.value
