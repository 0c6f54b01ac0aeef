"""Function blocks <-> plain data (dictionaries, lists, strings, numbers), without loss.

The form of a block follows from its dataclass: one key a field, enumerations by value, tuples as
lists. ``type`` names the class of a block, and of a part where several classes may stand. A field with a
default may be missing: streams written before it existed stay readable.
"""

from __future__ import annotations

import types
from dataclasses import MISSING, fields, is_dataclass
from enum import Enum
from functools import cache
from math import isfinite
from typing import Any, Union, get_args, get_origin, get_type_hints

from irlx.blocks.block import Block, HaltBlock, Origin, PauseBlock
from irlx.blocks.criterion import CriterionBlock
from irlx.blocks.move import ArcCourse, MoveBlock
from irlx.blocks.obstacle import ObstacleBlock
from irlx.blocks.options import CyclicBlock, FreezeBlock, LimitSwitchBlock
from irlx.blocks.reconfigure import ReconfigureBlock
from irlx.blocks.signal import InputBlock, SignalBlock, WaitBlock
from irlx.blocks.tool import ToolBlock, WeightsBlock

BLOCK_TYPES: dict[str, type[Block]] = {
    kind.__name__: kind
    for kind in (
        MoveBlock,
        ReconfigureBlock,
        HaltBlock,
        PauseBlock,
        LimitSwitchBlock,
        FreezeBlock,
        CyclicBlock,
        CriterionBlock,
        ObstacleBlock,
        SignalBlock,
        InputBlock,
        WaitBlock,
        ToolBlock,
        WeightsBlock,
    )
}
"""Every block there is, by the name that its plain form carries."""

_ONCE_ALONE = {ArcCourse}
"""Parts that stood where they stand before there was anything else: streams of then do not name them."""

_AS_THEY_ARE = {float, int, str, bool, type(None)}
"""Values that are plain already, which most are."""

_NOT_FINITE = {"inf", "-inf", "nan"}


class BlockFormError(ValueError):
    """Plain data that is no block; the message names the key."""


def block_to_plain(block: Block) -> dict[str, Any]:
    """Plain form of a block that JSON can hold: infinite numbers become 'inf' and '-inf'."""
    plain: dict[str, Any] = _without_infinities(block_to_fields(block))
    return plain


def block_to_fields(block: Block) -> dict[str, Any]:
    """Plain form of a block with every float as it is."""
    return {"type": type(block).__name__, **_fields_of(block)}


def block_from_plain(plain: object) -> Block:
    """Block of a plain form, with or without infinite numbers as strings.

    Raises BlockFormError for anything that `block_to_plain` does not produce.
    """
    if not isinstance(plain, dict):
        raise BlockFormError(f"a block is a dictionary, found {plain!r}")
    rest = dict(plain)
    name = rest.pop("type", None)
    if not isinstance(name, str) or name not in BLOCK_TYPES:
        raise BlockFormError(f"type: no block is called {name!r}; known: {', '.join(BLOCK_TYPES)}")
    block = _dataclass_from(BLOCK_TYPES[name], rest, "")
    assert isinstance(block, Block)
    return block


def _fields_of(value: Any) -> dict[str, Any]:
    kind: Any = type(value)
    hints = _hints(kind)
    return {field.name: _encode(getattr(value, field.name), hints[field.name]) for field in fields(value)}


def _encode(value: Any, hint: Any) -> Any:
    if type(value) in _AS_THEY_ARE:
        return value
    if type(value) is tuple and all(type(item) is float for item in value):
        return list(value)
    if is_dataclass(value):
        tag = {"type": type(value).__name__} if _is_choice(hint) else {}
        return {**tag, **_fields_of(value)}
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, tuple):
        return [_encode(item, part) for item, part in zip(value, _parts(hint, len(value)), strict=True)]
    # Values that came out of arrays print and serialise like any other number.
    if isinstance(value, float):
        return float(value)
    return value if value is None or isinstance(value, bool | str) else int(value)


