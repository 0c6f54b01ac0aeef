"""Headers and block records as plain data that JSON can hold, for the formats that carry JSON."""

from __future__ import annotations

from math import isnan
from typing import Any

import numpy as np

from irlx.blocks.codec import BlockFormError, block_from_plain, block_to_plain
from irlx.robot.limits import JointLimits
from irlx.streams.joint_stream import FORMAT_VERSION, BlockRecord, Floats, StreamHeader
from irlx.streams.making import Making

LIMIT_SIDES = (
    "position_lower",
    "position_upper",
    "speed_lower",
    "speed_upper",
    "acceleration_lower",
    "acceleration_upper",
)
"""The six arrays of `JointLimits`, in the order that files list them."""

_TEXTS = (
    "irlx_version",
    "program_name",
    "program_sha256",
    "cell_name",
    "robot_name",
    "robot_model",
    "robot_fingerprint",
    "tip",
)


LONGEST_TICK_NS = 2**62
"""Longest tick that files may have: times in ns fit an integer of 64 bits for a while."""


class PlainFormError(ValueError):
    """Plain data that is no header or record; the message names the key."""


class VersionError(PlainFormError):
    """A format version that this irlx does not read; `found` is what the file says."""

    def __init__(self, found: int) -> None:
        self.found = found
        super().__init__(f"format version {found}")


def header_to_plain(header: StreamHeader) -> dict[str, Any]:
    """Dictionary of a header; infinite limits become 'inf' and '-inf', all else stays as it is."""
    return {
        "format_version": header.format_version,
        **{name: getattr(header, name) for name in _TEXTS},
        "joint_names": list(header.joint_names),
        "joint_units": list(header.joint_units),
        "tick_ns": header.tick_ns,
        "limits": {side: _bounds_to_plain(getattr(header.limits, side)) for side in LIMIT_SIDES},
        "weights": list(header.weights),
        **({} if header.format_version == 1 else {"making": header.making.to_plain()}),
    }


def header_from_plain(plain: object) -> StreamHeader:
    """Header of what `header_to_plain` gives; raises PlainFormError (VersionError for other versions)."""
    fields = _dictionary(plain, "header")
    version = _typed(fields, "format_version", int)
    check_version(version)
    limits = _dictionary(fields.get("limits"), "limits")
    sides = {side: _bounds(limits.get(side), f"limits.{side}") for side in LIMIT_SIDES}
    known = {"format_version", *_TEXTS, "joint_names", "joint_units", "tick_ns", "limits", "weights"}
    known |= {"making"} if version > 1 else set()
    for key in [*(fields.keys() - known), *(limits.keys() - set(LIMIT_SIDES))]:
        raise PlainFormError(f"{key}: a header has no such entry")
    try:
        return StreamHeader(
            format_version=version,
            **{name: _typed(fields, name, str) for name in _TEXTS},
            joint_names=_texts(fields, "joint_names"),
            joint_units=_texts(fields, "joint_units"),
            tick_ns=_tick(fields),
            limits=JointLimits(**sides),
            weights=tuple(map(float, _bounds(fields.get("weights"), "weights"))),
            making=Making.from_plain(fields.get("making")) if version > 1 else Making(),
        )
    except PlainFormError:
        raise
    except ValueError as cause:
        raise PlainFormError(str(cause)) from cause


def check_version(version: int) -> None:
    """Raises VersionError for a format version that this irlx does not read."""
    if not 1 <= version <= FORMAT_VERSION:
        raise VersionError(version)


def record_to_plain(record: BlockRecord) -> dict[str, Any]:
    """Dictionary of a block record: its tick and the plain form of its block."""
    return {"tick": int(record.tick), "block": block_to_plain(record.block)}


def record_from_plain(plain: object) -> BlockRecord:
    """Block record of what `record_to_plain` gives; raises PlainFormError."""
    fields = _dictionary(plain, "record")
    if set(fields) != {"tick", "block"}:
        raise PlainFormError("a record has the entries tick and block")
    try:
        return BlockRecord(_typed(fields, "tick", int), block_from_plain(fields["block"]))
    except BlockFormError as cause:
        raise PlainFormError(str(cause)) from cause


def _bounds_to_plain(values: Floats) -> list[float | str]:
    return [value if np.isfinite(value) else repr(value) for value in values.tolist()]


def _dictionary(plain: object, where: str) -> dict[str, Any]:
    if not isinstance(plain, dict):
        raise PlainFormError(f"{where}: needs a dictionary")
    return plain


def _typed(fields: dict[str, Any], name: str, kind: type) -> Any:
    value = fields.get(name)
    if type(value) is not kind:
        raise PlainFormError(f"{name}: needs a value of type {kind.__name__}, found {value!r}")
    return value


def _tick(fields: dict[str, Any]) -> int:
    tick: int = _typed(fields, "tick_ns", int)
    if not 0 < tick <= LONGEST_TICK_NS:
        raise PlainFormError(f"tick_ns: needs 1 to {LONGEST_TICK_NS}")
    return tick


def _texts(fields: dict[str, Any], name: str) -> tuple[str, ...]:
    values = fields.get(name)
    if not isinstance(values, list) or not all(isinstance(value, str) for value in values):
        raise PlainFormError(f"{name}: needs a list of strings")
    return tuple(values)


def _bounds(values: object, where: str) -> Floats:
    if not isinstance(values, list):
        raise PlainFormError(f"{where}: needs a list of numbers")
    return np.array([_bound(value, where) for value in values], dtype=np.float64)


def _bound(value: object, where: str) -> float:
    if isinstance(value, str) and value in {"inf", "-inf"}:
        return float(value)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise PlainFormError(f"{where}: needs numbers, found {value!r}")
    try:
        number = float(value)
    except OverflowError:
        raise PlainFormError(f"{where}: a number is too large") from None
    if isnan(number):
        raise PlainFormError(f"{where}: needs numbers, found {value!r}")
    return number
