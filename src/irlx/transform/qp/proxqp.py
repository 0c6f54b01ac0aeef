"""The QP by ProxQP (dense), made exact; what it cannot decide is decided by the dual method."""

from __future__ import annotations

from typing import Any

import numpy as np

from irlx.transform.qp.active_set import sharpen
from irlx.transform.qp.dual import DualSolver
from irlx.transform.qp.solver import Array, QpSolution

_ACCURACY = 1e-9
_MAX_ITERATIONS = 60
_MAX_INNER_ITERATIONS = 30
_UNBOUNDED = 1e20
_SLACK = 1e-6


class ProxQpSolver:
    """Solves the least-norm problem with ProxQP; keeps one workspace a size.

    ProxQP gives the active rows, `sharpen` the exact solution for them. Where either finds none, the
    dual method has the last word: ProxQP may call a problem with a narrow solution infeasible.
    """

    def __init__(self) -> None:
        self._workspaces: dict[tuple[int, int], Any] = {}
        self._judge = DualSolver()

    def solve(self, rows: Array, lower: Array, upper: Array) -> QpSolution:
        """Solve min 1/2 |z|^2 with lower <= A z <= upper, A of shape (n, r).

        The problem is scaled by the largest violation at z = 0, so that ProxQP's absolute accuracy
        means the same at every tick length.
        """
        scale = float(max(np.max(lower), np.max(-upper), 0.0))
        if scale == 0.0:
            return QpSolution(np.zeros(rows.shape[1]), np.zeros(rows.shape[0], dtype=np.int8))
        multipliers = self._multipliers(rows, lower / scale, upper / scale)
        if multipliers is not None:
            guess = np.where(multipliers > _SLACK, 1, np.where(multipliers < -_SLACK, -1, 0))
            exact = sharpen(rows, lower, upper, guess.astype(np.int8))
            if exact is not None:
                return exact
        return self._judge.solve(rows, lower, upper)

    def _multipliers(self, rows: Array, lower: Array, upper: Array) -> Array | None:
        """ProxQP's multipliers of the rows (> 0 at the upper bound), None where it finds no solution."""
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
            qp.settings.max_iter_in = _MAX_INNER_ITERATIONS
            qp.settings.initial_guess = proxqp.InitialGuess.NO_INITIAL_GUESS
            qp.init(np.eye(r), np.zeros(r), None, None, rows, low, up, False)
            self._workspaces[(n, r)] = qp
        else:
            qp.update(
                H=np.eye(r), g=np.zeros(r), A=None, b=None, C=rows, l=low, u=up, update_preconditioner=False
            )
        qp.solve()
        solved = qp.results.info.status == proxqp.QPSolverOutput.PROXQP_SOLVED
        return np.array(qp.results.z) if solved else None
