"""Which joints are drawn."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from irlx.diagnostics import IrlxError, report
from irlx.diagnostics.diagnostic import near_matches
from irlx.report.plot.curves import Bounds, Curves
from irlx.report.plot.quantity import Quantity


def joints_named(wanted: Sequence[str | int], names: tuple[str, ...]) -> list[int]:
    """Numbers from 0 of joints given by name, or by number from 1; in the order given, each once.

    Raises IrlxError, IRL006, for one that is not there.
    """
    found: list[int] = []
    for given in wanted:
        text = str(given).strip()
        if text in names:
            number = names.index(text)
        elif text.isdecimal() and 1 <= int(text) <= len(names):
            number = int(text) - 1
        else:
            cause = f"no such joint; there are {len(names)}{near_matches(text, names)}"
            raise IrlxError(report("IRL006", option="--joints", value=text, cause=cause))
        if number not in found:
            found.append(number)
    return found


def told_numbers(wanted: Sequence[str | int], names: tuple[str, ...]) -> list[str]:
    """Which joints are meant by numbers (from 1) where another number is in the name: '3 is joint_2'."""
    found: list[str] = []
    for text in dict.fromkeys(str(given).strip() for given in wanted):
        if text in names or not text.isdecimal():
            continue
        name = names[int(text) - 1]
        inside = [int(digits) for digits in re.findall(r"[0-9]+", name)]
        if inside and int(text) not in inside:
            found.append(f"{int(text)} is {name}")
    return found


def busiest_joints(all_curves: Sequence[Curves], most: int) -> list[int]:
    """The joints (from 0, in their order) that come nearest to their limits, or else move farthest.

    First those that are at a limit; then by the largest share of a speed or acceleration limit or of the
    half range of position that a joint uses; then by its way. Joints that stand still come last.
    """
    joints = len(all_curves[0].joint_names)
    scores = np.max([[_score(curves, joint) for joint in range(joints)] for curves in all_curves], axis=0)
    ways = np.max([[_way(curves, joint) for joint in range(joints)] for curves in all_curves], axis=0)
    order = sorted(range(joints), key=lambda joint: (ways[joint] <= 1e-9, -scores[joint], -ways[joint]))
    return sorted(order[:most])


def _way(curves: Curves, joint: int) -> float:
    """How far a joint goes, deg or mm; an integral of its speed where its position is not drawn."""
    for quantity in (Quantity.POSITION, Quantity.SPEED, Quantity.ACCELERATION):
        values = curves.values.get(quantity)
        if values is not None and len(values):
            return float(np.ptp(values[:, joint]))
    return 0.0


def _score(curves: Curves, joint: int) -> float:
    """Largest use of a limit, 1 where it is met, 2 and more by the time for which it is."""
    total = max(float(np.ptp(curves.t)), 1e-9) if len(curves.t) else 1.0
    at_limit = sum(span.end - span.begin for span in curves.limit_spans if span.joint == joint)
    if at_limit > 0.0 and _way(curves, joint) > 1e-9:
        return 2.0 + at_limit / total
    shares = [_share(curves, quantity, bounds, joint) for quantity, bounds in curves.bounds.items()]
    return max(shares, default=0.0)


def _share(curves: Curves, quantity: Quantity, bounds: Bounds, joint: int) -> float:
    """Largest part of the tightest bounds of a joint that it uses; 0 without bounds on both sides."""
    values = curves.values[quantity][:, joint]
    if not len(values) or not len(bounds.lower):
        return 0.0
    lower, upper = float(np.max(bounds.lower[:, joint])), float(np.min(bounds.upper[:, joint]))
    middle = 0.5 * (lower + upper) if quantity is Quantity.POSITION else 0.0
    room = min(upper - middle, middle - lower)
    if not np.isfinite(room) or room <= 0.0:
        return 0.0
    return min(float(np.max(np.abs(values - middle))) / room, 1.0)
