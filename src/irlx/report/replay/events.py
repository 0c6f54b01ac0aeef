"""What happened in a run, each a span of ticks and a sentence."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from math import degrees
from pathlib import Path
from typing import Any

import numpy as np

from irlx.blocks import PauseBlock, WaitBlock
from irlx.blocks.text import block_text
from irlx.diagnostics import Diagnostic
from irlx.report.events import LimitActive, Slowed
from irlx.report.message import Message
from irlx.report.replay.gathering import MOST_SHOWN, Gathered
from irlx.report.replay.names import words_of
from irlx.report.signals import signals_of
from irlx.report.terminal import PER, joint_value
from irlx.report.unreached import unreached_time
from irlx.robot.limits import JointLimits
from irlx.streams.joint_stream import StreamHeader

Event = dict[str, Any]


def replay_events(
    header: StreamHeader,
    found: Gathered,
    told: Sequence[LimitActive | Slowed],
    errors: Sequence[Diagnostic],
) -> list[Event]:
    """Plain events in the order of time; `told` are those of the run, `errors` what ended it."""
    units = dict(zip(header.joint_names, header.joint_units, strict=True))
    numbers = {name: number for number, name in enumerate(header.joint_names)}
    events = [_told(event, units, numbers, found.limits) for event in told]
    events += [*_nearest(found), *_signals(header, found), *_waits(found)]
    events += [_message(message) for message in found.messages]
    last = max(found.rows - 1, 0)
    events += [_stop(last, header, error) for error in errors]
    return sorted(events, key=lambda event: (event["first"], event["last"]))


def _event(
    kind: str, first: int, last: int, label: str, text: str, line: int | None = None, joint: int | None = None
) -> Event:
    span = {"kind": kind, "first": first, "last": last, "line": line, "joint": joint}
    return {**span, "label": label, "text": text}


def _told(
    event: LimitActive | Slowed,
    units: Mapping[str, str],
    numbers: Mapping[str, int],
    limits: Sequence[tuple[int, JointLimits]],
) -> Event:
    first, last = event.first_tick, event.last_tick
    joint = numbers.get(event.joint)
    if isinstance(event, Slowed):
        why = f"slowed by {event.joint} {event.kind}" if event.joint else "slowed"
        words = _slowing(event, units)
        return _event("slowed", first, last, why, words, event.line, joint)
    braking = event.kind == "braking"
    kind = "position" if braking else event.kind
    bound = _bound(limits, first, kind, event.side, numbers[event.joint])
    value = joint_value(bound, units[event.joint], PER[kind])
    limit = f"{event.side} {kind} limit"
    verb = "brakes before its" if braking else "is held by its"
    label = f"{event.joint} {'before' if braking else 'at'} its {limit}"
    words = f"{event.joint} {verb} {limit}, {value}, {_times(event.first_time, event.last_time)}"
    return _event("limit", first, last, label, words, joint=joint)


def _slowing(event: Slowed, units: Mapping[str, str]) -> str:
    """How slow, where and why the tool was slower than programmed."""
    unit, scale = ("deg", degrees(1.0)) if event.turns else ("mm", 1000.0)
    requested, achieved, way = (f"{v * scale:.4g}" for v in (event.requested, event.achieved, event.way))
    why = ""
    if event.joint:
        bound = joint_value(event.bound, units[event.joint], PER[event.kind])
        why = f": {event.joint} {event.kind} limit {bound}"
    times = _times(event.first_time, event.last_time)
    over = "" if event.first_line == event.last_line else f" (lines {event.first_line} to {event.last_line})"
    words = f"the tool is slower than programmed{over}, {times}, by {event.lost:.3g} s"
    return f"{words}; slowest at {way} {unit} of its way, {achieved} of {requested} {unit}/s{why}"


def _times(first: float, last: float) -> str:
    return f"at {first:.6g} s" if first == last else f"{first:.6g} to {last:.6g} s"


def _bound(limits: Sequence[tuple[int, JointLimits]], tick: int, kind: str, side: str, joint: int) -> float:
    """A bound in force at a tick."""
    ticks = [start for start, _ in limits]
    own = limits[max(bisect_right(ticks, tick) - 1, 0)][1]
    return float(own.pair(kind)[side == "upper"][joint])


def _nearest(found: Gathered) -> Iterator[Event]:
    """Of each obstacle, and of each pair of links, the frame with the least room."""
    if not found.pairs:
        return
    columns = found.frames.columns
    names = list(found.pairs)
    best: dict[str, int] = {}
    for row in np.flatnonzero(columns.pair >= 0).tolist():
        other = names[int(columns.pair[row])][1]
        if other not in best or columns.room[row] < columns.room[best[other]]:
            best[other] = row
    for other, row in best.items():
        link, _, margin = names[int(columns.pair[row])]
        distance, tick = float(columns.distance[row]), int(columns.tick[row])
        words = f"{link} comes within {distance * 1e3:.4g} mm of {other}, its nearest"
        words += f"; {margin * 1e3:.4g} mm are kept clear"
        yield _event("nearest", tick, tick, f"{link} nearest to {other}", words)


def _signals(header: StreamHeader, found: Gathered) -> Iterator[Event]:
    for signal in signals_of(found.records, header.dt):
        value = str(signal.value).upper() if isinstance(signal.value, bool) else f"{signal.value:g}"
        words = f"{signal.port} {'says' if signal.is_input else 'is set to'} {value}"
        yield _event("signal", signal.tick, signal.tick, f"{signal.port} = {value}", words)


def _waits(found: Gathered) -> Iterator[Event]:
    """Waits and pauses; those of one statement, which looks again and again, are one."""
    open_one: Event | None = None
    for record, last in found.waits:
        block = record.block
        assert isinstance(block, WaitBlock | PauseBlock)
        condition = block.condition if isinstance(block, WaitBlock) else ""
        line = block.origin.line
        if open_one is not None:
            if condition and open_one["line"] == line and open_one["last"] == record.tick:
                open_one["last"] = last
                continue
            yield open_one
        word = "WAIT FOR" if condition else ("WAIT" if isinstance(block, WaitBlock) else "PAUSE")
        label = f"{word} {condition}".strip() if condition else block_text(block, ()).split(" ", 1)[1]
        label = label if condition else label.rpartition(" line ")[0]
        open_one = _event("wait", record.tick, last, label, f"the robot stands: {label}", line)
    if open_one is not None:
        yield open_one


def _stop(last: int, header: StreamHeader, error: Diagnostic) -> Event:
    words, time = words_of(error), unreached_time(error, last, header.dt)
    if time is not None:
        rest = last * header.dt
        words += f"; the robot rests at {rest:.6g} s, what was planned up to {time:.6g} s is left out"
    place = error.place
    # The page has the text of the main program alone.
    is_there = place is not None and Path(place.file).name == header.program_name
    line = place.line if place is not None and is_there else None
    return _event("stop", last, last, f"ended by {error.code}", words, line)


def _message(message: Message) -> Event:
    shown, tick = message.text.strip(), message.tick
    if len(shown) > MOST_SHOWN:
        shown = f"{shown[:MOST_SHOWN]} …"
    return _event("message", tick, tick, next(iter(shown.splitlines()), ""), shown, message.line)
