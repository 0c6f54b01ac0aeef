"""A criterion on whose minimum Newton's steps of a tick may go to and fro."""

from __future__ import annotations

import numpy as np

from irlx.transform.criteria.criterion import Array, Criterion


class Flat(Criterion):
    """1/2 S' H S, which grows in a few directions only."""

    name = "flat"

    def __init__(self, rows: Array, little: float = 1e-6) -> None:
        self._hessian = rows.T @ rows + little * np.eye(rows.shape[1])

    def value(self, q: Array, step: Array) -> float:
        return 0.5 * float(step @ self._hessian @ step)

    def gradient(self, q: Array, step: Array) -> Array:
        return self._hessian @ step

    def hessian(self) -> Array:
        return self._hessian
