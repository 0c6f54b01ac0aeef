"""The limits in force at each row, and the checks that hold positions, speeds and accelerations to them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.blocks import JointRange, LimitKind, LimitSwitchBlock
from irlx.promises import LIMIT_EXCESS, rounding_allowance
from irlx.robot.limits import JointLimits
from irlx.streams.joint_stream import Floats, Integers, JointStream
from irlx.verifier.moves import MoveRows
from irlx.verifier.tally import Tally

KINDS = {"position": LimitKind.POSITION, "speed": LimitKind.SPEED, "acceleration": LimitKind.ACCELERATION}

_ROWS = 1 << 16
_Ranges = dict[LimitKind, JointRange]


@dataclass(frozen=True)
class LimitsInForce:
    """`sets` of limits that occur in a stream, and for each row the `index` (N,) of the one in force."""

    sets: list[JointLimits]
    index: Integers

    def bounds(self, kind: str, rows: slice) -> tuple[Floats, Floats]:
        """Lower and upper bounds (R, n) of 'position', 'speed' or 'acceleration' at rows."""
        pairs = [limits.pair(kind) for limits in self.sets]
        which = self.index[rows]
        return np.stack([low for low, _ in pairs])[which], np.stack([high for _, high in pairs])[which]


def limits_in_force(stream: JointStream, moves: list[MoveRows]) -> LimitsInForce:
    """Limits at each row: the robot's, narrowed by the switch of each kind, or by the clause of the move.

    A switch recorded at tick k holds from row k + 1 on; a clause replaces the switch of its kind in
    the rows of its move; neither can widen the robot's own limits.
    """
    states: list[_Ranges] = [{}]
    state = np.zeros(len(stream.ticks), dtype=np.int64)
    for record in stream.records:
        if isinstance(record.block, LimitSwitchBlock):
            ranges = {kind: bounds for kind, bounds in states[-1].items() if kind is not record.block.kind}
            if record.block.range is not None:
                ranges[record.block.kind] = record.block.range
            states.append(ranges)
            state[record.tick + 1 :] = len(states) - 1
    return _resolved(stream, moves, states, state)


def _resolved(
    stream: JointStream, moves: list[MoveRows], states: list[_Ranges], state: Integers
) -> LimitsInForce:
    """Sets of limits of the switches' states, and of those states under the clauses of moves."""
    robot = stream.header.limits
    sets = [_narrowed(robot, ranges) for ranges in states]
    index = state.copy()
    for move in moves:
        clauses = {clause.kind: clause.range for clause in move.block.limits}
        if clauses and move.last > move.start:
            part = slice(move.start + 1, move.last + 1)
            for number in np.unique(state[part]).tolist():
                index[part][state[part] == number] = len(sets)
                sets.append(_narrowed(robot, {**states[number], **clauses}))
    return LimitsInForce(sets, index)


def _narrowed(robot: JointLimits, ranges: _Ranges) -> JointLimits:
    limits = robot
    for name, kind in KINDS.items():
        if kind in ranges:
            lower, upper = robot.pair(name)
            bounds = ranges[kind]
            limits = limits.with_pair(name, np.maximum(lower, bounds.lower), np.minimum(upper, bounds.upper))
    return limits


def check_limits(kind: str, stream: JointStream, limits: LimitsInForce, tally: Tally) -> None:
    """Add all rows to `tally`: positions must hold exactly, the others up to what principle 2 allows.

    Allowed are bound (1 + LIMIT_EXCESS) + `rounding_allowance` of the stream's values.
    """
    values = {"position": stream.q, "speed": stream.qd, "acceleration": stream.qdd}[kind]
    allowance = dict(zip(("speed", "acceleration"), rounding_allowance(stream.q, stream.dt), strict=True))
    for start in range(0, len(values), _ROWS):
        part = slice(start, min(start + _ROWS, len(values)))
        lower, upper = limits.bounds(kind, part)
        rows = np.arange(part.start, part.stop)
        if kind == "position":
            add_positions(tally, rows, values[part], lower, upper)
        else:
            _add_rates(tally, rows, values[part], (lower, upper), allowance[kind])


def add_positions(tally: Tally, rows: Integers, q: Floats, lower: Floats, upper: Floats) -> None:
    """Add positions q (R, n) with their bounds; the worst is nearest to a bound or furthest beyond."""
    beyond_upper, beyond_lower = q - upper, lower - q
    allowed = np.where(beyond_upper >= beyond_lower, upper, lower)
    inside: NDArray[np.bool_] = (q <= upper) & (q >= lower)
    tally.add(rows, q, allowed, ~inside, np.maximum(beyond_upper, beyond_lower))


def _add_rates(
    tally: Tally, rows: Integers, rates: Floats, bounds: tuple[Floats, Floats], allowance: float
) -> None:
    """Add speeds or accelerations (R, n); the worst is the one that uses most of its bound."""
    lower, upper = bounds
    high = upper + LIMIT_EXCESS * np.abs(upper) + allowance
    low = lower - LIMIT_EXCESS * np.abs(lower) - allowance
    inside: NDArray[np.bool_] = (rates <= high) & (rates >= low)
    # An allowance is tiny but never zero, so that a joint limited to 0 has a use of its bound as well.
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        use = np.where(rates > 0.0, rates / high, rates / low)
    allowed = np.where(rates > 0.0, upper, lower)
    use[np.isinf(allowed)] = -np.inf
    tally.add(rows, rates, allowed, ~inside, use)
