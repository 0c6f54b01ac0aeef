"""All that a replay page shows, as one JSON object; `docs/reference/page.md` says what stands in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import orjson
from numpy.typing import NDArray

from irlx._version import __version__
from irlx.blocks.text import block_text
from irlx.diagnostics import Diagnostic, report
from irlx.language.keywords import keyword_table
from irlx.report.appearance.build import TRIANGLES, appearance_of
from irlx.report.events import LimitActive, Slowed
from irlx.report.legible import legible
from irlx.report.replay.events import replay_events
from irlx.report.replay.frames import Columns
from irlx.report.replay.gathering import Gathered
from irlx.report.replay.names import words_of
from irlx.report.replay.scenery import Scenery
from irlx.report.replay.source import ReplaySource
from irlx.report.singularity import smallest_singular_values
from irlx.report.summary import Summary
from irlx.report.terminal import summary_text
from irlx.robot.limits import JointLimits
from irlx.streams.joint_stream import BlockRecord, StreamHeader

Plain = dict[str, Any]
FORMAT = "irlx page 1"
SMALL_TRIANGLES = 12_000
"""Triangles of a robot in a small page, for notebooks."""
_FINE, _COARSE = 9, 6
"""Decimals of positions and orientations, and of speeds and distances."""


@dataclass(frozen=True, eq=False)
class Replay:
    """What a page is made of: header, what was `found` going on, and what the run has come to."""

    header: StreamHeader
    found: Gathered
    source: ReplaySource
    summary: Summary
    events: Sequence[LimitActive | Slowed]
    diagnostics: Sequence[Diagnostic]


def replay_json(replay: Replay, small: bool = False) -> tuple[bytes, tuple[Diagnostic, ...]]:
    """JSON of a page, UTF-8, and what it lacks: IRL721, links not drawn as they are; IRL723, blocks."""
    looks = appearance_of(replay.source.cell, SMALL_TRIANGLES if small else TRIANGLES)
    plain = {**_head(replay, small), **_course(replay), **Scenery().plain(looks, replay.source.cell)}
    lacking = list(looks.diagnostics)
    listed, count = len(replay.found.records), replay.found.blocks
    if count > listed:
        lacking.append(report("IRL723", listed=f"{listed:,}", count=f"{count:,}"))
    plain["diagnostics"] = [_told(one) for one in (*replay.diagnostics, *lacking)]
    return _json(plain), tuple(lacking)


def _json(plain: Plain) -> bytes:
    options = orjson.OPT_SERIALIZE_NUMPY | orjson.OPT_NON_STR_KEYS
    try:
        return orjson.dumps(plain, option=options)
    except orjson.JSONEncodeError:
        # Names of files need not be text, and stand in many a place.
        return orjson.dumps(_legible(plain), option=options)


def _legible(value: Any) -> Any:
    """The same with all texts legible."""
    if isinstance(value, str):
        return legible(value)
    if isinstance(value, dict):
        return {key: _legible(entry) for key, entry in value.items()}
    return [_legible(entry) for entry in value] if isinstance(value, list | tuple) else value


def _told(diagnostic: Diagnostic) -> str:
    """Lines of a diagnostic: what, and what would help."""
    words = words_of(diagnostic)
    return f"{words}\n  help: {diagnostic.help}" if diagnostic.help else words


def _head(replay: Replay, small: bool) -> Plain:
    header, source, summary = replay.header, replay.source, replay.summary
    keywords = sorted(word.upper() for word in keyword_table())
    return {
        "format": FORMAT,
        "irlx": __version__,
        "title": header.program_name,
        "small": small,
        "complete": summary.complete,
        "program": {"name": header.program_name, "text": source.program_text, "keywords": keywords},
        "cell": {"name": header.cell_name},
        "summary": {
            "text": summary_text(summary),
            "plain": summary.to_plain(),
        },
        "tick_s": header.dt,
        "ticks_per_frame": replay.found.frames.every,
        "joints": [
            {"name": name, "unit": unit}
            for name, unit in zip(header.joint_names, header.joint_units, strict=True)
        ],
    }


def _course(replay: Replay) -> Plain:
    """What changes in time."""
    header, found = replay.header, replay.found
    columns = found.frames.columns
    tools = [{"tick": 0, "xyz": (0.0, 0.0, 0.0), "quat": (0.0, 0.0, 0.0, 1.0)}]
    tools += [{"tick": tick, "xyz": tool.position, "quat": tool.orientation} for tick, tool in found.tools]
    singular = smallest_singular_values(replay.source.cell.robot, found.records, columns.tick, columns.q)
    errors = [one for one in replay.diagnostics if one.is_error]
    return {
        "frames": {**_frames(columns), "singular": _rounded(singular, _FINE)},
        "pairs": [{"link": link, "other": other, "margin": margin} for link, other, margin in found.pairs],
        "limits": [{"tick": tick, **_limits(limits)} for tick, limits in found.limits],
        "tools": tools,
        "blocks": [_block(record, header) for record in found.records],
        "events": replay_events(header, found, replay.events, errors),
    }


def _frames(columns: Columns) -> Plain:
    return {
        "tick": columns.tick,
        "line": columns.line,
        "q": _rounded(columns.q.T, _FINE),
        "speed": _rounded(columns.speed.T, _COARSE),
        "tool": _rounded(columns.tool.T, _FINE),
        "tool_speed": _rounded(columns.tool_speed, _COARSE),
        "turn_speed": _rounded(columns.turn_speed, _COARSE),
        "clearance": _rounded(columns.distance, _COARSE),
        "nearest": columns.pair,
        "watched": _watched(columns),
    }


def _watched(columns: Columns) -> NDArray[np.bool_]:
    """Where anything is kept clear; of the start, in which nobody looks, what holds in the next frame."""
    return np.append(columns.watched[1:2], columns.watched[1:]) if len(columns.tick) > 1 else columns.watched


def _rounded(values: NDArray[np.float64], decimals: int) -> NDArray[np.float64]:
    """Contiguous, and without negative zeros; infinite numbers become null in JSON."""
    return np.ascontiguousarray(np.round(values, decimals) + 0.0)


def _limits(limits: JointLimits) -> Plain:
    return {kind: list(limits.pair(kind)) for kind in ("position", "speed", "acceleration")}


def _block(record: BlockRecord, header: StreamHeader) -> Plain:
    block = record.block
    number, words = block_text(block, header.joint_units).split(" ", 1)
    plain: Plain = {"tick": record.tick, "id": int(number), "line": block.origin.line}
    plain["text"] = words.rpartition(" line ")[0]
    if block.origin.file != header.program_name:
        plain["file"] = block.origin.file
    return plain
