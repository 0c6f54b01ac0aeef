"""The header of a stream <-> records of the groups 1xx and 2xx."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from irlx.streams.header_plain import LIMIT_SIDES, check_version, header_from_plain, header_to_plain
from irlx.streams.irdata import codes
from irlx.streams.irdata.record import Record, RecordError, Value
from irlx.streams.joint_stream import StreamHeader
from irlx.streams.making import Making

TITLE = "IRDATA-like joint stream"

_LAYOUT: tuple[tuple[int, dict[str, str]], ...] = (
    (codes.FORMAT, {"title": "", "version": "format_version"}),
    (codes.SOFTWARE, {"irlx": "irlx_version"}),
    (codes.PROGRAM, {"program": "program_name", "sha256": "program_sha256"}),
    (codes.CELL, {"cell": "cell_name"}),
    (codes.MAKING, {name: f"making.{name}" for name in Making.__dataclass_fields__}),
    (
        codes.ROBOT,
        {"robot": "robot_name", "model": "robot_model", "fingerprint": "robot_fingerprint", "tip": "tip"},
    ),
    (codes.CLOCK, {"joints": "", "tick_ns": "tick_ns"}),
)
"""Records before those of the joints: code, and of each operand the header's entry ('' if none)."""


def _layout_of(version: int) -> tuple[tuple[int, dict[str, str]], ...]:
    """The layout of a format version."""
    return _LAYOUT if version > 1 else tuple(entry for entry in _LAYOUT if entry[0] != codes.MAKING)


def header_records(header: StreamHeader) -> list[tuple[int, dict[str, Value]]]:
    """Code and operands of every record of a header, in order."""
    plain = header_to_plain(header)
    plain[""] = None
    plain |= {f"making.{name}": value for name, value in header.making.to_plain().items()}
    layouts = _layout_of(header.format_version)
    records = [(code, {name: plain[entry] for name, entry in layout.items()}) for code, layout in layouts]
    records[0][1]["title"] = TITLE
    records[-1][1]["joints"] = header.joints
    for joint in range(header.joints):
        bounds = {side: float(getattr(header.limits, side)[joint]) for side in LIMIT_SIDES}
        operands = {
            "name": header.joint_names[joint],
            "unit": header.joint_units[joint],
            "weight": float(header.weights[joint]),
            **bounds,
        }
        records.append((codes.JOINT, operands))
    return records


class HeaderParser:
    """Collects the records of a header one by one; `header` is there once the last joint has come."""

    def __init__(self) -> None:
        self.header: StreamHeader | None = None
        self._plain: dict[str, Any] = {}
        self._joints: list[dict[str, Value]] = []
        self._count = 0
        self._position = 0
        self._layout = _LAYOUT

    def add(self, record: Record) -> None:
        """Take the next record; raises RecordError, or PlainFormError where the entries do not fit."""
        in_layout = self._position < len(self._layout)
        code, layout = self._layout[self._position] if in_layout else (codes.JOINT, {})
        if record.code != code:
            raise RecordError(f"a record of code {code} is due here, found {record.code}")
        fields = record.fields()
        if in_layout:
            self._take(fields, layout)
        else:
            _same_names(fields, ("name", "unit", "weight", *LIMIT_SIDES))
            self._joints.append(fields)
        self._position += 1
        if self._position >= len(self._layout) and len(self._joints) == self._count:
            self._finish()

    def _take(self, fields: dict[str, Value], layout: dict[str, str]) -> None:
        _same_names(fields, tuple(layout))
        if fields.get("title", TITLE) != TITLE:
            raise RecordError(f"the title is not {TITLE!r}")
        if "joints" in fields:
            count = fields["joints"]
            if type(count) is not int or count < 0:
                raise RecordError("joints: needs a count")
            self._count = count
        for name, entry in layout.items():
            if entry:
                self._plain[entry] = fields[name]
        version = fields.get("version")
        if type(version) is int:
            check_version(version)
            self._layout = _layout_of(version)

    def _finish(self) -> None:
        joints = self._joints
        making = {name: self._plain.pop(f"making.{name}", None) for name in Making.__dataclass_fields__}
        if self._plain["format_version"] != 1:
            self._plain["making"] = making
        plain = {
            **self._plain,
            "joint_names": [joint["name"] for joint in joints],
            "joint_units": [joint["unit"] for joint in joints],
            "weights": [joint["weight"] for joint in joints],
            "limits": {side: [joint[side] for joint in joints] for side in LIMIT_SIDES},
        }
        self.header = header_from_plain(plain)


def _same_names(fields: dict[str, Value], wanted: Sequence[str]) -> None:
    if tuple(fields) != tuple(wanted):
        raise RecordError(f"its operands must be {', '.join(wanted)}; found {', '.join(fields) or 'none'}")
