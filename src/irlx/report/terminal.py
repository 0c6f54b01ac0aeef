"""The summary of a run as plain text for a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

from irlx.promises import CLOSURE
from irlx.report.clearances import SmallestClearance
from irlx.report.events import LimitActive, Slowed
from irlx.report.returns import Return
from irlx.report.summary import LimitUse, Summary
from irlx.verifier import Report
from irlx.verifier.findings.table import printable

_LABEL = 12
_MOST_SPANS = 4
_PER = {"position": "", "speed": "/s", "acceleration": "/s2"}


def summary_text(summary: Summary, joint_units: Sequence[str], joint_names: Sequence[str]) -> str:
    """Lines of label and figure; joint values in deg or mm."""
    units = dict(zip(joint_names, joint_units, strict=True))
    state = "complete" if summary.complete else "INCOMPLETE"
    lines = [
        _line("program", f"{summary.program}, {state}: {summary.moves} moves, {summary.samples} samples"),
        _line("duration", f"{summary.duration:.6g} s"),
        _line(
            "path error",
            f"{summary.path_position_error:.2g} m, {summary.path_orientation_error:.2g} rad at worst",
        ),
    ]
    lines += [_line("limit use", _use(use, units)) for use in summary.limit_use]
    lines += [_line("at a limit", words) for words in _active(summary.active)]
    if not summary.active:
        lines.append(_line("at a limit", "no joint was held by one"))
    if summary.planned:
        words = (
            f"{summary.planned} of {summary.moves} moves as a whole: ordinary ticks would have broken a limit"
        )
        lines.append(_line("planned", words))
    lines += [_line("slowed", words) for words in _slowed(summary.slowed, units)]
    if summary.closure is not None:
        difference = _value(summary.closure.difference, units[summary.closure.joint])
        words = f"the postures differ by {difference} at most ({summary.closure.joint})"
        lines.append(_line("closure", f"the tool ends where it began; {words}"))
    if summary.clearance is not None:
        lines.append(_line("clearance", _clearance(summary.clearance)))
    lines += [_line("cyclic", words) for words in _returns(summary.returns, joint_units, joint_names)]
    return "\n".join(lines)


def verification_line(name: str, report: Report) -> str:
    """One line on a verified file."""
    if not report.passed:
        first = report.failed[0]
        return _line("VERIFY", printable(f"{name}: {report.verdict}; {first.name}: {first.text}"))
    unmade = f", {len(report.unchecked)} not made" if report.unchecked else ""
    return _line("verified", f"{name}: {len(report.made)} checks passed{unmade}")


def _line(label: str, words: str) -> str:
    return f"{label:<{_LABEL}}{words}"


def _value(value: float, unit: str, per: str = "") -> str:
    if abs(value) < 1e-6:
        return f"{value:.2g} {unit}{per}"
    return f"{degrees(value):.6g} deg{per}" if unit == "rad" else f"{value * 1000.0:.6g} mm{per}"


def _use(use: LimitUse, units: dict[str, str]) -> str:
    value, bound = (_value(v, units[use.joint], _PER[use.kind]) for v in (use.value, use.bound))
    return f"{use.kind} {100.0 * use.share:.4g} %: {use.joint} {value} of {bound} at tick {use.tick}"


def _clearance(found: SmallestClearance) -> str:
    distance, margin = (f"{value * 1e3:.6g} mm" for value in (found.distance, found.margin))
    return f"at least {distance} (margin {margin}): {found.link} and {found.other} at tick {found.tick}"


def _slowed(events: Sequence[Slowed], units: dict[str, str]) -> list[str]:
    """The slowest places, the costliest first, and what all of them cost."""
    if not events:
        return []
    shown = sorted(events, key=lambda event: -event.lost)[:_MOST_SPANS]
    lines = [_slowing(event, units) for event in sorted(shown, key=lambda event: event.first_tick)]
    lost = sum(event.lost for event in events)
    places = "1 place" if len(events) == 1 else f"{len(events)} places"
    return [f"the path is kept; {lost:.3g} s longer than programmed, at {places}", *lines]


def _slowing(event: Slowed, units: dict[str, str]) -> str:
    unit, scale = ("deg", degrees(1.0)) if event.turns else ("mm", 1000.0)
    requested, achieved = (f"{value * scale:.4g}" for value in (event.requested, event.achieved))
    why = (
        f": {event.joint} {event.kind} {_value(event.bound, units[event.joint], _PER[event.kind])}"
        if event.joint
        else ""
    )
    return (
        f"line {event.line}, {event.first_time:.6g}-{event.last_time:.6g} s: "
        f"{achieved} of {requested} {unit}/s "
        f"at {event.way * scale:.4g} of {event.length * scale:.4g} {unit}{why}"
    )


def _returns(found: Sequence[Return], units: Sequence[str], names: Sequence[str]) -> list[str]:
    """What closed, in one line; for each return that did not the joints that are off and what held them."""
    lines = []
    closed = [one for one in found if one.closed]
    if closed:
        times = "once" if len(closed) == 1 else f"{len(closed)} times"
        worst = max(one.largest for one in closed)
        lines.append(f"back in the posture of CYCLICSTART {times}, to {worst:.2g} rad|m")
    open_ones = [one for one in found if not one.closed]
    for one in open_ones[:_MOST_SPANS]:
        off = sorted(zip(one.left, names, units, strict=True), key=lambda joint: -abs(joint[0]))
        words = ", ".join(f"{name} {_value(left, unit)}" for left, name, unit in off if abs(left) > CLOSURE)
        lines.append(
            f"line {one.line}: not back in the posture of line {one.since}: {words}; held by {one.held}"
        )
    others = len(open_ones) - _MOST_SPANS
    return [*lines, f"and {others} more returns that did not close"] if others > 0 else lines


def _active(events: Sequence[LimitActive]) -> list[str]:
    """One line for each joint and bound, with its spans of time."""
    spans: dict[tuple[str, str, str], list[str]] = {}
    for event in events:
        key = (event.joint, event.side, event.kind)
        spans.setdefault(key, []).append(f"{event.first_time:.6g}-{event.last_time:.6g}")
    lines = []
    for (joint, side, kind), times in spans.items():
        others = len(times) - _MOST_SPANS
        more = f" and {others} more times" if others > 0 else ""
        lines.append(f"{joint} {side} {kind}: {', '.join(times[:_MOST_SPANS])} s{more}")
    return lines
