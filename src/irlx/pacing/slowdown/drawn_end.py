"""The end of a motion that is drawn to a posture: where the criterion wants it, however slow the way there.

The elastic walk counts steps by programmed time. Where speeds bind it may still lag behind the posture at
the last knot; the clock has all the time it needs, so what is missing is spread over the knots.
"""

from __future__ import annotations

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
    model: Model, grid: PathGrid, walked: Array, bounds: tuple[Array, Array], criterion: Criterion
) -> Array:
    """Postures (N + 1, n) of a walk, led to the best end for the criterion of the last pose.

    `bounds` are lower and upper positions (N + 1, n). The walk stays as it is where its end is the best
    one, or where no such lead keeps the positions.
    """
    end = _best_end(model, grid, walked[-1], criterion)
    if end is None or float(np.max(np.abs(end - walked[-1]))) <= _NOTHING:
        return walked
    targets = model.targets(grid.poses)
    for knots in (grid.intervals, LEAD):
        x = np.clip(1.0 - (grid.intervals - np.arange(grid.intervals + 1)) / knots, 0.0, 1.0)
        risen = x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
        led = walked + risen[:, None] * (end - walked[-1])
        led[:, ~model.free] = walked[:, ~model.free]
        try:
            led = model.onto_path(led, targets, _ROUNDS).q
        except np.linalg.LinAlgError:
            return walked
        led[0], led[-1] = walked[0], end
        led = rounded_inside(led, model.limits)
        if np.all(np.isfinite(led)) and np.all((led >= bounds[0]) & (led <= bounds[1])):
            return led
    return walked


def _best_end(model: Model, grid: PathGrid, last: Array, criterion: Criterion) -> Array | None:
    """Posture (n,) of the last pose at which the criterion is least within the position limits."""
    source = np.full(last.size, BoundSource.POSITION, dtype=np.int8)
    room = StepBounds(model.limits.position_lower - last, model.limits.position_upper - last, source, source)
    target = model.kinematics.target(grid.poses.rotation[-1], grid.poses.position[-1])
    solver = TickSolver(model.kinematics, ProxQpSolver())
    found = solver.solve(TickProblem(target, last, room, criterion, model.free), thorough=False)
    return rounded_inside(found.q, model.limits) if found.solved else None
