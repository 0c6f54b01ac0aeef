"""The end of a motion that is drawn to a posture: where the criterion wants it, however slow the way there.

The elastic walk counts steps by programmed time. Where speeds bind it may still lag behind the posture at
the last knot; the clock has all the time it needs, so what is missing is spread over the knots. The same
holds for a place on the way where a posture is asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from irlx.pacing.slowdown.grid import PathGrid
from irlx.pacing.slowdown.model import Model
from irlx.pacing.slowdown.reserve import LEAD, rounded_inside
from irlx.transform.criteria.criterion import Criterion
from irlx.transform.qp.proxqp import ProxQpSolver
from irlx.transform.step_bounds import BoundSource, StepBounds
from irlx.transform.tick import TickSolver
from irlx.transform.tick_problem import TickProblem

Array = NDArray[np.float64]

_NOTHING = 1e-12
_ROUNDS = 3


def with_drawn_end(
    model: Model,
    grid: PathGrid,
    walked: Array,
    bounds: tuple[Array, Array],
    criterion_of: Callable[[float, float], Criterion],
    through: Sequence[int] = (),
) -> Array:
    """Postures (N + 1, n) of a walk, led to the best end for the criterion of the last pose.

    `bounds` are lower and upper positions (N + 1, n). `through` are inner knots, rising, at which the walk is
    led to the best posture as well. The walk stays as it is where it has the best
    posture, or where no such lead keeps the positions.
    """
    leading = _Leading(model, grid, bounds, criterion_of)
    last, kept = grid.intervals, 0
    knots = sorted(set(through))
    for knot, beyond in zip(knots, [*knots[1:], last], strict=False):
        room = knot - kept, beyond - knot
        near = min(LEAD, room[0]), min(LEAD, room[1])
        bumps = [
            _rise(last, knot - before, knot) - _rise(last, knot, knot + behind)
            for before, behind in (room, near)
        ]
        walked = leading.led(walked, knot, bumps, kept)
        # What leads to the next one begins behind this knot, which stays as it is.
        kept = knot
    rises = [_rise(last, kept, last), _rise(last, last - min(LEAD, last - kept), last)]
    return leading.led(walked, last, rises, kept)


def _rise(intervals: int, first: int, last: int) -> Array:
    """From 0 up to the knot `first` to 1 from the knot `last` on, at rest at both, (N + 1,)."""
    x = np.clip((np.arange(intervals + 1) - first) / (last - first), 0.0, 1.0)
    return np.asarray(x**3 * (10.0 - 15.0 * x + 6.0 * x**2))


@dataclass(frozen=True)
class _Leading:
    """Leads postures of a walk to better ones for the criterion of a pose."""

    model: Model
    grid: PathGrid
    bounds: tuple[Array, Array]
    criterion_of: Callable[[float, float], Criterion]

    def led(self, walked: Array, knot: int, shapes: Sequence[Array], kept: int = 0) -> Array:
        """The walk with the best posture at a knot, what is missing spread by the first shape (N + 1,) that
        keeps the positions; rows up to `kept` stay."""
        model, walked_free = self.model, walked[:, ~self.model.free]
        best = _best_posture(
            model, self.grid, knot, walked[knot], self.criterion_of(float(self.grid.s[knot]), 0.0)
        )
        if best is None or float(np.max(np.abs(best - walked[knot]))) <= _NOTHING:
            return walked
        targets = model.targets(self.grid.poses)
        for shape in shapes:
            led = walked + shape[:, None] * (best - walked[knot])
            led[:, ~model.free] = walked_free
            try:
                led = model.onto_path(led, targets, _ROUNDS).q
            except np.linalg.LinAlgError:
                return walked
            led[: kept + 1], led[-1], led[knot] = walked[: kept + 1], walked[-1], best
            led = rounded_inside(led, model.limits)
            if np.all(np.isfinite(led)) and np.all((led >= self.bounds[0]) & (led <= self.bounds[1])):
                return led
        return walked


def _best_posture(model: Model, grid: PathGrid, knot: int, q: Array, criterion: Criterion) -> Array | None:
    """Posture (n,) of a knot's pose, near q, at which the criterion is least within the position limits."""
    source = np.full(q.size, BoundSource.POSITION, dtype=np.int8)
    room = StepBounds(model.limits.position_lower - q, model.limits.position_upper - q, source, source)
    target = model.kinematics.target(grid.poses.rotation[knot], grid.poses.position[knot])
    solver = TickSolver(model.kinematics, ProxQpSolver())
    found = solver.solve(TickProblem(target, q, room, criterion, model.free), thorough=False)
    return rounded_inside(found.q, model.limits) if found.solved else None
