"""The QP by ProxQP (dense), its active set sharpened to rounding by least-norm solves."""

from __future__ import annotations

from typing import Any

import numpy as np

from irlx.transform.qp.active_set import sharpen
from irlx.transform.qp.solver import Array, QpSolution

_ACCURACY = 1e-9
_MAX_ITERATIONS = 400
_UNBOUNDED = 1e20
_SLACK = 1e-6


class ProxQpSolver:
    """Solves the least-norm problem with ProxQP; keeps one warm-started workspace a size."""

    def __init__(self) -> None:
        self._workspaces: dict[tuple[int, int], Any] = {}

    def solve(self, rows: Array, lower: Array, upper: Array) -> QpSolution:
        """Solve min 1/2 |z|^2 with lower <= A z <= upper, A of shape (n, r).

        The problem is scaled by the largest violation at z = 0, so that ProxQP's absolute accuracy
        means the same at every tick length.
        """
        nothing = np.zeros(rows.shape[0], dtype=np.int8)
        scale = float(max(np.max(lower), np.max(-upper), 0.0))
        if scale == 0.0:
            return QpSolution(np.zeros(rows.shape[1]), nothing)
        results = self._run(rows, lower / scale, upper / scale)
        if results is None:
            return QpSolution(None, nothing)
        z, multipliers = scale * results.x, results.z
        active = np.where(multipliers > _SLACK, 1, np.where(multipliers < -_SLACK, -1, 0)).astype(np.int8)
        return sharpen(rows, lower, upper, active) or QpSolution(z, active)

    def _run(self, rows: Array, lower: Array, upper: Array) -> Any:
        """ProxQP's results, or None where it finds the rows infeasible or does not finish."""
        from proxsuite import proxqp

        n, r = rows.shape
        low = np.maximum(lower, -_UNBOUNDED)
        up = np.minimum(upper, _UNBOUNDED)
        qp = self._workspaces.get((n, r))
        if qp is None:
            qp = proxqp.dense.QP(r, 0, n)
            qp.settings.eps_abs = _ACCURACY
            qp.settings.eps_rel = 0.0
            qp.settings.max_iter = _MAX_ITERATIONS
            qp.settings.initial_guess = proxqp.InitialGuess.NO_INITIAL_GUESS
            qp.init(np.eye(r), np.zeros(r), None, None, rows, low, up)
            self._workspaces[(n, r)] = qp
        else:
            qp.update(H=np.eye(r), g=np.zeros(r), A=None, b=None, C=rows, l=low, u=up)
        qp.solve()
        solved = qp.results.info.status == proxqp.QPSolverOutput.PROXQP_SOLVED
        return qp.results if solved else None
