"""The summary of a run as lines for a terminal: the verdict first, then what a reader may want to know."""

from __future__ import annotations

from collections.abc import Sequence
from math import degrees

from irlx.promises import CLOSURE
from irlx.report.clearances import SmallestClearance
from irlx.report.events import LimitActive, Slowed
from irlx.report.lines import Line, Tone, columns, plain_text, under
from irlx.report.returns import Return
from irlx.report.summary import Closure, LimitUse, Summary
from irlx.verifier import Report
from irlx.verifier.findings.table import printable

_MOST = 4
"""Entries of a list that are told; of the rest their number."""

_MOST_JOINTS = 3
"""The same for joints in one line."""

PER = {"position": "", "speed": "/s", "acceleration": "/s2"}
"""What follows the unit of a joint in values of each kind of limit."""


def summary_text(summary: Summary, verified: bool | None = None) -> str:
    """The summary without colour; see `summary_lines`."""
    return plain_text(summary_lines(summary, verified))


def summary_lines(summary: Summary, verified: bool | None = None) -> list[Line]:
    """Lines on a run: joint values in deg or mm, times in s, path errors in m and rad.

    `verified` tells whether all its files passed the verifier, None where none was looked at.
    """
    units = dict(zip(summary.joint_names, summary.joint_units, strict=True))
    lines = [headline(summary, verified), Line("moves", _moves(summary))]
    lines += under("slowed", _slowed(summary.slowed, units), Tone.CARE)
    worst = f"{summary.path_position_error:.2g} m, {summary.path_orientation_error:.2g} rad at worst"
    lines.append(Line("path error", worst))
    lines += under("limit use", _uses(summary.limit_use, units))
    lines += under("at a limit", _active(summary.active, _tick(summary), bool(summary.slowed)))
    if summary.clearance is not None:
        lines.append(Line("clearance", _clearance(summary.clearance)))
    if summary.closure is not None:
        lines.append(Line("closure", _closure(summary.closure, units)))
    lines += under("cyclic", _returns(summary.returns, summary.joint_units, summary.joint_names))
    return lines


def headline(summary: Summary, verified: bool | None = None) -> Line:
    """The verdict in one line: complete, verified, how long, slowed by how much, how near to something."""
    parts = ["complete" if summary.complete else "INCOMPLETE"]
    if verified is not None:
        parts.append("verified" if verified else "VERIFICATION FAILED")
    lost = sum(event.lost for event in summary.slowed)
    parts += [f"{summary.duration:.6g} s", f"slowed by {lost:.3g} s" if summary.slowed else "not slowed"]
    if summary.clearance is not None:
        parts.append(f"nearest {summary.clearance.distance * 1e3:.3g} mm")
    good = summary.complete and verified is not False
    return Line(None, f"{summary.program}: {', '.join(parts)}", Tone.GOOD if good else Tone.BAD)


def stop_line(summary: Summary, why: str) -> Line:
    """The verdict on a run that did not come to its end: how far it came, and what ended it."""
    moves = "1 move" if summary.moves == 1 else f"{summary.moves} moves"
    words = f"{summary.program}: INCOMPLETE, {moves} in {summary.duration:.6g} s until {why}"
    return Line(None, words, Tone.BAD)


def file_lines(summary: Summary, files: Sequence[str], reports: dict[str, Report]) -> list[Line]:
    """A line on each written file; what a failed check found."""
    rows = []
    for name in files:
        report = reports.get(name)
        unmade = f", {len(report.unchecked)} not made" if report is not None and report.unchecked else ""
        passed = f", {len(report.made)} checks passed{unmade}" if report is not None and report.passed else ""
        rows.append((name, f"{summary.samples} samples{passed}"))
    lines = [Line("written", words) for words in columns(rows)] if rows else []
    return [*lines, *failed_lines(reports)]


def failed_lines(reports: dict[str, Report]) -> list[Line]:
    """What is wrong with files that did not pass."""
    lines = []
    for name, report in reports.items():
        if not report.passed:
            first = report.failed[0]
            words = printable(f"{name}: {report.verdict}; {first.name}: {first.text}")
            lines.append(Line("VERIFY", words, Tone.BAD))
    return lines


def _tick(summary: Summary) -> float:
    return summary.duration / max(summary.samples - 1, 1)


def joint_value(value: float, unit: str, per: str = "") -> str:
    """A value in rad | m (`unit`), or in that `per` time, for people: in deg or mm."""
    if abs(value) < 1e-6:
        return f"{value:.2g} {unit}{per}"
    return f"{degrees(value):.4g} deg{per}" if unit == "rad" else f"{value * 1000.0:.4g} mm{per}"


def _moves(summary: Summary) -> str:
    planned = f" ({summary.planned} planned as a whole to keep limits)" if summary.planned else ""
    return f"{summary.moves}{planned}"


def _uses(uses: Sequence[LimitUse], units: dict[str, str]) -> list[str]:
    rows = [
        (
            use.kind,
            f"{100.0 * use.share:.4g} %",
            use.joint,
            _of(use.value, use.bound, units.get(use.joint, "rad"), PER[use.kind]),
            f"tick {use.tick}",
        )
        for use in uses
    ]
    return columns(rows, right=(1,)) if rows else []