def _without_infinities(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_infinities(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_without_infinities(item) for item in value]
    return repr(value) if isinstance(value, float) and not isfinite(value) else value


@cache
def _hints(kind: Any) -> dict[str, Any]:
    return get_type_hints(kind)


@cache
def _alternatives(hint: Any) -> tuple[Any, ...]:
    return get_args(hint) if get_origin(hint) in {Union, types.UnionType} else (hint,)


@cache
def _is_choice(hint: Any) -> bool:
    """Whether more than one dataclass may stand here, so that the plain form must name it."""
    return sum(is_dataclass(option) for option in _alternatives(hint)) > 1


@cache
def _may_miss(kind: Any) -> dict[str, bool]:
    """Whether a field has a default, by its name."""
    return {field.name: field.default is not MISSING for field in fields(kind)}


@cache
def _asked(hint: Any) -> tuple[bool, tuple[Any, ...], tuple[Any, ...] | None]:
    """Whether None may stand here, what else, and the items where that is a tuple."""
    every = _alternatives(hint)
    options = tuple(option for option in every if option is not type(None))
    items = get_args(options[0]) if get_origin(options[0]) is tuple else None
    return len(options) < len(every), options, items


def _parts(hint: Any, count: int) -> tuple[Any, ...]:
    """Hints of the items of a tuple."""
    items = next(get_args(option) for option in _alternatives(hint) if get_origin(option) is tuple)
    return items[:1] * count if len(items) == 2 and items[1] is Ellipsis else items


def _dataclass_from(kind: Any, plain: object, where: str) -> Any:
    if not isinstance(plain, dict):
        raise BlockFormError(f"{where or 'block'}: needs a {kind.__name__}, found {plain!r}")
    hints = _hints(kind)
    optional = _may_miss(kind)
    for key in plain:
        if key not in optional:
            raise BlockFormError(f"{_join(where, str(key))}: a {kind.__name__} has no such field")
    values = {}
    for name, may_miss in optional.items():
        if name in plain:
            values[name] = _decode(hints[name], plain[name], _join(where, name))
        elif not may_miss:
            raise BlockFormError(f"{_join(where, name)}: missing")
    found = kind(**values)
    if isinstance(found, Origin) and not 0 <= found.start <= found.end:
        raise BlockFormError(f"{where}: needs 0 <= start <= end, found {found.start} and {found.end}")
    return found


def _join(where: str, name: str) -> str:
    return f"{where}.{name}" if where else name


def _decode(hint: Any, value: object, where: str) -> Any:
    may_be_none, options, items = _asked(hint)
    if value is None and may_be_none:
        return None
    if len(options) > 1:
        return _decode_choice(options, value, where)
    option = options[0]
    if items is not None:
        return _decode_tuple(items, value, where)
    if is_dataclass(option):
        return _dataclass_from(option, value, where)
    if issubclass(option, Enum):
        try:
            return option(value)
        except ValueError:
            known = ", ".join(str(member.value) for member in option)
            raise BlockFormError(f"{where}: {value!r} is none of {known}") from None
    return _decode_scalar(option, value, where)


def _decode_choice(options: tuple[type, ...], value: object, where: str) -> Any:
    rest = dict(value) if isinstance(value, dict) else {}
    name = rest.pop("type", None)
    for option in options:
        if option.__name__ == name or (name is None and isinstance(value, dict) and option in _ONCE_ALONE):
            return _dataclass_from(option, rest, where)
    known = ", ".join(option.__name__ for option in options)
    raise BlockFormError(f"{_join(where, 'type')}: {name!r} is none of {known}")


def _decode_tuple(items: tuple[Any, ...], value: object, where: str) -> tuple[Any, ...]:
    if not isinstance(value, list | tuple):
        raise BlockFormError(f"{where}: needs a list, found {value!r}")
    if len(items) == 2 and items[1] is Ellipsis:
        items = (items[0],) * len(value)
    if len(items) != len(value):
        raise BlockFormError(f"{where}: needs {len(items)} values, found {len(value)}")
    if items[:1] == (float,) and all(
        item is float and type(part) is float for item, part in zip(items, value, strict=True)
    ):
        # Most of what a stream holds.
        return tuple(value)
    return tuple(
        _decode(item, part, f"{where}.{number}")
        for number, (item, part) in enumerate(zip(items, value, strict=True), 1)
    )


def _decode_scalar(kind: type, value: object, where: str) -> object:
    if kind is float:
        if type(value) in {int, float}:
            return _to_float(value, where)
        if isinstance(value, str) and value in _NOT_FINITE:
            return float(value)
    elif type(value) is kind:
        return value
    raise BlockFormError(f"{where}: needs a {kind.__name__}, found {value!r}")


def _to_float(value: Any, where: str) -> float:
    try:
        return float(value)
    except OverflowError:
        raise BlockFormError(f"{where}: {value} is too large for a float") from None
