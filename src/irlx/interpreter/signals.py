"""Signals of a program: what its names of inputs and outputs stand for."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from irlx.blocks import Port, SignalKind
from irlx.interpreter.errors import fail
from irlx.interpreter.expressions import Expressions
from irlx.interpreter.scope import Scope, Signal
from irlx.interpreter.types import BOOL, INT, REAL, Type
from irlx.language import tree
from irlx.language.builtins import is_analog_port, is_input_port, is_port_name

_KINDS: dict[str, tuple[SignalKind, Type]] = {
    "BOOL": (SignalKind.BOOL, BOOL),
    "INT": (SignalKind.INT, INT),
    "REAL": (SignalKind.REAL, REAL),
}
_MEDIA = {"DIGITAL": "BOOL", "ANALOG": "REAL"}


def declared_signals(
    part: tree.SignalDeclaration, expressions: Expressions, scope: Scope
) -> Iterator[Signal]:
    """Signals of a declaration. Raises InterpreterError: IRL222 for a type that no port carries."""
    source = expressions.source
    name = _MEDIA[part.medium] if part.medium is not None else ""
    if part.type is not None:
        found = scope.type(part.type.name.key)
        name = found.name if found is not None else part.type.name.name
        if name not in _KINDS:
            data = {"expected": "BOOL, INT or REAL for a signal", "found": name}
            raise fail("IRL222", source, part.type.span, **data)
    kind, type = _KINDS[name]
    is_input = part.direction == "INPUT"
    for signal in part.signals:
        number = expressions.whole(signal.port)
        if number < 0:
            data = {"param": "the number of a port", "expected": "0 or more", "value": str(number)}
            raise fail("IRL505", source, signal.port.span, **data)
        port = Port(_port_name(is_input, kind, number), kind)
        yield Signal(signal.name.name, type, _off(kind), port=port, is_input=is_input)


def port_signal(name: tree.Name) -> Signal | None:
    """The signal of a port that is used by its own name, as OUT_3; None for another name."""
    if not is_port_name(name.key):
        return None
    number = name.key.rpartition("_")[2]
    kind, type = _KINDS["REAL" if is_analog_port(name.key) else "BOOL"]
    is_input = is_input_port(name.key)
    port = Port(_port_name(is_input, kind, int(number)), kind)
    return Signal(name.name, type, _off(kind), port=port, is_input=is_input)


def _port_name(is_input: bool, kind: SignalKind, number: int) -> str:
    return f"{'' if kind is SignalKind.BOOL else 'A'}{'IN' if is_input else 'OUT'}_{number}"


def _off(kind: SignalKind) -> bool | int | float:
    return {SignalKind.BOOL: False, SignalKind.INT: 0, SignalKind.REAL: 0.0}[kind]


@dataclass(frozen=True)
class Watched:
    """Inputs that a condition reads, each by the names that its values may go by."""

    inputs: tuple[tuple[str, ...], ...]


def watched(condition: tree.Expression, expressions: Expressions) -> Watched:
    """Inputs that a condition may depend on: those it names, and all where it calls a routine."""
    scope = expressions.scope
    found: list[Signal] = []
    for node in tree.walk(condition):
        if isinstance(node, tree.Designator):
            signal = expressions.designators.signal(node.base)
            found += [signal] if signal is not None else []
        if expressions.is_routine(node):
            found += scope.signals()
    inputs = {signal.port.name: (signal.name, signal.port.name) for signal in found if signal.is_input}
    return Watched(tuple(inputs.values()))