def _of(value: float, bound: float, unit: str, per: str) -> str:
    """A value and its bound with their unit once."""
    scale, name = (degrees(1.0), "deg") if unit == "rad" else (1000.0, "mm")
    return f"{value * scale:.4g} of {bound * scale:.4g} {name}{per}"


def _active(events: Sequence[LimitActive], dt: float, slowed: bool) -> list[str]:
    """A line for each joint and bound that was held longest: how long in all, from when to when."""
    if not events:
        # A plan that slows the tool has its pace from limits without meeting them in any tick.
        return [] if slowed else ["no joint was held by one"]
    spans: dict[tuple[str, str], list[LimitActive]] = {}
    for event in events:
        # Of rates nobody wants to know the direction, of positions everybody.
        kind = f"{event.side} {event.kind}" if event.kind == "position" else event.kind
        spans.setdefault((event.joint, kind), []).append(event)

    def ticks(key: tuple[str, str]) -> int:
        return sum(event.last_tick - event.first_tick + 1 for event in spans[key])

    longest = sorted(spans, key=lambda key: -ticks(key))[:_MOST]
    rows = []
    for key in (key for key in spans if key in longest):
        first, last = spans[key][0].first_time, spans[key][-1].last_time
        times = f", {len(spans[key])} times" if len(spans[key]) > 1 else ""
        rows.append((*key, f"{ticks(key) * dt:.3g} s", f"{first:.6g}-{last:.6g} s{times}"))
    more = len(spans) - len(longest)
    return [*columns(rows, right=(2,)), *([f"and {more} more, for less time"] if more else [])]


def _clearance(found: SmallestClearance) -> str:
    distance, margin = (f"{value * 1e3:.4g} mm" for value in (found.distance, found.margin))
    return f"{distance} at least (margin {margin}): {found.link} and {found.other}, tick {found.tick}"


def _closure(found: Closure, units: dict[str, str]) -> str:
    if found.difference <= CLOSURE:
        return f"tool and posture end where they began, to {found.difference:.2g} rad|m"
    off = joint_value(found.difference, units.get(found.joint, "rad"))
    return f"the tool ends where it began, but {found.joint} is off by {off}"


def _slowed(events: Sequence[Slowed], units: dict[str, str]) -> list[str]:
    """What all slow places cost, and the costliest of them in order of time."""
    if not events:
        return []
    shown = sorted(events, key=lambda event: -event.lost)[:_MOST]
    rows = [_slowing(event, units) for event in sorted(shown, key=lambda event: event.first_tick)]
    lost = sum(event.lost for event in events)
    places = "1 place" if len(events) == 1 else f"{len(events)} places"
    others = len(events) - len(shown)
    words = f"{lost:.3g} s longer than programmed at {places}, the path is kept"
    return [words, *columns(rows, right=(2,)), *([f"and {others} more, for less time"] if others else [])]


def _slowing(event: Slowed, units: dict[str, str]) -> tuple[str, ...]:
    unit, scale = ("deg", degrees(1.0)) if event.turns else ("mm", 1000.0)
    requested, achieved = (_rate(value * scale) for value in (event.requested, event.achieved))
    bound = f"{joint_value(event.bound, units.get(event.joint, 'rad'), PER.get(event.kind, ''))}"
    return (
        event.lines,
        f"{event.first_time:.6g}-{event.last_time:.6g} s",
        f"+{event.lost:.3g} s",
        f"{achieved} of {requested} {unit}/s",
        f"{event.joint}: {bound}" if event.joint else "",
    )


def _rate(value: float) -> str:
    """A speed in as few digits as tell it."""
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def _returns(found: Sequence[Return], units: Sequence[str], names: Sequence[str]) -> list[str]:
    """What closed, in one line; for each return that did not the joints that are off and what held them."""
    lines = []
    closed = [one for one in found if one.closed]
    if closed:
        times = "once" if len(closed) == 1 else f"{len(closed)} times"
        worst = max(one.largest for one in closed)
        lines.append(f"back in the posture of CYCLICSTART {times}, to {worst:.2g} rad|m")
    open_ones = [one for one in found if not one.closed]
    for one in open_ones[:_MOST]:
        lines.append(f"line {one.line}: not back in the posture of line {one.since}, held by {one.held}")
        lines.append(f"  off: {_off(one, units, names)}")
    others = len(open_ones) - _MOST
    return [*lines, f"and {others} more returns that did not close"] if others > 0 else lines


def _off(one: Return, units: Sequence[str], names: Sequence[str]) -> str:
    """The joints that are off most, and how many others are."""
    joints = [joint for joint in zip(one.left, names, units, strict=True) if abs(joint[0]) > CLOSURE]
    joints.sort(key=lambda joint: -abs(joint[0]))
    told = [f"{name} {joint_value(left, unit)}" for left, name, unit in joints[:_MOST_JOINTS]]
    others = len(joints) - _MOST_JOINTS
    return ", ".join([*told, *([f"and {others} more joints"] if others > 0 else [])])
